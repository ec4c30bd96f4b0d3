#include "pipeline/emulate/shared_passes.h"

#include <algorithm>
#include <utility>

namespace hwsim::pipeline {
namespace {

/// More than a copy takes, which leaves out pages of zeros.
std::uint64_t held_bytes(const GpuImage& image) {
  const auto bytes = [](const auto&... vectors) {
    return (std::uint64_t{0} + ... + (vectors.size() * sizeof(vectors[0])));
  };
  return bytes(image.texels, image.stencil, image.planes, image.plane_lanes, image.coverage_map,
               image.packed.words, image.packed.quad_start, image.stored_form, image.second_color);
}

}  // namespace

SharedPasses::SharedPasses(PassMemo* memo, const FrameGraph& graph, const CompiledGraph& compiled,
                           const FunctionalConfig& functional, const EmulationOptions& options)
    : memo_(memo != nullptr && memo->expects_anything() && memo->scene_ == graph.shared_scene() ? memo
                                                                                                : nullptr) {
  if (memo_ == nullptr) return;
  frame_ = key_frame(graph, compiled, functional, options);
  for (std::size_t i = 0; i < frame_.passes.size(); ++i)
    for (const Digest& state : frame_.passes[i].after) makers_.emplace(state, i);
  choose();
}

SharedPasses::~SharedPasses() {
  for (std::size_t i = 0; i < was_known_.size(); ++i) {
    if (was_known_[i] == 0) continue;
    const auto known = memo_->results_.find(frame_.passes[i].key);
    if (--known->second.uses <= 0) memo_->results_.erase(known);
  }
}

bool SharedPasses::can_be_brought(const Digest& state, std::span<const char> reused) const {
  const auto maker = makers_.find(state);
  if (maker == makers_.end() || reused[maker->second] == 0) return true;
  const auto held = memo_->states_.find(state);
  return held != memo_->states_.end() && held->second.is_held();
}

/// Passes whose counts are known, but for those whose images another pass needs and the memo does not hold.
void SharedPasses::choose() {
  for (const KeyedPass& pass : frame_.passes) {
    const auto known = memo_->results_.find(pass.key);
    was_known_.push_back(known != memo_->results_.end() && known->second.result != nullptr ? 1 : 0);
  }
  reused_ = was_known_;
  const auto require = [&](const Digest& state) {
    if (!can_be_brought(state, reused_)) reused_[makers_.at(state)] = 0;
  };
  require(frame_.output);
  for (std::size_t i = frame_.passes.size(); i-- > 0;)  // a pass's makers stand before it
    if (reused_[i] == 0)
      for (const Digest& state : frame_.passes[i].before) require(state);
}

const PassResult* SharedPasses::reused(std::size_t position) const {
  if (memo_ == nullptr || reused_[position] == 0) return nullptr;
  return memo_->results_.at(frame_.passes[position].key).result.get();
}

std::uint64_t SharedPasses::reused_passes() const {
  return static_cast<std::uint64_t>(std::ranges::count(reused_, 1));
}

void SharedPasses::take(std::size_t position, FrameMemory& memory) const {
  const KeyedPass& pass = frame_.passes[position];
  const PassResult& result = *reused(position);
  for (std::size_t i = 0; i < pass.images.size(); ++i)
    memory.set_away(ImageId{pass.images[i]}, result.untouched_tiles[i]);
  for (const int buffer : pass.buffers) memory.set_away(BufferId{buffer});
  ++memo_->reused_passes_;
}

void SharedPasses::bring_image(int image, const Digest& state, FrameMemory& memory) {
  if (!memory.is_away(ImageId{image})) return;
  const auto held = memo_->states_.find(state);
  const bool last = --held->second.uses <= 0;
  memory.bring_back(ImageId{image},
                    last ? std::move(held->second.image) : std::make_unique<GpuImage>(*held->second.image));
  if (last) memo_->forget(held);
}

void SharedPasses::bring_buffer(int buffer, const Digest& state, FrameMemory& memory) {
  if (!memory.is_away(BufferId{buffer})) return;
  const auto held = memo_->states_.find(state);
  const bool last = --held->second.uses <= 0;
  memory.bring_back(BufferId{buffer}, last ? std::move(*held->second.words) : *held->second.words);
  if (last) memo_->forget(held);
}

void SharedPasses::bring(std::size_t position, FrameMemory& memory) {
  if (memo_ == nullptr) return;
  const KeyedPass& pass = frame_.passes[position];
  for (std::size_t i = 0; i < pass.images.size(); ++i) bring_image(pass.images[i], pass.before[i], memory);
  for (std::size_t i = 0; i < pass.buffers.size(); ++i)
    bring_buffer(pass.buffers[i], pass.before[pass.images.size() + i], memory);
}

void SharedPasses::bring_output(ImageId output, FrameMemory& memory) {
  if (memo_ != nullptr) bring_image(output.index, frame_.output, memory);
}

bool SharedPasses::wants(std::size_t position) const {
  if (memo_ == nullptr) return false;
  const auto known = memo_->results_.find(frame_.passes[position].key);
  return known != memo_->results_.end() && known->second.uses > 0 && known->second.result == nullptr;
}

void SharedPasses::keep(std::size_t position, FrameMemory& memory, PassResult result) {
  const KeyedPass& pass = frame_.passes[position];
  for (const int image : pass.images)
    result.untouched_tiles.push_back(FrameMemory::untouched(memory.image(ImageId{image})));
  memo_->results_[pass.key].result = std::make_unique<const PassResult>(std::move(result));
}

void SharedPasses::keep_states(std::size_t position, FrameMemory& memory) {
  if (memo_ == nullptr) return;
  const KeyedPass& pass = frame_.passes[position];
  const auto wanted = [&](std::size_t i) -> PassMemo::State* {
    const auto state = memo_->states_.find(pass.after[i]);
    const bool is_wanted =
        state != memo_->states_.end() && state->second.uses > 0 && !state->second.is_held();
    return is_wanted ? &state->second : nullptr;
  };
  for (std::size_t i = 0; i < pass.images.size(); ++i) {
    const GpuImage& image = memory.image(ImageId{pass.images[i]});
    if (PassMemo::State* state = wanted(i); state != nullptr && memo_->reserve(*state, held_bytes(image)))
      state->image = std::make_unique<GpuImage>(image);
  }
  for (std::size_t i = 0; i < pass.buffers.size(); ++i) {
    const std::vector<std::uint32_t>& words = memory.buffer(BufferId{pass.buffers[i]});
    PassMemo::State* state = wanted(pass.images.size() + i);
    if (state != nullptr && memo_->reserve(*state, 4 * words.size()))
      state->words = std::make_unique<std::vector<std::uint32_t>>(words);
  }
}

}  // namespace hwsim::pipeline
