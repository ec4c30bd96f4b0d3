#include "algos/forward/forward.h"

#include <cmath>

#include "algos/base/frame_parts.h"
#include "algos/base/prepass.h"
#include "algos/base/shaders/post.h"
#include "algos/forward/forward_plus.h"
#include "algos/forward/options.h"
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
// (docs/techniques/forward.md#supersampling).
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

void build_multisampled(FrameGraph& graph, const FrameParts& parts, const MsaaOptions& options,
                        bool sample_rate) {
  ForwardTarget target =
      make_forward_target(graph, "multisampled", graph.width(), graph.height(), options.samples);
  target.centroid = options.centroid;
  target.prepass = options.prepass;
  target.sample_rate = sample_rate;
  add_forward(graph, parts, "", target);
  graph.add_resolve("resolve", target.color, add_output(graph));
}

// Layers of eight samples under shifted viewports (docs/techniques/forward.md#multicast); no resolve mixes
// layers, so a shader does.
void build_multicast(FrameGraph& graph, const FrameParts& parts, const MsaaOptions& options,
                     const MulticastPattern& layers) {
  ForwardTarget target =
      make_forward_target(graph, "multisampled", graph.width(), graph.height(), options.samples,
                          Format::rgba8_srgb, Format::d24_unorm_s8, layers);
  target.centroid = options.centroid;
  target.prepass = options.prepass;
  add_forward(graph, parts, "", target);
  add_full_screen(graph, "merge", {target.color}, add_output(graph), merge_program(),
                  std::make_shared<MergeUniforms>(MergeUniforms{options.samples}));
}

/// Samples and positions of coverage (docs/techniques/forward.md#coverage-sampling).
struct CoverageMode {
  int samples, coverage_samples;
};

FrameGraph build_coverage(const FrameRequest& request, const CoverageOptions& options, CoverageMode mode) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  ForwardTarget target;
  target.width = graph.width();
  target.height = graph.height();
  target.samples = mode.samples;
  target.coverage_samples = mode.coverage_samples > mode.samples ? mode.coverage_samples : 0;
  target.centroid = options.centroid;
  target.drop_orphans = options.orphans == OrphanPositions::drop;
  target.color = graph.add_image({"multisampled_color", Format::rgba8_srgb, target.width, target.height,
                                  target.samples, 1, target.coverage_samples});
  target.depth = graph.add_image(
      {"multisampled_depth", Format::d24_unorm_s8, target.width, target.height, target.samples});
  add_forward(graph, parts, "", target);
  graph.add_resolve("resolve", target.color, add_output(graph));
  return graph;
}

FrameGraph build_none(const FrameRequest& request, const PlainOptions& options) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  ForwardTarget target;
  target.width = graph.width();
  target.height = graph.height();
  target.prepass = options.prepass;
  target.color = add_output(graph);
  target.depth = graph.add_image({"depth", Format::d24_unorm_s8, graph.width(), graph.height(), 1});
  add_forward(graph, parts, "", target);
  return graph;
}

FrameGraph build_ssaa(const FrameRequest& request, const SsaaOptions& options) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  const int factor = static_cast<int>(std::lround(std::sqrt(options.samples)));
  switch (options.variant) {
    case SsaaVariant::ordered:
      build_ordered(graph, parts, factor);
      break;
    case SsaaVariant::accumulate:
      build_accumulated(graph, parts, factor);
      break;
    case SsaaVariant::sample_rate:
      build_multisampled(graph, parts, {.samples = options.samples, .centroid = false}, true);
      break;
  }
  return graph;
}

FrameGraph build_layers(const FrameRequest& request, const MsaaOptions& options,
                        const MulticastPattern& layers) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  if (layers.viewports.empty())
    build_multisampled(graph, parts, options, false);
  else
    build_multicast(graph, parts, options, layers);
  return graph;
}

FrameGraph build_msaa(const FrameRequest& request, const MsaaOptions& options) {
  return build_layers(request, options, {});
}
FrameGraph build_many_samples(const FrameRequest& request, const ManySamplesOptions& options) {
  return build_layers(request, options.msaa,
                      multicast_layers(request, options.msaa.samples, options.emulate));
}

FrameGraph build_csaa(const FrameRequest& request, const CsaaOptions& options) {
  // In the order of CsaaMode.
  constexpr CoverageMode kModes[] = {{4, 8}, {8, 8}, {4, 16}, {8, 16}, {8, 32}};
  return build_coverage(request, options.coverage, kModes[static_cast<std::size_t>(options.mode)]);
}
FrameGraph build_eqaa(const FrameRequest& request, const EqaaOptions& options) {
  constexpr CoverageMode kModes[] = {{2, 4}, {4, 8}, {8, 16}};  // in the order of EqaaMode
  return build_coverage(request, options.coverage, kModes[static_cast<std::size_t>(options.mode)]);
}

void describe_coverage(OptionList& list, CoverageOptions& o) {
  describe_centroid(list, o.centroid);
  list.choice("orphans", o.orphans, "follow|drop",
              "positions whose sample was overwritten: another of the same fragment, or none");
}

MsaaOptions samples(int count) { return {.samples = count}; }

}  // namespace

void describe(OptionList& list, PlainOptions& o) { describe_prepass(list, o.prepass); }

void describe(OptionList& list, SsaaOptions& o) {
  list.fixed("samples", o.samples, "shaded samples a pixel");
  list.choice("variant", o.variant, "ordered|accumulate|sample_rate",
              "one large image, jittered frames, or sample-rate shading");
}

void describe(OptionList& list, MsaaOptions& o) {
  list.fixed("samples", o.samples, "samples a pixel");
  describe_centroid(list, o.centroid);
  describe_prepass(list, o.prepass);
}

void describe(OptionList& list, ManySamplesOptions& o) {
  describe(list, o.msaa);
  list.choice("emulate", o.emulate, kEmulateChoices,
              "layers of 8 samples, by viewport multicast, or native samples");
}

void describe(OptionList& list, CsaaOptions& o) {
  list.choice("mode", o.mode, "8x|8xq|16x|16xq|32x",
              "color and coverage samples: 4/8, 8/8, 4/16, 8/16 or 8/32");
  describe_coverage(list, o.coverage);
}

void describe(OptionList& list, EqaaOptions& o) {
  list.choice("mode", o.mode, "2f4x|4f8x|8f16x", "color and coverage samples");
  describe_coverage(list, o.coverage);
}

Room forward_room() {
  const std::string_view native = "multisampling, hardware resolve";
  return {
      .techniques = {base_technique("none", "one sample a pixel, forward shading", build_none),
                     base_technique("ssaa4x", "supersampling, 2x2", build_ssaa, {.samples = 4}),
                     base_technique("ssaa16x", "supersampling, 4x4", build_ssaa, {.samples = 16}),
                     base_technique("ssaa64x", "supersampling, 8x8", build_ssaa, {.samples = 64}),
                     base_technique("msaa2x", native, build_msaa, samples(2)),
                     base_technique("msaa4x", native, build_msaa, samples(4)),
                     base_technique("msaa8x", native, build_msaa, samples(8)),
                     base_technique("msaa16x", "multisampling, native or as two shifted layers of 8 samples",
                                    build_many_samples, {.msaa = samples(16)}),
                     base_technique("msaa32x", "multisampling, native or as four shifted layers of 8 samples",
                                    build_many_samples, {.msaa = samples(32)}),
                     base_technique(
                         "csaa",
                         "coverage sampling: fewer color and depth samples than positions of coverage",
                         build_csaa),
                     base_technique("eqaa", "enhanced quality: coverage sampling by its other name and modes",
                                    build_eqaa),
                     forward_plus_technique()},
      .counters = BaseCounters::kDeclared,
      .shaded = {BaseCounters::lit_samples}};
}

}  // namespace hwsim::algos
