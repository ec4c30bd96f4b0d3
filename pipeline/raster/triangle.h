#pragma once
// A triangle ready for rasterization, and its set-up from snapped vertices.
#include <cstdint>
#include <span>

#include "pipeline/state/pipeline_state.h"

namespace hwsim::pipeline {

inline constexpr int kSubpixelBits = 8;  // 24.8 fixed point, 1/256 pixel
inline constexpr int kSubpixelUnits = 1 << kSubpixelBits;
// Vertices beyond these are clipped. A difference of two coordinates is below 2^15 px = 2^23 units, so for an
// edge function that changes sign inside an 8x8 tile |E| <= (|a| + |b|) * 127 < 2^24 * 127 < 2^31 in steps of
// 1/16 px.
inline constexpr int kGuardBandMinPx = -8192;
inline constexpr int kGuardBandMaxPx = 24575;
static_assert((std::int64_t{2} * (kGuardBandMaxPx - kGuardBandMinPx) * kSubpixelUnits) * 127 <
              (std::int64_t{1} << 31));

/// A vertex after the viewport transform.
struct ScreenVertex {
  std::int32_t x = 0, y = 0;  ///< 24.8 fixed point, y down
  float z = 0.0f;             ///< 0..1 inside the view volume
  float inv_w = 1.0f;
};

/// Value at pixel coordinates (x, y) relative to the triangle's reference point: (base + ddy * y) + ddx * x,
/// in single precision and in this order everywhere.
struct PlaneEquation {
  float base = 0.0f, ddx = 0.0f, ddy = 0.0f;
};

struct RasterTriangle {
  // Sample at (X, Y) sixteenths of a pixel is inside iff a*X + b*Y + c >= 0 for all three edges. The top-left
  // rule and the rounding from 1/256 to 1/16 px are inside c.
  std::int32_t a[3], b[3];
  std::int64_t c[3];
  std::int16_t min_x, min_y, max_x, max_y;  ///< pixels whose samples can be inside, clipped to the viewport
  /// The top left corner of a pixel, px; shifted with the viewport, so that all layers of a multicast pass
  /// evaluate the same planes at the same points. Multiples of 1/256 below 2^15: differences are exact.
  float reference_x, reference_y;
  PlaneEquation z;
  PlaneEquation inv_w;       ///< 1/w
  PlaneEquation l1_w, l2_w;  ///< barycentric coordinates of vertices 1 and 2, over w
  std::uint32_t vertex[3];   ///< indices into the segment's varyings
  std::uint32_t draw;        ///< index into the pass's flat list of draws
  std::uint32_t chunk;       ///< index of the chunk of work
  std::uint32_t primitive;   ///< number of the triangle in the pass, in submission order
  std::int32_t layer;        ///< the layer of the attachments
  bool front_facing;
};

/// A point: a square around its center, drawn as the triangles of its corners 0, 1, 2 and 0, 2, 3, clockwise
/// from the top left. They are set up where they are rasterized: most points cover one sample.
struct RasterPoint {
  std::int32_t x, y;  ///< 24.8 fixed point
  float z, inv_w;
  std::uint32_t vertex, chunk, primitive;  ///< as a triangle's
};

/// Pixels of the viewport, both ends included.
struct PixelRectangle {
  int min_x, min_y, max_x, max_y;
};

enum class SetupResult { drawn, backface, zero_area, sample_miss };

struct SetupRules {
  bool cull_back = false, cull_front = false;
  int width_px = 0, height_px = 0;  ///< viewport
  int sample_min_x = 0, sample_min_y = 0, sample_max_x = 0,
      sample_max_y = 0;  ///< bounds of the pattern, 1/16 px
  bool conservative = false;
};

/// Fills edges, bounds and planes of `triangle`; front faces turn counterclockwise seen with y up (glTF).
SetupResult set_up_triangle(const ScreenVertex (&v)[3], const SetupRules& rules, RasterTriangle& triangle);

/// The same for each viewport, at most kMaxViewports. Planes are set up once, from the unshifted vertices:
/// the layers together are bit for bit a rasterization at all their sample positions.
void set_up_triangle(const ScreenVertex (&v)[3], const SetupRules& rules,
                     std::span<const ViewportShift> viewports, std::span<RasterTriangle> triangles,
                     std::span<SetupResult> results);

/// Pixels that can hold covered samples of the square of `half` 1/256 px on each side of the center; false:
/// none.
bool find_point_bounds(const RasterPoint& point, std::int32_t half, const SetupRules& rules,
                       PixelRectangle& bounds);

/// The upper right half of the square, or the lower left one; of a point that can cover a sample.
void set_up_point(const RasterPoint& point, std::int32_t half, bool upper, const SetupRules& rules,
                  RasterTriangle& triangle);

/// The one pixel that a point of a pixel's size covers, of patterns of one sample, and the half that has it.
struct PointPixel {
  int x, y;
  bool upper;
  bool one_tile;  ///< the pixels that can hold the sample, edges included, lie in one 8x8 tile

  PointPixel(const RasterPoint& p, const SetupRules& rules) {
    // Its sample is the only one at or right of (below) `low` and left of (above) low + 256.
    const std::int32_t to_x = kSubpixelUnits / 2 + 16 * rules.sample_min_x,
                       to_y = kSubpixelUnits / 2 + 16 * rules.sample_min_y;
    const std::int32_t low_x = p.x - kSubpixelUnits / 2 - to_x, low_y = p.y - kSubpixelUnits / 2 - to_y;
    x = (low_x + kSubpixelUnits - 1) >> kSubpixelBits;
    y = (low_y + kSubpixelUnits - 1) >> kSubpixelBits;
    // The diagonal falls to the right; samples on it belong to the half whose left edge it is.
    upper = x * kSubpixelUnits + to_x - p.x >= y * kSubpixelUnits + to_y - p.y;
    const int last_x = (low_x >> kSubpixelBits) + 1, last_y = (low_y >> kSubpixelBits) + 1;
    one_tile = x >> 3 == last_x >> 3 && y >> 3 == last_y >> 3 && x >= 0 && y >= 0 && x < rules.width_px &&
               y < rules.height_px;
  }

  /// How often the coarse raster visits the tile: for the half that has the sample, and for the other one
  /// unless the diagonal cuts it off in the tile's corner.
  std::uint64_t visits() const {
    return upper ? ((x & 7) == 0 && (y & 7) == 7 ? 1 : 2) : ((x & 7) == 7 && (y & 7) == 0 ? 1 : 2);
  }
};

/// set_up_point's planes for the half that covers the pixel; edges and bounds are left as they are.
void set_point_planes(const RasterPoint& point, const PointPixel& pixel, RasterTriangle& triangle);

}  // namespace hwsim::pipeline
