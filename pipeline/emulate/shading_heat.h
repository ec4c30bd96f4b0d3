#pragma once
// How often each pixel of a frame is shaded.
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/emulate/pass_context.h"

namespace hwsim::pipeline {

class ShadingHeat {
 public:
  ShadingHeat(int width, int height);

  /// Lets the pass count. Shading at a multiple of the frame's size (supersampling) counts for the pixel that
  /// it ends in; other sizes (shadow maps) do not count.
  void attach(PassContext& context);
  Image image(int jobs) const;

  /// Tile by tile, as in GpuImage.
  const std::vector<std::uint32_t>& counts() const { return counts_; }
  void add(std::span<const std::uint32_t> counts);
  /// Empty where nothing was.
  std::vector<std::uint32_t> added_since(std::span<const std::uint32_t> before) const;

 private:
  int width_, height_, blocks_x_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace hwsim::pipeline
