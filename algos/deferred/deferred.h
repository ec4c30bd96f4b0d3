#pragma once
// Deferred shading of a multisampled G-buffer (docs/techniques/deferred.md): every sample lit, or samples
// only where they differ.
#include "algos/base/technique.h"

namespace hwsim::algos {

Room deferred_room();

}  // namespace hwsim::algos
