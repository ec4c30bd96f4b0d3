#pragma once
// Triangles after snapping, and what rendering them leaves in every sample.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hwsim::oracle {

inline constexpr int kSubpixelsPerPixel = 256;

/// Window coordinates in 1/256 pixel, x right, y down, row 0 on top; depth in [0,1].
struct FixedVertex {
  std::int32_t x = 0, y = 0;
  float depth = 0.0f;
};

struct FixedTriangle {
  std::array<FixedVertex, 3> vertices;
};

/// In 1/16 pixel from the pixel's center, x right, y down.
struct SampleOffset {
  int x = 0, y = 0;
};

/// The standard positions of Direct3D 11 and Vulkan for 1, 2, 4, 8 or 16 samples, in index order.
std::span<const SampleOffset> standard_offsets(int samples);

/// Row by row from the top, pixel by pixel, sample by sample.
struct SampleImage {
  int width = 0, height = 0, samples = 1;
  std::vector<std::uint32_t> primitive;  ///< number of the triangle, counted from 1; 0: none
  std::vector<float> depth;              ///< 1 where no triangle is; empty when the oracle computes none

  SampleImage() = default;
  SampleImage(int w, int h, int n)
      : width(w),
        height(h),
        samples(n),
        primitive(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(n)) {}
  std::size_t index(int x, int y, int sample) const {
    const auto pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    return pixel * static_cast<std::size_t>(samples) + static_cast<std::size_t>(sample);
  }
};

}  // namespace hwsim::oracle
