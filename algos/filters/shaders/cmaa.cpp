#include "algos/filters/shaders/cmaa.h"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/filters/shaders/cmaa.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/filters/shaders/edges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// Edges of a pixel in its combined mask.
enum CmaaEdge : int { kRightEdge = 1, kTopEdge = 2, kLeftEdge = 4, kBottomEdge = 8 };

template <class S>
typename S::M bit_set(typename S::I bits, int mask) {
  return (bits & typename S::I(mask)) > typename S::I(0);
}
template <class S>
typename S::M bit_clear(typename S::I bits, int mask) {
  return (bits & typename S::I(mask)) == typename S::I(0);
}

struct CmaaEdgeShader {
  using Uniforms = CmaaUniforms;
  template <class S>
  static void run(S& s, const CmaaUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    using M = typename S::M;
    using Color = lanes::Vec4<F>;
    const I x = s.pixel_x() + s.pixel_x(), y = s.pixel_y() + s.pixel_y();
    std::array<std::array<Color, 3>, 3>
        c{};  // eight of nine: the last corner belongs to no edge of the four pixels
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i)
        if (i + j < 4)
          c[j][i] = s.load_image(0, x + I(static_cast<int>(i)), y + I(static_cast<int>(j)), I(0));
    const auto strength = [&](const Color& a, const Color& b) HWY_ATTR {
      const Color d = {abs(a.x - b.x), abs(a.y - b.y), abs(a.z - b.z), F(0.0f)};
      const F over = min(max(luma_709(d) - F(u.threshold), F(0.0f)), F(1.0f));
      return floor(F(15.0f) * over + F(0.99f));
    };
    std::array<F, 4> packed{};
    M any_edge = F(1.0f) < F(0.0f), edge_right = any_edge, edge_below = any_edge;
    for (std::size_t p = 0; p < 4; ++p) {
      const std::size_t i = p & 1, j = p >> 1;
      const F right = strength(c[j][i], c[j][i + 1]), below = strength(c[j][i], c[j + 1][i]);
      packed[p] = right + F(16.0f) * below;
      any_edge = any_edge | (packed[p] > F(0.0f));
      if (i == 1) edge_right = edge_right | (right > F(0.0f));
      if (j == 1) edge_below = edge_below | (below > F(0.0f));
    }
    s.output(0, {packed[0], packed[1], packed[2], packed[3]});
    s.output_depth(select(any_edge, F(1.0f), F(0.0f)));
    // What later passes blend: these pixels, and those across edges that leave them.
    const I last_x(s.image_width(0) - 1), last_y(s.image_height(0) - 1);
    s.branch(1, any_edge, [&]() HWY_ATTR {
      for (int p = 0; p < 4; ++p) {
        const I px = x + I(p & 1), py = y + I(p >> 1);
        s.store_image(0, px, py, I(0), c[static_cast<std::size_t>(p >> 1)][static_cast<std::size_t>(p & 1)],
                      any_edge & !(px > last_x) & !(py > last_y));
      }
    });
    s.branch(2, edge_right, [&]() HWY_ATTR {
      for (int j = 0; j < 2; ++j)
        s.store_image(0, x + I(2), y + I(j), I(0), c[static_cast<std::size_t>(j)][2],
                      edge_right & !(x + I(2) > last_x) & !(y + I(j) > last_y));
    });
    s.branch(3, edge_below, [&]() HWY_ATTR {
      for (int i = 0; i < 2; ++i)
        s.store_image(0, x + I(i), y + I(2), I(0), c[2][static_cast<std::size_t>(i)],
                      edge_below & !(x + I(i) > last_x) & !(y + I(2) > last_y));
    });
  }
};

struct CmaaPruneShader {
  using Uniforms = CmaaUniforms;
  /// Right and bottom strengths of the pixels of 3x3 quads, from (-2, -2) on.
  template <class S>
  struct Window {
    std::array<std::array<lanes::Vec4<typename S::F>, 3>, 3> quads{};
    typename S::I packed(int x, int y) const {
      const auto& q = quads[static_cast<std::size_t>((y + 2) >> 1)][static_cast<std::size_t>((x + 2) >> 1)];
      const int p = (x & 1) | (y & 1) << 1;
      return to_int(p == 0 ? q.x : p == 1 ? q.y : p == 2 ? q.z : q.w);
    }
    typename S::F right(int x, int y) const { return to_float(packed(x, y) & typename S::I(15)); }
    typename S::F bottom(int x, int y) const { return to_float(shift_right<4>(packed(x, y))); }
  };

  template <class S>
  static void run(S& s, const CmaaUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    Window<S> w;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        w.quads[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] =
            s.load_image(0, s.pixel_x() + I(i - 1), s.pixel_y() + I(j - 1), I(0));
    s.loop(1, 4, s.valid(), [&](int p) HWY_ATTR {
      const int x = p & 1, y = p >> 1;
      const F own_right = w.right(x, y), own_bottom = w.bottom(x, y);
      const std::array<F, 12> e = {
          own_right,         own_bottom,         w.right(x + 1, y),      w.bottom(x + 1, y),
          w.right(x, y + 1), w.bottom(x, y + 1), w.right(x - 1, y),      w.bottom(x - 1, y),
          w.right(x, y - 1), w.bottom(x, y - 1), w.bottom(x + 1, y - 1), w.right(x - 1, y + 1)};
      F highest = e[0], last_four(0.0f), all(0.0f);
      for (std::size_t k = 1; k < 12; ++k) highest = max(highest, e[k]);
      for (std::size_t k = 8; k < 12; ++k) last_four = last_four + e[k];
      if (!u.average_quirk)
        for (std::size_t k = 0; k < 8; ++k) all = all + e[k];
      const F limit = max(F(0.65f / 12.0f) * (last_four + all) + F(0.35f) * highest, F(0.5f));
      const F right = select(own_right >= limit, F(1.0f), F(0.0f));
      const F bottom = select(own_bottom >= limit, F(2.0f), F(0.0f));
      store(s, p, F(128.0f) + right + bottom);
    });
  }

  /// To pixel p of the four.
  template <class S>
  static void store(S& s, int p, typename S::F value) {
    using F = typename S::F;
    using I = typename S::I;
    const I x = s.pixel_x() + s.pixel_x() + I(p & 1), y = s.pixel_y() + s.pixel_y() + I(p >> 1);
    s.store_image(0, x, y, I(0), {value, F(0.0f), F(0.0f), F(0.0f)},
                  (x < I(s.target_width(0))) & (y < I(s.target_height(0))));
  }
};

struct CmaaCombineShader {
  using Uniforms = CmaaUniforms;
  template <class S>
  static void run(S& s, const CmaaUniforms&) {
    using F = typename S::F;
    using I = typename S::I;
    using M = typename S::M;
    const I x = s.pixel_x() + s.pixel_x(), y = s.pixel_y() + s.pixel_y();
    std::array<std::array<I, 3>, 3> bits{};  // from (-1, -1) on; the corner is of no use
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i) {
        if (i + j == 0) continue;
        const I px = x + I(static_cast<int>(i) - 1), py = y + I(static_cast<int>(j) - 1);
        const M inside = (px > I(-1)) & (py > I(-1));
        bits[j][i] = select(inside, to_int(s.load_image(0, px, py, I(0)).x), I(0));
      }
    M several = F(1.0f) < F(0.0f);
    for (int p = 0; p < 4; ++p) {
      const auto i = static_cast<std::size_t>(p & 1), j = static_cast<std::size_t>(p >> 1);
      const M right = bit_set<S>(bits[j + 1][i + 1], 1), bottom = bit_set<S>(bits[j + 1][i + 1], 2);
      const M left = bit_set<S>(bits[j + 1][i], 1), top = bit_set<S>(bits[j][i + 1], 2);
      const auto value = [&](M set, int bit)
                             HWY_ATTR { return select(set, F(static_cast<float>(bit)), F(0.0f)); };
      CmaaPruneShader::store(s, p,
                             value(right, kRightEdge) + value(top, kTopEdge) + value(left, kLeftEdge) +
                                 value(bottom, kBottomEdge));
      several = several | ((right | left) & (top | bottom)) | (right & left) | (top & bottom);
    }
    s.output_depth(select(several, F(1.0f), F(0.0f)));
  }
};

/// A Z of edges around a step, as seen along it: which edges of a pixel the line follows before the step
/// (`first`) and after it (`second`), which edge is the step (`step`) and which one faces it (`facing`).
struct ZShape {
  int step, facing, first, second;
};
inline constexpr ZShape kShapes[4] = {{kRightEdge, kLeftEdge, kTopEdge, kBottomEdge},
                                      {kRightEdge, kLeftEdge, kBottomEdge, kTopEdge},
                                      {kBottomEdge, kTopEdge, kLeftEdge, kRightEdge},
                                      {kBottomEdge, kTopEdge, kRightEdge, kLeftEdge}};

template <class S>
class CmaaBlend {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;
  using Color = lanes::Vec4<F>;
  enum Block : int { kPixel = 1, kSimple, kRow, kRowTrace, kRowPixel, kColumn, kColumnTrace, kColumnPixel };
  static constexpr int kLongestLine = 64;

  explicit CmaaBlend(S& s) : s_(s), x0_(s.pixel_x() + s.pixel_x()), y0_(s.pixel_y() + s.pixel_y()) {
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i)
        window_[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] =
            edges_at(x0_ + I(i - 1), y0_ + I(j - 1));
    s_.loop(kPixel, 4, s_.valid(), [&](int p) HWY_ATTR {
      blend_simple(p & 1, p >> 1);
      blend_line<kRow>(p & 1, p >> 1);
      blend_line<kColumn>(p & 1, p >> 1);
    });
  }

 private:
  I edges_at(I x, I y) {
    const M inside = (x > I(-1)) & (y > I(-1)) & (x < I(s_.image_width(0))) & (y < I(s_.image_height(0)));
    return select(inside, to_int(s_.load_image(0, x, y, I(0)).x), I(0));
  }
  I edges(int x, int y) const {
    return window_[static_cast<std::size_t>(y + 1)][static_cast<std::size_t>(x + 1)];
  }

  /// Corners and ends: the pixel takes a little of each neighbor across an edge.
  void blend_simple(int px, int py) {
    const I e = edges(px, py);
    const auto one = [&](int bit) HWY_ATTR { return select(bit_set<S>(e, bit), F(1.0f), F(0.0f)); };
    const F right = one(kRightEdge), top = one(kTopEdge), left = one(kLeftEdge), bottom = one(kBottomEdge);
    const F count = right + top + left + bottom;
    const M parallel = (count < F(2.5f)) & ((right + left > F(1.5f)) | (top + bottom > F(1.5f)));
    const M blended = (count > F(1.5f)) & !parallel;
    s_.branch(kSimple, blended, [&]() HWY_ATTR {
      const F share = select(count < F(2.5f), F(0.15f), select(count < F(3.5f), F(0.13f), F(0.07f)));
      const I x = x0_ + I(px), y = y0_ + I(py);
      const auto at = [&](int dx, int dy) HWY_ATTR { return s_.load_image(1, x + I(dx), y + I(dy), I(0)); };
      const Color below = at(0, 1), before = at(-1, 0), above = at(0, -1), after = at(1, 0), own = at(0, 0);
      const Color sum = own + after * (share * right) + above * (share * top) + before * (share * left) +
                        below * (share * bottom);
      s_.store_image(0, x, y, I(0), sum * (F(1.0f) / (F(1.0f) + share * count)), blended);
    });
  }

  struct Candidate {
    M is;         ///< a Z of this shape
    M continued;  ///< whose first side goes on before the pixel
  };
  Candidate find(const ZShape& z, int px, int py, int dx, int dy) {
    const I own = edges(px, py), next = edges(px + dx, py + dy);
    const M corner =
        bit_set<S>(own, z.step) & bit_set<S>(own, z.first) & bit_clear<S>(own, z.facing | z.second);
    const M goes_on = bit_set<S>(next, z.second) & bit_clear<S>(next, z.step | z.first);
    const M before = bit_set<S>(edges(px - dx, py - dy), z.first);
    // The pixel after the next lies outside of the window for the second pixels of a quad.
    const bool within = px + 2 * dx <= 2 && py + 2 * dy <= 2;
    const I after_next =
        within ? edges(px + 2 * dx, py + 2 * dy) : edges_at(x0_ + I(px + 2 * dx), y0_ + I(py + 2 * dy));
    const M after = bit_set<S>(after_next, z.second);
    return {corner & goes_on & (before | after), before};
  }

  template <int kBlock>
  void blend_line(int px, int py) {
    constexpr int dx = kBlock == kRow ? 1 : 0, dy = 1 - dx;
    const ZShape& normal = kShapes[kBlock == kRow ? 0 : 2];
    const ZShape& inverted = kShapes[kBlock == kRow ? 1 : 3];
    const Candidate a = find(normal, px, py, dx, dy), b = find(inverted, px, py, dx, dy);
    const M flipped = b.is & !(a.is & (a.continued | !b.continued));
    const M line = a.is | b.is;
    s_.branch(kBlock, line, [&]() HWY_ATTR {
      const I x = x0_ + I(px), y = y0_ + I(py);
      const I first = select(flipped, I(inverted.first), I(normal.first));
      const I second = select(flipped, I(inverted.second), I(normal.second));
      F before(1.0f), after(1.0f);
      trace<kBlock == kRow ? kRowTrace : kColumnTrace>(line, x, y, first | I(normal.step), first,
                                                       second | I(normal.facing), second, before, after);
      draw<kBlock == kRow ? kRowPixel : kColumnPixel>(line, x, y, before, after, flipped);
    });
  }

  /// Lengths of both sides, until the first of them ends.
  template <int kBlock>
  void trace(M line, I x, I y, I mask_before, I on_before, I mask_after, I on_after, F& before, F& after) {
    constexpr int dx = kBlock == kRowTrace ? 1 : 0, dy = 1 - dx;
    M open = line;
    const std::size_t longest = s_.loop_count(kLongestLine - 1);
    for (std::size_t i = 1; i <= longest; ++i) {
      s_.branch(kBlock, open, [&]() HWY_ATTR {
        const int n = static_cast<int>(i);
        const I e_before = edges_at(x - I(dx * n), y - I(dy * n));
        const I e_after = edges_at(x + I(dx * (n + 1)), y + I(dy * (n + 1)));
        const M goes_before = (e_before & mask_before) == on_before,
                goes_after = (e_after & mask_after) == on_after;
        const F length(static_cast<float>(n + 1));
        before = select(open & goes_before, length, before);
        after = select(open & goes_after, length, after);
        open = open & goes_before & goes_after;
      });
    }
  }

  template <int kBlock>
  void draw(M line, I x, I y, F before, F after, M flipped) {
    constexpr int dx = kBlock == kRowPixel ? 1 : 0, dy = 1 - dx;
    const F half(0.5f);
    const auto odd = [&](F length) HWY_ATTR { return F(0.3f) * (length * half - floor(length * half)); };
    const F odd_before = odd(before), odd_after = odd(after);
    const F from = F(1.0f) - floor((before + F(1.0f)) * half), to = floor((after + F(1.0f)) * half);
    const F scale = F(1.0f) / (to - from + F(1.0f) - odd_before - odd_after);
    const std::size_t count = s_.loop_count(kLongestLine + 2);
    for (std::size_t k = 0; k < count; ++k) {
      const F i = from + F(static_cast<float>(k));
      const M drawn = line & (i <= to);
      s_.branch(kBlock, drawn, [&]() HWY_ATTR {
        const F along = min(max((i + half - odd_before - from) * scale, F(0.0f)), F(1.0f));
        const F blend = select(i > F(0.0f), along - F(1.0f), along);
        const F across = select(flipped, blend, -blend);
        const I at_x = x + (dx == 1 ? to_int(i) : I(0)), at_y = y + (dy == 1 ? to_int(i) : I(0));
        const F u = center_of<F>(at_x) + (dx == 1 ? F(0.0f) : across);
        const F v = center_of<F>(at_y) + (dx == 1 ? across : F(0.0f));
        s_.store_image(1, at_x, at_y, I(0), s_.sample_image(1, u, v), drawn);
      });
    }
  }

  S& s_;
  I x0_, y0_;
  std::array<std::array<I, 4>, 4> window_{};  ///< edges of the pixels from (-1, -1) on
};

struct CmaaBlendShader {
  using Uniforms = CmaaUniforms;
  template <class S>
  static void run(S& s, const CmaaUniforms&) {
    const CmaaBlend<S> blend(s);
  }
};

void run_cmaa_edge(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<CmaaEdgeShader>(b, u);
}
void run_cmaa_prune(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<CmaaPruneShader>(b, u);
}
void run_cmaa_combine(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<CmaaCombineShader>(b, u);
}
void run_cmaa_blend(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<CmaaBlendShader>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_cmaa_edge);
HWY_EXPORT(run_cmaa_prune);
HWY_EXPORT(run_cmaa_combine);
HWY_EXPORT(run_cmaa_blend);

const pipeline::FragmentProgram& cmaa_edge_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::CmaaEdgeShader>(
          "cmaa_edges", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_cmaa_edge)(b, u);
          });
  return program;
}
const pipeline::FragmentProgram& cmaa_prune_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::CmaaPruneShader>(
          "cmaa_prune", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_cmaa_prune)(b, u);
          });
  return program;
}
const pipeline::FragmentProgram& cmaa_combine_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::CmaaCombineShader>(
          "cmaa_combine", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_cmaa_combine)(b, u);
          });
  return program;
}
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
