// AXAA: FXAA with three rules (techniques 7.2).
#include "algos/filters/fxaa.h"
#include "algos/filters/post_filters.h"

namespace hwsim::algos {

pipeline::ImageId add_axaa(pipeline::FrameGraph& graph, pipeline::ImageId input,
                           const Parameters& parameters) {
  const auto value = [&](const char* name) { return parameters.find(name)->second; };
  FxaaUniforms u = fxaa_uniforms(parameters);
  u.skip_filtered = value("skip_filtered") != 0;
  u.alpha = static_cast<float>(value("alpha"));
  u.alpha_mode = static_cast<AlphaMode>(static_cast<int>(value("alpha_mode")));
  u.keep_thin_lines = value("keep_thin_lines") != 0;
  u.same_sign = value("same_sign") != 0;
  u.adaptive_steps = value("adaptive_steps") != 0;
  u.metric_min = value("axaa_metric") != 0;
  return add_fxaa_passes(graph, input, "axaa", u, value("discard") != 0);
}

}  // namespace hwsim::algos
