#pragma once
// The vertex shaders of meshes. All of them compute the position by the same operations, so that depth is
// bit-identical between passes.
#include <glm/glm.hpp>

#include "pipeline/batch/program.h"
#include "pipeline/batch/uniforms.h"

namespace hwsim::pipeline {

/// Offsets of attribute scalars in the varyings of mesh_surface programs.
struct SurfaceVaryings {
  static constexpr int kNormal = 0;    ///< 3, world space, not normalized
  static constexpr int kUv0 = 3;       ///< 2
  static constexpr int kPosition = 5;  ///< 3, world space
  static constexpr int kTangent = 8;   ///< 4: xyz world space, w handedness
  static constexpr int kColor = 12;    ///< 4
  static constexpr int kUv1 = 16;      ///< 2
  static constexpr int kNormalOnly = 3, kNormalUv = 5, kBasic = 8, kFull = 18;
};

/// What mesh_geometry_program writes, for passes that need the primitive's plane and perhaps its alpha.
struct GeometryVaryings {
  static constexpr int kPosition = 0;  ///< 3, world space
  static constexpr int kUv0 = 3;       ///< 2, the base color texture's
  static constexpr int kCount = 5;
};

struct MeshVertexUniforms {
  glm::mat4 clip_from_world{1.0f};
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(ContentDigest& digest, const MeshVertexUniforms& uniforms) {
  const auto& [clip_from_world] = uniforms;
  digest.add(clip_from_world);
}

const VertexProgram& mesh_position_program();   ///< no varyings: depth passes
const VertexProgram& mesh_uv_program();         ///< the base color texture's, at 0: alpha-tested depth passes
const VertexProgram& mesh_normal_program();     ///< SurfaceVaryings up to kNormalOnly
const VertexProgram& mesh_normal_uv_program();  ///< SurfaceVaryings up to kNormalUv
const VertexProgram& mesh_geometry_program();   ///< GeometryVaryings
const VertexProgram& mesh_surface_program();    ///< SurfaceVaryings up to kBasic
const VertexProgram& mesh_full_program();       ///< SurfaceVaryings up to kFull

}  // namespace hwsim::pipeline
