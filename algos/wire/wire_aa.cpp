#include "algos/wire/wire_aa.h"

#include <array>

namespace hwsim::algos {
namespace {

constexpr std::array<ParameterInfo, 6> kParameters = {{
    {"width_px", 1, 0.5, 4, "least width of a wire in pixels; 1.3 with fxaa"},
    {"w_hi", 4, 1.01, 64, "from this width down to a pixel, lighting fades to its soft form"},
    {"lighting", 1, 0, 3, "the soft form: none, half Lambert, flattened normals, or both",
     "none|half_lambert|flatten|both"},
    {"hl_pow", 2, 1, 2, "exponent of half Lambert"},
    {"fade", 0, 0, 1, "computed at the vertices, or again from radius and distance in each pixel",
     "vertex|pixel"},
    {"z_write", 0, 0, 2, "depth: of wires wider than the least width only, of none, of all", "split|off|on"},
}};

void modify(FrameRequest& request, const Parameters& p) {
  const auto value = [&](std::string_view name) { return p.find(name)->second; };
  WireOptions wires;
  wires.width_px = static_cast<float>(value("width_px"));
  wires.full_light_px = static_cast<float>(value("w_hi"));
  const int lighting = static_cast<int>(value("lighting"));
  wires.half_lambert = (lighting & 1) != 0;
  wires.flatten = (lighting & 2) != 0;
  wires.half_lambert_power = static_cast<int>(value("hl_pow"));
  wires.fade_per_pixel = value("fade") != 0;
  wires.depth = static_cast<WireDepth>(value("z_write"));
  request.wires = wires;
}

}  // namespace

std::span<const TechniqueInfo> wire_techniques() {
  static constexpr TechniqueInfo kTechniques[] = {
      {.id = "wire_aa",
       .description = "wires at least a pixel wide, faded by their true width",
       .parameters = kParameters,
       .modify = modify},
  };
  return kTechniques;
}

}  // namespace hwsim::algos
