#include "pipeline/gltf/view_release.h"

#include <algorithm>

#include "pipeline/base/zeroed_vector.h"

namespace hwsim::pipeline::gltf {

ViewRelease::ViewRelease(Source& source) : model_(source.model), uses_(model_.bufferViews.size(), 0) {
  const auto count = [&](int accessor) {
    for (const int view : views_of(accessor)) uses_[static_cast<std::size_t>(view)] += 1;
  };
  for (const tinygltf::Mesh& mesh : model_.meshes)
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      for (const auto& [name, accessor] : primitive.attributes) count(accessor);
      if (primitive.indices >= 0) count(primitive.indices);
    }
  for (const SkinSpec& skin : source.skins)
    if (skin.inverse_bind_matrices >= 0) count(skin.inverse_bind_matrices);
  for (const EncodedImage& image : source.images) keep(image.bytes);
}

std::vector<int> ViewRelease::views_of(int accessor) const {
  const tinygltf::Accessor& a = model_.accessors[static_cast<std::size_t>(accessor)];
  std::vector<int> views;
  if (a.bufferView >= 0) views.push_back(a.bufferView);
  if (a.sparse.isSparse) {
    views.push_back(a.sparse.indices.bufferView);
    views.push_back(a.sparse.values.bufferView);
  }
  return views;
}

ViewRelease::Range ViewRelease::range_of(int view) const {
  const tinygltf::BufferView& v = model_.bufferViews[static_cast<std::size_t>(view)];
  return {v.buffer, v.byteOffset, v.byteOffset + v.byteLength};
}

void ViewRelease::keep(std::span<const std::uint8_t> bytes) {
  for (std::size_t b = 0; b < model_.buffers.size(); ++b) {
    const auto& data = model_.buffers[b].data;
    if (data.empty() || bytes.data() < data.data() || bytes.data() >= data.data() + data.size()) continue;
    const auto begin = static_cast<std::size_t>(bytes.data() - data.data());
    kept_.push_back({static_cast<int>(b), begin, begin + bytes.size()});
  }
}

bool ViewRelease::is_needed(const Range& range) const {
  for (std::size_t v = 0; v < uses_.size(); ++v)
    if (uses_[v] > 0 && range_of(static_cast<int>(v)).overlaps(range)) return true;
  return std::ranges::any_of(kept_, [&](const Range& kept) { return kept.overlaps(range); });
}

void ViewRelease::copied(int accessor) {
  for (const int view : views_of(accessor)) {
    std::uint64_t& uses = uses_[static_cast<std::size_t>(view)];
    if (--uses > 0) continue;
    const Range range = range_of(view);
    auto& data = model_.buffers[static_cast<std::size_t>(range.buffer)].data;
    if (range.end - range.begin < kMinBytes || range.end > data.size() || is_needed(range)) continue;
    released_bytes_ += give_back_pages(data.data() + range.begin, range.end - range.begin);
  }
}

}  // namespace hwsim::pipeline::gltf
