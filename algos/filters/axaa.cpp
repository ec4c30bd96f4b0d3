// AXAA: FXAA with three rules (docs/techniques/filters.md#axaa).
#include "algos/filters/filters.h"
#include "algos/filters/fxaa.h"

namespace hwsim::algos {
namespace {

pipeline::ImageId add_axaa(pipeline::FrameGraph& graph, pipeline::ImageId input, const AxaaOptions& options) {
  FxaaUniforms u = fxaa_uniforms(options.fxaa);
  u.skip_filtered = options.skip_filtered;
  u.alpha = static_cast<float>(options.alpha);
  u.alpha_mode = options.alpha_mode;
  u.keep_thin_lines = options.keep_thin_lines;
  u.same_sign = options.same_sign;
  u.adaptive_steps = options.adaptive_steps;
  u.metric_min = options.metric == AxaaMetric::min;
  return add_fxaa_passes(graph, input, "axaa", u, options.fxaa.path);
}

}  // namespace

void describe(OptionList& list, AxaaOptions& o) {
  describe(list, o.fxaa);
  list.choice("skip_filtered", o.skip_filtered, "off|on",
              "rule 1: pixels with a value in the middle of the contrast stay");
  list.real("alpha", o.alpha, {0, 0.5}, "rule 1: how near to the middle");
  list.choice("alpha_mode", o.alpha_mode, "range|mid|absolute",
              "rule 1: alpha is a part of the contrast, of the middle, or luma");
  list.choice("keep_thin_lines", o.keep_thin_lines, "off|on",
              "rule 2: pixels that differ by 0.3 on both sides stay");
  list.choice("same_sign", o.same_sign, "off|on", "rule 2 only where both sides are darker, or both lighter");
  list.choice("adaptive_steps", o.adaptive_steps, "off|on", "rule 3: fewer steps at low contrast");
  list.choice("axaa_metric", o.metric, "max|min",
              "rule 3: contrast is the larger or the smaller of both (as printed)");
}

TechniqueInfo axaa_filter() {
  return filter_technique(
      "axaa", "FXAA that leaves filtered pixels and thin lines, and searches less at low contrast", add_axaa);
}

}  // namespace hwsim::algos
