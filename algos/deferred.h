#pragma once
// Deferred shading of multisampled G-buffers (techniques 2).
#include "algos/technique.h"

namespace hwsim::algos {

pipeline::FrameGraph build_deferred(const FrameRequest& request, const Parameters& parameters);
pipeline::FrameGraph build_simple_complex(const FrameRequest& request, const Parameters& parameters);

}  // namespace hwsim::algos
