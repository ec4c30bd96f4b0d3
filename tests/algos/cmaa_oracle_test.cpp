// CMAA against a scalar reading of its description (docs/techniques/filters.md#cmaa): pixel by pixel over
// whole pictures.
#include <gtest/gtest.h>

#include "algos/picture.h"

namespace hwsim::test {
namespace {

struct PixelEdges {
  bool right = false, top = false, left = false, bottom = false;
  int count() const { return (right ? 1 : 0) + (top ? 1 : 0) + (left ? 1 : 0) + (bottom ? 1 : 0); }
  /// A quarter turn clockwise: what lies above comes to the right.
  PixelEdges turned() const { return {top, left, bottom, right}; }
  /// Upside down.
  PixelEdges flipped() const { return {right, bottom, left, top}; }
};

class CmaaOracle {
 public:
  CmaaOracle(const Picture& picture, bool quirk) : in_(picture), out_(picture), quirk_(quirk) {
    find_strengths();
    prune();
    combine();
    for_each([&](int x, int y) { blend_simple(x, y); });
    for_each([&](int x, int y) {
      const Direction d = direction(x, y);
      if (d != Direction::none) blend_line(x, y, d == Direction::column);
    });
  }
  const Picture& result() const { return out_; }

 private:
  struct Strength {
    int right = 0, bottom = 0;
  };

  template <class Body>
  void for_each(Body&& body) {
    for (int y = 0; y < in_.height; ++y)
      for (int x = 0; x < in_.width; ++x) body(x, y);
  }
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < in_.width && y < in_.height; }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * in_.width + x); }

  int strength_between(int x, int y, int x2, int y2) const {
    const Rgb a = in_.color(x, y), b = in_.color(x2, y2);
    const float luma = 0.2126f * std::fabs(a[0] - b[0]) + 0.7152f * std::fabs(a[1] - b[1]) +
                       0.0722f * std::fabs(a[2] - b[2]);
    return static_cast<int>(std::floor(15.0f * std::clamp(luma - 1.0f / 13.0f, 0.0f, 1.0f) + 0.99f));
  }
  void find_strengths() {
    strength_.resize(in_.codes.size());
    for_each([&](int x, int y) {
      strength_[index(x, y)] = {strength_between(x, y, x + 1, y), strength_between(x, y, x, y + 1)};
    });
  }
  Strength strength(int x, int y) const { return inside(x, y) ? strength_[index(x, y)] : Strength{}; }

  /// Whether a quad has any edge: the mask of the later passes.
  bool quad_has_edge(int x, int y) const {
    bool any = false;
    for (int p = 0; p < 4; ++p) {
      const Strength s = strength((x & ~1) + (p & 1), (y & ~1) + (p >> 1));
      any = any || s.right > 0 || s.bottom > 0;
    }
    return any;
  }

  void prune() {
    kept_.resize(in_.codes.size());
    for_each([&](int x, int y) {
      const auto right = [&](int dx, int dy) { return strength(x + dx, y + dy).right; };
      const auto bottom = [&](int dx, int dy) { return strength(x + dx, y + dy).bottom; };
      const int group[12] = {right(0, 0),  bottom(0, 0),  right(1, 0),   bottom(1, 0),
                             right(0, 1),  bottom(0, 1),  right(-1, 0),  bottom(-1, 0),
                             right(0, -1), bottom(0, -1), bottom(1, -1), right(-1, 1)};
      int most = 0, sum = 0;
      for (int i = 0; i < 12; ++i) {
        most = std::max(most, group[i]);
        sum += !quirk_ || i >= 8 ? group[i] : 0;
      }
      const double limit = 0.65 * sum / 12.0 + 0.35 * most;
      const auto keeps = [&](int s) { return s > 0 && s >= limit - 1e-5; };
      kept_[index(x, y)] = {keeps(right(0, 0)), keeps(bottom(0, 0))};
    });
  }

  void combine() {
    edges_.resize(in_.codes.size());
    const auto kept = [&](int x, int y) {
      return inside(x, y) ? kept_[index(x, y)] : std::pair(false, false);
    };
    for_each([&](int x, int y) {
      edges_[index(x, y)] = {kept(x, y).first, kept(x, y - 1).second, kept(x - 1, y).first,
                             kept(x, y).second};
    });
  }
  PixelEdges edges(int x, int y) const { return inside(x, y) ? edges_[index(x, y)] : PixelEdges{}; }

  /// The mask of the last pass: a pixel of the quad has two edges, and one of them leaves the quad's pixels
  /// to the right or below.
  bool quad_is_blended(int x, int y) const {
    if (!quad_has_edge(x, y)) return false;
    bool any = false;
    for (int p = 0; p < 4; ++p) any = any || edges((x & ~1) + (p & 1), (y & ~1) + (p >> 1)).count() > 1;
    return any;
  }

  void put(int x, int y, const Rgb& c) {
    for (std::size_t k = 0; k < 3; ++k) out_.at(x, y)[k] = static_cast<int>(std::lround(255.0f * c[k]));
  }

  void blend_simple(int x, int y) {
    const PixelEdges e = edges(x, y);
    const int n = e.count();
    if (!quad_is_blended(x, y)) return;
    if (n < 2 || (n == 2 && ((e.right && e.left) || (e.top && e.bottom)))) return;
    const float share = n == 2 ? 0.08f : n == 3 ? 0.11f : 0.05f;
    Rgb sum = in_.color(x, y);
    const auto add = [&](bool edge, int dx, int dy) {
      const Rgb c = in_.color(x + dx, y + dy);
      for (std::size_t k = 0; edge && k < 3; ++k) sum[k] += share * c[k];
    };
    add(e.right, 1, 0);
    add(e.top, 0, -1);
    add(e.left, -1, 0);
    add(e.bottom, 0, 1);
    for (float& c : sum) c /= 1.0f + share * static_cast<float>(n);
    put(x, y, sum);
  }

  /// Edges of a pixel as a horizontal line sees them; `flip`: the other way up.
  PixelEdges seen(int x, int y, bool column, bool flip) const {
    PixelEdges e = edges(x, y);
    if (column) e = e.turned();
    return flip ? e.flipped() : e;
  }

  enum class Direction { none, row, column };
  /// A pixel's line goes one way: along its row, or up its column.
  Direction direction(int x, int y) const {
    const PixelEdges e = edges(x, y), before = edges(x - 1, y), after = edges(x + 1, y),
                     above = edges(x, y - 1);
    if (!quad_is_blended(x, y) || e.count() != 2) return Direction::none;
    const bool row_a = e.right && e.bottom && after.top && !after.right;
    const bool row_b = e.right && e.top && after.bottom && !after.right;
    const bool column_a = e.top && e.right && above.left && !above.top;
    const bool column_b = e.top && e.left && above.right && !above.top;
    const bool row = row_a || row_b, column = column_a || column_b;
    if (row && column)
      return (row_a && before.bottom) || (row_b && before.top) ? Direction::row : Direction::column;
    return row ? Direction::row : column ? Direction::column : Direction::none;
  }

  bool is_z(int x, int y, bool column, bool flip) const {
    const int dx = column ? 0 : 1, dy = column ? -1 : 0;
    const PixelEdges own = seen(x, y, column, flip), next = seen(x + dx, y + dy, column, flip);
    const bool after = seen(x + 2 * dx, y + 2 * dy, column, flip).bottom;
    const bool continued = seen(x - dx, y - dy, column, flip).top;
    return own.right && own.top && !own.left && !own.bottom && next.bottom && !next.right && !next.top &&
           (continued || after);
  }

  void blend_line(int x, int y, bool column) {
    const bool flip = is_z(x, y, column, true);
    if (!flip && !is_z(x, y, column, false)) return;
    const int dx = column ? 0 : 1, dy = column ? -1 : 0;
    int before = 1, after = 1;
    for (int n = 1; n < 64; ++n) {
      const PixelEdges b = seen(x - n * dx, y - n * dy, column, flip);
      const PixelEdges a = seen(x + (n + 1) * dx, y + (n + 1) * dy, column, flip);
      const bool left_on = b.top && !b.right, right_on = a.bottom && !a.left;
      if (left_on) before = n + 1;
      if (right_on) after = n + 1;
      if (!left_on || !right_on) break;
    }
    const float odd_left = 0.15f * static_cast<float>(before % 2),
                odd_right = 0.15f * static_cast<float>(after % 2);
    const int from = 1 - (before + 1) / 2, to = (after + 1) / 2;
    const float total = static_cast<float>(to - from + 1) - odd_left - odd_right;
    for (int i = from; i <= to; ++i) {
      const float m = std::clamp((static_cast<float>(i - from) + 0.5f - odd_left) / total, 0.0f, 1.0f);
      const float k = (m - (i > 0 ? 1.0f : 0.0f)) * (flip ? 1.0f : -1.0f);
      const int px = x + i * dx, py = y + i * dy;
      if (!inside(px, py)) continue;
      put(px, py, shifted(px, py, k, column));
    }
  }

  /// Between the pixel and its neighbor across the line.
  Rgb shifted(int x, int y, float k, bool column) const {
    const int step = k < 0.0f ? -1 : 1;
    const Rgb own = in_.color(x, y), next = column ? in_.color(x + step, y) : in_.color(x, y + step);
    Rgb c;
    for (std::size_t i = 0; i < 3; ++i) c[i] = own[i] + std::fabs(k) * (next[i] - own[i]);
    return c;
  }

  const Picture& in_;
  Picture out_;
  bool quirk_;
  std::vector<Strength> strength_;
  std::vector<std::pair<bool, bool>> kept_;  ///< right, bottom
  std::vector<PixelEdges> edges_;
};

/// The same picture with a border of one color: what lies beyond the image does not matter then.
Picture framed(Picture p) {
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      if (std::min({x, y, p.width - 1 - x, p.height - 1 - y}) < 3) p.at(x, y) = {120, 120, 120};
  return p;
}

TEST(Cmaa, IsTheFilterOfTheText) {
  for (const bool quirk : {true, false}) {
    const std::string technique = quirk ? "cmaa" : "cmaa:cmaa_avg_quirk=off";
    int changed = 0;
    for (const Picture& p : {framed(shapes(192, 96)), framed(shapes(97, 141)), framed(noise(128, 64, 7)),
                             framed(gray(160, 60, [](int x, int y) { return 7 * y > x + 40 ? 230 : 30; })),
                             framed(gray(80, 90, [](int x, int y) { return 5 * x > y + 60 ? 20 : 200; }))}) {
      const CmaaOracle oracle(p, quirk);
      const Picture found = filter(p, technique).picture;
      // Lines that cross may write a pixel in another order.
      EXPECT_LE(count_differences(found, oracle.result(), 1), static_cast<int>(p.codes.size()) / 500)
          << technique << " " << p.width << "x" << p.height;
      changed += count_differences(p, oracle.result());
    }
    EXPECT_GT(changed, 2000);
  }
}

}  // namespace
}  // namespace hwsim::test
