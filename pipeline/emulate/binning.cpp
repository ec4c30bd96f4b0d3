#include "pipeline/emulate/binning.h"

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

}  // namespace

// A counting sort of (bin, triangle) pairs.
void bin_triangles(const PassContext& context, GeometryItem& item) {
  const auto bins = static_cast<std::size_t>(context.bins_x * context.bins_y) * context.viewports.size();
  item.bin_start.assign(bins + 1, 0);
  for (const RasterTriangle& t : item.triangles)
    for_each_bin(context, t, [&](std::size_t b) { item.bin_start[b + 1] += 1; });
  for (std::size_t b = 0; b < bins; ++b) item.bin_start[b + 1] += item.bin_start[b];
  item.binned.resize(item.bin_start[bins]);
  std::vector<std::uint32_t> next(item.bin_start.begin(), item.bin_start.end() - 1);
  for (std::uint32_t i = 0; i < item.triangles.size(); ++i)
    for_each_bin(context, item.triangles[i], [&](std::size_t b) { item.binned[next[b]++] = i; });
}

}  // namespace hwsim::pipeline
