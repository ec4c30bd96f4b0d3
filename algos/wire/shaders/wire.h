#pragma once
// Shaders of wire anti-aliasing (docs/techniques/wire.md).
#include "pipeline/batch/program.h"
#include "pipeline/shade/lighting.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {

/// How wires are lit and faded.
struct WireLook {
  float width_px = 1.0f;       ///< least width
  float full_light_px = 4.0f;  ///< from this width on a wire is lit as any surface
  bool half_lambert = false, flatten = false;
  int half_lambert_power = 2;
  bool fade_per_pixel = false;
};

struct WireVertexUniforms {
  glm::mat4 clip_from_world{1.0f};
  float pixel_scale = 0.0f;  ///< half the height of a pixel in the world where w = 1
  float width_px = 1.0f;
  bool bend = false;  ///< normals are flattened here, for fragment programs that know nothing of wires
  glm::vec3 eye{0.0f};
  float full_light_px = 4.0f;
};

struct WireUniforms {
  pipeline::LightingUniforms lighting;
  float pixel_scale = 0.0f;
  WireLook look;
};

/// Varyings beyond those of surfaces, all of which a wire has.
struct WireVaryings {
  static constexpr int kFade = pipeline::SurfaceVaryings::kFull, kRadius = kFade + 1, kW = kFade + 2,
                       kCount = kFade + 3;
};

enum class WirePart { all, wide, faded };  ///< fragments of wires above, or below, the least width

/// What the vertex program hands on: what the mesh programs of these names do, or all that wire_program
/// takes.
enum class WireOutput { position, normal, geometry, basic, full, wire };

const pipeline::VertexProgram& wire_vertex_program(WireOutput output);
/// `extended`: the lighting's.
const pipeline::FragmentProgram& wire_program(WirePart part, bool extended);

}  // namespace hwsim::algos
