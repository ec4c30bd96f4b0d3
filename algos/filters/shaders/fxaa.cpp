#include "algos/filters/shaders/fxaa.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/filters/shaders/fxaa.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/filters/shaders/edges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

enum FxaaBlock : int {
  kFilteredRule = 1,
  kEdge,
  kThinRule,
  kStepRule,
  kStep,
  kStepBack,
  kStepOn,
  kLastStepRule,
};

/// One pixel's filter. Names follow docs/techniques/filters.md#fxaa: m is the pixel, n, s, w, e its
/// neighbors.
/// kGather: FXAA's own Direct3D 11 path, FXAA_GATHER4_ALPHA: seven of the nine lumas by two requests.
template <class S, bool kGather, bool kDiscard>
class Fxaa {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;
  using Color = lanes::Vec4<F>;

  Fxaa(S& s, const FxaaUniforms& u) : s_(s), u_(u), x_(s.pixel_x()), y_(s.pixel_y()) {
    Color center;
    if constexpr (kGather) {
      const lanes::TexelQuad<F> below = lumas_at(0, 0), above = lumas_at(-1, -1);
      m_ = below.t00;
      e_ = below.t10;
      s_luma_ = below.t01;
      se_ = below.t11;
      nw_ = above.t00;
      n_ = above.t10;
      w_ = above.t01;
      center = {m_, m_, m_, m_};  // a discarded pixel needs no color
      if constexpr (!kDiscard) center = s_.load_image(0, x_, y_, I(0));
    } else {
      center = s_.load_image(0, x_, y_, I(0));
      m_ = luma(center);
      n_ = luma_at(0, -1);
      s_luma_ = luma_at(0, 1);
      w_ = luma_at(-1, 0);
      e_ = luma_at(1, 0);
    }
    color = center;
    max_ = max(max(max(n_, s_luma_), max(w_, e_)), m_);
    min_ = min(min(min(n_, s_luma_), min(w_, e_)), m_);
    range_ = max_ - min_;
    edge = (range_ > F(0.0f)) & (range_ >= max(F(u_.edge_threshold_min), max_ * F(u_.edge_threshold)));
    s_.uniform_branch(kFilteredRule, u_.skip_filtered, [&]() HWY_ATTR { edge = edge & !is_filtered(); });
    s_.branch(kEdge, edge & s_.valid(), [&]() HWY_ATTR { color = select_color(edge, filtered(), center); });
  }

  M edge;
  Color color;

 private:
  F luma(const Color& c) const { return u_.green_as_luma ? c.y : c.w; }
  F luma_at(int dx, int dy) { return luma(s_.load_image(0, x_ + I(dx), y_ + I(dy), I(0))); }
  lanes::TexelQuad<F> lumas_at(int dx, int dy) {
    return s_.gather_image(0, u_.green_as_luma ? 1 : 3, x_, y_, dx, dy);
  }

  /// AXAA rule 1.
  M is_filtered() const {
    const F mid = (max_ + min_) * F(0.5f);
    const F alpha(u_.alpha);
    const F reach = u_.alpha_mode == AlphaMode::range ? alpha * range_
                    : u_.alpha_mode == AlphaMode::mid ? alpha * mid
                                                      : alpha;
    const auto near = [&](F l) HWY_ATTR { return abs(l - mid) <= reach; };
    return near(m_) | near(n_) | near(s_luma_) | near(w_) | near(e_);
  }

  Color filtered() {
    if constexpr (!kGather) nw_ = luma_at(-1, -1);
    const F nw = nw_, ne = luma_at(1, -1), sw = luma_at(-1, 1);
    if constexpr (!kGather) se_ = luma_at(1, 1);
    const F se = se_;
    const F two(2.0f);
    const F across_rows =
        abs(nw + sw - two * w_) + two * abs(n_ + s_luma_ - two * m_) + abs(ne + se - two * e_);
    const F across_columns =
        abs(nw + ne - two * n_) + two * abs(w_ + e_ - two * m_) + abs(sw + se - two * s_luma_);
    horizontal_ = across_rows >= across_columns;
    const F a = select(horizontal_, n_, w_), b = select(horizontal_, s_luma_, e_);
    const F gradient_a = a - m_, gradient_b = b - m_;
    const M pair_a = abs(gradient_a) >= abs(gradient_b);
    sign_ = select(pair_a, F(-1.0f), F(1.0f));
    average_ = (select(pair_a, a, b) + m_) * F(0.5f);
    gradient_ = max(abs(gradient_a), abs(gradient_b)) * F(0.25f);
    F offset = max(edge_offset(), subpixel_offset(nw + ne + sw + se));
    s_.uniform_branch(kThinRule, u_.keep_thin_lines, [&]() HWY_ATTR {
      const F thin(0.3f);
      M line = (abs(gradient_a) > thin) & (abs(gradient_b) > thin);
      if (u_.same_sign) line = line & (gradient_a * gradient_b > F(0.0f));
      offset = select(line, F(0.0f), offset);
    });
    const F across = sign_ * offset;
    return s_.sample_image(0, center_of<F>(x_) + select(horizontal_, F(0.0f), across),
                           center_of<F>(y_) + select(horizontal_, across, F(0.0f)));
  }

  F subpixel_offset(F corners) const {
    const F mean = (F(2.0f) * (n_ + s_luma_ + w_ + e_) + corners) * F(1.0f / 12.0f);
    const F sub = min(max(abs(mean - m_) / range_, F(0.0f)), F(1.0f));
    const F smooth = (F(3.0f) - F(2.0f) * sub) * (sub * sub);
    return smooth * smooth * F(u_.subpix);
  }

  /// Luma beside the edge, `along` pixels from the pixel, against the edge's mean.
  F end_at(F along) {
    const F half = sign_ * F(0.5f);
    const F x = center_of<F>(x_) + select(horizontal_, along, half);
    const F y = center_of<F>(y_) + select(horizontal_, half, along);
    return luma(s_.sample_image(0, x, y)) - average_;
  }

  /// AXAA rule 3: rounds in which both ends are sampled.
  F search_rounds() const {
    F rounds(static_cast<float>(u_.steps - 1));
    s_.uniform_branch(kStepRule, u_.adaptive_steps, [&]() HWY_ATTR {
      const F below = m_ - min_, above = max_ - m_;
      const F contrast = u_.metric_min ? min(below, above) : max(below, above);
      const F some = select(contrast <= F(0.1f), F(1.0f), min(F(2.0f), rounds));
      rounds = select(contrast <= F(0.3f), some, rounds);
    });
    return rounds;
  }

  F edge_offset() {
    const F first(u_.step_px[0]);
    F back = first, on = first;  // distances to the ends
    F end_back = end_at(-back), end_on = end_at(on);
    M done_back = abs(end_back) >= gradient_, done_on = abs(end_on) >= gradient_;
    M open = !(done_back & done_on);
    const F rounds = search_rounds();
    const std::size_t count = s_.loop_count(u_.steps - 1);
    for (std::size_t i = 1; i <= count; ++i) {
      s_.branch(kStep, open, [&]() HWY_ATTR {
        const F step(static_cast<float>(i));
        M last = step >= F(static_cast<float>(u_.steps - 1));
        F move(u_.step_px[i]);
        s_.uniform_branch(kLastStepRule, u_.adaptive_steps, [&]() HWY_ATTR {
          last = last | (step >= rounds);
          move = select(last, F(u_.step_px[static_cast<std::size_t>(u_.steps - 1)]), move);
        });
        back = select(open & !done_back, back + move, back);
        on = select(open & !done_on, on + move, on);
        const M sampled = open & !last;  // the last move is not: an end there is taken for far
        s_.branch(kStepBack, sampled & !done_back,
                  [&]() HWY_ATTR { end_back = select(sampled & !done_back, end_at(-back), end_back); });
        s_.branch(kStepOn, sampled & !done_on,
                  [&]() HWY_ATTR { end_on = select(sampled & !done_on, end_at(on), end_on); });
        done_back = done_back | (sampled & (abs(end_back) >= gradient_));
        done_on = done_on | (sampled & (abs(end_on) >= gradient_));
        open = sampled & !(done_back & done_on);
      });
    }
    const F nearer = min(back, on);
    const F end = select(back < on, end_back, end_on);
    const M good = differ(end < F(0.0f), (m_ - average_) < F(0.0f));
    return select(good, F(0.5f) - nearer / (back + on), F(0.0f));
  }

  S& s_;
  const FxaaUniforms& u_;
  I x_, y_;
  F m_, n_, s_luma_, w_, e_, nw_, se_;
  F max_, min_, range_;
  M horizontal_;
  F sign_, average_, gradient_;  ///< the edge's side, mean luma, and a quarter of the gradient across it
};

template <bool kGather, bool kDiscard>
struct FxaaShader {
  using Uniforms = FxaaUniforms;
  template <class S>
  static void run(S& s, const FxaaUniforms& u) {
    const Fxaa<S, kGather, kDiscard> fxaa(s, u);
    if constexpr (kDiscard) s.discard(!fxaa.edge);
    s.output(0, {fxaa.color.x, fxaa.color.y, fxaa.color.z, typename S::F(1.0f)});
  }
};

struct LumaShader {
  using Uniforms = NoUniforms;
  template <class S>
  static void run(S& s, const NoUniforms&) {
    const auto c = s.load_image(0, s.pixel_x(), s.pixel_y(), typename S::I(0));
    s.output(0, {c.x, c.y, c.z, luma_601(c)});
  }
};

template <bool kGather, bool kDiscard>
void run_fxaa(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<FxaaShader<kGather, kDiscard>>(b, u);
}
void run_loads(pipeline::FragmentBatch& b, const void* u) { run_fxaa<false, false>(b, u); }
void run_loads_discard(pipeline::FragmentBatch& b, const void* u) { run_fxaa<false, true>(b, u); }
void run_gathers(pipeline::FragmentBatch& b, const void* u) { run_fxaa<true, false>(b, u); }
void run_gathers_discard(pipeline::FragmentBatch& b, const void* u) { run_fxaa<true, true>(b, u); }
void run_luma(pipeline::FragmentBatch& b, const void* u) { lanes::run_fragment_shader<LumaShader>(b, u); }

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_loads);
HWY_EXPORT(run_loads_discard);
HWY_EXPORT(run_gathers);
HWY_EXPORT(run_gathers_discard);
HWY_EXPORT(run_luma);

const pipeline::FragmentProgram& fxaa_program(const FxaaPath& path) {
  using HWY_NAMESPACE::FxaaShader;
  using pipeline::FragmentBatch;
  using pipeline::HWY_NAMESPACE::describe_fragment_shader;
  static const pipeline::FragmentProgram loads[] = {
      describe_fragment_shader<FxaaShader<false, false>>("fxaa",
                                                         [](FragmentBatch& b, const void* u) {
                                                           HWY_DYNAMIC_DISPATCH(run_loads)
                                                           (b, u);
                                                         }),
      describe_fragment_shader<FxaaShader<false, true>>("fxaa_discard", [](FragmentBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_loads_discard)(b, u);
      })};
  static const pipeline::FragmentProgram gathers[] = {
      describe_fragment_shader<FxaaShader<true, false>>("fxaa_gather",
                                                        [](FragmentBatch& b, const void* u) {
                                                          HWY_DYNAMIC_DISPATCH(run_gathers)
                                                          (b, u);
                                                        }),
      describe_fragment_shader<FxaaShader<true, true>>("fxaa_gather_discard",
                                                       [](FragmentBatch& b, const void* u) {
                                                         HWY_DYNAMIC_DISPATCH(run_gathers_discard)(b, u);
                                                       })};
  return (path.gather ? gathers : loads)[path.discard ? 1 : 0];
}

const pipeline::FragmentProgram& luma_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::LumaShader>(
          "luma", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_luma)
            (b, u);
          });
  return program;
}

}  // namespace hwsim::algos
#endif
