#include "algos/forward/forward.h"

#include <array>
#include <cmath>

#include "algos/base/frame_parts.h"
#include "algos/base/shaders/post.h"
#include "pipeline/state/sample_pattern.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

// Variant A: one big image, box filter.
void build_ordered(FrameGraph& graph, const FrameParts& parts, int factor) {
  const ForwardTarget target =
      make_forward_target(graph, "supersampled", graph.width() * factor, graph.height() * factor, 1);
  add_forward(graph, parts, "", target);
  const ImageId output = add_output(graph);
  add_full_screen(graph, "downsample", {target.color}, output, downsample_program(),
                  std::make_shared<DownsampleUniforms>(DownsampleUniforms{factor}));
}

// Variant C: jittered frames, summed in floats: fp16 loses increments beyond 2048 samples, and rounds before
// (techniques 1.2).
void build_accumulated(FrameGraph& graph, const FrameParts& parts, int factor) {
  ForwardTarget target = make_forward_target(graph, "frame", graph.width(), graph.height(), 1);
  const ImageId sum =
      graph.add_image({"accumulated", Format::rgba32_float, graph.width(), graph.height(), 1});
  graph.add_clear("accumulate_clear", {sum});
  const float k = static_cast<float>(factor);
  for (int j = 0; j < factor * factor; ++j) {
    target.jitter_px = {(2.0f * static_cast<float>(j % factor) + 1.0f) / (2.0f * k) - 0.5f,
                        (2.0f * static_cast<float>(j / factor) + 1.0f) / (2.0f * k) - 0.5f};
    const std::string number = std::to_string(j) + "_";
    add_forward(graph, parts, number, target);
    Pass& pass = add_full_screen(graph, number + "accumulate", {target.color}, sum, scale_program(),
                                 std::make_shared<ScaleUniforms>(ScaleUniforms{1.0f}));
    pass.state.blend = {{true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf}};
  }
  add_full_screen(graph, "normalize", {sum}, add_output(graph), scale_program(),
                  std::make_shared<ScaleUniforms>(ScaleUniforms{1.0f / (k * k)}));
}

void build_multisampled(FrameGraph& graph, const FrameParts& parts, int samples, bool centroid,
                        bool sample_rate) {
  ForwardTarget target = make_forward_target(graph, "multisampled", graph.width(), graph.height(), samples);
  target.centroid = centroid;
  target.sample_rate = sample_rate;
  add_forward(graph, parts, "", target);
  graph.add_resolve("resolve", target.color, add_output(graph));
}

// Layers of eight samples under shifted viewports (techniques 1.4); no resolve mixes layers, so a shader
// does.
void build_multicast(FrameGraph& graph, const FrameParts& parts, int samples, bool centroid,
                     const MulticastPattern& layers) {
  ForwardTarget target = make_forward_target(graph, "multisampled", graph.width(), graph.height(), samples,
                                             Format::rgba8_srgb, Format::d24_unorm_s8, layers);
  target.centroid = centroid;
  add_forward(graph, parts, "", target);
  add_full_screen(graph, "merge", {target.color}, add_output(graph), merge_program(),
                  std::make_shared<MergeUniforms>(MergeUniforms{samples}));
}

/// Samples and positions of coverage (techniques 1.6).
struct CoverageMode {
  int samples, coverage_samples;
};

FrameGraph build_coverage(const FrameRequest& request, const Parameters& parameters, CoverageMode mode) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  ForwardTarget target;
  target.width = graph.width();
  target.height = graph.height();
  target.samples = mode.samples;
  target.coverage_samples = mode.coverage_samples > mode.samples ? mode.coverage_samples : 0;
  target.centroid = parameters.find("centroid")->second != 0;
  target.drop_orphans = parameters.find("orphans")->second != 0;
  target.color = graph.add_image({"multisampled_color", Format::rgba8_srgb, target.width, target.height,
                                  target.samples, 1, target.coverage_samples});
  target.depth = graph.add_image(
      {"multisampled_depth", Format::d24_unorm_s8, target.width, target.height, target.samples});
  add_forward(graph, parts, "", target);
  graph.add_resolve("resolve", target.color, add_output(graph));
  return graph;
}

int integer(const Parameters& parameters, std::string_view name) {
  return static_cast<int>(parameters.find(name)->second);
}

FrameGraph build_none(const FrameRequest& request, const Parameters&) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  ForwardTarget target;
  target.width = graph.width();
  target.height = graph.height();
  target.color = add_output(graph);
  target.depth = graph.add_image({"depth", Format::d24_unorm_s8, graph.width(), graph.height(), 1});
  add_forward(graph, parts, "", target);
  return graph;
}

FrameGraph build_ssaa(const FrameRequest& request, const Parameters& parameters) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  const int samples = integer(parameters, "samples");
  const int factor = static_cast<int>(std::lround(std::sqrt(samples)));
  switch (integer(parameters, "variant")) {
    case 0:
      build_ordered(graph, parts, factor);
      break;
    case 1:
      build_accumulated(graph, parts, factor);
      break;
    default:
      build_multisampled(graph, parts, samples, false, true);
      break;
  }
  return graph;
}

FrameGraph build_msaa(const FrameRequest& request, const Parameters& parameters) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  const int samples = integer(parameters, "samples");
  const bool centroid = integer(parameters, "centroid") != 0;
  const auto emulate = parameters.find("emulate");
  const MulticastPattern layers = emulate == parameters.end()
                                      ? MulticastPattern{}
                                      : multicast_layers(request, samples, static_cast<int>(emulate->second));
  if (layers.viewports.empty())
    build_multisampled(graph, parts, samples, centroid, false);
  else
    build_multicast(graph, parts, samples, centroid, layers);
  return graph;
}

constexpr CoverageMode kCsaaModes[] = {{4, 8}, {8, 8}, {4, 16}, {8, 16}};
FrameGraph build_csaa(const FrameRequest& request, const Parameters& parameters) {
  return build_coverage(request, parameters, kCsaaModes[integer(parameters, "mode")]);
}
constexpr CoverageMode kEqaaModes[] = {{2, 4}, {4, 8}, {8, 16}};
FrameGraph build_eqaa(const FrameRequest& request, const Parameters& parameters) {
  return build_coverage(request, parameters, kEqaaModes[integer(parameters, "mode")]);
}

constexpr ParameterInfo kVariant{"variant",
                                 0,
                                 0,
                                 2,
                                 "one large image, jittered frames, or sample-rate shading",
                                 "ordered|accumulate|sample_rate"};
constexpr std::array<ParameterInfo, 2> msaa(double samples) {
  return {ParameterInfo{"samples", samples, samples, samples, "samples a pixel"}, kCentroid};
}
constexpr std::array<ParameterInfo, 3> msaa_beyond_8(double samples) {
  return {ParameterInfo{"samples", samples, samples, samples, "samples a pixel"}, kCentroid,
          ParameterInfo{"emulate", 0, 0, 2, "layers of 8 samples, by viewport multicast, or native samples",
                        kEmulateChoices}};
}
constexpr std::array<ParameterInfo, 2> ssaa(double samples) {
  return {ParameterInfo{"samples", samples, samples, samples, "shaded samples a pixel"}, kVariant};
}
constexpr std::array<ParameterInfo, 3> coverage(double mode, double modes, std::string_view description,
                                                std::string_view choices) {
  return {ParameterInfo{"mode", mode, 0, modes - 1, description, choices}, kCentroid,
          ParameterInfo{"orphans", 0, 0, 1,
                        "positions whose sample was overwritten: another of the same fragment, or none",
                        "follow|drop"}};
}
constexpr auto kCsaa =
    coverage(2, 4, "color and coverage samples: 4/8, 8/8, 4/16 or 8/16", "8x|8xq|16x|16xq");
constexpr auto kEqaa = coverage(1, 3, "color and coverage samples", "2f4x|4f8x|8f16x");
constexpr auto kMsaa2 = msaa(2), kMsaa4 = msaa(4), kMsaa8 = msaa(8);
constexpr auto kMsaa16 = msaa_beyond_8(16), kMsaa32 = msaa_beyond_8(32);
constexpr auto kSsaa4 = ssaa(4), kSsaa16 = ssaa(16), kSsaa64 = ssaa(64);

constexpr TechniqueInfo kTechniques[] = {
    {"none", "one sample a pixel, forward shading", {}, build_none},
    {"ssaa4x", "supersampling, 2x2", kSsaa4, build_ssaa},
    {"ssaa16x", "supersampling, 4x4", kSsaa16, build_ssaa},
    {"ssaa64x", "supersampling, 8x8", kSsaa64, build_ssaa},
    {"msaa2x", "multisampling, hardware resolve", kMsaa2, build_msaa},
    {"msaa4x", "multisampling, hardware resolve", kMsaa4, build_msaa},
    {"msaa8x", "multisampling, hardware resolve", kMsaa8, build_msaa},
    {"msaa16x", "multisampling, native or as two shifted layers of 8 samples", kMsaa16, build_msaa},
    {"msaa32x", "multisampling, native or as four shifted layers of 8 samples", kMsaa32, build_msaa},
    {"csaa", "coverage sampling: fewer color and depth samples than positions of coverage", kCsaa,
     build_csaa},
    {"eqaa", "enhanced quality: coverage sampling by its other name and modes", kEqaa, build_eqaa},
};

}  // namespace

std::span<const TechniqueInfo> forward_techniques() { return kTechniques; }

}  // namespace hwsim::algos
