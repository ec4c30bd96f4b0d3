#pragma once
// A GPU as tables of keys, values and their meaning.
#include <string>
#include <vector>

#include "hwsim/gpu/gpu_config.h"
#include "lab/base/table.h"
#include "lab/catalog/config_folder.h"

namespace hwsim::lab {

/// Throws InputError; only gpu.* may be set.
GpuConfig load_gpu_from_options(const ConfigFolder& folder, const std::string& name,
                                const std::vector<std::string>& overlays,
                                const std::vector<std::string>& sets);

/// Key, value, meaning; with_origin adds where each value comes from.
Table key_table(const GpuConfig& gpu, bool with_origin);

/// The keys in which two GPUs differ.
Table difference_table(const GpuConfig& a, const GpuConfig& b);

}  // namespace hwsim::lab
