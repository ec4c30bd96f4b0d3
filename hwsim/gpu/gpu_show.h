#pragma once
// GPU files and hashes of some keys only: what a fit writes and remembers.
#include <set>
#include <span>
#include <string>

#include "hwsim/gpu/gpu_config.h"

namespace hwsim {

/// A TOML file that extends the GPU `parent` and holds `keys`, with their origins. Loaded, it has the numbers
/// of `config` where `config` differs from the parent in these keys alone.
std::string show_extension(const GpuConfig& config, const std::string& parent,
                           const std::set<std::string>& keys);

/// The names that content_hash reads: every key but labels.
std::set<std::string> hashed_keys();

/// content_hash of the named keys alone, so that keys which came later leave it as it was. A name that is no
/// key (any more) counts as a key without a value.
std::string content_hash(const GpuConfig& config, const std::set<std::string>& keys);

}  // namespace hwsim
