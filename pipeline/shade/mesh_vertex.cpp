#include "pipeline/shade/mesh_vertex.h"

#include "pipeline/batch/fragment_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/shade/mesh_vertex.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/vertex_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

enum class MeshOutput { position, uv, geometry, normal, normal_uv, surface, full };

/// S offers F, the attributes and matrices, and the outputs (shade/vertex_lanes-inl.h).
template <MeshOutput kOutput>
struct MeshVertexShader {
  template <class S>
  static void run(S& s, const MeshVertexUniforms& u) {
    using F = typename S::F;
    using V = SurfaceVaryings;
    const Vec3<F> local = s.attribute3(s.kPosition);
    const Vec3<F> world = {s.world(0, local), s.world(1, local), s.world(2, local)};
    const glm::mat4& m = u.clip_from_world;
    for (int row = 0; row < 4; ++row)
      s.clip(row, ((s.constant(m[0][row]) * world.x + s.constant(m[1][row]) * world.y) +
                   s.constant(m[2][row]) * world.z) +
                      s.constant(m[3][row]));
    if constexpr (kOutput == MeshOutput::uv) {
      s.varying(0, s.attribute(s.kAlphaUv, 0));
      s.varying(1, s.attribute(s.kAlphaUv, 1));
    }
    if constexpr (kOutput == MeshOutput::geometry) {
      using G = GeometryVaryings;
      s.varying(G::kPosition, world.x);
      s.varying(G::kPosition + 1, world.y);
      s.varying(G::kPosition + 2, world.z);
      s.varying(G::kUv0, s.attribute(s.kAlphaUv, 0));
      s.varying(G::kUv0 + 1, s.attribute(s.kAlphaUv, 1));
    }
    if constexpr (kOutput >= MeshOutput::normal) {
      const Vec3<F> n = s.attribute3(s.kNormal);
      for (int row = 0; row < 3; ++row) s.varying(V::kNormal + row, s.normal(row, n));
    }
    if constexpr (kOutput >= MeshOutput::normal_uv) {
      s.varying(V::kUv0, s.attribute(s.kUv, 0));
      s.varying(V::kUv0 + 1, s.attribute(s.kUv, 1));
    }
    if constexpr (kOutput >= MeshOutput::surface) {
      s.varying(V::kPosition, world.x);
      s.varying(V::kPosition + 1, world.y);
      s.varying(V::kPosition + 2, world.z);
    }
    if constexpr (kOutput == MeshOutput::full) {
      const Vec3<F> t = s.attribute3(s.kTangent);
      for (int row = 0; row < 3; ++row) s.varying(V::kTangent + row, s.world_direction(row, t));
      s.varying(V::kTangent + 3, s.attribute(s.kTangent, 3));
      for (int i = 0; i < 4; ++i) s.varying(V::kColor + i, s.attribute(s.kColor, i));
      s.varying(V::kUv1, s.attribute(s.kUv1, 0));
      s.varying(V::kUv1 + 1, s.attribute(s.kUv1, 1));
    }
  }
};

template <MeshOutput kOutput>
void run_mesh_vertex(VertexBatch& batch, const void* uniforms) {
  run_vertex_shader<MeshVertexShader<kOutput>>(batch, *static_cast<const MeshVertexUniforms*>(uniforms));
}
void run_position(VertexBatch& b, const void* u) { run_mesh_vertex<MeshOutput::position>(b, u); }
void run_uv(VertexBatch& b, const void* u) { run_mesh_vertex<MeshOutput::uv>(b, u); }
void run_normal(VertexBatch& b, const void* u) { run_mesh_vertex<MeshOutput::normal>(b, u); }
void run_normal_uv(VertexBatch& b, const void* u) { run_mesh_vertex<MeshOutput::normal_uv>(b, u); }
void run_geometry(VertexBatch& b, const void* u) { run_mesh_vertex<MeshOutput::geometry>(b, u); }
void run_surface(VertexBatch& b, const void* u) { run_mesh_vertex<MeshOutput::surface>(b, u); }
void run_full(VertexBatch& b, const void* u) { run_mesh_vertex<MeshOutput::full>(b, u); }

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::pipeline {
HWY_EXPORT(run_position);
HWY_EXPORT(run_uv);
HWY_EXPORT(run_normal);
HWY_EXPORT(run_normal_uv);
HWY_EXPORT(run_geometry);
HWY_EXPORT(run_surface);
HWY_EXPORT(run_full);

namespace {
using HWY_NAMESPACE::MeshOutput;

template <MeshOutput kOutput>
VertexProgram describe(std::string name, void (*run)(VertexBatch&, const void*)) {
  VertexProgram program = HWY_NAMESPACE::describe_vertex_shader<HWY_NAMESPACE::MeshVertexShader<kOutput>>(
      std::move(name), run, MeshVertexUniforms{});
  program.clip_from_world = [](const void* u) {
    return &static_cast<const MeshVertexUniforms*>(u)->clip_from_world;
  };
  return program;
}
}  // namespace

const VertexProgram& mesh_position_program() {
  static const VertexProgram program =
      describe<MeshOutput::position>("mesh_position", [](VertexBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_position)
        (b, u);
      });
  return program;
}
const VertexProgram& mesh_uv_program() {
  static const VertexProgram program = describe<MeshOutput::uv>("mesh_uv", [](VertexBatch& b, const void* u) {
    HWY_DYNAMIC_DISPATCH(run_uv)(b, u);
  });
  return program;
}
const VertexProgram& mesh_normal_program() {
  static const VertexProgram program =
      describe<MeshOutput::normal>("mesh_normal", [](VertexBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_normal)
        (b, u);
      });
  return program;
}
const VertexProgram& mesh_normal_uv_program() {
  static const VertexProgram program =
      describe<MeshOutput::normal_uv>("mesh_normal_uv", [](VertexBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_normal_uv)
        (b, u);
      });
  return program;
}
const VertexProgram& mesh_geometry_program() {
  static const VertexProgram program =
      describe<MeshOutput::geometry>("mesh_geometry", [](VertexBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_geometry)
        (b, u);
      });
  return program;
}
const VertexProgram& mesh_surface_program() {
  static const VertexProgram program =
      describe<MeshOutput::surface>("mesh_surface", [](VertexBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_surface)
        (b, u);
      });
  return program;
}
const VertexProgram& mesh_full_program() {
  static const VertexProgram program =
      describe<MeshOutput::full>("mesh_full", [](VertexBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_full)
        (b, u);
      });
  return program;
}

}  // namespace hwsim::pipeline
#endif
