// SMAA 1x: edges, blending weights, blending (docs/techniques/filters.md#smaa).
#include <array>

#include "algos/base/frame_parts.h"
#include "algos/filters/filters.h"
#include "algos/filters/shaders/smaa.h"
#include "algos/filters/smaa_tables.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

enum class SmaaPreset : std::uint8_t { low, medium, high, ultra };
enum class SmaaEdges : std::uint8_t { luma, color };
struct SmaaOptions {
  SmaaPreset preset = SmaaPreset::high;
  SmaaEdges edges = SmaaEdges::luma;
};

void describe(OptionList& list, SmaaOptions& o) {
  list.choice("preset", o.preset, "low|medium|high|ultra", "threshold, search steps, diagonals and corners");
  list.choice("edges", o.edges, "luma|color", "contrast of luma, or the largest of the channels");
}

struct Preset {
  float threshold;
  int search_steps, diagonal_steps;  // 0: no diagonals
  int corner_rounding_pct;           // negative: corners stay
};
constexpr std::array<Preset, 4> kPresets = {
    {{0.15f, 4, 0, -1}, {0.1f, 8, 0, -1}, {0.1f, 16, 8, 25}, {0.05f, 32, 16, 25}}};

void select_edges(Pass& pass, ImageId stencil, bool mark) {
  pass.depth = stencil;
  pass.depth_read_only = true;
  pass.state.stencil.test = true;
  pass.state.stencil.reference = 1;
  if (mark)
    pass.state.stencil.on_pass = StencilOp::replace;
  else
    pass.state.stencil.compare = Compare::equal;
}

ImageId add_smaa(FrameGraph& graph, ImageId input, const SmaaOptions& options) {
  const Preset& preset = kPresets.at(static_cast<std::size_t>(options.preset));
  SmaaUniforms u;
  u.threshold = preset.threshold;
  u.color_edges = options.edges == SmaaEdges::color;
  u.search_steps = preset.search_steps;
  if (preset.diagonal_steps > 0) u.diagonal_steps = preset.diagonal_steps;
  u.corners = preset.corner_rounding_pct >= 0;
  u.corner_rounding = 0.01f * static_cast<float>(preset.corner_rounding_pct);
  const auto uniforms = std::make_shared<SmaaUniforms>(u);

  const auto image = [&](const char* name, Format format) {
    return graph.add_image({name, format, graph.width(), graph.height(), 1});
  };
  const ImageId edges = image("smaa_edges", Format::rg8_unorm),
                weights = image("smaa_weights", Format::rgba8_unorm);
  const ImageId stencil = image("smaa_stencil", Format::s8_uint);
  const ImageId output = image("smaa_output", Format::rgba8_srgb);
  const ImageId area =
      graph.add_image({"smaa_area_table", Format::rg8_unorm, 160, 560, 1}, smaa_area_table());
  const ImageId search =
      graph.add_image({"smaa_search_table", Format::r8_unorm, 64, 16, 1}, smaa_search_table());

  graph.add_clear("smaa_clear", {edges, weights, stencil});
  Pass& edge = add_full_screen(graph, "smaa_edges", {input}, edges, smaa_edge_program(), uniforms);
  edge.views = {Format::rgba8_unorm};
  select_edges(edge, stencil, true);
  select_edges(add_full_screen(graph, "smaa_weights", {edges, area, search}, weights,
                               smaa_weight_program(preset.diagonal_steps > 0), uniforms),
               stencil, false);
  Pass& blend =
      add_full_screen(graph, "smaa_blend", {weights, input}, output, smaa_blend_program(), uniforms);
  blend.views = {Format::none, Format::rgba8_srgb};
  return output;
}

}  // namespace

TechniqueInfo smaa_filter() {
  return filter_technique("smaa", "SMAA 1x: edges re-vectorized, diagonals and corners included", add_smaa);
}

}  // namespace hwsim::algos
