#include "oracle/exact_coverage.h"

#include <algorithm>
#include <functional>

namespace hwsim::oracle {
namespace {

__extension__ using Wide = __int128;

// Twice the signed area of (a, b, p): positive where p is on the right hand of who walks from a to b on the
// screen.
Wide edge(const FixedVertex& a, const FixedVertex& b, std::int64_t x, std::int64_t y) {
  return (Wide{b.x} - a.x) * (Wide{y} - a.y) - (Wide{b.y} - a.y) * (Wide{x} - a.x);
}

// Top: exactly horizontal and above the third vertex. Left: not horizontal, the triangle on its right side.
bool is_top_or_left(const FixedVertex& a, const FixedVertex& b, const FixedVertex& opposite) {
  if (a.y == b.y) return opposite.y > a.y;
  const FixedVertex& upper = a.y < b.y ? a : b;
  const FixedVertex& lower = a.y < b.y ? b : a;
  return edge(upper, lower, opposite.x, opposite.y) < 0;  // walking down, the screen's right is the left hand
}

struct PixelRange {
  int first, last;
};

// The pixels whose samples, at most half a pixel from the center, can lie between low and high.
PixelRange pixel_range(std::int32_t low, std::int32_t high, int count) {
  const std::int64_t first = std::int64_t{low} / kSubpixelsPerPixel - 1,
                     last = std::int64_t{high} / kSubpixelsPerPixel + 1;
  return {static_cast<int>(std::clamp<std::int64_t>(first, 0, count)),
          static_cast<int>(std::clamp<std::int64_t>(last, -1, count - 1))};
}

using Visit = std::function<void(std::size_t sample_index, std::size_t triangle)>;

void visit_covered(const std::vector<FixedTriangle>& triangles, const SampleImage& image,
                   const Visit& visit) {
  const std::span<const SampleOffset> offsets = standard_offsets(image.samples);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t].vertices;
    const PixelRange xs = pixel_range(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), image.width);
    const PixelRange ys = pixel_range(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), image.height);
    for (int y = ys.first; y <= ys.last; ++y)
      for (int x = xs.first; x <= xs.last; ++x)
        for (int s = 0; s < image.samples; ++s) {
          const SampleOffset offset = offsets[static_cast<std::size_t>(s)];
          const std::int64_t px = std::int64_t{x} * 256 + 128 + offset.x * 16;
          const std::int64_t py = std::int64_t{y} * 256 + 128 + offset.y * 16;
          if (covers(triangles[t], px, py)) visit(image.index(x, y, s), t);
        }
  }
}

}  // namespace

std::span<const SampleOffset> standard_offsets(int samples) {
  static constexpr SampleOffset one[] = {{0, 0}};
  static constexpr SampleOffset two[] = {{4, 4}, {-4, -4}};
  static constexpr SampleOffset four[] = {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}};
  static constexpr SampleOffset eight[] = {{1, -3}, {-1, 3},  {5, 1}, {-3, -5},
                                           {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
  static constexpr SampleOffset sixteen[] = {{1, 1},  {-1, -3}, {-3, 2}, {4, -1}, {-5, -2}, {2, 5},
                                             {5, 3},  {3, -5},  {-2, 6}, {0, -7}, {-4, -6}, {-6, 4},
                                             {-8, 0}, {7, -4},  {6, 7},  {-7, -8}};
  switch (samples) {
    case 1:
      return one;
    case 2:
      return two;
    case 4:
      return four;
    case 8:
      return eight;
    case 16:
      return sixteen;
    default:
      return {};
  }
}

bool covers(const FixedTriangle& triangle, std::int64_t x, std::int64_t y) {
  const auto& v = triangle.vertices;
  const Wide area = edge(v[0], v[1], v[2].x, v[2].y);
  if (area == 0) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const FixedVertex &a = v[i], &b = v[(i + 1) % 3], &opposite = v[(i + 2) % 3];
    const Wide value = area > 0 ? edge(a, b, x, y) : -edge(a, b, x, y);
    if (value < 0 || (value == 0 && !is_top_or_left(a, b, opposite))) return false;
  }
  return true;
}

SampleImage exact_coverage(const std::vector<FixedTriangle>& triangles, int width, int height, int samples) {
  SampleImage image(width, height, samples);
  visit_covered(triangles, image, [&](std::size_t i, std::size_t t) {
    image.primitive[i] = static_cast<std::uint32_t>(t + 1);
  });
  return image;
}

std::vector<std::uint32_t> exact_cover_counts(const std::vector<FixedTriangle>& triangles, int width,
                                              int height, int samples) {
  SampleImage image(width, height, samples);
  visit_covered(triangles, image, [&](std::size_t i, std::size_t) { ++image.primitive[i]; });
  return std::move(image.primitive);
}

}  // namespace hwsim::oracle
