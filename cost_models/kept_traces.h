#pragma once
// The work traces of the published rows in one file, so that fit and validation need no emulation: each pass
// once, whichever runs begin with it.
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cost_models/experiment.h"

namespace hwsim::cost_models {

struct KeptTraces {
  std::string sources;  ///< digest of the sources that emulated them (algos::source_digest)
  std::map<RunSpec, std::shared_ptr<const WorkTrace>> traces;
};

std::vector<std::uint8_t> encode_kept(const KeptTraces& kept);

/// Throws DamagedBytes for anything but what encode_kept of the same trace layout wrote.
KeptTraces decode_kept(std::span<const std::uint8_t> bytes);

/// Gives a run its kept trace; throws InputError M008 for a run that has none.
TraceSource source_of(KeptTraces kept);

/// Passes on what `traces` gives, and notes it in `kept`, which must outlive the result.
TraceSource keeping(TraceSource traces, KeptTraces& kept);

}  // namespace hwsim::cost_models
