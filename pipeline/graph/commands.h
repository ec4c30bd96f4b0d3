#pragma once
// What a driver would send for a compiled graph: the command stream, and what its commands cost the front
// end.
#include <cstdint>
#include <string_view>
#include <vector>

#include "pipeline/graph/frame_graph.h"

namespace hwsim::pipeline {

enum class CommandKind : std::uint32_t {
  barrier,         ///< wait for earlier passes, flush what they wrote
  bind_targets,    ///< color and depth attachments, viewport
  bind_pipeline,   ///< fixed-function state and programs
  bind_resources,  ///< images, buffers and textures that programs read
  draw,
  dispatch,
  clear,
  copy,
  resolve,
};
std::string_view command_name(CommandKind kind);

/// 32-bit words that the front end parses for a command: the header and its operands as open drivers write
/// them for the generation of the calibration GPUs, rounded. The timing engines charge draws and changes, not
/// words.
std::uint32_t command_words(CommandKind kind);

struct Command {
  CommandKind kind = CommandKind::draw;
  std::uint32_t batch = 0;  ///< draws and binds: index into Pass::batches
  std::uint32_t draw = 0;   ///< draws: number in the pass
  std::uint64_t count = 0;  ///< draws: indices; dispatches: groups; others: targets or resources
};

/// The commands of one pass, in order. Binds are sent when they change something: a pipeline for each batch,
/// resources for each new material.
std::vector<Command> record_pass(const FrameGraph& graph, const Pass& pass, bool barrier_before);

}  // namespace hwsim::pipeline
