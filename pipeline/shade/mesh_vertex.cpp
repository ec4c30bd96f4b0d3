#include "pipeline/shade/mesh_vertex.h"

#include "pipeline/emulate/fragment_batch.h"
#include "pipeline/shade/count_lane.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/shade/mesh_vertex.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/lanes-inl.h"
#include "pipeline/shade/vec-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

enum class MeshOutput { position, uv, geometry, normal, normal_uv, surface, full };

/// S offers F, the attributes and matrices, and the outputs: VertexLanes below, or CountVertex.
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
      constexpr int kSet = kOutput == MeshOutput::normal_uv ? S::kAlphaUv : S::kUv;
      s.varying(V::kUv0, s.attribute(kSet, 0));
      s.varying(V::kUv0 + 1, s.attribute(kSet, 1));
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

/// Attribute names, in the order of VertexBatch.
struct VertexAttributes {
  static constexpr int kPosition = 0, kNormal = 1, kTangent = 2, kUv = 3, kColor = 4, kUv1 = 5, kAlphaUv = 6;
};

class CountVertex : public VertexAttributes {
 public:
  using F = CountF;
  F attribute(int, int) { return F(CountValue{&recorder_, recorder_.add(OpKind::value, {-1, -1, -1})}); }
  Vec3<F> attribute3(int a) { return {attribute(a, 0), attribute(a, 1), attribute(a, 2)}; }
  F constant(float c) { return F(c); }
  F world(int, const Vec3<F>& v) { return ((F(1.0f) * v.x + F(1.0f) * v.y) + F(1.0f) * v.z) + F(1.0f); }
  F world_direction(int, const Vec3<F>& v) { return (F(1.0f) * v.x + F(1.0f) * v.y) + F(1.0f) * v.z; }
  F normal(int row, const Vec3<F>& v) { return world_direction(row, v); }
  void clip(int, F value) { recorder_.add(OpKind::output, {value.op, -1, -1}); }
  void varying(int index, F value) {
    recorder_.add(OpKind::output, {value.op, -1, -1});
    varyings_ = std::max(varyings_, index + 1);
  }
  ShaderOps ops() const { return recorder_.finish()[0]; }
  int varyings() const { return varyings_; }

 private:
  OpRecorder recorder_;
  int varyings_ = 0;
};

class VertexLanes : public VertexAttributes {
 public:
  using F = LaneF;
  VertexLanes(VertexBatch& batch, int first) : b_(batch), first_(first) {}

  F attribute(int attribute, int component) const {
    switch (attribute) {
      case kPosition:
        return load(b_.position[component] + first_);
      case kNormal:
        return load(b_.normal[component] + first_);
      case kTangent:
        return load(b_.tangent[component] + first_);
      case kUv:
        return load(b_.uv0[component] + first_);
      case kUv1:
        return load(b_.uv1[component] + first_);
      case kAlphaUv:
        return load((b_.alpha_uv_set == 1 ? b_.uv1 : b_.uv0)[component] + first_);
      default:
        return load(b_.color[component] + first_);
    }
  }
  Vec3<F> attribute3(int a) const { return {attribute(a, 0), attribute(a, 1), attribute(a, 2)}; }
  F constant(float c) const { return F(c); }
  F world(int row, const Vec3<F>& v) const {
    return world_direction(row, v) + F(b_.world_from_local[12 + row]);
  }
  F world_direction(int row, const Vec3<F>& v) const {
    const float* m = b_.world_from_local + row;
    return (F(m[0]) * v.x + F(m[4]) * v.y) + F(m[8]) * v.z;
  }
  F normal(int row, const Vec3<F>& v) const {
    const float* m = b_.normal_from_local + row;
    return (F(m[0]) * v.x + F(m[3]) * v.y) + F(m[6]) * v.z;
  }
  void clip(int row, F value) { store(value, b_.clip_position[row] + first_); }
  void varying(int index, F value) { store(value, b_.varyings[index] + first_); }

 private:
  VertexBatch& b_;
  int first_;
};

template <MeshOutput kOutput>
void run_mesh_vertex(VertexBatch& batch, const void* uniforms) {
  for (int first = 0; first < batch.count; first += kVectorLanes) {
    VertexLanes s(batch, first);
    MeshVertexShader<kOutput>::run(s, *static_cast<const MeshVertexUniforms*>(uniforms));
  }
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
  HWY_NAMESPACE::CountVertex counter;
  HWY_NAMESPACE::MeshVertexShader<kOutput>::run(counter, MeshVertexUniforms{});
  return {std::move(name), run, counter.ops(), counter.varyings(),
          [](const void* u) { return &static_cast<const MeshVertexUniforms*>(u)->clip_from_world; }};
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
