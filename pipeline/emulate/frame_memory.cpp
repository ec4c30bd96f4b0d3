#include "pipeline/emulate/frame_memory.h"

#include <algorithm>

#include "pipeline/emulate/transfer.h"

namespace hwsim::pipeline {

FrameMemory::FrameMemory(const FrameGraph& graph, const CompiledGraph& compiled)
    : graph_(graph),
      compiled_(compiled),
      images_(graph.images().size()),
      buffers_(graph.buffers().size()),
      images_away_(graph.images().size()),
      buffers_away_(graph.buffers().size(), 0),
      cleared_(graph.images().size(), 0) {}

void FrameMemory::allocate(int position) {
  for (std::size_t i = 0; i < images_.size(); ++i) {
    if (compiled_.images[i].first_pass != position) continue;
    const ImageDesc& desc = graph_.images()[i];
    images_[i] = std::make_unique<GpuImage>(desc.format, desc.width, desc.height, desc.samples, desc.layers,
                                            desc.coverage_samples);
    if (const RawImage* contents = graph_.contents({static_cast<int>(i)}))
      upload_image(*contents, *images_[i]);
  }
  for (std::size_t i = 0; i < buffers_.size(); ++i)
    if (compiled_.buffers[i].first_pass == position) {
      const BufferDesc& desc = graph_.buffers()[i];
      if (desc.contents) buffers_[i] = *desc.contents;
      buffers_[i].resize(desc.words, 0);
    }
}

void FrameMemory::release(int position) {
  for (std::size_t i = 0; i < images_.size(); ++i)
    if (compiled_.images[i].last_pass == position && static_cast<int>(i) != graph_.output().index) {
      if (images_[i]) count_untouched(*images_[i]);
      untouched_tiles_ += images_away_[i].value_or(0);
      images_away_[i].reset();
      images_[i].reset();
    }
  for (std::size_t i = 0; i < buffers_.size(); ++i)
    if (compiled_.buffers[i].last_pass == position) std::vector<std::uint32_t>().swap(buffers_[i]);
}

std::vector<const GpuImage*> FrameMemory::images() const {
  std::vector<const GpuImage*> all;
  for (const std::unique_ptr<GpuImage>& i : images_) all.push_back(i.get());
  return all;
}

void FrameMemory::set_away(ImageId id, std::uint64_t untouched) {
  const auto i = static_cast<std::size_t>(id.index);
  images_[i].reset();
  images_away_[i] = untouched;
}

void FrameMemory::set_away(BufferId id) {
  const auto i = static_cast<std::size_t>(id.index);
  std::vector<std::uint32_t>().swap(buffers_[i]);
  buffers_away_[i] = 1;
}

void FrameMemory::bring_back(ImageId id, std::unique_ptr<GpuImage> image) {
  const auto i = static_cast<std::size_t>(id.index);
  images_[i] = std::move(image);
  images_away_[i].reset();
}

void FrameMemory::bring_back(BufferId id, std::vector<std::uint32_t> words) {
  const auto i = static_cast<std::size_t>(id.index);
  buffers_[i] = std::move(words);
  buffers_away_[i] = 0;
}

void FrameMemory::note_writes(const Pass& pass) {
  for (const ImageId id : pass.color) cleared_[static_cast<std::size_t>(id.index)] = 0;
  if (pass.depth && !pass.depth_read_only) cleared_[static_cast<std::size_t>(pass.depth.index)] = 0;
  for (const ImageId id : pass.targets)
    cleared_[static_cast<std::size_t>(id.index)] = pass.kind == PassKind::clear ? 1 : 0;
}

std::uint64_t FrameMemory::untouched(const GpuImage& image) {
  return static_cast<std::uint64_t>(std::count(image.cleared.begin(), image.cleared.end(), 1));
}

void FrameMemory::count_untouched(const GpuImage& image) { untouched_tiles_ += untouched(image); }

}  // namespace hwsim::pipeline
