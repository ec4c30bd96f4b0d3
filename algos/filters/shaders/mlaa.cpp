#include "algos/filters/shaders/mlaa.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/filters/shaders/mlaa.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/filters/shaders/edges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

inline constexpr int kEdgeAbove = 1, kEdgeRight = 2;

struct MlaaEdgeShader {
  using Uniforms = MlaaUniforms;
  template <class S>
  static void run(S& s, const MlaaUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    const I x = s.pixel_x(), y = s.pixel_y();
    const auto luma_at = [&](int dx, int dy)
                             HWY_ATTR { return luma_601(s.load_image(0, x + I(dx), y + I(dy), I(0))); };
    const F own = luma_at(0, 0);
    const F above = select(abs(own - luma_at(0, -1)) > F(u.threshold), F(kEdgeAbove), F(0.0f));
    const F right = select(abs(own - luma_at(1, 0)) > F(u.threshold), F(kEdgeRight), F(0.0f));
    s.output(0, {above + right, F(0.0f), F(0.0f), F(1.0f)});
  }
};

template <class M, class I>
M has_edge(I mask, int bit) {
  return (mask & I(bit)) > I(0);
}

/// A count of either way: the length in the low bits, above it the bit that says that the end was found.
inline int count_bits(const MlaaUniforms& u) { return u.wide_counts ? 8 : 4; }
inline int longest_count(const MlaaUniforms& u) { return (1 << (count_bits(u) - 1)) - 1; }

struct MlaaCountShader {
  using Uniforms = MlaaUniforms;
  enum Block : int { kAbove = 1, kRight, kLeftwards, kRightwards, kUpwards, kDownwards };

  template <class S>
  static void run(S& s, const MlaaUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    using M = typename S::M;
    const I x = s.pixel_x(), y = s.pixel_y();
    const I own = to_int(s.load_image(0, x, y, I(0)).x);
    const int limit = longest_count(u);
    const auto walk = [&](int block, M lanes, int bit, int dx, int dy) HWY_ATTR {
      I steps(0);
      M open = lanes, ended = !lanes;
      const std::size_t count = s.loop_count(limit);
      for (std::size_t i = 1; i <= count; ++i) {
        s.branch(block, open, [&]() HWY_ATTR {
          const int n = static_cast<int>(i);
          const I at_x = x + I(dx * n), at_y = y + I(dy * n);
          const M inside =
              (at_x > I(-1)) & (at_y > I(-1)) & (at_x < I(s.image_width(0))) & (at_y < I(s.image_height(0)));
          const M on = inside & has_edge<M>(to_int(s.load_image(0, at_x, at_y, I(0)).x), bit);
          steps = select(open & on, I(n), steps);
          ended = ended | (open & !on);
          open = open & on;
        });
      }
      return steps + select(ended, I(limit + 1), I(0));
    };
    const I scale(1 << count_bits(u));
    I above(0), right(0);
    const M has_above = has_edge<M>(own, kEdgeAbove), has_right = has_edge<M>(own, kEdgeRight);
    s.branch(kAbove, has_above, [&]() HWY_ATTR {
      const I on = walk(kRightwards, has_above, kEdgeAbove, 1, 0);
      const I back = walk(kLeftwards, has_above, kEdgeAbove, -1, 0);
      above = select(has_above, back + on * scale, above);
    });
    s.branch(kRight, has_right, [&]() HWY_ATTR {
      const I on = walk(kDownwards, has_right, kEdgeRight, 0, 1);
      const I back = walk(kUpwards, has_right, kEdgeRight, 0, -1);
      right = select(has_right, back + on * scale, right);
    });
    s.output(0, {to_float(above), to_float(right), F(0.0f), F(1.0f)});
  }
};

/// Blends a pixel with those across its four edges, in order: above, below, right, left.
template <class S>
class MlaaBlend {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;
  using Color = lanes::Vec4<F>;
  enum Block : int { kAbove = 1, kBelow, kRight, kLeft };

  MlaaBlend(S& s, const MlaaUniforms& u) : s_(s), u_(u), x_(s.pixel_x()), y_(s.pixel_y()) {
    own_ = s_.load_image(0, x_, y_, I(0));
    color = own_;
    const I own = mask_at(0, 0), below = mask_at(0, 1), left = mask_at(-1, 0);
    blend<kAbove>(has_edge<M>(own, kEdgeAbove), 0, -1, 0, 0);
    blend<kBelow>(has_edge<M>(below, kEdgeAbove) & (y_ < I(s_.image_height(0) - 1)), 0, 1, 0, 1);
    blend<kRight>(has_edge<M>(own, kEdgeRight), 1, 0, 0, 0);
    blend<kLeft>(has_edge<M>(left, kEdgeRight) & (x_ > I(0)), -1, 0, -1, 0);
  }

  Color color;

 private:
  I mask_at(int dx, int dy) { return to_int(s_.load_image(1, x_ + I(dx), y_ + I(dy), I(0)).x); }
  Color color_at(I x, I y) { return s_.load_image(0, x, y, I(0)); }

  /// One way of a run: its length from the pixel, and whether the pixel's own side ends there.
  struct End {
    F steps;
    M found, crossed;
  };
  End end_of(I count, int axis_x, int axis_y) {
    const int limit = longest_count(u_);
    const I steps = count & I(limit);
    const M found = (count & I(limit + 1)) > I(0);
    const I last = steps, past = steps + I(1);
    const F before = luma_601(color_at(x_ + last * I(axis_x), y_ + last * I(axis_y)));
    const F after = luma_601(color_at(x_ + past * I(axis_x), y_ + past * I(axis_y)));
    const M crossed = found & (abs(before - after) > F(u_.threshold));
    return {select(found, to_float(steps), F(static_cast<float>(limit + 1))), found, crossed};
  }

  /// Towards the pixel across, by the area between the edge and the line that replaces its run. The run is
  /// stored with the pixel at (from_x, from_y).
  template <int kBlock>
  void blend(M edge, int across_x, int across_y, int from_x, int from_y) {
    s_.branch(kBlock, edge, [&]() HWY_ATTR {
      constexpr bool kRow = kBlock == kAbove || kBlock == kBelow;
      const Color stored = s_.load_image(2, x_ + I(from_x), y_ + I(from_y), I(0));
      const I runs = to_int(kRow ? stored.x : stored.y);
      const I on_count = u_.wide_counts ? shift_right<8>(runs) : shift_right<4>(runs);
      const End back = end_of(runs, kRow ? -1 : 0, kRow ? 0 : -1);
      const End on = end_of(on_count, kRow ? 1 : 0, kRow ? 0 : 1);
      const F length = back.steps + on.steps + F(1.0f);
      const F h0 = abs((length - back.steps) / length - F(0.5f));
      const F h1 = abs((length - back.steps - F(1.0f)) / length - F(0.5f));
      const F twice = F(2.0f) * back.steps + F(1.0f);  // the pixel's center, in half pixels from the start
      const M side = (back.crossed & (twice <= length)) | (on.crossed & (twice >= length));
      const M single = back.found & on.found & (length < F(1.5f));
      const F area = select(single, F(0.125f), select(side, F(0.5f) * (h0 + h1), F(0.0f)));
      mix(edge & (area > F(0.0f)), color_at(x_ + I(across_x), y_ + I(across_y)), area);
    });
  }

  /// In approximately linear light: squares.
  void mix(M lanes, const Color& across, F area) {
    const auto one = [&](F c, F d) HWY_ATTR {
      const F linear = c * c;
      return select(lanes, sqrt(linear + (d * d - linear) * area), c);
    };
    color = {one(color.x, across.x), one(color.y, across.y), one(color.z, across.z), color.w};
  }

  S& s_;
  const MlaaUniforms& u_;
  I x_, y_;
  Color own_;
};

struct MlaaBlendShader {
  using Uniforms = MlaaUniforms;
  template <class S>
  static void run(S& s, const MlaaUniforms& u) {
    const MlaaBlend<S> blend(s, u);
    s.output(0, {blend.color.x, blend.color.y, blend.color.z, typename S::F(1.0f)});
  }
};

void run_mlaa_edge(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<MlaaEdgeShader>(b, u);
}
void run_mlaa_count(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<MlaaCountShader>(b, u);
}
void run_mlaa_blend(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<MlaaBlendShader>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_mlaa_edge);
HWY_EXPORT(run_mlaa_count);
HWY_EXPORT(run_mlaa_blend);

const pipeline::FragmentProgram& mlaa_edge_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::MlaaEdgeShader>(
          "mlaa_edges", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_mlaa_edge)(b, u);
          });
  return program;
}
const pipeline::FragmentProgram& mlaa_count_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::MlaaCountShader>(
          "mlaa_counts", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_mlaa_count)(b, u);
          });
  return program;
}
const pipeline::FragmentProgram& mlaa_blend_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::MlaaBlendShader>(
          "mlaa_blend", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_mlaa_blend)(b, u);
          });
  return program;
}

}  // namespace hwsim::algos
#endif
