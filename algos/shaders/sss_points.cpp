// Points on critical triangles, placed by a geometry shader (techniques 5.2).
#include <array>

#include "algos/shaders/sss.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/shaders/sss_points.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/shaders/sss_geometry-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// A point's varyings: attributes, the change of uv for a pixel where there are textures, the weight.
constexpr int point_scalars(SssVertex vertex) {
  return attribute_count(vertex) + (vertex == SssVertex::plain ? 1 : 5);
}

template <SssVertex kVertex>
struct PointShader : SssGeometryShader<kVertex, pipeline::GeometryOutput::points, 64> {
  template <class S>
  static void run(S& s, const SssUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    PointShader::for_chosen(
        s, u, [&](const SssCorner<F>(&c)[3], const SssTriangle<F>& t, typename S::M chosen) HWY_ATTR {
          Values<F> values;
          read_attributes(s, c, values);
          const SssPattern<F> pattern = make_pattern<F, I>(u, t, c, s.primitive());
          std::array<F, point_scalars(kVertex)> out;
          out.back() = pattern.weight;
          if constexpr (kVertex != SssVertex::plain) set_gradients(t, c, values, out);
          s.loop_each(kSampleBlock, to_int(pattern.count), chosen, [&](int i, typename S::M left) HWY_ATTR {
            const Vec3<F> b = pattern_place(pattern, i);
            place(t, c, values, b, out);
            s.emit(left, clip_place(t, c, b), std::span<const F>(out));
            s.count(&TechniqueCounters::sss_point_samples, left);
          });
        });
  }

 private:
  static constexpr auto kCount = static_cast<std::size_t>(attribute_count(kVertex));
  template <class F>
  using Values =
      std::array<std::array<F, kCount>, 3>;  ///< of the three vertices, in the order of attribute_place
  template <class F>
  using Scalars = std::array<F, static_cast<std::size_t>(point_scalars(kVertex))>;

  template <class S, class F>
  static void read_attributes(S& s, const SssCorner<F> (&c)[3], Values<F>& values) {
    for (int v = 0; v < 3; ++v) {
      std::array<F, kCount>& out = values[static_cast<std::size_t>(v)];
      for (std::size_t k = 3; k < kCount; ++k)
        out[k] = s.attr(v, attribute_place(kVertex, static_cast<int>(k)));
      out[0] = c[v].normal.x;
      out[1] = c[v].normal.y;
      out[2] = c[v].normal.z;
    }
  }

  template <class F>
  static void set_gradients(const SssTriangle<F>& t, const SssCorner<F> (&c)[3], const Values<F>& values,
                            Scalars<F>& out) {
    constexpr std::size_t kUv = pipeline::SurfaceVaryings::kUv0;
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec2<F> g = gradient(c, t.area2, values[0][kUv + k], values[1][kUv + k], values[2][kUv + k]);
      out[kCount + k] = g.x;
      out[kCount + 2 + k] = g.y;
    }
  }

  template <class F>
  static void place(const SssTriangle<F>& t, const SssCorner<F> (&c)[3], const Values<F>& values,
                    const Vec3<F>& b, Scalars<F>& out) {
    const Vec3<F> w = perspective_weights(c, b);
    for (std::size_t k = 0; k < kCount; ++k) {
      const F value = w.x * values[0][k] + w.y * values[1][k] + w.z * values[2][k];
      out[k] = k < 3 ? value * t.facing : value;
    }
  }

  template <class F>
  static Vec4<F> clip_place(const SssTriangle<F>& t, const SssCorner<F> (&c)[3], const Vec3<F>& b) {
    const auto across = [&](F p, F q, F r) HWY_ATTR { return b.x * p + b.y * q + b.z * r; };
    return {across(c[0].clip.x * c[0].inv_w, c[1].clip.x * c[1].inv_w, c[2].clip.x * c[2].inv_w),
            across(c[0].clip.y * c[0].inv_w, c[1].clip.y * c[1].inv_w, c[2].clip.y * c[2].inv_w),
            max(across(c[0].z, c[1].z, c[2].z) - t.depth_bias, F(0.0f)), F(1.0f)};
  }
};

template <SssVertex kVertex>
struct PointShadingShader {
  using Uniforms = SssUniforms;
  template <class S>
  static void run(S& s, const SssUniforms& u) {
    using F = typename S::F;
    SurfacePoint<S> point(s);
    point.values.fill(F(0.0f));
    for (int k = 0; k < attribute_count(kVertex); ++k)
      point.values[static_cast<std::size_t>(attribute_place(kVertex, k))] = s.flat_attr(k);
    if constexpr (kVertex != SssVertex::plain) {
      constexpr int kAt = attribute_count(kVertex);
      point.site.du_dx = s.flat_attr(kAt);
      point.site.dv_dx = s.flat_attr(kAt + 1);
      point.site.du_dy = s.flat_attr(kAt + 2);
      point.site.dv_dy = s.flat_attr(kAt + 3);
    }
    const F weight = s.flat_attr(point_scalars(kVertex) - 1);
    const Vec3<F> c = light_point(s, u, point, kVertex, s.active());
    s.output(0, {c.x * weight, c.y * weight, c.z * weight, weight});
  }
};

/// a of the sum over the frame: a = min(1, W); the sum's own color is its mean.
template <class S>
void blend_sum(S& s, const Vec4<typename S::F>& sum) {
  using F = typename S::F;
  using I = typename S::I;
  const Vec4<F> frame = s.load_image(kSssFrameSlot, s.pixel_x(), s.pixel_y(), I(0));
  const F share = min(F(1.0f), sum.w), rest = F(1.0f) - share;
  const F scale = share / max(sum.w, F(1e-4f));
  s.output(0, {rest * frame.x + scale * sum.x, rest * frame.y + scale * sum.y, rest * frame.z + scale * sum.z,
               frame.w});
}

struct CompositeShader {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    blend_sum(s, s.load_image(kSssSumSlot, s.pixel_x(), s.pixel_y(), typename S::I(0)));
  }
};

/// The sums of the compute variant: four words a pixel in buffer slot 0, fixed-point or floats.
template <bool kFloat>
struct SumCompositeShader {
  using Uniforms = SssUniforms;
  template <class S>
  static void run(S& s, const SssUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    const I first = (s.pixel_y() * I(u.width_px) + s.pixel_x()) * I(4);
    const F scale(1.0f / u.fixed_point_scale);
    const auto word = [&](int i) HWY_ATTR {
      const I value = s.load_buffer(0, first + I(i), s.active());
      if constexpr (kFloat) return bits_to_float(value);
      // Unsigned words: the high half apart, so that no value is taken for a negative one.
      return (to_float(shift_right<16>(value) & I(0xffff)) * F(65536.0f) + to_float(value & I(0xffff))) *
             scale;
    };
    const F r = word(0), g = word(1), b = word(2), w = word(3);
    blend_sum(s, Vec4<F>{r, g, b, w});
  }
};

template <SssVertex kVertex>
void run_points(pipeline::GeometryBatch& b, const void* u) {
  lanes::run_geometry_shader<PointShader<kVertex>>(b, u);
}
template <SssVertex kVertex>
void run_point_shading(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<PointShadingShader<kVertex>>(b, u);
}
void run_points_plain(pipeline::GeometryBatch& b, const void* u) { run_points<SssVertex::plain>(b, u); }
void run_points_textured(pipeline::GeometryBatch& b, const void* u) { run_points<SssVertex::textured>(b, u); }
void run_points_full(pipeline::GeometryBatch& b, const void* u) { run_points<SssVertex::full>(b, u); }
void run_shading_plain(pipeline::FragmentBatch& b, const void* u) {
  run_point_shading<SssVertex::plain>(b, u);
}
void run_shading_textured(pipeline::FragmentBatch& b, const void* u) {
  run_point_shading<SssVertex::textured>(b, u);
}
void run_shading_full(pipeline::FragmentBatch& b, const void* u) { run_point_shading<SssVertex::full>(b, u); }
void run_composite(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<CompositeShader>(b, u);
}
void run_fixed_composite(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<SumCompositeShader<false>>(b, u);
}
void run_float_composite(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<SumCompositeShader<true>>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_points_plain);
HWY_EXPORT(run_points_textured);
HWY_EXPORT(run_points_full);
HWY_EXPORT(run_shading_plain);
HWY_EXPORT(run_shading_textured);
HWY_EXPORT(run_shading_full);
HWY_EXPORT(run_composite);
HWY_EXPORT(run_fixed_composite);
HWY_EXPORT(run_float_composite);

namespace {
using pipeline::FragmentBatch;
using pipeline::FragmentProgram;
using pipeline::GeometryBatch;
using pipeline::GeometryProgram;
namespace shaders = HWY_NAMESPACE;

template <SssVertex kVertex>
GeometryProgram describe_points(void (*run)(GeometryBatch&, const void*), int points_max) {
  GeometryProgram program =
      pipeline::HWY_NAMESPACE::describe_geometry_shader<shaders::PointShader<kVertex>>("sss_points", run);
  program.max_vertices = points_max;
  return program;
}
template <SssVertex kVertex>
FragmentProgram describe_shading(void (*run)(FragmentBatch&, const void*)) {
  FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<shaders::PointShadingShader<kVertex>>("sss_point",
                                                                                              run);
  program.varying_scalars = shaders::point_scalars(kVertex);
  return program;
}
void call_points_plain(GeometryBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_points_plain)(b, u); }
void call_points_textured(GeometryBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_points_textured)(b, u);
}
void call_points_full(GeometryBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_points_full)(b, u); }
void call_shading_plain(FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_shading_plain)(b, u); }
void call_shading_textured(FragmentBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_shading_textured)(b, u);
}
void call_shading_full(FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_shading_full)(b, u); }

constexpr int kPointsMax = 256;  // the largest budget of a triangle

/// By vertex, and by limit: programs are shared, so there is one for each.
std::vector<GeometryProgram> describe_all(SssVertex vertex) {
  std::vector<GeometryProgram> all;
  GeometryProgram program =
      vertex == SssVertex::plain      ? describe_points<SssVertex::plain>(call_points_plain, 1)
      : vertex == SssVertex::textured ? describe_points<SssVertex::textured>(call_points_textured, 1)
                                      : describe_points<SssVertex::full>(call_points_full, 1);
  for (int most = 1; most <= kPointsMax; ++most) {
    program.max_vertices = most;
    all.push_back(program);
  }
  return all;
}
}  // namespace

const GeometryProgram& sss_points_program(SssVertex vertex, int points_max) {
  static const std::array<std::vector<GeometryProgram>, 3> programs = {
      describe_all(SssVertex::plain), describe_all(SssVertex::textured), describe_all(SssVertex::full)};
  return programs[static_cast<std::size_t>(vertex)].at(static_cast<std::size_t>(points_max) - 1);
}

const FragmentProgram& sss_point_shading_program(SssVertex vertex) {
  static const FragmentProgram programs[] = {describe_shading<SssVertex::plain>(call_shading_plain),
                                             describe_shading<SssVertex::textured>(call_shading_textured),
                                             describe_shading<SssVertex::full>(call_shading_full)};
  return programs[static_cast<std::size_t>(vertex)];
}

const FragmentProgram& sss_composite_program() {
  static const FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<shaders::CompositeShader>(
          "sss_composite", [](FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_composite)(b, u);
          });
  return program;
}

const FragmentProgram& sss_sum_composite_program(bool floats) {
  using pipeline::HWY_NAMESPACE::describe_fragment_shader;
  static const FragmentProgram programs[] = {
      describe_fragment_shader<shaders::SumCompositeShader<false>>("sss_fixed_composite",
                                                                   [](FragmentBatch& b, const void* u) {
                                                                     HWY_DYNAMIC_DISPATCH(run_fixed_composite)
                                                                     (b, u);
                                                                   }),
      describe_fragment_shader<shaders::SumCompositeShader<true>>(
          "sss_float_composite", [](FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_float_composite)(b, u);
          })};
  return programs[floats ? 1 : 0];
}

}  // namespace hwsim::algos
#endif
