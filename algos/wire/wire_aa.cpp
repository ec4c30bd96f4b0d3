#include "algos/wire/wire_aa.h"

#include "algos/wire/options.h"
#include "algos/wire/wire_draws.h"

namespace hwsim::algos {
namespace {

void modify(FrameRequest& request, const WireOptions& options) {
  request.separate = std::make_shared<const WireDraws>(options);
}

}  // namespace

void describe(OptionList& list, WireOptions& o) {
  list.real("width_px", o.width_px, {0.5, 4}, "least width of a wire in pixels; 1.3 with fxaa");
  list.real("w_hi", o.full_light_px, {1.01, 64},
            "from this width down to a pixel, lighting fades to its soft form");
  list.choice("lighting", o.lighting, "none|half_lambert|flatten|both",
              "the soft form: none, half Lambert, flattened normals, or both");
  list.whole("hl_pow", o.half_lambert_power, {1, 2}, "exponent of half Lambert");
  list.choice("fade", o.fade, "vertex|pixel",
              "computed at the vertices, or again from radius and distance in each pixel");
  list.choice("z_write", o.depth, "split|off|on",
              "depth: of wires wider than the least width only, of none, of all");
}

Room wire_room() {
  return {.techniques = {modifier_technique(
              "wire_aa", "wires at least a pixel wide, faded by their true width", modify)}};
}

}  // namespace hwsim::algos
