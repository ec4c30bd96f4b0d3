#pragma once
// The witness of TimeSlopes: derivatives that are carried forward through every chunk of a trace.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "hwsim/engines/timing.h"
#include "hwsim/gpu/gpu_lift.h"
#include "hwsim/timing/dual.h"
#include "hwsim/timing/time_pass.h"
#include "hwsim/timing/time_slopes.h"

namespace hwsim::test {

/// d(frame time) / d(key) of the queue engine, one for each key.
inline std::vector<double> forward_slopes(const WorkTrace& trace, const GpuConfig& gpu,
                                          std::span<const std::string> keys) {
  constexpr std::size_t kWidth = 8;
  using Number = Dual<kWidth>;
  std::vector<double> slopes;
  for (std::size_t first = 0; first < keys.size(); first += kWidth) {
    const auto rates = derive_rates<Number>(lift<Number>(gpu, [&](std::string_view key, double value) {
      const auto found = std::ranges::find(keys, key);
      const auto index = static_cast<std::size_t>(found - keys.begin());
      return index >= first && index < first + kWidth ? Number(value, index - first) : Number(value);
    }));
    const Number time = sum_of_passes_ns<Number>(trace, [&](const PassWork& pass, bool waits) {
      return time_pass(pass, rates, Engine::queue, waits).time_ns;
    });
    for (std::size_t i = 0; i < kWidth && slopes.size() < keys.size(); ++i) slopes.push_back(time.d[i]);
  }
  return slopes;
}

/// Every real number of a GPU.
inline std::vector<std::string> real_keys(const GpuConfig& gpu) {
  GpuValues<double> values = gpu;
  std::vector<std::string> names;
  for (const Key& key : keys_of(values))
    if (std::holds_alternative<double*>(key.slot)) names.emplace_back(key.info.name);
  return names;
}

/// How many of the slopes are not zero.
inline std::size_t expect_equal_slopes(const WorkTrace& trace, const GpuConfig& gpu,
                                       std::span<const std::string> keys, const std::string& what) {
  TimeSlopes slopes(gpu, keys);
  const double time_ns = time_frame(trace, gpu, Engine::queue, {}, &slopes).time_ns;
  EXPECT_EQ(time_ns, time_frame(trace, gpu, Engine::queue).time_ns) << what;
  const std::vector<double> forward = forward_slopes(trace, gpu, keys);
  GpuValues<double> values = gpu;
  const std::vector<Key> all = keys_of(values);
  std::size_t nonzero = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto key = std::ranges::find(all, keys[i], [](const Key& k) { return k.info.name; });
    const double value = *std::get<double*>(key->slot);
    const double unit_ns = time_ns / std::max(std::abs(value), 1e-9);
    // Sums over thousands of chunks in another order.
    EXPECT_NEAR(slopes.ns()[i], forward[i], 1e-9 * std::abs(forward[i]) + 1e-12 * unit_ns)
        << what << ": " << keys[i];
    nonzero += forward[i] != 0.0 ? 1 : 0;
  }
  return nonzero;
}

}  // namespace hwsim::test
