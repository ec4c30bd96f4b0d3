#include "algos/filters/fxaa.h"

#include <algorithm>
#include <span>

#include "algos/base/frame_parts.h"
#include "algos/filters/filters.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

// Pixels added at each step of the search, presets 10 to 15, 20 to 29, 39 (docs/techniques/filters.md#fxaa).
struct Preset {
  int steps;
  std::array<float, kMaxFxaaSteps> step_px;
};
constexpr std::array<Preset, 17> kPresets = {{
    {3, {1.5f, 3, 12}},
    {4, {1, 1.5f, 3, 12}},
    {5, {1, 1.5f, 2, 4, 12}},
    {6, {1, 1.5f, 2, 2, 4, 12}},
    {7, {1, 1.5f, 2, 2, 2, 4, 12}},
    {8, {1, 1.5f, 2, 2, 2, 2, 4, 12}},
    {3, {1.5f, 2, 8}},
    {4, {1, 1.5f, 2, 8}},
    {5, {1, 1.5f, 2, 2, 8}},
    {6, {1, 1.5f, 2, 2, 2, 8}},
    {7, {1, 1.5f, 2, 2, 2, 3, 8}},
    {8, {1, 1.5f, 2, 2, 2, 2, 4, 8}},
    {9, {1, 1.5f, 2, 2, 2, 2, 2, 4, 8}},
    {10, {1, 1.5f, 2, 2, 2, 2, 2, 2, 4, 8}},
    {11, {1, 1.5f, 2, 2, 2, 2, 2, 2, 2, 4, 8}},
    {12, {1, 1.5f, 2, 2, 2, 2, 2, 2, 2, 2, 4, 8}},
    {12, {1, 1, 1, 1, 1, 1.5f, 2, 2, 2, 2, 4, 8}},
}};

ImageId add_perceptual(FrameGraph& graph, const std::string& name) {
  return graph.add_image({name, Format::rgba8_unorm, graph.width(), graph.height(), 1});
}

ImageId add_fxaa(FrameGraph& graph, ImageId input, const FxaaOptions& options) {
  return add_fxaa_passes(graph, input, "fxaa", fxaa_uniforms(options), options.path);
}

}  // namespace

FxaaUniforms fxaa_uniforms(const FxaaOptions& options) {
  const Preset& preset = kPresets.at(static_cast<std::size_t>(options.preset));
  FxaaUniforms u;
  u.steps = preset.steps;
  u.step_px = preset.step_px;
  u.subpix = static_cast<float>(options.subpix);
  u.edge_threshold = static_cast<float>(options.edge_threshold);
  u.edge_threshold_min = static_cast<float>(options.edge_threshold_min);
  u.green_as_luma = options.green_as_luma;
  return u;
}

ImageId add_fxaa_passes(FrameGraph& graph, ImageId input, const std::string& name,
                        const FxaaUniforms& uniforms, const FxaaPath& path) {
  ImageId color = input;
  if (!uniforms.green_as_luma) {
    color = add_perceptual(graph, name + "_luma");
    add_full_screen(graph, name + "_luma", {input}, color, luma_program(), std::make_shared<NoUniforms>())
        .views = {Format::rgba8_unorm};
  }
  const ImageId output = add_perceptual(graph, name + "_output");
  if (path.discard) {
    Pass& copy = graph.add_pass(name + "_copy", PassKind::copy);
    copy.source = color;
    copy.targets = {output};
  }
  add_full_screen(graph, name, {color}, output, fxaa_program(path), std::make_shared<FxaaUniforms>(uniforms))
      .views = {Format::rgba8_unorm};
  return output;
}

void describe(OptionList& list, FxaaOptions& o) {
  list.choice("preset", o.preset, "10|11|12|13|14|15|20|21|22|23|24|25|26|27|28|29|39",
              "steps of the search along edges");
  list.real("subpix", o.subpix, {0, 1}, "blur of details that are smaller than a pixel");
  list.real("edge_threshold", o.edge_threshold, {0.01, 1},
            "contrast of an edge, as a part of the highest luma");
  list.real("edge_threshold_min", o.edge_threshold_min, {0, 1},
            "least contrast of an edge: darkness is not filtered");
  list.choice("green_as_luma", o.green_as_luma, "off|on", "no pass that writes luma: green stands for it");
  list.choice(
      "gather", o.path.gather, "off|on",
      "lumas around the pixel by two gathers of four, as in the Direct3D 11 shader; off: by eight loads");
  list.choice("discard", o.path.discard, "off|on",
              "edges are drawn onto a copy of the image, other pixels discarded");
}

TechniqueInfo fxaa_filter() {
  return filter_technique("fxaa", "FXAA 3.11 Quality: blends along edges found by luma", add_fxaa);
}

}  // namespace hwsim::algos
