// Points on critical triangles, placed and lit by a compute shader: a thread a triangle
// (docs/techniques/sss.md#points).
#include <array>

#include "algos/sss/shaders/programs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/sss/shaders/compute.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/sss/shaders/pattern-inl.h"
#include "pipeline/shade/compute_lanes-inl.h"
#include "pipeline/shade/count_fragment-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// Vertices as SurfaceVaryings has them, in the mesh's space: normal, uv, position, and tangent and color
/// where the scene has any.
template <class S, bool kFloat>
class PointThread {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;
  using V = pipeline::SurfaceVaryings;

  PointThread(S& s, const SssUniforms& u, const SssDraw& draw) : s_(s), u_(u), draw_(draw) {}

  /// `triangle`: its number among all, `number`: among those of the draw.
  void run(I triangle, I number, M exists) {
    SssCorner<F> c[3];
    load_corners(triangle, exists, c);
    const SssTriangle<F> t = measure_triangle(s_, u_, draw_.mirrored ? -1.0f : 1.0f, c);
    const M chosen = select_triangles(s_, u_, t, c, exists);
    s_.branch(kStoreBlock, chosen, [&]() HWY_ATTR {
      const SssPattern<F> pattern = make_pattern<F, I>(u_, t, c, number);
      SurfacePoint<S> point(s_);
      set_gradients(t, c, point);
      s_.loop_each(kSampleBlock, to_int(pattern.count), chosen, [&](int i, M left) HWY_ATTR {
        s_.count(SssCounters::sss_point_samples, left);
        add_point(t, c, pattern.weight, pattern_place(pattern, i), left, point);
      });
    });
  }

 private:
  void load_corners(I triangle, M exists, SssCorner<F> (&c)[3]) {
    for (int v = 0; v < 3; ++v) {
      const I vertex = s_.load_buffer(kSssTriangleBuffer, triangle * I(3) + I(v), exists);
      auto& values = values_[static_cast<std::size_t>(v)];
      values.fill(F(0.0f));
      for (int k = 0; k < u_.vertex_words; ++k)
        values[static_cast<std::size_t>(k)] =
            bits_to_float(s_.load_buffer(kSssVertexBuffer, vertex * I(u_.vertex_words) + I(k), exists));
      transform(values);
      c[v].normal = {values[0], values[1], values[2]};
      c[v].position = {values[V::kPosition], values[V::kPosition + 1], values[V::kPosition + 2]};
      const Vec3<F>& p = c[v].position;
      const glm::mat4& m = u_.clip_from_world;
      const auto row = [&](int r) HWY_ATTR {
        return F(m[0][r]) * p.x + F(m[1][r]) * p.y + F(m[2][r]) * p.z + F(m[3][r]);
      };
      c[v].clip = {row(0), row(1), row(2), row(3)};
    }
  }

  void transform(std::array<F, V::kFull>& values) const {
    const auto rotate = [](const auto& m, std::array<F, V::kFull>& v, int at) HWY_ATTR {
      const auto k = static_cast<std::size_t>(at);
      const Vec3<F> in = {v[k], v[k + 1], v[k + 2]};
      for (int r = 0; r < 3; ++r)
        v[k + static_cast<std::size_t>(r)] = F(m[0][r]) * in.x + F(m[1][r]) * in.y + F(m[2][r]) * in.z;
    };
    rotate(draw_.normal_from_local, values, V::kNormal);
    rotate(draw_.world_from_local, values, V::kPosition);
    for (int r = 0; r < 3; ++r) {
      F& p = values[static_cast<std::size_t>(V::kPosition + r)];
      p = p + F(draw_.world_from_local[3][r]);
    }
    if (u_.vertex_words == V::kFull) rotate(draw_.world_from_local, values, V::kTangent);
    const Vec3<F> n = normalize(Vec3<F>{values[0], values[1], values[2]});
    values[0] = n.x;
    values[1] = n.y;
    values[2] = n.z;
  }

  void set_gradients(const SssTriangle<F>& t, const SssCorner<F> (&c)[3], SurfacePoint<S>& point) const {
    const auto of = [&](int k) HWY_ATTR {
      const auto i = static_cast<std::size_t>(k);
      return gradient(c, t.area2, values_[0][i], values_[1][i], values_[2][i]);
    };
    const Vec2<F> du = of(V::kUv0), dv = of(V::kUv0 + 1);
    point.site.du_dx = du.x;
    point.site.du_dy = du.y;
    point.site.dv_dx = dv.x;
    point.site.dv_dy = dv.y;
  }

  void add_point(const SssTriangle<F>& t, const SssCorner<F> (&c)[3], F weight, const Vec3<F>& b, M left,
                 SurfacePoint<S>& point) {
    const F x = b.x * c[0].x + b.y * c[1].x + b.z * c[2].x, y = b.x * c[0].y + b.y * c[1].y + b.z * c[2].y;
    const F z = b.x * c[0].z + b.y * c[1].z + b.z * c[2].z;
    const I px = point_pixel<I>(x), py = point_pixel<I>(y);
    const M outside = (x < F(0.0f)) | (y < F(0.0f)) | (z < F(0.0f)) | (z > F(1.0f));
    const M inside =
        (!outside) & (I(-1) < px) & (I(-1) < py) & (px < I(u_.width_px)) & (py < I(u_.height_px));
    const DepthTest<F, I> test = depth_test<F, I>(u_, t, x - to_float(px), y - to_float(py), z);
    const F scene = s_.load_image(kSssDepthSlot, px, py, test.sample).x;
    const M seen = left & inside & !(test.depth > scene);
    s_.branch(kShadeBlock, seen, [&]() HWY_ATTR {
      const Vec3<F> w = perspective_weights(c, b);
      for (std::size_t k = 0; k < values_[0].size(); ++k) {
        const F value = w.x * values_[0][k] + w.y * values_[1][k] + w.z * values_[2][k];
        point.values[k] = k < 3 ? value * t.facing : value;
      }
      const SssVertex vertex = u_.vertex_words == V::kFull ? SssVertex::full : SssVertex::textured;
      const Vec3<F> color = light_point(s_, u_, point, vertex, seen);
      const F scale = kFloat ? weight : weight * F(u_.fixed_point_scale);
      const I first = (py * I(u_.width_px) + px) * I(4);
      const F sums[4] = {color.x, color.y, color.z, F(1.0f)};
      for (int k = 0; k < 4; ++k) {
        if constexpr (kFloat)
          s_.atomic_add_float(kSssSumBuffer, first + I(k), sums[k] * scale, seen);
        else
          s_.atomic_add(kSssSumBuffer, first + I(k), to_int(floor(sums[k] * scale + F(0.5f))), seen);
      }
    });
  }

  S& s_;
  const SssUniforms& u_;
  const SssDraw& draw_;
  std::array<F, V::kFull> values_[3];
};

/// One pass through every block, for the operation counts.
template <bool kFloat>
pipeline::ComputeProgram describe_sss_compute(const SssComputeVariant& variant,
                                              void (*run)(pipeline::GroupBatch&, const void*)) {
  lanes::CountFragment s;
  SssUniforms u;
  u.vertex_words =
      variant.full_vertices ? pipeline::SurfaceVaryings::kFull : pipeline::SurfaceVaryings::kBasic;
  u.lighting.extended = variant.extended;
  const SssDraw draw;
  PointThread<lanes::CountFragment, kFloat>(s, u, draw).run(s.pixel_x(), s.pixel_y(), s.valid());
  pipeline::ComputeProgram program;
  program.name = kFloat ? "sss_compute_float" : "sss_compute";
  program.ordered_storage = s.ordered_storage();
  program.run = run;
  program.ops = s.blocks();
  program.block_count = s.block_count();
  program.group_width = pipeline::kBatchLanes;
  program.group_height = 1;
  return program;
}

inline pipeline::ComputeProgram describe_sss_clear(void (*run)(pipeline::GroupBatch&, const void*)) {
  lanes::CountFragment s;
  for (int i = 0; i < kSssClearWords; ++i)
    s.store_buffer(kSssHeadBuffer, s.pixel_x(), s.pixel_y(), s.valid());
  pipeline::ComputeProgram program;
  program.name = "sss_clear";
  program.run = run;
  program.ops = s.blocks();
  program.group_width = pipeline::kBatchLanes;
  program.group_height = 1;
  return program;
}

using lanes::ComputeLanes;
using lanes::kVectorLanes;
using lanes::LaneI;

/// body(context, lanes' numbers in the wave) for each register of the group's wave.
template <class Body>
void for_each_register(pipeline::GroupBatch& group, int count, Body&& body) {
  for (int first = 0; first < count; first += kVectorLanes) {
    HWY_ALIGN std::int32_t number[kVectorLanes];
    for (int lane = 0; lane < kVectorLanes; ++lane) number[lane] = first + lane;
    const LaneI n = lanes::load(number);
    ComputeLanes s(group, first, n, LaneI(0), LaneI(0), n < LaneI(count));
    body(s, n);
  }
  lanes::end_wave(group, count);
}

template <bool kFloat>
void run_points_group(pipeline::GroupBatch& group, const void* uniforms) {
  const auto& u = *static_cast<const SssUniforms*>(uniforms);
  const std::uint32_t* entry = group.resources->buffers[kSssGroupBuffer] + kSssGroupWords * group.group_x;
  const auto first = static_cast<std::int32_t>(entry[0]), count = static_cast<std::int32_t>(entry[1]);
  const SssDraw& draw = u.draws[entry[2]];
  const auto before = static_cast<std::int32_t>(entry[3]);
  group.material = group.resources->materials + draw.material;
  group.counters->mem.storage_read_bytes += 4 * kSssGroupWords;
  for_each_register(group, count, [&](ComputeLanes& s, LaneI n) HWY_ATTR {
    PointThread<ComputeLanes, kFloat>(s, u, draw).run(n + LaneI(first), n + LaneI(before), s.valid());
  });
}

void run_sss_compute(pipeline::GroupBatch& g, const void* u) { run_points_group<false>(g, u); }
void run_sss_compute_float(pipeline::GroupBatch& g, const void* u) { run_points_group<true>(g, u); }

void run_sss_clear(pipeline::GroupBatch& group, const void* uniforms) {
  const auto& u = *static_cast<const SssClearUniforms*>(uniforms);
  const int first = group.group_x * pipeline::kBatchLanes * kSssClearWords;
  for_each_register(group, pipeline::kBatchLanes, [&](ComputeLanes& s, LaneI n) HWY_ATTR {
    for (int i = 0; i < kSssClearWords; ++i) {
      const LaneI word = LaneI(first + i * pipeline::kBatchLanes) + n;
      s.store_buffer(0, word, LaneI(u.value), word < LaneI(u.words));
    }
    if (u.counter && group.group_x == 0) s.store_buffer(kSssCounterBuffer, n, LaneI(0), n < LaneI(1));
  });
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_sss_compute);
HWY_EXPORT(run_sss_compute_float);
HWY_EXPORT(run_sss_clear);

namespace {

pipeline::ComputeProgram describe_compute(const SssComputeVariant& variant) {
  if (variant.floats)
    return HWY_NAMESPACE::describe_sss_compute<true>(variant, [](pipeline::GroupBatch& g, const void* u) {
      HWY_DYNAMIC_DISPATCH(run_sss_compute_float)
      (g, u);
    });
  return HWY_NAMESPACE::describe_sss_compute<false>(variant, [](pipeline::GroupBatch& g, const void* u) {
    HWY_DYNAMIC_DISPATCH(run_sss_compute)
    (g, u);
  });
}

}  // namespace

const pipeline::ComputeProgram& sss_compute_program(const SssComputeVariant& variant) {
  static const auto programs = [] {
    std::array<pipeline::ComputeProgram, 8> all;
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = describe_compute({(i & 1) != 0, (i & 2) != 0, (i & 4) != 0});
    return all;
  }();
  return programs[(variant.floats ? 1u : 0u) + (variant.full_vertices ? 2u : 0u) +
                  (variant.extended ? 4u : 0u)];
}

const pipeline::ComputeProgram& sss_clear_program() {
  static const pipeline::ComputeProgram program =
      HWY_NAMESPACE::describe_sss_clear([](pipeline::GroupBatch& g, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_sss_clear)
        (g, u);
      });
  return program;
}

}  // namespace hwsim::algos
#endif
