#pragma once
// Triangles that rasterizers get wrong. The same numbers on every machine: no distribution of the standard
// library.
#include <cstdint>
#include <random>
#include <vector>

#include "oracle/fixed_triangle.h"

namespace hwsim::oracle {

enum class TriangleKind {
  general,       ///< vertices anywhere in and around the target
  sliver,        ///< long, and a few subpixels wide
  tie,           ///< vertices on sample positions: edges run through samples
  axis_aligned,  ///< horizontal and vertical edges, many on sample rows
  tiny,          ///< smaller than a pixel
  large,         ///< hundreds of pixels outside
  guard_band,    ///< up to 2^15 pixels outside
};
inline constexpr TriangleKind kAllTriangleKinds[] = {
    TriangleKind::general, TriangleKind::sliver, TriangleKind::tie,       TriangleKind::axis_aligned,
    TriangleKind::tiny,    TriangleKind::large,  TriangleKind::guard_band};
const char* name(TriangleKind kind);

class TriangleGenerator {
 public:
  TriangleGenerator(int width, int height, std::uint32_t seed)
      : width_(width), height_(height), random_(seed) {}

  std::vector<FixedTriangle> make(TriangleKind kind, int count);
  /// Triangles around a common vertex that together fill a polygon: neighbors share an edge, vertices on the
  /// 1/16 grid.
  std::vector<FixedTriangle> fan(int count);
  /// The rectangle that the target is, cut into triangles by random splits: each sample is covered exactly
  /// once.
  std::vector<FixedTriangle> partition(int splits);

 private:
  std::int32_t between(std::int32_t low, std::int32_t high);  ///< both included
  FixedVertex in_target(std::int32_t margin_px, std::int32_t grid);
  FixedTriangle one(TriangleKind kind);
  FixedTriangle sliver();
  FixedTriangle axis_aligned();
  FixedTriangle tiny();

  int width_, height_;
  std::mt19937 random_;
};

}  // namespace hwsim::oracle
