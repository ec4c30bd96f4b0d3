#include "pipeline/emulate/pass_memo.h"

namespace hwsim::pipeline {

std::map<std::string, std::uint64_t> SkipCounts::by_name() const {
  return {{"frustum", frustum},
          {"single_color_pixels", single_color_pixels},
          {"cleared_tiles", cleared_tiles},
          {"hidden_tiles", hidden_tiles},
          {"accepted_tiles", accepted_tiles},
          {"plane_tiles", plane_tiles}};
}

SkipCounts& SkipCounts::operator+=(const SkipCounts& other) {
  frustum += other.frustum;
  cleared_tiles += other.cleared_tiles;
  hidden_tiles += other.hidden_tiles;
  accepted_tiles += other.accepted_tiles;
  plane_tiles += other.plane_tiles;
  single_color_pixels += other.single_color_pixels;
  return *this;
}

SkipCounts operator-(SkipCounts a, const SkipCounts& b) {
  a.frustum -= b.frustum;
  a.cleared_tiles -= b.cleared_tiles;
  a.hidden_tiles -= b.hidden_tiles;
  a.accepted_tiles -= b.accepted_tiles;
  a.plane_tiles -= b.plane_tiles;
  a.single_color_pixels -= b.single_color_pixels;
  return a;
}

void PassMemo::clear() {
  planned_.clear();
  results_.clear();
  states_.clear();
  held_bytes_ = 0;
  scene_.reset();
}

void PassMemo::expect(const FrameGraph& graph, const GpuFeatures& features,
                      const FunctionalConfig& functional, const EmulationOptions& options) {
  if (scene_ != graph.shared_scene()) clear();  // frames of different scenes share nothing
  scene_ = graph.shared_scene();
  expect(key_frame(graph, compile(graph, features, functional), functional, options));
}

void PassMemo::expect(const KeyedFrame& frame) {
  std::set<Digest> reused;  // states that no pass of this frame will make
  const auto need = [&](const Digest& state) {
    if (reused.contains(state)) ++states_[state].uses;
  };
  for (const KeyedPass& pass : frame.passes) {
    if (planned_.insert(pass.key).second) {
      for (const Digest& state : pass.before) need(state);
    } else {
      ++results_[pass.key].uses;
      reused.insert(pass.after.begin(), pass.after.end());
    }
  }
  need(frame.output);
}

bool PassMemo::reserve(State& state, std::uint64_t bytes) {
  if (held_bytes_ + bytes > limit_bytes_) return false;
  held_bytes_ += bytes;
  state.bytes = bytes;
  return true;
}

void PassMemo::forget(std::map<Digest, State>::iterator state) {
  held_bytes_ -= state->second.bytes;
  states_.erase(state);
}

}  // namespace hwsim::pipeline
