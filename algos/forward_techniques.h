#pragma once
// No anti-aliasing, supersampling and multisampling: forward shading (techniques 1.1 to 1.3).
#include "algos/technique.h"

namespace hwsim::algos {

pipeline::FrameGraph build_none(const FrameRequest& request, const Parameters& parameters);
pipeline::FrameGraph build_ssaa(const FrameRequest& request, const Parameters& parameters);
pipeline::FrameGraph build_msaa(const FrameRequest& request, const Parameters& parameters);

}  // namespace hwsim::algos
