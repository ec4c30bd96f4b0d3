// Points on critical triangles, placed by a geometry shader (docs/techniques/sss.md#points).
#include <array>

#include "algos/sss/shaders/programs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/sss/shaders/points.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/sss/shaders/geometry-inl.h"
#include "algos/sss/shaders/pattern-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// A point's varyings: attributes, the change of uv for a pixel where there are textures, the weight; where
/// the shader tests depth, that depth and the sample that it is tested against.
constexpr int weight_scalar(SssVertex vertex) {
  return attribute_count(vertex) + (vertex == SssVertex::plain ? 0 : 4);
}
constexpr int point_scalars(SssVertex vertex, SssPointDepth depth) {
  return weight_scalar(vertex) + (depth == SssPointDepth::fixed ? 1 : 3);
}

template <SssVertex kVertex, SssPointDepth kDepth>
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
          Scalars<F> out;
          out[kWeight] = pattern.weight;
          if constexpr (kVertex != SssVertex::plain) set_gradients(t, c, values, out);
          s.loop_each(kSampleBlock, to_int(pattern.count), chosen, [&](int i, typename S::M left) HWY_ATTR {
            const Vec3<F> b = pattern_place(pattern, i);
            place(t, c, values, b, out);
            const Vec2<F> at = screen_place(c, b);
            F z = b.x * c[0].z + b.y * c[1].z + b.z * c[2].z;
            if constexpr (kDepth == SssPointDepth::fixed)
              z = max(z - t.depth_bias, F(0.0f));
            else
              set_depth_test<I>(u, t, at, z, out);
            s.emit(left, to_clip(u, at, z), std::span<const F>(out));
            s.count(SssCounters::sss_point_samples, left);
          });
        });
  }

 private:
  static constexpr auto kCount = static_cast<std::size_t>(attribute_count(kVertex));
  template <class F>
  using Values = std::array<std::array<F, kCount>,
                            3>;  ///< attributes of the three vertices, in the order of attribute_place
  template <class F>
  using Scalars = std::array<F, static_cast<std::size_t>(point_scalars(kVertex, kDepth))>;
  static constexpr auto kWeight = static_cast<std::size_t>(weight_scalar(kVertex));

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
  static Vec2<F> screen_place(const SssCorner<F> (&c)[3], const Vec3<F>& b) {
    return {b.x * c[0].x + b.y * c[1].x + b.z * c[2].x, b.x * c[0].y + b.y * c[1].y + b.z * c[2].y};
  }
  template <class F>
  static Vec4<F> to_clip(const SssUniforms& u, const Vec2<F>& at, F z) {
    return {at.x * F(2.0f / static_cast<float>(u.width_px)) - F(1.0f),
            F(1.0f) - at.y * F(2.0f / static_cast<float>(u.height_px)), z, F(1.0f)};
  }

  template <class I, class F>
  static void set_depth_test(const SssUniforms& u, const SssTriangle<F>& t, const Vec2<F>& at, F z,
                             Scalars<F>& out) {
    const I px = point_pixel<I>(at.x), py = point_pixel<I>(at.y);
    const DepthTest<F, I> test = depth_test<F, I>(u, t, at.x - to_float(px), at.y - to_float(py), z);
    out[kWeight + 1] = test.depth;
    out[kWeight + 2] = to_float(test.sample);
  }
};

template <SssVertex kVertex, SssPointDepth kDepth>
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
    constexpr int kWeight = weight_scalar(kVertex);
    const F weight = s.flat_attr(kWeight);
    auto seen = s.active();
    if constexpr (kDepth == SssPointDepth::shader) {
      const F depth = s.flat_attr(kWeight + 1);
      const auto sample = to_int(s.flat_attr(kWeight + 2));
      seen = seen & !(depth > s.load_image(kSssDepthSlot, s.pixel_x(), s.pixel_y(), sample).x);
      s.discard(!seen);
    }
    s.branch(kShadeBlock, seen, [&]() HWY_ATTR {
      const Vec3<F> c = light_point(s, u, point, kVertex, seen);
      s.output(0, {c.x * weight, c.y * weight, c.z * weight, weight});
    });
  }
};

template <SssPointDepth kDepth>
void run_points(SssVertex vertex, pipeline::GeometryBatch& b, const void* u) {
  with_vertex(vertex, [&](auto v) HWY_ATTR { lanes::run_geometry_shader<PointShader<v(), kDepth>>(b, u); });
}
template <SssPointDepth kDepth>
void run_point_shading(SssVertex vertex, pipeline::FragmentBatch& b, const void* u) {
  with_vertex(vertex,
              [&](auto v) HWY_ATTR { lanes::run_fragment_shader<PointShadingShader<v(), kDepth>>(b, u); });
}
void run_tested_points(SssVertex vertex, pipeline::GeometryBatch& b, const void* u) {
  run_points<SssPointDepth::shader>(vertex, b, u);
}
void run_tested_point_shading(SssVertex vertex, pipeline::FragmentBatch& b, const void* u) {
  run_point_shading<SssPointDepth::shader>(vertex, b, u);
}
void run_plain_points(SssVertex vertex, pipeline::GeometryBatch& b, const void* u) {
  run_points<SssPointDepth::fixed>(vertex, b, u);
}
void run_plain_point_shading(SssVertex vertex, pipeline::FragmentBatch& b, const void* u) {
  run_point_shading<SssPointDepth::fixed>(vertex, b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_tested_points);
HWY_EXPORT(run_tested_point_shading);
HWY_EXPORT(run_plain_points);
HWY_EXPORT(run_plain_point_shading);

namespace {

constexpr int kPointsMax = 256;  // the largest budget of a triangle

/// By limit: programs are shared, so there is one for each.
template <SssVertex kVertex, SssPointDepth kDepth>
std::vector<pipeline::GeometryProgram> describe_points() {
  pipeline::GeometryProgram program =
      pipeline::HWY_NAMESPACE::describe_geometry_shader<HWY_NAMESPACE::PointShader<kVertex, kDepth>>(
          "sss_points", [](pipeline::GeometryBatch& b, const void* u) {
            if constexpr (kDepth == SssPointDepth::fixed)
              HWY_DYNAMIC_DISPATCH(run_plain_points)(kVertex, b, u);
            else
              HWY_DYNAMIC_DISPATCH(run_tested_points)(kVertex, b, u);
          });
  std::vector<pipeline::GeometryProgram> all;
  for (program.max_vertices = 1; program.max_vertices <= kPointsMax; ++program.max_vertices)
    all.push_back(program);
  return all;
}

template <SssVertex kVertex, SssPointDepth kDepth>
pipeline::FragmentProgram describe_shading(bool extended) {
  SssUniforms uniforms;
  uniforms.lighting.extended = extended;
  pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::PointShadingShader<kVertex, kDepth>>(
          "sss_point",
          [](pipeline::FragmentBatch& b, const void* u) {
            if constexpr (kDepth == SssPointDepth::fixed)
              HWY_DYNAMIC_DISPATCH(run_plain_point_shading)(kVertex, b, u);
            else
              HWY_DYNAMIC_DISPATCH(run_tested_point_shading)(kVertex, b, u);
          },
          uniforms);
  program.varying_scalars = HWY_NAMESPACE::point_scalars(kVertex, kDepth);
  return program;
}

template <SssPointDepth kDepth>
const pipeline::FragmentProgram& shading_program(SssVertex vertex, bool extended) {
  static const auto plain = for_each_vertex([](auto v) { return describe_shading<v(), kDepth>(false); });
  static const auto more = for_each_vertex([](auto v) { return describe_shading<v(), kDepth>(true); });
  return (extended ? more : plain)[static_cast<std::size_t>(vertex)];
}

template <SssPointDepth kDepth>
const pipeline::GeometryProgram& points_program(SssVertex vertex, int points_max) {
  static const auto programs = for_each_vertex([](auto v) { return describe_points<v(), kDepth>(); });
  return programs[static_cast<std::size_t>(vertex)].at(static_cast<std::size_t>(points_max) - 1);
}

}  // namespace

const pipeline::GeometryProgram& sss_points_program(SssVertex vertex, SssPointDepth depth, int points_max) {
  return depth == SssPointDepth::fixed ? points_program<SssPointDepth::fixed>(vertex, points_max)
                                       : points_program<SssPointDepth::shader>(vertex, points_max);
}

const pipeline::FragmentProgram& sss_point_shading_program(SssVertex vertex, SssPointDepth depth,
                                                           bool extended) {
  return depth == SssPointDepth::fixed ? shading_program<SssPointDepth::fixed>(vertex, extended)
                                       : shading_program<SssPointDepth::shader>(vertex, extended);
}

}  // namespace hwsim::algos
#endif
