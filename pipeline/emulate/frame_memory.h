#pragma once
// The images and buffers of a frame, each from its first pass to its last.
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/graph/frame_graph.h"
#include "pipeline/memory/gpu_image.h"

namespace hwsim::pipeline {

class FrameMemory {
 public:
  FrameMemory(const FrameGraph& graph, const CompiledGraph& compiled);

  /// Before and after the pass at `position` of the order.
  void allocate(int position);
  void release(int position);

  GpuImage& image(ImageId id) { return *images_[static_cast<std::size_t>(id.index)]; }
  std::vector<std::uint32_t>& buffer(BufferId id) { return buffers_[static_cast<std::size_t>(id.index)]; }
  /// By number; null: not alive.
  std::vector<const GpuImage*> images() const;

  /// The pass that would have written it was not run: there is no memory until it is brought back. A release
  /// counts `untouched` tiles.
  void set_away(ImageId id, std::uint64_t untouched);
  void set_away(BufferId id);
  bool is_away(ImageId id) const { return images_away_[static_cast<std::size_t>(id.index)].has_value(); }
  bool is_away(BufferId id) const { return buffers_away_[static_cast<std::size_t>(id.index)] != 0; }
  void bring_back(ImageId id, std::unique_ptr<GpuImage> image);
  void bring_back(BufferId id, std::vector<std::uint32_t> words);

  void note_writes(const Pass& pass);
  /// One flag an image: whether nothing was drawn into it since its clear.
  const std::vector<char>& cleared() const { return cleared_; }
  /// Tiles that nothing has used since their clear.
  static std::uint64_t untouched(const GpuImage& image);
  /// Adds the image's to `untouched_tiles`.
  void count_untouched(const GpuImage& image);
  std::uint64_t untouched_tiles() const { return untouched_tiles_; }

 private:
  const FrameGraph& graph_;
  const CompiledGraph& compiled_;
  std::vector<std::unique_ptr<GpuImage>> images_;
  std::vector<std::vector<std::uint32_t>> buffers_;
  std::vector<std::optional<std::uint64_t>> images_away_;  ///< their untouched tiles
  std::vector<char> buffers_away_;
  std::vector<char> cleared_;
  std::uint64_t untouched_tiles_ = 0;
};

}  // namespace hwsim::pipeline
