#pragma once
// Options and passes of FXAA, which AXAA shares (docs/techniques/filters.md#fxaa).
#include <cstdint>
#include <string>

#include "algos/base/options.h"
#include "algos/filters/shaders/fxaa.h"
#include "pipeline/graph/frame_graph.h"

namespace hwsim::algos {

/// Steps of the search along edges, by the numbers that FXAA gives them.
enum class FxaaPreset : std::uint8_t {
  p10,
  p11,
  p12,
  p13,
  p14,
  p15,
  p20,
  p21,
  p22,
  p23,
  p24,
  p25,
  p26,
  p27,
  p28,
  p29,
  p39
};

struct FxaaOptions {
  FxaaPreset preset = FxaaPreset::p12;
  double subpix = 0.75;
  double edge_threshold = 0.166;
  double edge_threshold_min = 0.0833;
  bool green_as_luma = false;
  FxaaPath path;
};
void describe(OptionList& list, FxaaOptions& o);

enum class AxaaMetric : std::uint8_t { max, min };
struct AxaaOptions {
  FxaaOptions fxaa;
  bool skip_filtered = true;
  double alpha = 0.1;
  AlphaMode alpha_mode = AlphaMode::range;
  bool keep_thin_lines = true;
  bool same_sign = false;
  bool adaptive_steps = true;
  AxaaMetric metric = AxaaMetric::max;
};
void describe(OptionList& list, AxaaOptions& o);

FxaaUniforms fxaa_uniforms(const FxaaOptions& options);

/// Luma, unless green stands for it; a copy, if other pixels than edges are discarded; the filter.
pipeline::ImageId add_fxaa_passes(pipeline::FrameGraph& graph, pipeline::ImageId input,
                                  const std::string& name, const FxaaUniforms& uniforms,
                                  const FxaaPath& path);

}  // namespace hwsim::algos
