#pragma once
// What a batch of lanes costs: its operations, by how often each block of its shader ran, and its texels.
#include <cstdint>

#include "pipeline/batch/fragment_batch.h"

namespace hwsim::pipeline {

/// Charges unfiltered texels.
void charge_texels(const TexelCounts& texels, PassCounters& counters);

/// Charges the batch's invocations and their blocks' operations.
void account_shading(const FragmentBatch& batch, const FragmentProgram& program, bool sample_rate,
                     PassCounters& counters);
void account_blocks(const BlockTrips& blocks, const BlockOps& ops, int block_count, std::uint64_t valid_lanes,
                    PassCounters& counters);

}  // namespace hwsim::pipeline
