#pragma once
// Deferred shading of multisampled G-buffers (techniques 2).
#include "algos/base/technique.h"

namespace hwsim::algos {

std::span<const TechniqueInfo> deferred_techniques();

}  // namespace hwsim::algos
