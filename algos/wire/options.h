#pragma once
// Options of wire anti-aliasing.
#include <cstdint>

#include "algos/base/options.h"

namespace hwsim::algos {

enum class WireLighting : std::uint8_t { none, half_lambert, flatten, both };
enum class WireFade : std::uint8_t { vertex, pixel };
enum class WireDepth : std::uint8_t { split, none, all };  ///< which wires write depth: wide ones, none, all

struct WireOptions {
  double width_px = 1.0;       ///< least width
  double full_light_px = 4.0;  ///< from this width on a wire is lit as any surface
  WireLighting lighting = WireLighting::half_lambert;
  int half_lambert_power = 2;
  WireFade fade = WireFade::vertex;
  WireDepth depth = WireDepth::split;
};
void describe(OptionList& list, WireOptions& o);

}  // namespace hwsim::algos
