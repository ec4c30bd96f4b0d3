#pragma once
// Keys of a frame's passes: two passes with one key do the same work on the same contents, and leave the
// same.
#include <vector>

#include "pipeline/batch/uniforms.h"
#include "pipeline/emulate/emulator.h"

namespace hwsim::pipeline {

using Digest = ContentDigest::Words;

/// What a pass does with memory, as digests of how each content came about: what it is made of, and every
/// pass that has touched it since, readers too, since they may change the form in which it is held.
struct KeyedPass {
  Digest key;
  std::vector<int> images, buffers;   ///< that it touches, each once
  std::vector<Digest> before, after;  ///< states: the images', then the buffers'
};

struct KeyedFrame {
  std::vector<KeyedPass> passes;  ///< in the order of submission
  Digest output;                  ///< the output image's state at the end
};

/// Programs, and the scene, are told apart by their addresses: they must live as long as the keys are used.
/// Uniforms whose type has no `add_content` make a key that no other pass has.
KeyedFrame key_frame(const FrameGraph& graph, const CompiledGraph& compiled,
                     const FunctionalConfig& functional, const EmulationOptions& options);

}  // namespace hwsim::pipeline
