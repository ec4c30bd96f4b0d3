#pragma once
// The parts of a pass's work that follow from its declaration: targets, states, commands, bound constants.
#include <span>
#include <vector>

#include "hwsim/trace/work_trace.h"
#include "pipeline/emulate/pass_context.h"
#include "pipeline/graph/frame_graph.h"

namespace hwsim::pipeline {

/// `cleared`, by ImageId: nothing was drawn into the image since its clear.
PassWork describe(const FrameGraph& graph, const CompiledGraph& compiled, int position,
                  std::span<const char> cleared);

/// Words, state changes and draws of the pass's commands; a draw's count where its triangles do.
void count_commands(const FrameGraph& graph, const Pass& pass, const PassContext& c, bool barrier,
                    std::vector<PassCounters>& chunks);

/// Constants that a driver binds for each draw.
void count_inputs(const PassContext& c, std::vector<PassCounters>& chunks);

}  // namespace hwsim::pipeline
