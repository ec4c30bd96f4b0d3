#pragma once
// A setting is declared once, in the `describe` function of its struct: key with unit suffix, range, flags,
// meaning; the default is the member's initializer. From that one line come the parser, the range check, the
// JSON schema, the list of keys, the canonical text that is hashed and the sensitivity sweep.
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace hwsim {

enum KeyFlag : std::uint8_t {
  kNoFlags = 0,
  kRequired = 1,  ///< no default: a file must say it
  kFit = 2,       ///< calibration may move it inside its interval
  kFaster = 4,    ///< a larger value, or the switch turned on, never makes a pass take longer
  kSlower = 8,    ///< it never makes a pass take shorter
  kNeither = 16,  ///< it changes times in both directions; a key without a direction enters no time
  kWhole = 32,    ///< a real in the model (so that it has a derivative), a whole number in files
};
inline constexpr unsigned kDirections = kFaster | kSlower | kNeither;

struct KeyInfo {
  std::string_view name;  ///< "core_clock_mhz", "features.native_msaa_max"
  double low = 0.0;       ///< inclusive; unused for switches and texts
  double high = 0.0;
  unsigned flags = kNoFlags;
  std::string_view description;
  bool has(KeyFlag flag) const { return (flags & flag) != 0; }
};

using KeySlot = std::variant<double*, int*, bool*, std::string*>;

struct Key {
  KeyInfo info;
  KeySlot slot;
};

/// The visitor that turns a `describe` into a list of keys with the addresses of their values.
struct KeyCollector {
  std::vector<Key> keys;
  template <class Value>
  void key(const KeyInfo& info, Value& value) {
    keys.push_back({info, KeySlot(&value)});
  }
};

template <class Config>
std::vector<Key> keys_of(Config& config) {
  KeyCollector collector;
  describe(collector, config);
  return std::move(collector.keys);
}

}  // namespace hwsim
