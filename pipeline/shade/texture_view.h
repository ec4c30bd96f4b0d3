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
  std::uint32_t first_line = 0;  ///< this texture's lines among those of all textures
};

/// All textures of a scene in the texture unit's layout. Views point into it.
class TextureStore {
 public:
  explicit TextureStore(const Scene& scene);
  /// The texture with the sampler of `ref`; null when ref has none.
  const TextureView* view(const TextureRef& ref) const;
  std::uint32_t line_count() const { return line_count_; }

 private:
  std::vector<std::vector<std::uint32_t>> texels_;
  std::vector<TextureView> by_texture_;
  std::vector<TextureView> views_;  // texture x sampler
  int sampler_count_ = 0;
  std::uint32_t line_count_ = 0;
};

/// Which 64-byte lines of textures were used: by a small cache that starts cold in each screen bin, so that
/// the count depends neither on threads nor on their order, and in a set of lines for the whole pass.
struct TextureTracker {
  static constexpr int kSets = 64, kWays = 4;  ///< 16 KiB, the class of the texture L1s of gpus section 3
  std::array<std::array<std::uint32_t, kWays>, kSets> tags;
  std::uint64_t missed_lines = 0;
  std::vector<std::uint64_t>* used_lines = nullptr;  ///< a bit a line, one set a worker
  std::array<std::vector<std::uint32_t>, 16>
      batch_lines;  ///< of each quad of the batch that is being shaded, in order

  void reset() {
    for (auto& set : tags) set.fill(0xffffffffu);
  }
  /// Quads that share a register fetch in turn, others after each other: the cache meets a batch's lines quad
  /// by quad, whatever the register's width.
  void use(int quad, std::uint32_t line) {
    std::vector<std::uint32_t>& lines = batch_lines[static_cast<std::size_t>(quad)];
    if (lines.empty() || lines.back() != line) lines.push_back(line);
  }
  void end_batch() {
    for (std::vector<std::uint32_t>& lines : batch_lines) {
      for (const std::uint32_t line : lines) touch(line);
      lines.clear();
    }
  }
  void touch(std::uint32_t line) {
    auto& set = tags[line % kSets];
    if (set[0] == line) return;
    for (int way = 1; way < kWays; ++way) {
      if (set[static_cast<std::size_t>(way)] == line) {
        for (int w = way; w > 0; --w) set[static_cast<std::size_t>(w)] = set[static_cast<std::size_t>(w - 1)];
        set[0] = line;
        return;
      }
    }
    for (int w = kWays - 1; w > 0; --w)
      set[static_cast<std::size_t>(w)] = set[static_cast<std::size_t>(w - 1)];
    set[0] = line;
    ++missed_lines;
    (*used_lines)[line / 64] |= std::uint64_t{1} << (line % 64);
  }
};

/// sRGB code to linear, by the standard's formula; shared by textures and render targets.
const std::array<float, 256>& srgb_decode_table();

}  // namespace hwsim::pipeline
