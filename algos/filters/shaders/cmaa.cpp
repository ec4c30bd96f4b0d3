#include "algos/filters/shaders/cmaa.h"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/filters/shaders/cmaa.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/filters/shaders/cmaa_edges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

struct CmaaEdgeShader {
  using Uniforms = CmaaUniforms;
  template <class S>
  static void run(S& s, const CmaaUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    using M = typename S::M;
    using Color = lanes::Vec4<F>;
    const I x = s.pixel_x() + s.pixel_x(), y = s.pixel_y() + s.pixel_y();
    std::array<std::array<Color, 3>, 3> c{};   // eight of nine: the last corner belongs to no edge here
    std::array<std::array<F, 3>, 3> strong{};  // sum of a pixel's edges: whether later passes blend it
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i) {
        strong[j][i] = F(0.0f);
        if (i + j < 4)
          c[j][i] = s.load_image(0, x + I(static_cast<int>(i)), y + I(static_cast<int>(j)), I(0));
      }
    const auto over = [&](const Color& a, const Color& b) HWY_ATTR {
      const Color d = {abs(a.x - b.x), abs(a.y - b.y), abs(a.z - b.z), F(0.0f)};
      return min(max(luma_709(d) - F(u.threshold), F(0.0f)), F(1.0f));
    };
    const auto digit = [&](F strength) HWY_ATTR { return floor(F(15.0f) * strength + F(0.99f)); };
    std::array<F, 4> packed{};
    M any_edge = F(1.0f) < F(0.0f);
    for (std::size_t p = 0; p < 4; ++p) {
      const std::size_t i = p & 1, j = p >> 1;
      const F right = over(c[j][i], c[j][i + 1]), below = over(c[j][i], c[j + 1][i]);
      packed[p] = digit(right) + F(16.0f) * digit(below);
      any_edge = any_edge | (packed[p] > F(0.0f));
      strong[j][i] = strong[j][i] + right + below;
      strong[j][i + 1] = strong[j][i + 1] + right;
      strong[j + 1][i] = strong[j + 1][i] + below;
    }
    s.output(0, {packed[0], packed[1], packed[2], packed[3]});
    s.output_depth(select(any_edge, F(1.0f), F(0.0f)));
    const I last_x(s.image_width(0) - 1), last_y(s.image_height(0) - 1);
    s.branch(kAnyEdge, any_edge, [&]() HWY_ATTR {
      for (int k = 0; k < 8; ++k) {
        const auto i = static_cast<std::size_t>(k % 3), j = static_cast<std::size_t>(k / 3);
        const M kept = any_edge & (strong[j][i] > F(0.0f));
        s.branch(kFirstCopy + k, kept, [&]() HWY_ATTR {
          const I px = x + I(k % 3), py = y + I(k / 3);
          s.store_image(0, px, py, I(0), c[j][i], kept & !(px > last_x) & !(py > last_y));
        });
      }
    });
  }

 private:
  enum Block : int { kAnyEdge = 1, kFirstCopy = 2 };
};

/// Keeps those of four pixels' edges to the right and below that are strong beside their neighbors. Quads
/// around are loaded where a pixel with an edge asks for them.
template <class S>
class CmaaPrune {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;

  CmaaPrune(S& s, const CmaaUniforms& u) : s_(s), u_(u) {
    load(0, 0);
    const M a = has_edge(0, 0), b = has_edge(1, 0), c = has_edge(0, 1), d = has_edge(1, 1);
    s_.branch(kAbove, a | b, [&]() HWY_ATTR { load(0, -1); });
    s_.branch(kBefore, a | c, [&]() HWY_ATTR { load(-1, 0); });
    s_.branch(kFirst, a, [&]() HWY_ATTR { prune<kStoreFirst>(0, a); });
    s_.branch(kAfter, b | d, [&]() HWY_ATTR { load(1, 0); });
    s_.branch(kSecond, b, [&]() HWY_ATTR {
      load(1, -1);
      prune<kStoreSecond>(1, b);
    });
    s_.branch(kBelow, c | d, [&]() HWY_ATTR { load(0, 1); });
    s_.branch(kThird, c, [&]() HWY_ATTR {
      load(-1, 1);
      prune<kStoreThird>(2, c);
    });
    s_.branch(kFourth, d, [&]() HWY_ATTR { prune<kStoreFourth>(3, d); });
  }

 private:
  enum Block : int {
    kAbove = 1,
    kBefore,
    kFirst,
    kStoreFirst,
    kAfter,
    kSecond,
    kStoreSecond,
    kBelow,
    kThird,
    kStoreThird,
    kFourth,
    kStoreFourth
  };

  void load(int i, int j) {
    quads_[static_cast<std::size_t>(j + 1)][static_cast<std::size_t>(i + 1)] =
        s_.load_image(0, s_.pixel_x() + I(i), s_.pixel_y() + I(j), I(0));
  }
  /// Both strengths of a pixel, counted from the invocation's first.
  I packed(int x, int y) const {
    const auto& q = quads_[static_cast<std::size_t>((y + 2) >> 1)][static_cast<std::size_t>((x + 2) >> 1)];
    const int p = (x & 1) | (y & 1) << 1;
    return to_int(p == 0 ? q.x : p == 1 ? q.y : p == 2 ? q.z : q.w);
  }
  M has_edge(int x, int y) const { return packed(x, y) > I(0); }
  F right(int x, int y) const { return to_float(packed(x, y) & I(15)); }
  F bottom(int x, int y) const { return to_float(shift_right<4>(packed(x, y))); }

  template <int kStoreBlock>
  void prune(int p, M mask) {
    const int x = p & 1, y = p >> 1;
    const std::array<F, 12> e = {right(x, y),      bottom(x, y),         right(x + 1, y),
                                 bottom(x + 1, y), right(x, y + 1),      bottom(x, y + 1),
                                 right(x - 1, y),  bottom(x - 1, y),     right(x, y - 1),
                                 bottom(x, y - 1), bottom(x + 1, y - 1), right(x - 1, y + 1)};
    F highest = e[0], sum(0.0f);
    for (std::size_t k = 1; k < 12; ++k) highest = max(highest, e[k]);
    for (std::size_t k = u_.average_quirk ? 8 : 0; k < 12; ++k) sum = sum + e[k];
    const F limit = F(0.65f / 12.0f) * sum + F(0.35f) * highest;
    const F kept = select(e[0] >= limit, F(static_cast<float>(kRightEdge)), F(0.0f)) +
                   select(e[1] >= limit, F(static_cast<float>(kBottomEdge)), F(0.0f));
    const M any_kept = mask & (kept > F(0.0f));
    s_.branch(kStoreBlock, any_kept, [&]() HWY_ATTR {
      store_quad_pixel(s_, p, kept + F(static_cast<float>(kFreshEdges)), any_kept);
    });
  }

  S& s_;
  const CmaaUniforms& u_;
  std::array<std::array<lanes::Vec4<F>, 3>, 3> quads_{};  ///< from (-1, -1) on
};

struct CmaaPruneShader {
  using Uniforms = CmaaUniforms;
  template <class S>
  static void run(S& s, const CmaaUniforms& u) {
    const CmaaPrune<S> prune(s, u);
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
    const std::array<I, 4> above = four_texels(s, x, y, 0, -1);
    const std::array<I, 4> before = four_texels(s, x, y, -1, 0);
    const I last = to_int(s.load_image(0, x + I(1), y + I(1), I(0)).x);
    const M has_above = y > I(0), has_before = x > I(0);
    const auto fresh = [](I bits) HWY_ATTR { return max(bits - I(kFreshEdges), I(0)); };
    const std::array<I, 4> own = {fresh(above[2]), fresh(above[3]), fresh(before[3]), fresh(last)};
    const std::array<I, 4> left = {select(has_before, fresh(before[0]), I(0)), own[0],
                                   select(has_before, fresh(before[2]), I(0)), own[2]};
    const std::array<I, 4> up = {select(has_above, fresh(above[0]), I(0)),
                                 select(has_above, fresh(above[1]), I(0)), own[0], own[1]};
    M several = F(1.0f) < F(0.0f);
    for (std::size_t p = 0; p < 4; ++p) {
      const I bits = own[p] | shift_left<2>(left[p] & I(kRightEdge)) | shift_left<2>(up[p] & I(kBottomEdge));
      store_quad_pixel(s, static_cast<int>(p), to_float(bits), s.valid());
      several = several | ((bits & (bits - I(1))) > I(0));
    }
    s.output_depth(select(several, F(1.0f), F(0.0f)));
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

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_cmaa_edge);
HWY_EXPORT(run_cmaa_prune);
HWY_EXPORT(run_cmaa_combine);

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
}  // namespace hwsim::algos
#endif
