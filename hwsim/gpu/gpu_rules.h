#pragma once
// Rules over several keys of a GPU, and over the GPUs of a run.
#include <span>
#include <string_view>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/gpu/gpu_config.h"

namespace hwsim {

/// Appends a C018 for each rule over several keys that does not hold.
void check_rules(const GpuConfig& config, std::vector<Diagnostic>& problems);

/// False for a number that means nothing on a GPU of this kind: slots of instruction words where lanes are
/// scalar, tile memory where there is none.
bool applies(std::string_view key, const GpuValues<double>& gpu);

/// C023 for each GPU whose id names the same folder of results as that of one before it (letters, digits and
/// -_. count, every other character is one like the other): one would overwrite the other. The same GPU twice
/// is none.
void check_ids(std::span<const GpuConfig> gpus, std::vector<Diagnostic>& problems);

}  // namespace hwsim
