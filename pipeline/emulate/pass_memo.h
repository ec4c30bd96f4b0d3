#pragma once
// What passes left behind, for frames that have the same passes: techniques of one view share its shadow map,
// G-buffers, or a whole frame that filters go on with.
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "pipeline/emulate/pass_key.h"
#include "pipeline/memory/gpu_image.h"

namespace hwsim::pipeline {

/// By skip, as SkipInfo names them.
struct SkipCounts {
  std::uint64_t frustum = 0, cleared_tiles = 0, hidden_tiles = 0, accepted_tiles = 0, plane_tiles = 0,
                single_color_pixels = 0;
  std::map<std::string, std::uint64_t> by_name() const;
  SkipCounts& operator+=(const SkipCounts& other);
  friend SkipCounts operator+(SkipCounts a, const SkipCounts& b) { return a += b; }
  friend SkipCounts operator-(SkipCounts a, const SkipCounts& b);
};

/// What a pass counted.
struct PassResult {
  std::vector<PassCounters> chunks;
  ReuseProfile reuse;
  int raster_samples = 1;
  SkipCounts skipped;
  std::vector<std::uint32_t> heat;             ///< what it added to each pixel; empty: nothing
  std::vector<std::uint64_t> untouched_tiles;  ///< after it, in each image that it touched
};

/// Holds only what a frame that is expected will ask for, and no more than its limit of images and buffers: a
/// pass whose images there was no room for is emulated again. Not for several threads at a time.
class PassMemo {
 public:
  explicit PassMemo(std::uint64_t limit_bytes) : limit_bytes_(limit_bytes) {}

  /// A frame that will be emulated, in the order of these calls.
  void expect(const FrameGraph& graph, const GpuFeatures& features, const FunctionalConfig& functional,
              const EmulationOptions& options);
  /// Nothing is expected any more.
  void clear();
  bool expects_anything() const { return !planned_.empty(); }
  /// Passes that were not emulated again, so far.
  std::uint64_t reused_passes() const { return reused_passes_; }

 private:
  friend class SharedPasses;  // a frame's view while it runs (shared_passes.h)

  struct Result {
    int uses = 0;  ///< frames that are still to come
    std::unique_ptr<const PassResult> result;
  };
  struct State {
    int uses = 0;
    std::unique_ptr<GpuImage> image;
    std::unique_ptr<std::vector<std::uint32_t>> words;
    std::uint64_t bytes = 0;
    bool is_held() const { return image != nullptr || words != nullptr; }
  };

  void expect(const KeyedFrame& frame);
  /// False where it would go beyond the limit.
  bool reserve(State& state, std::uint64_t bytes);
  void forget(std::map<Digest, State>::iterator state);

  std::uint64_t limit_bytes_, held_bytes_ = 0;
  std::shared_ptr<const Scene> scene_;  ///< keys hold its address
  std::set<Digest> planned_;            ///< passes of frames that were expected
  std::map<Digest, Result> results_;
  std::map<Digest, State> states_;
  std::uint64_t reused_passes_ = 0;
};

}  // namespace hwsim::pipeline
