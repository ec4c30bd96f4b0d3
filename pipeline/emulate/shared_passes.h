#pragma once
// A frame's dealings with the memo of passes.
#include <span>

#include "pipeline/emulate/frame_memory.h"
#include "pipeline/emulate/pass_memo.h"

namespace hwsim::pipeline {

class SharedPasses {
 public:
  /// `memo`: null, or without expectations: nothing is shared, at no cost.
  SharedPasses(PassMemo* memo, const FrameGraph& graph, const CompiledGraph& compiled,
               const FunctionalConfig& functional, const EmulationOptions& options);
  /// What only this frame waited for is dropped.
  ~SharedPasses();
  SharedPasses(const SharedPasses&) = delete;
  SharedPasses& operator=(const SharedPasses&) = delete;

  /// What the pass at `position` counted; null: it must be emulated.
  const PassResult* reused(std::size_t position) const;
  std::uint64_t reused_passes() const;

  /// Instead of the pass: what it touches has no memory until bring().
  void take(std::size_t position, FrameMemory& memory) const;
  /// Before a pass is emulated: memory of what earlier passes, not emulated, left for it.
  void bring(std::size_t position, FrameMemory& memory);
  void bring_output(ImageId output, FrameMemory& memory);

  /// Whether a later frame asks for what the pass counts.
  bool wants(std::size_t position) const;
  /// After it was emulated. `result` is without untouched tiles.
  void keep(std::size_t position, FrameMemory& memory, PassResult result);
  void keep_states(std::size_t position, FrameMemory& memory);

 private:
  void choose();
  bool can_be_brought(const Digest& state, std::span<const char> reused) const;
  void bring_image(int image, const Digest& state, FrameMemory& memory);
  void bring_buffer(int buffer, const Digest& state, FrameMemory& memory);

  PassMemo* memo_;
  KeyedFrame frame_;
  std::map<Digest, std::size_t> makers_;  ///< by state: the pass that leaves it
  std::vector<char> reused_, was_known_;  ///< by pass
};

}  // namespace hwsim::pipeline
