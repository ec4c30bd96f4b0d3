#pragma once
// Clipping in homogeneous coordinates against near, far and the guard band.
#include <array>

namespace hwsim::pipeline {

struct ClipVertex {
  std::array<double, 4> position;   ///< x, y, z, w; inside: 0 <= z <= w, |x|, |y| within the band
  std::array<double, 3> weights{};  ///< shares of the triangle's three vertices; sum 1
};

/// Limits of x/w and y/w that keep screen coordinates inside the guard band; and those of the view, 1 unless
/// shifted viewports show what lies `margin_px` beyond its edges.
struct GuardBand {
  double min_x, max_x, min_y, max_y;
  float view_x = 1.0f, view_y = 1.0f;
};
GuardBand guard_band(int width_px, int height_px, int margin_px = 0);

inline constexpr int kMaxClippedVertices = 9;  ///< three and one for each plane

/// The part of a triangle inside; returns the number of vertices written (0 or 3..9), in order around the
/// polygon.
int clip_triangle(const std::array<ClipVertex, 3>& triangle, const GuardBand& band,
                  std::array<ClipVertex, kMaxClippedVertices>& out);

/// Bit mask of planes that a point is outside of: 1 x < -w, 2 x > w, 4 y < -w, 8 y > w, 16 z < 0, 32 z > w;
/// x and y against the band's view.
inline int frustum_outcode(const float* p, const GuardBand& band) {
  const float x = p[3] * band.view_x, y = p[3] * band.view_y;
  return (p[0] < -x ? 1 : 0) | (p[0] > x ? 2 : 0) | (p[1] < -y ? 4 : 0) | (p[1] > y ? 8 : 0) |
         (p[2] < 0.0f ? 16 : 0) | (p[2] > p[3] ? 32 : 0);
}

}  // namespace hwsim::pipeline
