#pragma once
// The rules that a frame graph must obey on a GPU.
#include "pipeline/graph/frame_graph.h"

namespace hwsim::pipeline {

/// What a driver's debug layer would report about a graph on this GPU; empty when it is valid. Codes:
/// G001 size, G002 sample count, G003 format, G004 feedback loop, G005 read before write, G006 feature, G007
/// programs, G008 output, G009 resolve or copy.
std::vector<Diagnostic> validate(const FrameGraph& graph, const GpuFeatures& features,
                                 const FunctionalConfig& functional);

}  // namespace hwsim::pipeline
