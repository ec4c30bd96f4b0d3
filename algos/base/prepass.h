#pragma once
// A pass that draws depth alone, so that the one after it shades only what stays visible.
#include <string>

#include "algos/base/frame_parts.h"

namespace hwsim::algos {

/// The option `prepass` of techniques that shade or store surfaces while they draw.
void describe_prepass(OptionList& list, bool& prepass);

/// Depth of what is opaque or alpha-tested, with the coverage that `target`'s pass gives it: both passes
/// compute the same depth to the bit, so that the second draws what is equal. Draws that a modifier took are
/// among them where the base draws them (prepare_gbuffer_frame). The target must have been cleared.
void add_prepass(pipeline::FrameGraph& graph, const FrameParts& parts, const std::string& prefix,
                 const ForwardTarget& target);

/// Makes a batch draw where the pre-pass left its depth, and write none.
void draw_where_equal(pipeline::PipelineState& state);

}  // namespace hwsim::algos
