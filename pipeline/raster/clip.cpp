#include "pipeline/raster/clip.h"

#include <cstddef>

#include "pipeline/raster/triangle.h"

namespace hwsim::pipeline {
namespace {

// Distance to a plane, positive inside.
double plane_distance(const std::array<double, 4>& p, int plane, const GuardBand& band) {
  switch (plane) {
    case 0:
      return p[2];  // near
    case 1:
      return p[3] - p[2];  // far
    case 2:
      return p[0] - band.min_x * p[3];
    case 3:
      return band.max_x * p[3] - p[0];
    case 4:
      return p[1] - band.min_y * p[3];
    default:
      return band.max_y * p[3] - p[1];
  }
}

// Always from the inside vertex to the outside one, so that two triangles that share an edge cut it at the
// same point.
ClipVertex cut(const ClipVertex& inside, const ClipVertex& outside, double d_inside, double d_outside) {
  const double t = d_inside / (d_inside - d_outside);
  ClipVertex v;
  for (std::size_t i = 0; i < 4; ++i)
    v.position[i] = inside.position[i] + (outside.position[i] - inside.position[i]) * t;
  for (std::size_t i = 0; i < 3; ++i)
    v.weights[i] = inside.weights[i] + (outside.weights[i] - inside.weights[i]) * t;
  return v;
}

}  // namespace

GuardBand guard_band(int width_px, int height_px, int margin_px) {
  // x_screen = (x/w / 2 + 1/2) * width; one pixel of margin for snapping, and that of the viewports. y points
  // up in clip space, down on screen.
  const auto to_ndc = [](double px, int size) { return 2.0 * px / size - 1.0; };
  const auto view = [&](int size) {
    return 1.0f + 2.0f * static_cast<float>(margin_px) / static_cast<float>(size);
  };
  const int low = kGuardBandMinPx + 1 + margin_px, high = kGuardBandMaxPx - 1 - margin_px;
  return {to_ndc(low, width_px),   to_ndc(high, width_px), -to_ndc(high, height_px),
          -to_ndc(low, height_px), view(width_px),         view(height_px)};
}

int clip_triangle(const std::array<ClipVertex, 3>& triangle, const GuardBand& band,
                  std::array<ClipVertex, kMaxClippedVertices>& out) {
  std::array<ClipVertex, kMaxClippedVertices> from{};
  int count = 3;
  for (std::size_t i = 0; i < 3; ++i) out[i] = triangle[i];
  for (int plane = 0; plane < 6; ++plane) {
    from = out;
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const ClipVertex& a = from[static_cast<std::size_t>(i)];
      const ClipVertex& b = from[static_cast<std::size_t>((i + 1) % count)];
      const double da = plane_distance(a.position, plane, band), db = plane_distance(b.position, plane, band);
      if (da >= 0) out[static_cast<std::size_t>(kept++)] = a;
      if (da >= 0 && db < 0) out[static_cast<std::size_t>(kept++)] = cut(a, b, da, db);
      if (da < 0 && db >= 0) out[static_cast<std::size_t>(kept++)] = cut(b, a, db, da);
    }
    count = kept;
    if (count < 3) return 0;
  }
  return count;
}

}  // namespace hwsim::pipeline
