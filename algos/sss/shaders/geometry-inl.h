// What geometry shaders of selective supersampling share: their kind, and the triangle that they are given.
// Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include "algos/sss/shaders/view-inl.h"
#include "pipeline/shade/geometry_lanes-inl.h"
#if defined(HWSIM_ALGOS_SSS_SHADERS_GEOMETRY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_SSS_SHADERS_GEOMETRY_INL_H_
#undef HWSIM_ALGOS_SSS_SHADERS_GEOMETRY_INL_H_
#else
#define HWSIM_ALGOS_SSS_SHADERS_GEOMETRY_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

template <SssVertex kVertex, pipeline::GeometryOutput kWhat, int kMost>
struct SssGeometryShader {
  using Uniforms = SssUniforms;
  static constexpr pipeline::GeometryOutput kOutput = kWhat;
  static constexpr int kMaxVertices = kMost;
  static constexpr int kInputScalars =
      kVertex == SssVertex::full ? pipeline::SurfaceVaryings::kFull : pipeline::SurfaceVaryings::kBasic;

  /// emit(corners, triangle, chosen) for triangles that are to be sampled in this view.
  template <class S, class Emit>
  static void for_chosen(S& s, const SssUniforms& u, Emit&& emit) {
    using F = typename S::F;
    using V = pipeline::SurfaceVaryings;
    SssCorner<F> c[3];
    for (int v = 0; v < 3; ++v) {
      c[v].clip = s.clip_position(v);
      c[v].normal = normalize(s.attr3(v, V::kNormal));
      c[v].position = s.attr3(v, V::kPosition);
    }
    const SssTriangle<F> t = measure_triangle(s, u, s.winding(), c);
    const auto chosen = select_triangles(s, u, t, c, s.valid());
    s.branch(kStoreBlock, chosen, [&]() HWY_ATTR { emit(c, t, chosen); });
  }
};

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
