#pragma once
// Numbers that no GPU ever had: most are a data sheet's, in another unit than the key's.
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/gpu/gpu_config.h"

namespace hwsim::lab {

/// Warnings C027: clocks, sizes and numbers of units beyond the smallest and the largest that were built.
std::vector<Diagnostic> implausible_numbers(const GpuConfig& gpu);

}  // namespace hwsim::lab
