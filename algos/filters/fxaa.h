#pragma once
// The passes of FXAA, which AXAA shares (techniques 7.1, 7.2).
#include "algos/base/technique.h"
#include "algos/filters/shaders/fxaa.h"

namespace hwsim::algos {

FxaaUniforms fxaa_uniforms(const Parameters& parameters);

/// Luma, unless green stands for it; a copy, if other pixels than edges are discarded; the filter.
pipeline::ImageId add_fxaa_passes(pipeline::FrameGraph& graph, pipeline::ImageId input,
                                  const std::string& name, const FxaaUniforms& uniforms, bool discard);

}  // namespace hwsim::algos
