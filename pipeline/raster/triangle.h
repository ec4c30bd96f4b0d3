#pragma once
// A triangle ready for rasterization, and its set-up from snapped vertices.
#include <cstdint>
#include <span>

#include "pipeline/graph/pipeline_state.h"

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
  std::int32_t layer;        ///< of the attachments
  bool front_facing;
};

enum class SetupResult { drawn, backface, zero_area, sample_miss };

struct SetupRules {
  bool cull_back = false, cull_front = false;
  int width_px = 0, height_px = 0;                                             ///< viewport
  int sample_min_x = 0, sample_min_y = 0, sample_max_x = 0, sample_max_y = 0;  ///< of the pattern, 1/16 px
  bool conservative = false;
};

/// Fills edges, bounds and planes of `triangle`; front faces turn counterclockwise seen with y up (glTF).
SetupResult set_up_triangle(const ScreenVertex (&v)[3], const SetupRules& rules, RasterTriangle& triangle);

/// The same for each viewport, at most kMaxViewports. Planes are set up once, from the unshifted vertices:
/// the layers together are bit for bit a rasterization at all their sample positions.
void set_up_triangle(const ScreenVertex (&v)[3], const SetupRules& rules,
                     std::span<const ViewportShift> viewports, std::span<RasterTriangle> triangles,
                     std::span<SetupResult> results);

}  // namespace hwsim::pipeline
