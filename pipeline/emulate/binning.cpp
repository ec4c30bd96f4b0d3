#include "pipeline/emulate/binning.h"

#include "pipeline/emulate/primitive_setup.h"

namespace hwsim::pipeline {
namespace {

// Some point of the bin inside each edge; a bin's samples lie within its square.
bool touches_bin(const RasterTriangle& t, int bin_x, int bin_y) {
  constexpr std::int64_t kSize = 16 * kBinPx;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t a = t.a[i], b = t.b[i];
    const std::int64_t x = bin_x * kSize + (a > 0 ? kSize : 0), y = bin_y * kSize + (b > 0 ? kSize : 0);
    if (a * x + b * y + t.c[i] < 0) return false;
  }
  return true;
}

template <class Body>
void for_each_bin(const PassContext& context, const RasterTriangle& t, Body&& body) {
  const int left = t.min_x / kBinPx, right = t.max_x / kBinPx, top = t.min_y / kBinPx,
            bottom = t.max_y / kBinPx;
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x)
      if ((left == right && top == bottom) || touches_bin(t, x, y))
        body(static_cast<std::size_t>((t.layer * context.bins_y + y) * context.bins_x + x));
}

// A counting sort of (bin, number) pairs; `each` hands on the bins of a number.
template <class Each>
void sort_into_bins(const PassContext& context, std::size_t count, GeometryItem& item, Each&& each) {
  const auto bins = static_cast<std::size_t>(context.bins_x * context.bins_y) * context.viewports.size();
  item.bin_start.assign(bins + 1, 0);
  for (std::uint32_t i = 0; i < count; ++i) each(i, [&](std::size_t b) { item.bin_start[b + 1] += 1; });
  for (std::size_t b = 0; b < bins; ++b) item.bin_start[b + 1] += item.bin_start[b];
  item.binned.resize(item.bin_start[bins]);
  std::vector<std::uint32_t> next(item.bin_start.begin(), item.bin_start.end() - 1);
  for (std::uint32_t i = 0; i < count; ++i) each(i, [&](std::size_t b) { item.binned[next[b]++] = i; });
}

}  // namespace

void bin_triangles(const PassContext& context, GeometryItem& item) {
  sort_into_bins(context, item.triangles.size(), item,
                 [&](std::uint32_t i, auto&& body) { for_each_bin(context, item.triangles[i], body); });
}

void bin_points(const PassContext& context, GeometryItem& item) {
  const DrawInfo& draw = context.draws[item.draw];
  const SetupRules rules = setup_rules(context, draw);
  const std::int32_t half = point_half(draw.batch->state);
  sort_into_bins(context, item.points.size(), item, [&](std::uint32_t i, auto&& body) {
    const RasterPoint& p = item.points[i];
    PixelRectangle r;
    find_point_bounds(p, half, rules, r);
    const int left = r.min_x / kBinPx, top = r.min_y / kBinPx;
    if (left == r.max_x / kBinPx && top == r.max_y / kBinPx)
      return body(static_cast<std::size_t>(top * context.bins_x + left));
    RasterTriangle halves[2];
    for (int h = 0; h < 2; ++h) set_up_point(p, half, h == 0, rules, halves[h]);
    for (int y = top; y <= r.max_y / kBinPx; ++y)
      for (int x = left; x <= r.max_x / kBinPx; ++x)
        if (touches_bin(halves[0], x, y) || touches_bin(halves[1], x, y))
          body(static_cast<std::size_t>(y * context.bins_x + x));
  });
}

}  // namespace hwsim::pipeline
