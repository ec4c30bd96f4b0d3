#include "pipeline/texture/texture_view.h"

namespace hwsim::pipeline {
namespace {

int tiles(int size) { return (size + 3) / 4; }

void append_level(const MipLevel& level, std::size_t index, TextureView& view,
                  std::vector<std::uint32_t>& out) {
  view.width[index] = level.width;
  view.height[index] = level.height;
  view.tiles_x[index] = tiles(level.width);
  view.first_texel[index] = static_cast<std::int32_t>(out.size());
  const std::size_t first = out.size();
  out.resize(first + static_cast<std::size_t>(tiles(level.width)) *
                         static_cast<std::size_t>(tiles(level.height)) * kTexelsPerLine);
  for (int y = 0; y < level.height; ++y) {
    for (int x = 0; x < level.width; ++x) {
      const int offset = ((y >> 2) * view.tiles_x[index] + (x >> 2)) * kTexelsPerLine + (y & 3) * 4 + (x & 3);
      out[first + static_cast<std::size_t>(offset)] =
          level.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) +
                       static_cast<std::size_t>(x)];
    }
  }
}

}  // namespace

TextureStore::TextureStore(const Scene& scene)
    : texels_(scene.textures.size()),
      by_texture_(scene.textures.size()),
      sampler_count_(static_cast<int>(scene.samplers.size())) {
  std::vector<std::uint32_t> line_counts;
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const Texture& texture = scene.textures[i];
    TextureView& view = by_texture_[i];
    if (texture.same_texels_as >= 0) {  // texels of its own in the GPU's memory, but one copy of them here
      view = by_texture_[static_cast<std::size_t>(texture.same_texels_as)];
      view.first_line = line_count_;
      line_count_ += line_counts[static_cast<std::size_t>(texture.same_texels_as)];
      line_counts.push_back(line_counts[static_cast<std::size_t>(texture.same_texels_as)]);
      continue;
    }
    view.srgb = texture.srgb;
    view.levels = static_cast<int>(std::min<std::size_t>(texture.levels.size(), kMaxMipLevels));
    for (std::size_t level = 0; level < static_cast<std::size_t>(view.levels); ++level)
      append_level(texture.levels[level], level, view, texels_[i]);
    view.texels = texels_[i].data();
    view.first_line = line_count_;
    line_counts.push_back(static_cast<std::uint32_t>(texels_[i].size() / kTexelsPerLine));
    line_count_ += line_counts.back();
  }
  for (const TextureView& base : by_texture_) {
    for (const Sampler& sampler : scene.samplers) {
      for (const int uv_set : {0, 1}) {
        views_.push_back(base);
        views_.back().sampler = sampler;
        views_.back().uv_set = uv_set;
      }
    }
  }
}

const TextureView* TextureStore::view(const TextureRef& ref) const {
  if (ref.texture < 0) return nullptr;
  const TextureView& view =
      views_[static_cast<std::size_t>((ref.texture * sampler_count_ + ref.sampler) * 2 + ref.uv_set)];
  return view.levels > 0 ? &view : nullptr;
}

}  // namespace hwsim::pipeline
