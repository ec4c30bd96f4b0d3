#pragma once
// A GPU's numbers over another scalar type: Jets to fit, duals to tell what a key is worth.
#include <string_view>
#include <variant>
#include <vector>

#include "hwsim/gpu/gpu_keys.h"

namespace hwsim {

/// Visits the keys of the lifted values beside those of the given ones.
template <class T, class Place>
struct Lifter {
  std::vector<Key> keys;
  const Place& place;
  std::size_t next = 0;
  void key(const KeyInfo& info, T& value) { value = place(info.name, *std::get<double*>(keys[next++].slot)); }
  void key(const KeyInfo&, int& value) { value = *std::get<int*>(keys[next++].slot); }
  void key(const KeyInfo&, bool& value) { value = *std::get<bool*>(keys[next++].slot); }
};

/// `place(name, value)` says what a real number becomes; it is called once for each, in the order of the
/// keys.
template <class T, class Place>
GpuValues<T> lift(GpuValues<double> values, const Place& place) {
  GpuValues<T> lifted;
  Lifter<T, Place> lifter{keys_of(values), place};
  describe(lifter, lifted);
  return lifted;
}

}  // namespace hwsim
