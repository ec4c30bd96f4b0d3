// CMAA's last pass (docs/techniques/filters.md#cmaa).
#include "algos/filters/shaders/cmaa.h"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/filters/shaders/cmaa_blend.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/filters/shaders/cmaa_edges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// Pixels of two edges or more take a little of their neighbors across them; where a pixel begins a Z, the
/// line that the Z's arms make is blended afterwards.
template <class S>
class CmaaBlend {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;
  using Color = lanes::Vec4<F>;
  static constexpr int kLongestLine = 64;

  explicit CmaaBlend(S& s) : s_(s), x0_(s.pixel_x() + s.pixel_x()), y0_(s.pixel_y() + s.pixel_y()) {
    lines_.fill(I(0));
    load_window();
    s_.loop(kPixel, 4, s_.valid(), [&](int p) HWY_ATTR { blend_pixel(p); });
    s_.loop_each(kLine, line_count_, s_.valid(), [&](int k, M left) HWY_ATTR { blend_line(k, left); });
  }

 private:
  enum Block : int { kPixel = 1, kShape, kCorner, kCandidate, kLine, kTrace, kLinePixel };
  /// A line's place and kind in a word: which of the four pixels, and these.
  static constexpr int kHorizontal = 4, kInverted = 8;

  M inside(I x, I y) {
    return (x > I(-1)) & (y > I(-1)) & (x < I(s_.image_width(0))) & (y < I(s_.image_height(0)));
  }
  I edges_at(I x, I y) { return select(inside(x, y), to_int(s_.load_image(0, x, y, I(0)).x), I(0)); }

  void load_window() {
    for (int q = 0; q < 4; ++q) {
      const int i = 2 * (q & 1), j = 2 * (q >> 1);
      const I x = x0_ + I(i - 1), y = y0_ + I(j - 1);
      const std::array<I, 4> four = four_texels(s_, x0_, y0_, i - 1, j - 1);
      for (int p = 0; p < 4; ++p)
        window_[static_cast<std::size_t>(j + (p >> 1))][static_cast<std::size_t>(i + (p & 1))] =
            select(inside(x + I(p & 1), y + I(p >> 1)), four[static_cast<std::size_t>(p)], I(0));
    }
  }
  I edges(int x, int y) const {
    return window_[static_cast<std::size_t>(y + 1)][static_cast<std::size_t>(x + 1)];
  }

  void blend_pixel(int p) {
    const int px = p & 1, py = p >> 1;
    const I e = edges(px, py);
    const auto one = [&](int bit) HWY_ATTR { return select(bit_set<S>(e, bit), F(1.0f), F(0.0f)); };
    const F right = one(kRightEdge), bottom = one(kBottomEdge), left = one(kLeftEdge), top = one(kTopEdge);
    const F count = right + bottom + left + top;
    s_.branch(kShape, count > F(1.5f), [&]() HWY_ATTR {
      const M parallel = (count < F(2.5f)) & ((right * left > F(0.5f)) | (top * bottom > F(0.5f)));
      const F share = select(count < F(2.5f), F(0.08f), select(count < F(3.5f), F(0.11f), F(0.05f)));
      const M blended = (count > F(1.5f)) & !parallel;
      s_.branch(kCorner, blended, [&]() HWY_ATTR {
        const I x = x0_ + I(px), y = y0_ + I(py);
        const auto at = [&](int dx, int dy) HWY_ATTR { return s_.load_image(1, x + I(dx), y + I(dy), I(0)); };
        const Color own = at(0, 0);
        const Color before = at(-1, 0);
        const Color above = at(0, -1);
        const Color after = at(1, 0);
        const Color below = at(0, 1);
        const F weight = share * count, others = weight / (F(1.0f) + weight);
        const Color sum = before * (share * left) + above * (share * top) + after * (share * right) +
                          below * (share * bottom);
        const Color mean = sum * (F(1.0f) / (weight + F(0.0001f)));
        s_.store_image(0, x, y, I(0), own + (mean - own) * others, blended);
        find_line(p, e, blended & (count < F(2.5f)));
      });
    });
  }

  /// Whether the corner begins a Z, to the right or upward: one of both, the one whose other arm goes on.
  void find_line(int p, I own, M corner) {
    const int px = p & 1, py = p >> 1;
    const I before = edges(px - 1, py), above = edges(px, py - 1), after = edges(px + 1, py),
            below = edges(px, py + 1);
    const auto is = [&](int set) HWY_ATTR { return own == I(set); };
    const M row_a = is(kRightEdge | kBottomEdge) & bits_are<S>(after, kRightEdge | kTopEdge, kTopEdge);
    const M row_b = is(kRightEdge | kTopEdge) & bits_are<S>(after, kRightEdge | kBottomEdge, kBottomEdge);
    const M column_a = is(kTopEdge | kRightEdge) & bits_are<S>(above, kTopEdge | kLeftEdge, kLeftEdge);
    const M column_b = is(kTopEdge | kLeftEdge) & bits_are<S>(above, kTopEdge | kRightEdge, kRightEdge);
    const M row = row_a | row_b, column = column_a | column_b;
    const M goes_on = (row_a & bit_set<S>(before, kBottomEdge)) | (row_b & bit_set<S>(before, kTopEdge));
    const M horizontal = row & (goes_on | !column);
    const M candidate = corner & (row | column);
    s_.branch(kCandidate, candidate, [&]() HWY_ATTR {
      const I x = x0_ + I(px) + select(horizontal, I(2), I(0)),
              y = y0_ + I(py) - select(horizontal, I(0), I(2));
      const I farther = edges_at(x, y);
      const I behind = select(horizontal, before, below), next = select(horizontal, after, above);
      // As a row sees them: the edge that steps, the one that faces it, and those on both sides of the line.
      const auto seen = [&](I e, int in_row, int in_column)
                            HWY_ATTR { return (e & select(horizontal, I(in_row), I(in_column))) > I(0); };
      const auto low = [&](I e) HWY_ATTR { return seen(e, kBottomEdge, kRightEdge); };
      const auto high = [&](I e) HWY_ATTR { return seen(e, kTopEdge, kLeftEdge); };
      const M step = seen(own, kRightEdge, kTopEdge) & !seen(own, kLeftEdge, kBottomEdge) &
                     !seen(next, kRightEdge, kTopEdge) & candidate;
      const M inverted =
          step & low(own) & !high(own) & high(next) & !low(next) & (low(behind) | high(farther));
      const M normal = step & high(own) & !low(own) & low(next) & !high(next) & (high(behind) | low(farther));
      const M found = inverted | normal;
      const I line = I(p) | select(horizontal, I(kHorizontal), I(0)) | select(inverted, I(kInverted), I(0));
      for (int k = 0; k < 4; ++k) {
        I& slot = lines_[static_cast<std::size_t>(k)];
        slot = select(found & (line_count_ == I(k)), line, slot);
      }
      line_count_ = line_count_ + select(found, I(1), I(0));
    });
  }

  struct Line {
    I x, y, step_x, step_y;
    M horizontal, inverted, is;
    F before, after;  ///< pixels to both sides of the step
  };

  void blend_line(int k, M left) {
    const I word = lines_[static_cast<std::size_t>(k)];
    Line line;
    line.is = left;
    line.x = x0_ + (word & I(1));
    line.y = y0_ + (shift_right<1>(word) & I(1));
    line.horizontal = bit_set<S>(word, kHorizontal);
    line.inverted = bit_set<S>(word, kInverted);
    line.step_x = select(line.horizontal, I(1), I(0));
    line.step_y = select(line.horizontal, I(0), I(-1));
    trace(line);
    draw(line);
  }

  /// Lengths of both arms, until the first of them ends.
  void trace(Line& line) {
    const auto kind = [&](int row, int row_inverted, int column, int column_inverted) HWY_ATTR {
      return select(line.horizontal, select(line.inverted, I(row_inverted), I(row)),
                    select(line.inverted, I(column_inverted), I(column)));
    };
    const I on_before = kind(kTopEdge, kBottomEdge, kLeftEdge, kRightEdge);
    const I on_after = kind(kBottomEdge, kTopEdge, kRightEdge, kLeftEdge);
    const I mask_before = on_before | select(line.horizontal, I(kRightEdge), I(kTopEdge));
    const I mask_after = on_after | select(line.horizontal, I(kLeftEdge), I(kBottomEdge));
    line.before = F(1.0f);
    line.after = F(1.0f);
    M open = line.is;
    const std::size_t longest = s_.loop_count(kLongestLine - 1);
    for (std::size_t i = 1; i <= longest; ++i) {
      s_.branch(kTrace, open, [&]() HWY_ATTR {
        const I n(static_cast<int>(i)), n_after(static_cast<int>(i) + 1);
        const I e_before = edges_at(line.x - line.step_x * n, line.y - line.step_y * n);
        const I e_after = edges_at(line.x + line.step_x * n_after, line.y + line.step_y * n_after);
        const M goes_before = (e_before & mask_before) == on_before,
                goes_after = (e_after & mask_after) == on_after;
        const F length(static_cast<float>(i + 1));
        line.before = select(open & goes_before, length, line.before);
        line.after = select(open & goes_after, length, line.after);
        open = open & goes_before & goes_after;
      });
    }
  }

  void draw(const Line& line) {
    const F half(0.5f);
    const auto odd = [&](F length) HWY_ATTR { return F(0.3f) * (length * half - floor(length * half)); };
    const F odd_before = odd(line.before), odd_after = odd(line.after);
    const F from = F(1.0f) - floor((line.before + F(1.0f)) * half), to = floor((line.after + F(1.0f)) * half);
    const F scale = F(1.0f) / (to - from + F(1.0f) - odd_before - odd_after);
    const std::size_t count = s_.loop_count(kLongestLine + 2);
    for (std::size_t k = 0; k < count; ++k) {
      const F i = from + F(static_cast<float>(k));
      const M drawn = line.is & (i <= to);
      s_.branch(kLinePixel, drawn, [&]() HWY_ATTR {
        const F along = min(max((i + half - odd_before - from) * scale, F(0.0f)), F(1.0f));
        const F blend = select(i > F(0.0f), along - F(1.0f), along);
        const F across = select(line.inverted, blend, -blend);
        const I n = to_int(i);
        const I x = line.x + line.step_x * n, y = line.y + line.step_y * n;
        const F u = center_of<F>(x) + select(line.horizontal, F(0.0f), across);
        const F v = center_of<F>(y) + select(line.horizontal, across, F(0.0f));
        s_.store_image(1, x, y, I(0), s_.sample_image(1, u, v), drawn);
      });
    }
  }

  S& s_;
  I x0_, y0_;
  std::array<std::array<I, 4>, 4> window_{};  ///< edges of the pixels from (-1, -1) on
  std::array<I, 4> lines_{};
  I line_count_ = I(0);
};

struct CmaaBlendShader {
  using Uniforms = CmaaUniforms;
  template <class S>
  static void run(S& s, const CmaaUniforms&) {
    const CmaaBlend<S> blend(s);
  }
};

void run_cmaa_blend(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<CmaaBlendShader>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_cmaa_blend);

const pipeline::FragmentProgram& cmaa_blend_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::CmaaBlendShader>(
          "cmaa_blend", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_cmaa_blend)(b, u);
          });
  return program;
}

}  // namespace hwsim::algos
#endif
