#pragma once
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/gpu/gpu_config.h"

namespace hwsim {

/// Appends a C018 for each rule over several keys that does not hold.
void check_rules(const GpuConfig& config, std::vector<Diagnostic>& problems);

}  // namespace hwsim
