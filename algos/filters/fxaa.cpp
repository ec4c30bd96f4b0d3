#include "algos/filters/fxaa.h"

#include <algorithm>
#include <span>

#include "algos/base/frame_parts.h"
#include "algos/filters/post_filters.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

// Pixels added at each step of the search, presets 10 to 15, 20 to 29, 39 (techniques 7.1).
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

}  // namespace

FxaaUniforms fxaa_uniforms(const Parameters& parameters) {
  const Preset& preset = kPresets.at(static_cast<std::size_t>(parameters.find("preset")->second));
  FxaaUniforms u;
  u.steps = preset.steps;
  u.step_px = preset.step_px;
  u.subpix = static_cast<float>(parameters.find("subpix")->second);
  u.edge_threshold = static_cast<float>(parameters.find("edge_threshold")->second);
  u.edge_threshold_min = static_cast<float>(parameters.find("edge_threshold_min")->second);
  u.green_as_luma = parameters.find("green_as_luma")->second != 0;
  return u;
}

ImageId add_fxaa_passes(FrameGraph& graph, ImageId input, const std::string& name,
                        const FxaaUniforms& uniforms, bool discard) {
  ImageId color = input;
  if (!uniforms.green_as_luma) {
    color = add_perceptual(graph, name + "_luma");
    add_full_screen(graph, name + "_luma", {input}, color, luma_program(), std::make_shared<NoUniforms>())
        .views = {Format::rgba8_unorm};
  }
  const ImageId output = add_perceptual(graph, name + "_output");
  if (discard) {
    Pass& copy = graph.add_pass(name + "_copy", PassKind::copy);
    copy.source = color;
    copy.targets = {output};
  }
  add_full_screen(graph, name, {color}, output, fxaa_program(discard),
                  std::make_shared<FxaaUniforms>(uniforms))
      .views = {Format::rgba8_unorm};
  return output;
}

ImageId add_fxaa(FrameGraph& graph, ImageId input, const Parameters& parameters) {
  return add_fxaa_passes(graph, input, "fxaa", fxaa_uniforms(parameters),
                         parameters.find("discard")->second != 0);
}

}  // namespace hwsim::algos
