#pragma once
// Pictures hold few values many times, and powers are slow.
#include <array>
#include <bit>
#include <cstdint>

#include "pipeline/image/image.h"

namespace hwsim::pipeline {

/// srgb_from_linear of values that have often been asked for before.
class KnownSrgb {
 public:
  float operator()(float linear) {
    const auto bits = std::bit_cast<std::uint32_t>(linear);
    Entry& entry = entries_[bits * 0x9E3779B1u >> (32 - kBits)];
    if (entry.linear != bits) entry = {bits, srgb_from_linear(linear)};
    return entry.encoded;
  }

 private:
  static constexpr int kBits = 11;
  struct Entry {
    std::uint32_t linear = 0;
    float encoded = 0.0f;
  };
  std::array<Entry, std::size_t{1} << kBits> entries_{};  // 0 is encoded as 0: valid as they are
};

}  // namespace hwsim::pipeline
