#pragma once
// A texture as the texture unit reads it.
#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

inline constexpr int kMaxMipLevels = 15;
inline constexpr int kTexelsPerLine = 16;  ///< a 64-byte line holds a 4x4 tile of RGBA8 texels

/// Texels in 4x4 tiles, rows of tiles from the top; levels follow each other.
struct TextureView {
  const std::uint32_t* texels = nullptr;
  std::array<std::int32_t, kMaxMipLevels> width{}, height{}, tiles_x{}, first_texel{};
  int levels = 0;
  bool srgb = false;
  Sampler sampler;
  int uv_set = 0;                ///< the coordinates that it is read at
  std::uint32_t first_line = 0;  ///< this texture's lines among those of all textures
};

/// All textures of a scene in the texture unit's layout. Views point into it.
class TextureStore {
 public:
  explicit TextureStore(const Scene& scene);
  /// The texture with the sampler and the UV set of `ref`; null when ref has none.
  const TextureView* view(const TextureRef& ref) const;
  std::uint32_t line_count() const { return line_count_; }

 private:
  std::vector<std::vector<std::uint32_t>> texels_;
  std::vector<TextureView> by_texture_;
  std::vector<TextureView> views_;  // texture x sampler x UV set
  int sampler_count_ = 0;
  std::uint32_t line_count_ = 0;
};

}  // namespace hwsim::pipeline
