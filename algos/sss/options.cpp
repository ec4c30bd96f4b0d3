#include "algos/sss/options.h"

#include <array>

namespace hwsim::algos {
namespace {

void describe_selection(OptionList& list, SssOptions& o) {
  list.real("theta_c", o.theta_c_deg, {0.01, 90},
            "triangles are critical whose normals differ by more, in degrees");
  list.real("tri_px", o.triangle_px, {0, 1e6}, "a triangle is small below the square of this, in pixels");
  list.real("hl_px", o.highlight_px, {0, 1e6}, "a highlight is small below this, in pixels");
  list.choice("mode", o.mode, "and|or",
              "sampled are triangles with small area, small highlight: both, or one of them");
  list.choice("early_exit", o.early_exit, "off|on", "leave out triangles that no highlight comes near");
  list.real("tau", o.threshold, {0, 0.2}, "a highlight below this does not count");
}

void describe_sampling(OptionList& list, SssOptions& o) {
  list.real("rho", o.samples_per_px, {1, 256}, "points for a pixel of area");
  list.real("k_min", o.samples_min, {1, 64}, "points of a triangle, at least");
  list.real("k_max", o.samples_max, {1, 256}, "and at most");
  list.real("rho_min", o.sparsest_per_px, {0, 256},
            "points for a pixel below which a triangle is left to the frame: k_max is spread too thin");
  list.real("border_frac", o.border_share, {0, 1}, "share of them on the border");
  list.real("pt_bias_units", o.depth_bias_steps, {0, 65536},
            "samples come forward by this many steps of 24-bit depth");
  list.real("pt_bias_slope", o.depth_slope, {0, 16}, "and by this times the change of depth for a pixel");
}

}  // namespace

void describe(OptionList& list, SssOptions& o) {
  describe_selection(list, o);
  describe_sampling(list, o);
  list.choice("shading", o.shading, "scene|phong",
              "highlights of the whole frame: the scene's model, or Phong's, as the paper has it");
  list.choice("base", o.base, "auto|msaa8x|csaa32x",
              "the frame below: 8 samples, with 32 positions of coverage where the GPU has them; without: 8x "
              "multisampling");
  list.choice("rest", o.rest, "frame|others",
              "under what samples leave of a pixel: the whole frame, which holds their triangles already, or "
              "its other triangles");
}

void describe(OptionList& list, SssPointOptions& o) {
  describe(list, o.sss);
  list.choice("points", o.points, "auto|geometry_shader|tessellator",
              "from a geometry shader, or from the tessellator, whose points fill no buffer");
  list.choice(
      "depth", o.depth, "fixed|shader",
      "points are tested by the hardware against the frame's samples, or by their shader against one");
}

void describe(OptionList& list, SssComputeOptions& o) {
  describe(list, o.sss);
  list.choice("atomics", o.atomics, "auto|integer|float", "sums in fixed point, or in floats");
  list.whole("fixed_bits", o.fixed_bits, {12, 24}, "of a sum's 32 bits, those behind the point");
  list.real("radiance_max", o.radiance_max, {1, 1024}, "brightest sample; more takes bits from the rest");
}

void describe(OptionList& list, SssListOptions& o) {
  describe(list, o.sss);
  list.choice(
      "m", o.grid, "2|4|8|adaptive",
      "m x m places in a pixel; adaptive: 4, or 8 where a highlight is thinner than a quarter of a pixel");
  list.choice("node_bytes", o.node_bytes, "12|16|32", std::array{12, 16, 4 * kSssPlaceNodeWords},
              "of a list's node; 32: with its places and plane, so that nodes hide each other place by "
              "place");
  list.whole("capacity_nodes", o.capacity_nodes, {0, 1'000'000'000}, "nodes in memory; 0: four a pixel");
  list.real("budget_mib", o.budget_mib, {0, 65536},
            "or as many as fit with the heads; 0: capacity_nodes says it");
  list.whole("list_cap", o.list_cap, {1, 64}, "nodes that the resolve reads of a pixel");
  list.choice("conservative", o.conservative, "boxes|raster",
              "boxes from the geometry shader, or the rasterizer's own");
}

}  // namespace hwsim::algos
