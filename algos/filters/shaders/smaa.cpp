#include "algos/filters/shaders/smaa.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/filters/shaders/smaa.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/filters/shaders/edges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

struct SmaaEdgeShader {
  using Uniforms = SmaaUniforms;
  template <class S>
  static void run(S& s, const SmaaUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    using M = typename S::M;
    using Color = lanes::Vec4<F>;
    const I x = s.pixel_x(), y = s.pixel_y();
    const auto at = [&](int dx, int dy) HWY_ATTR { return s.load_image(0, x + I(dx), y + I(dy), I(0)); };
    const auto contrast = [&](const Color& a, const Color& b) HWY_ATTR {
      return u.color_edges ? max(max(abs(a.x - b.x), abs(a.y - b.y)), abs(a.z - b.z))
                           : abs(luma_709(a) - luma_709(b));
    };
    const Color center = at(0, 0), left = at(-1, 0), top = at(0, -1);
    const F d_left = contrast(center, left), d_top = contrast(center, top);
    const F threshold(u.threshold);
    const M has_left = d_left >= threshold, has_top = d_top >= threshold;
    const M edge = has_left | has_top;
    s.discard(!edge);
    F red(0.0f), green(0.0f);
    s.branch(1, edge, [&]() HWY_ATTR {
      // An edge stays if no neighboring contrast is more than twice its own.
      const Color bottom = at(0, 1), right = at(1, 0), second_top = at(0, -2), second_left = at(-2, 0);
      const F across = max(max(d_left, d_top), max(contrast(center, right), contrast(center, bottom)));
      const F before = max(contrast(left, second_left), contrast(top, second_top));
      const F highest = max(across, before);
      red = select(has_left & (F(2.0f) * d_left >= highest), F(1.0f), F(0.0f));
      green = select(has_top & (F(2.0f) * d_top >= highest), F(1.0f), F(0.0f));
    });
    s.output(0, {red, green, F(0.0f), F(1.0f)});
  }
};

// A block belongs to one place in the code: its operations are counted once.
enum SmaaBlock : int {
  kTopEdge = 1,
  kRisingBack,
  kRisingOn,
  kRisingArea,
  kFallingBack,
  kFallingOn,
  kFallingArea,
  kTopArea,
  kTopBack,
  kTopOn,
  kTopCorners,
  kLeftEdge,
  kLeftBack,
  kLeftOn,
  kLeftCorners,
};

/// Weights of one pixel. Edge texels are 0 or 1, so that bilinear fetches at chosen fractions tell apart
/// which of two or four texels are set. Directions of the horizontal case are named; the vertical case
/// exchanges the axes.
template <class S, bool kDiagonals>
class SmaaWeights {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;
  using Color = lanes::Vec4<F>;

  SmaaWeights(S& s, const SmaaUniforms& u)
      : s_(s), u_(u), x_(center_of<F>(s.pixel_x())), y_(center_of<F>(s.pixel_y())) {
    const Color e = s_.load_image(0, s.pixel_x(), s.pixel_y(), I(0));
    const M top = e.y > F(0.0f);
    M left = e.x > F(0.0f);
    s_.branch(kTopEdge, top, [&]() HWY_ATTR {
      M straight = top;
      if constexpr (kDiagonals) {
        rising_diagonal(left & top, top);
        falling_diagonal(top);
        straight = top & (r_ <= F(0.0f)) & (g_ <= F(0.0f));
        left = left & !(top & ((r_ > F(0.0f)) | (g_ > F(0.0f))));
      }
      s_.branch(kTopArea, straight, [&]() HWY_ATTR {
        const Weights w = straight_weights<false>();
        r_ = select(straight, w.first, r_);
        g_ = select(straight, w.second, g_);
      });
    });
    s_.branch(kLeftEdge, left, [&]() HWY_ATTR {
      const Weights w = straight_weights<true>();
      b_ = select(left, w.first, b_);
      a_ = select(left, w.second, a_);
    });
  }

  Color weights() const { return {r_, g_, b_, a_}; }

 private:
  struct Weights {
    F first, second;
  };
  /// An edge texel as seen along the edge: what crosses it, and the edge itself.
  struct Crossing {
    F across, along;
  };

  /// Edges at an offset in pixels, `along` the edge and `down` from it (to the right, in the vertical case).
  template <bool kVertical>
  Crossing edges_at(F along, F down) {
    const Color c =
        kVertical ? s_.sample_image(0, x_ + down, y_ + along) : s_.sample_image(0, x_ + along, y_ + down);
    return kVertical ? Crossing{c.y, c.x} : Crossing{c.x, c.y};
  }

  /// The pixels that the line goes on for, one way. Each fetch sees two pixels of the line and those beside
  /// them.
  template <bool kVertical>
  F search(int block, float start, float step) {
    F along(start);
    F across(0.0f), line(1.0f);
    M open = F(0.0f) <= x_;
    const std::size_t steps = s_.loop_count(u_.search_steps);
    for (std::size_t i = 0; i < steps; ++i) {
      s_.branch(block, open, [&]() HWY_ATTR {
        const Crossing e = edges_at<kVertical>(along, F(-0.125f));
        across = select(open, e.across, across);
        line = select(open, e.along, line);
        along = select(open, along + F(step), along);
        open = open & (line > F(0.8281f)) & !(across > F(0.0f));
      });
    }
    // The table says how many of the last two pixels count: 0, 1 or 2, stored times 127.
    const F column = across * F(32.0f) + F(step < 0.0f ? 0.5f : 33.5f);
    const F row = F(32.5f) - line * F(32.0f);
    const F last = s_.sample_image(2, column, row).x * F(255.0f / 127.0f);
    const F back = F(3.25f) - last;
    return step < 0.0f ? along + back : along - back;
  }

  template <bool kVertical>
  Weights straight_weights() {
    const F start = search<kVertical>(kVertical ? kLeftBack : kTopBack, -0.25f, -2.0f);
    const F e1 = edges_at<kVertical>(start, F(-0.25f)).across;
    const F end = search<kVertical>(kVertical ? kLeftOn : kTopOn, 1.25f, 2.0f);
    const F e2 = edges_at<kVertical>(end + F(1.0f), F(-0.25f)).across;
    const F before = floor(abs(start) + F(0.5f)), after = floor(abs(end) + F(0.5f));
    // 16x16 texels for each pair of codes 0, 1, 3, 4; distances by their square roots.
    const F column = F(16.0f) * floor(F(4.0f) * e1 + F(0.5f)) + sqrt(before) + F(0.5f);
    const F row = F(16.0f) * floor(F(4.0f) * e2 + F(0.5f)) + sqrt(after) + F(0.5f);
    const Color area = s_.sample_image(1, column, row);
    Weights w{area.x, area.y};
    s_.uniform_branch(kVertical ? kLeftCorners : kTopCorners, u_.corners,
                      [&]() HWY_ATTR { round_corners<kVertical>(start, end, before, after, w); });
    return w;
  }

  template <bool kVertical>
  void round_corners(F start, F end, F before, F after, Weights& w) {
    const M near_start = after >= before, near_end = before >= after;
    const F full(1.0f - u_.corner_rounding), half(0.5f * (1.0f - u_.corner_rounding));
    const F both = select(near_start & near_end, half, full);
    const F at_start = select(near_start, both, F(0.0f)), at_end = select(near_end, both, F(0.0f));
    const auto crossing = [&](F along, float down)
                              HWY_ATTR { return edges_at<kVertical>(along, F(down)).across; };
    const F past = end + F(1.0f);
    const F end_inside = crossing(past, 1.0f), start_inside = crossing(start, 1.0f);
    const F end_outside = crossing(past, -2.0f), start_outside = crossing(start, -2.0f);
    const F inside = F(1.0f) - at_start * start_inside - at_end * end_inside;
    const F outside = F(1.0f) - at_start * start_outside - at_end * end_outside;
    w.first = w.first * min(max(inside, F(0.0f)), F(1.0f));
    w.second = w.second * min(max(outside, F(0.0f)), F(1.0f));
  }

  /// Splits a fetch a quarter pixel to the right: red of the right texel, green of the left one.
  static Color split_quarter(const Color& c) {
    return {floor(c.x * abs(F(5.0f) * c.x - F(3.75f)) + F(0.5f)), floor(c.y + F(0.5f)), c.z, c.w};
  }

  struct Walk {
    F steps;     ///< pixels with both edges, one less than the limit at most
    M found;     ///< the end lies within reach
    F end_edge;  ///< green of the last pixel visited
  };
  /// Diagonally from the pixel; `quarter`: edges of the falling diagonal lie on two pixels.
  Walk walk(int block, M lanes, float dx, float dy, bool quarter) {
    Walk w{F(0.0f), !lanes, F(0.0f)};
    M open = lanes;
    const F shift(quarter ? 0.25f : 0.0f);
    const std::size_t steps = s_.loop_count(u_.diagonal_steps);
    for (std::size_t i = 0; i < steps; ++i) {
      s_.branch(block, open, [&]() HWY_ATTR {
        const F n(static_cast<float>(i + 1));
        const Color c = s_.sample_image(0, x_ + F(dx) * n + shift, y_ + F(dy) * n);
        const Color e = quarter ? split_quarter(c) : c;
        const M both = e.x + e.y > F(1.8f);
        if (static_cast<int>(i) + 1 < u_.diagonal_steps) w.steps = select(open & both, n, w.steps);
        w.end_edge = select(open, e.y, w.end_edge);
        w.found = w.found | (open & !both);
        open = open & both;
      });
    }
    return w;
  }

  void add_diagonal_area(M lanes, F before, F after, F code1, F code2, bool swapped) {
    const Color area =
        s_.sample_image(1, F(80.5f) + F(20.0f) * code1 + before, F(0.5f) + F(20.0f) * code2 + after);
    r_ = select(lanes, r_ + (swapped ? area.y : area.x), r_);
    g_ = select(lanes, g_ + (swapped ? area.x : area.y), g_);
  }

  // A code is twice the edge along plus the edge across, 0 where the end was not found.
  F code(const Walk& w, F along, F across) const {
    return select(w.found, F(2.0f) * along + across, F(0.0f));
  }

  void rising_diagonal(M from_left, M top) {
    Walk back = walk(kRisingBack, from_left, -1.0f, 1.0f, false);
    back.steps = back.steps + select(from_left & (back.end_edge > F(0.9f)), F(1.0f), F(0.0f));
    const Walk on = walk(kRisingOn, top, 1.0f, -1.0f, false);
    const F d1 = back.steps, d2 = on.steps;
    const M found = top & (d1 + d2 > F(2.0f));
    s_.branch(kRisingArea, found, [&]() HWY_ATTR {
      const Color start = split_quarter(s_.sample_image(0, x_ - d1 - F(0.75f), y_ + d1));
      const Color end = split_quarter(s_.sample_image(0, x_ + d2 + F(1.0f), y_ - d2 - F(0.25f)));
      add_diagonal_area(found, d1, d2, code(back, start.y, start.x), code(on, end.y, end.x), false);
    });
  }

  void falling_diagonal(M top) {
    const Walk back = walk(kFallingBack, top, -1.0f, -1.0f, true);
    const M from_right = top & (s_.load_image(0, s_.pixel_x() + I(1), s_.pixel_y(), I(0)).x > F(0.0f));
    Walk on = walk(kFallingOn, from_right, 1.0f, 1.0f, true);
    on.steps = on.steps + select(from_right & (on.end_edge > F(0.9f)), F(1.0f), F(0.0f));
    const F d1 = back.steps, d2 = on.steps;
    const M found = top & (d1 + d2 > F(2.0f));
    s_.branch(kFallingArea, found, [&]() HWY_ATTR {
      const F along1 = s_.sample_image(0, x_ - d1 - F(1.0f), y_ - d1).y;
      const F across1 = s_.sample_image(0, x_ - d1, y_ - d1 - F(1.0f)).x;
      const Color end = s_.sample_image(0, x_ + d2 + F(1.0f), y_ + d2);
      add_diagonal_area(found, d1, d2, code(back, along1, across1), code(on, end.y, end.x), true);
    });
  }

  S& s_;
  const SmaaUniforms& u_;
  F x_, y_;
  F r_ = F(0.0f), g_ = F(0.0f), b_ = F(0.0f), a_ = F(0.0f);
};

template <bool kDiagonals>
struct SmaaWeightShader {
  using Uniforms = SmaaUniforms;
  template <class S>
  static void run(S& s, const SmaaUniforms& u) {
    s.output(0, SmaaWeights<S, kDiagonals>(s, u).weights());
  }
};

struct SmaaBlendShader {
  using Uniforms = SmaaUniforms;
  template <class S>
  static void run(S& s, const SmaaUniforms&) {
    using F = typename S::F;
    using I = typename S::I;
    using M = typename S::M;
    using Color = lanes::Vec4<F>;
    const I x = s.pixel_x(), y = s.pixel_y();
    const Color own = s.load_image(0, x, y, I(0));
    const F right = s.load_image(0, x + I(1), y, I(0)).w, bottom = s.load_image(0, x, y + I(1), I(0)).y;
    const F top = own.x, left = own.z;
    const M blended = !(right + bottom + top + left < F(1e-5f));
    Color color = s.load_image(1, x, y, I(0));
    s.branch(1, blended, [&]() HWY_ATTR {
      const M across = max(right, left) > max(bottom, top);
      const F on = select(across, right, bottom), back = select(across, left, top);
      const F total = on + back;
      const F zero(0.0f);
      const auto at = [&](F offset) HWY_ATTR {
        return s.sample_image(1, center_of<F>(x) + select(across, offset, zero),
                              center_of<F>(y) + select(across, zero, offset));
      };
      const Color behind = at(-back), ahead = at(on);
      const Color mixed = ahead * (on / total) + behind * (back / total);
      color = select_color(blended, mixed, color);
    });
    s.output(0, {color.x, color.y, color.z, F(1.0f)});
  }
};

void run_smaa_edge(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<SmaaEdgeShader>(b, u);
}
void run_smaa_weight(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<SmaaWeightShader<false>>(b, u);
}
void run_smaa_weight_diagonals(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<SmaaWeightShader<true>>(b, u);
}
void run_smaa_blend(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<SmaaBlendShader>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_smaa_edge);
HWY_EXPORT(run_smaa_weight);
HWY_EXPORT(run_smaa_weight_diagonals);
HWY_EXPORT(run_smaa_blend);

const pipeline::FragmentProgram& smaa_edge_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::SmaaEdgeShader>(
          "smaa_edges", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_smaa_edge)(b, u);
          });
  return program;
}
const pipeline::FragmentProgram& smaa_weight_program(bool diagonals) {
  using pipeline::HWY_NAMESPACE::describe_fragment_shader;
  static const pipeline::FragmentProgram straight =
      describe_fragment_shader<HWY_NAMESPACE::SmaaWeightShader<false>>(
          "smaa_weights", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_smaa_weight)(b, u);
          });
  static const pipeline::FragmentProgram all =
      describe_fragment_shader<HWY_NAMESPACE::SmaaWeightShader<true>>(
          "smaa_weights_diagonals", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_smaa_weight_diagonals)(b, u);
          });
  return diagonals ? all : straight;
}
const pipeline::FragmentProgram& smaa_blend_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::SmaaBlendShader>(
          "smaa_blend", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_smaa_blend)(b, u);
          });
  return program;
}

}  // namespace hwsim::algos
#endif
