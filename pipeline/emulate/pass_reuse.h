#pragma once
// What a pass's memory accesses come to: which blocks are followed, their reuse distances, the busiest
// atomic.
#include <array>
#include <cstdint>
#include <span>

#include "hwsim/trace/work_trace.h"
#include "pipeline/emulate/pass_context.h"
#include "pipeline/graph/frame_graph.h"

namespace hwsim::pipeline {

/// The least sample: 1 block in 32, of all vertex data (its sampling error is in docs/hardware_model.md).
inline constexpr int kReuseShiftMax = 5;

/// First 64-byte line of each sampled image: they are numbered behind the `texture_lines` of all textures.
std::array<std::uint32_t, kMaxImageSlots> image_lines(const FrameGraph& graph, const Pass& pass,
                                                      std::uint64_t texture_lines);

/// Bytes and sampling rate of each stream's blocks; `exact` follows every block.
BlockKinds block_kinds(const FrameGraph& graph, const Pass& pass, const PassContext& c,
                       std::uint64_t texture_lines, bool exact);

/// Takes the workers' accesses.
ReuseProfile merge_reuse(std::span<BinWorker> workers, const PassWork& work, bool exact, int jobs);

/// Chunks share the most frequent address in proportion to their atomics.
void share_same_address(std::span<const BinWorker> workers, PassWork& work);

}  // namespace hwsim::pipeline
