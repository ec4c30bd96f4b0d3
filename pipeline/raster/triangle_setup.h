#pragma once
// The steps of set_up_triangle, for callers that need some of them: culling needs the first alone, depth the
// second, attributes the third.
#include <algorithm>

#include "pipeline/raster/triangle.h"

namespace hwsim::pipeline {

/// Where a triangle is drawn in one viewport.
struct TrianglePlace {
  std::int16_t min_x, min_y, max_x, max_y;  ///< as RasterTriangle's
  std::int16_t reference_x, reference_y;    ///< the reference pixel, before the viewport's shift
};

/// Slopes of the barycentric coordinates of vertices 1 and 2.
struct TriangleSlopes {
  double x0, y0;                      ///< vertex 0 relative to the reference pixel, px
  double l1_dx, l1_dy, l2_dx, l2_dy;  ///< per px
};

/// Pixels that can hold covered samples, not yet clipped to the viewport.
struct PixelBounds {
  int first_x, last_x, first_y, last_y;
};

// First pixel column (or row) with a sample at or right of `low`, and last with one at or left of `high`;
// 1/256 px.
inline void sample_bounds(std::int32_t low, std::int32_t high, int sample_low, int sample_high, int& first,
                          int& last) {
  // pixel p has samples from 256 p + 128 + 16 sample_low to 256 p + 128 + 16 sample_high
  const std::int32_t to_last_sample = 128 + 16 * sample_high;
  const std::int32_t to_first_sample = 128 + 16 * sample_low;
  first = (low - to_last_sample + kSubpixelUnits - 1) >> kSubpixelBits;
  last = (high - to_first_sample) >> kSubpixelBits;
}

inline PixelBounds find_bounds(std::int32_t low_x, std::int32_t high_x, std::int32_t low_y,
                               std::int32_t high_y, const SetupRules& rules) {
  if (rules.conservative)
    return {(low_x - 1) >> kSubpixelBits, high_x >> kSubpixelBits, (low_y - 1) >> kSubpixelBits,
            high_y >> kSubpixelBits};
  PixelBounds b;
  sample_bounds(low_x, high_x, rules.sample_min_x, rules.sample_max_x, b.first_x, b.last_x);
  sample_bounds(low_y, high_y, rules.sample_min_y, rules.sample_max_y, b.first_y, b.last_y);
  return b;
}

inline PixelBounds find_bounds(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c,
                               const SetupRules& rules) {
  return find_bounds(std::min(std::min(a.x, b.x), c.x), std::max(std::max(a.x, b.x), c.x),
                     std::min(std::min(a.y, b.y), c.y), std::max(std::max(a.y, b.y), c.y), rules);
}

inline bool clip_bounds(const PixelBounds& b, const SetupRules& rules, PixelRectangle& r) {
  r = {std::max(b.first_x, 0), std::max(b.first_y, 0), std::min(b.last_x, rules.width_px - 1),
       std::min(b.last_y, rules.height_px - 1)};
  return r.min_x <= r.max_x && r.min_y <= r.max_y;
}

inline bool set_bounds(const PixelBounds& b, const SetupRules& rules, TrianglePlace& place) {
  PixelRectangle r;
  if (!clip_bounds(b, rules, r)) return false;
  place.min_x = static_cast<std::int16_t>(r.min_x);
  place.min_y = static_cast<std::int16_t>(r.min_y);
  place.max_x = static_cast<std::int16_t>(r.max_x);
  place.max_y = static_cast<std::int16_t>(r.max_y);
  return true;
}

/// Twice the area, 1/256 px squared. With y down, front faces have a negative one.
inline std::int64_t doubled_area(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
  return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{c.x - a.x} * (b.y - a.y);
}

/// What culling by area and facing says; `drawn`: nothing yet.
inline SetupResult cull_by_area(std::int64_t area2, const SetupRules& rules) {
  if (area2 == 0) return SetupResult::zero_area;
  const bool front_facing = area2 < 0;
  const bool culled = (rules.cull_back && !front_facing) || (rules.cull_front && front_facing);
  return culled ? SetupResult::backface : SetupResult::drawn;
}

/// The first step in the one viewport that is not shifted.
inline SetupResult place_triangle(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c,
                                  const SetupRules& rules, TrianglePlace& place) {
  const SetupResult result = cull_by_area(doubled_area(a, b, c), rules);
  if (result != SetupResult::drawn) return result;
  const PixelBounds bounds = find_bounds(a, b, c, rules);
  if (!set_bounds(bounds, rules, place)) return SetupResult::sample_miss;
  place.reference_x = static_cast<std::int16_t>(std::max(bounds.first_x, 0));
  place.reference_y = static_cast<std::int16_t>(std::max(bounds.first_y, 0));
  return SetupResult::drawn;
}

/// The first step in each viewport: all have one reference pixel.
void place_triangle(const ScreenVertex (&v)[3], const SetupRules& rules,
                    std::span<const ViewportShift> viewports, std::span<TrianglePlace> places,
                    std::span<SetupResult> results);

/// The second step: edges, bounds, facing, reference point and depth of a triangle that is drawn.
TriangleSlopes set_up_depth(const ScreenVertex (&v)[3], const TrianglePlace& place, ViewportShift shift,
                            bool conservative, RasterTriangle& triangle);

/// The third step: 1/w and barycentric coordinates.
void set_up_attributes(const ScreenVertex (&v)[3], const TriangleSlopes& slopes, RasterTriangle& triangle);

}  // namespace hwsim::pipeline
