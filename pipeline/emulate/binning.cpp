#include "pipeline/emulate/binning.h"

#include <algorithm>
#include <limits>

#include "pipeline/emulate/primitive_setup.h"
#include "pipeline/raster/triangle_setup.h"

namespace hwsim::pipeline {
namespace {

/// Bins from left to right and top to bottom, both ends included.
struct BinRectangle {
  int left = std::numeric_limits<int>::max(), top = left, right = -1, bottom = -1;

  BinRectangle() = default;
  BinRectangle(int min_x, int min_y, int max_x, int max_y)
      : left(min_x / kBinPx), top(min_y / kBinPx), right(max_x / kBinPx), bottom(max_y / kBinPx) {}
  bool is_one() const { return left == right && top == bottom; }
  void add(const BinRectangle& r) {
    left = std::min(left, r.left);
    top = std::min(top, r.top);
    right = std::max(right, r.right);
    bottom = std::max(bottom, r.bottom);
  }
};

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

/// Which bins an item's triangles touch.
class TriangleBins {
 public:
  TriangleBins(const PassContext& context, const GeometryItem& item)
      : c_(context), conservative_(context.draws[item.draw].batch->state.raster.conservative) {}

  static BinRectangle rectangle(const BinTriangle& t) {
    return {t.place.min_x, t.place.min_y, t.place.max_x, t.place.max_y};
  }
  static int layer(const BinTriangle& t) { return t.layer; }

  template <class Body>
  void each(const BinTriangle& t, const BinRectangle& r, Body&& body) const {
    RasterTriangle edges;
    set_up_depth(t.screen, t.place, c_.viewports[static_cast<std::size_t>(t.layer)], conservative_, edges);
    for (int y = r.top; y <= r.bottom; ++y)
      for (int x = r.left; x <= r.right; ++x)
        if (touches_bin(edges, x, y)) body(x, y);
  }

 private:
  const PassContext& c_;
  const bool conservative_;
};

class PointBins {
 public:
  PointBins(const PassContext& context, const GeometryItem& item)
      : rules_(setup_rules(context, context.draws[item.draw])),
        half_(point_half(context.draws[item.draw].batch->state)) {}

  BinRectangle rectangle(const RasterPoint& p) const {
    PixelRectangle r;
    find_point_bounds(p, half_, rules_, r);
    return {r.min_x, r.min_y, r.max_x, r.max_y};
  }
  static int layer(const RasterPoint& /*p*/) { return 0; }

  template <class Body>
  void each(const RasterPoint& p, const BinRectangle& r, Body&& body) const {
    RasterTriangle halves[2];
    for (int h = 0; h < 2; ++h) set_up_point(p, half_, h == 0, rules_, halves[h]);
    for (int y = r.top; y <= r.bottom; ++y)
      for (int x = r.left; x <= r.right; ++x)
        if (touches_bin(halves[0], x, y) || touches_bin(halves[1], x, y)) body(x, y);
  }

 private:
  const SetupRules rules_;
  const std::int32_t half_;
};

// A counting sort.
template <class Primitive, class Bins>
const Primitive* sort_primitives(const std::vector<Primitive>& primitives, const Bins& bins,
                                 std::size_t layers, GeometryItem& item, Arena& arena) {
  BinRectangle all;
  for (const Primitive& p : primitives) all.add(bins.rectangle(p));
  item.bin_left = all.left;
  item.bin_top = all.top;
  item.bins_x = all.right - all.left + 1;
  item.bins_y = all.bottom - all.top + 1;
  const std::size_t count = layers * static_cast<std::size_t>(item.bins_x * item.bins_y);
  auto* const start = arena.take<std::uint32_t>(count + 2);
  std::fill_n(start, count + 2, 0u);
  const auto each = [&](const Primitive& p, auto&& body) {
    const BinRectangle r = bins.rectangle(p);
    const int layer = bins.layer(p) * item.bins_y;
    const auto at = [&](int x, int y) {
      body(static_cast<std::size_t>((layer + y - all.top) * item.bins_x + x - all.left));
    };
    if (r.is_one()) return at(r.left, r.top);
    bins.each(p, r, at);
  };
  for (const Primitive& p : primitives) each(p, [&](std::size_t bin) { start[bin + 2] += 1; });
  for (std::size_t bin = 2; bin < count + 2; ++bin) start[bin] += start[bin - 1];
  // From here on start[bin + 1] is where the bin's next primitive goes: in the end, where the bin after
  // begins.
  auto* const sorted = arena.take<Primitive>(start[count + 1]);
  for (const Primitive& p : primitives) each(p, [&](std::size_t bin) { sorted[start[bin + 1]++] = p; });
  item.bin_start = start;
  return sorted;
}

std::size_t bin_count(const PassContext& context) {
  return static_cast<std::size_t>(context.bins_x * context.bins_y);
}

}  // namespace

void sort_into_bins(const PassContext& context, GeometryItem& item, Arena& arena) {
  BuiltPrimitives& built = *item.built;
  item.built_triangles = built.triangles.size() + 2 * built.points.size();
  const std::size_t layers = context.viewports.size();
  if (!built.points.empty())
    item.points = sort_primitives(built.points, PointBins(context, item), layers, item, arena);
  else if (!built.triangles.empty())
    item.triangles = sort_primitives(built.triangles, TriangleBins(context, item), layers, item, arena);
  built.triangles.clear();
  built.points.clear();
}

void list_bins(const PassContext& context, Segment& segment) {
  const std::size_t bins = bin_count(context), layers = context.viewports.size();
  for (std::vector<BinRun>& runs : segment.runs) runs.clear();
  segment.runs.resize(bins * layers);
  for (std::size_t i = segment.first_item; i < segment.last_item; ++i) {
    const GeometryItem& item = segment.items[i];
    if (item.bin_start == nullptr) continue;
    const std::uint32_t* start = item.bin_start;
    for (std::size_t layer = 0; layer < layers; ++layer)
      for (int y = 0; y < item.bins_y; ++y)
        for (int x = 0; x < item.bins_x; ++x, ++start)
          if (start[0] != start[1])
            segment
                .runs[layer * bins +
                      static_cast<std::size_t>((item.bin_top + y) * context.bins_x + item.bin_left + x)]
                .push_back({static_cast<std::uint32_t>(i), start[0], start[1]});
  }
  segment.bins.clear();
  for (std::size_t bin = 0; bin < bins; ++bin) {
    bool any = false;
    for (std::size_t layer = 0; layer < layers; ++layer)
      any = any || !segment.runs[layer * bins + bin].empty();
    if (any) segment.bins.push_back(static_cast<std::uint32_t>(bin));
  }
}

void sort_bins_by_work(const PassContext& context, Segment& segment) {
  const std::size_t bins = bin_count(context);
  std::vector<std::uint32_t> work(bins, 0);
  for (std::size_t slot = 0; slot < segment.runs.size(); ++slot)
    for (const BinRun& run : segment.runs[slot]) work[slot % bins] += run.last - run.first;
  std::stable_sort(segment.bins.begin(), segment.bins.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return work[a] > work[b]; });
}

}  // namespace hwsim::pipeline
