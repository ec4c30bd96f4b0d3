// Tone mapping with bloom: what a frame of linear light goes through before it is shown.
#include "algos/filters/shaders/tone_map.h"
#include "algos/base/frame_parts.h"
#include "algos/filters/filters.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

struct ToneMapOptions {
  double key = 0.18;
  double bloom = 0.1;
  double threshold = 1.0;
};

void describe(OptionList& list, ToneMapOptions& o) {
  list.real("key", o.key, {0.01, 1}, "what the frame's mean luminance becomes, before the curve");
  list.real("bloom", o.bloom, {0, 1}, "share of the blurred bright parts that is added");
  list.real("threshold", o.threshold, {0, 100}, "luminance beyond which a pixel is bright");
}

constexpr int kBloomFactor = 4, kMeanFactor = 8;

/// The image with a pixel for each factor x factor of `input`, and what the shader is to know of them.
struct Reduction {
  ImageId image;
  ReduceUniforms uniforms;
};

Reduction reduced(FrameGraph& graph, ImageId input, const std::string& name, Format format, int factor) {
  const ImageDesc from = graph.image(input);
  const auto side = [&](int px) { return (px + factor - 1) / factor; };
  return {graph.add_image({name, format, side(from.width), side(from.height), 1}),
          {factor, from.width, from.height, 0.0f}};
}

ImageId add_reduction(FrameGraph& graph, ImageId input, const std::string& name, const Reduction& to,
                      const FragmentProgram& program) {
  add_full_screen(graph, name, {input}, to.image, program, std::make_shared<ReduceUniforms>(to.uniforms));
  return to.image;
}

/// The frame's mean luminance, by a chain of smaller images.
ImageId add_mean_luminance(FrameGraph& graph, ImageId input) {
  const std::string name = "tone_map_luminance";
  ImageId mean = add_reduction(
      graph, input, name, reduced(graph, input, name, Format::r32_float, kBloomFactor), luminance_program());
  for (int level = 0; graph.image(mean).width > 1 || graph.image(mean).height > 1; ++level) {
    const std::string smaller = "tone_map_mean" + std::to_string(level);
    mean = add_reduction(graph, mean, smaller, reduced(graph, mean, smaller, Format::r32_float, kMeanFactor),
                         mean_program());
  }
  return mean;
}

ImageId add_blur(FrameGraph& graph, ImageId input, const std::string& name, int dx, int dy) {
  ImageDesc desc = graph.image(input);
  desc.name = name;
  const ImageId blurred = graph.add_image(desc);
  add_full_screen(graph, name, {input}, blurred, blur_program(),
                  std::make_shared<BlurUniforms>(BlurUniforms{dx, dy, desc.width, desc.height}));
  return blurred;
}

ImageId add_bloom(FrameGraph& graph, ImageId input, float threshold) {
  Reduction bright = reduced(graph, input, "tone_map_bright", Format::rgba16_float, kBloomFactor);
  bright.uniforms.threshold = threshold;
  const ImageId small = add_reduction(graph, input, "tone_map_bright", bright, bright_program());
  const ImageId row = add_blur(graph, small, "tone_map_blur_x", 1, 0);
  return add_blur(graph, row, "tone_map_blur_y", 0, 1);
}

ImageId add_tone_map(FrameGraph& graph, ImageId input, const ToneMapOptions& options) {
  const ImageId mean = add_mean_luminance(graph, input);
  const ImageId bloom = add_bloom(graph, input, static_cast<float>(options.threshold));
  const ImageId output =
      graph.add_image({"tone_map_output", Format::rgba8_srgb, graph.width(), graph.height(), 1});
  const ImageDesc small = graph.image(bloom);
  add_full_screen(graph, "tone_map", {input, bloom, mean}, output, tone_map_program(),
                  std::make_shared<ToneMapUniforms>(
                      ToneMapUniforms{static_cast<float>(options.key), static_cast<float>(options.bloom),
                                      kBloomFactor, small.width, small.height}));
  return output;
}

}  // namespace

TechniqueInfo tone_map_filter() {
  TechniqueInfo info =
      filter_technique("tone_map", "mean luminance, bloom and tone mapping of a frame in half floats",
                       add_tone_map, ToneMapOptions{});
  info.linear_input = true;
  return info;
}

}  // namespace hwsim::algos
