#pragma once
// The draws of wire anti-aliasing within a frame.
#include "algos/base/frame_parts.h"

namespace hwsim::algos {

/// The triangles of a mesh part, wire by wire from the farthest to the nearest: blending needs the order.
pipeline::DrawCall sorted_wires(const pipeline::Scene& scene, const pipeline::Camera& camera,
                                pipeline::DrawCall call);

/// Their depth alone, at the width that they are drawn with; no draws where there are none.
pipeline::DrawBatch wire_depth_batch(const FrameParts& parts, const ForwardTarget& target);

/// Wires of a frame that was asked for wire anti-aliasing, into lit color.
void add_wires(pipeline::FrameGraph& graph, const FrameParts& parts, const std::string& name,
               const ForwardTarget& target);

}  // namespace hwsim::algos
