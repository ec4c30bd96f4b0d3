#include "pipeline/graph/frame_graph.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace hwsim::pipeline {

std::uint64_t allocated_bytes(const ImageDesc& image) {
  const std::uint64_t pixels = static_cast<std::uint64_t>(image.width) *
                               static_cast<std::uint64_t>(image.height) *
                               static_cast<std::uint64_t>(image.layers);
  return pixels * (static_cast<std::uint64_t>(image.samples) * info(image.format).bytes +
                   coverage_map_bytes(image.samples, image.coverage_samples));
}

std::uint64_t coverage_map_bytes(int samples, int coverage_samples) {
  if (coverage_samples == 0) return 0;
  const int bits =
      static_cast<int>(std::bit_width(static_cast<unsigned>(samples)));  // that number 0..samples
  return static_cast<std::uint64_t>(coverage_samples * bits + 7) / 8;
}

std::uint64_t allocated_bytes(const BufferDesc& buffer) { return buffer.contents ? 0 : 4 * buffer.words; }

std::shared_ptr<const IndexList> make_index_list(std::vector<std::uint32_t> indices) {
  auto list = std::make_shared<IndexList>();
  if (!indices.empty()) {
    const auto [low, high] = std::minmax_element(indices.begin(), indices.end());
    list->first_vertex = *low;
    list->vertex_count = *high - *low + 1;
  }
  list->indices = std::move(indices);
  return list;
}

bool same_bits(Format a, Format b) {
  const auto is_rgba8 = [](Format f) { return f == Format::rgba8_unorm || f == Format::rgba8_srgb; };
  return a == b || (is_rgba8(a) && is_rgba8(b));
}

Format Pass::view_of(const FrameGraph& graph, std::size_t slot) const {
  const Format view = slot < views.size() ? views[slot] : Format::none;
  return view == Format::none ? graph.image(sampled.at(slot)).format : view;
}

Format Pass::target_view_of(const FrameGraph& graph, std::size_t slot) const {
  const Format view = slot < target_views.size() ? target_views[slot] : Format::none;
  return view == Format::none ? graph.image(targets.at(slot)).format : view;
}

ImageId FrameGraph::add_image(ImageDesc desc) { return add_image(std::move(desc), nullptr); }

ImageId FrameGraph::add_image(ImageDesc desc, std::shared_ptr<const RawImage> contents) {
  images_.push_back(std::move(desc));
  contents_.push_back(std::move(contents));
  return {static_cast<int>(images_.size()) - 1};
}

void FrameGraph::make_output_linear() {
  const auto widen = [&](ImageId id) {
    images_[static_cast<std::size_t>(id.index)].format = Format::rgba16_float;
  };
  widen(output_);
  for (const Pass& pass : passes_)
    if (pass.kind == PassKind::resolve && pass.targets.front() == output_) widen(pass.source);
  output_view_ = Format::none;
}

BufferId FrameGraph::add_buffer(BufferDesc desc) {
  buffers_.push_back(std::move(desc));
  return {static_cast<int>(buffers_.size()) - 1};
}

Pass& FrameGraph::add_pass(std::string name, PassKind kind) {
  Pass pass;
  pass.name = std::move(name);
  pass.kind = kind;
  pass.width = width_;
  pass.height = height_;
  passes_.push_back(std::move(pass));
  return passes_.back();
}

Pass& FrameGraph::add_clear(std::string name, std::vector<ImageId> targets, glm::vec4 color) {
  Pass& pass = add_pass(std::move(name), PassKind::clear);
  if (!targets.empty()) {
    pass.width = image(targets.front()).width;
    pass.height = image(targets.front()).height;
    pass.samples = image(targets.front()).samples;
  }
  pass.targets = std::move(targets);
  pass.clear_color = color;
  return pass;
}

Pass& FrameGraph::add_resolve(std::string name, ImageId source, ImageId target) {
  Pass& pass = add_pass(std::move(name), PassKind::resolve);
  pass.width = image(target).width;
  pass.height = image(target).height;
  pass.source = source;
  pass.targets = {target};
  return pass;
}

}  // namespace hwsim::pipeline
