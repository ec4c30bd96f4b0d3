#pragma once
// Up to 16 quads on their way through a fragment shader: 64 lanes, four for each quad.
#include <array>
#include <cstdint>
#include <vector>

#include "hwsim/trace/counters.h"
#include "pipeline/access/access_tracker.h"
#include "pipeline/batch/program.h"
#include "pipeline/memory/gpu_image.h"
#include "pipeline/raster/triangle.h"
#include "pipeline/state/sample_pattern.h"
#include "pipeline/texture/texture_view.h"

namespace hwsim::pipeline {

inline constexpr int kBatchLanes = 64;
inline constexpr int kBatchQuads = 16;
inline constexpr int kMaxColorTargets = 8;
inline constexpr int kMaxImageSlots = 12;
inline constexpr int kMaxBufferSlots = 8;

/// Material state of a draw, as shaders see it.
struct MaterialView {
  float base_color[4] = {1, 1, 1, 1};
  float emissive[3] = {0, 0, 0};
  float metallic = 1.0f, roughness = 1.0f, normal_scale = 1.0f, occlusion_strength = 1.0f,
        alpha_cutoff = 0.5f;
  bool alpha_test = false;
  bool double_sided = false;
  bool unlit = false;       ///< seen in its base color, whatever the light
  bool has_colors = false;  ///< a mesh that uses it has vertex colors
  int index = 0;
  const TextureView* base_color_texture = nullptr;  ///< null: none
  const TextureView* metallic_roughness_texture = nullptr;
  const TextureView* normal_texture = nullptr;
  const TextureView* emissive_texture = nullptr;
  const TextureView* occlusion_texture = nullptr;
};

/// A depth image's tiles as planes, where they are held so. Reading texels leaves the planes in place.
struct DepthPlaneView {
  const GpuImage* image = nullptr;        ///< null: the pass reads none
  std::vector<std::uint8_t> plane_count;  ///< one number a tile; 0: not held as planes
};

/// Image and buffer slots of a pass.
struct ResourceView {
  std::array<const GpuImage*, kMaxImageSlots> images{};
  std::array<Format, kMaxImageSlots> formats{};           ///< as programs read them
  std::array<GpuImage*, kMaxColorTargets> targets{};      ///< images that programs store to
  std::array<Format, kMaxColorTargets> target_formats{};  ///< as they store to them
  std::array<std::uint32_t*, kMaxBufferSlots> buffers{};
  std::array<std::uint64_t, kMaxBufferSlots> buffer_words{};
  const MaterialView* materials = nullptr;  ///< the scene's, in its order
  const DepthPlaneView* depth_planes = nullptr;
  std::array<std::uint32_t, kMaxImageSlots> image_first_line{};  ///< after the lines of the textures
  AccessTracker* tracker = nullptr;                              ///< the worker's own
};

/// How often each lane went through each block of a shader (a loop's body: once for each iteration).
struct BlockTrips {
  alignas(64) std::array<std::array<std::int32_t, kBatchLanes>, kMaxBlocks> trips;
  std::uint32_t used =
      0;  ///< bit b: trips[b] has been started; others hold garbage. Block 0 is not kept: all lanes, once
};

/// Unfiltered texels, by size: the texture unit's rate depends on it.
struct TexelCounts {
  std::uint64_t bits32 = 0, bits64 = 0, bits128 = 0;  ///< bits32: and smaller
  void add(std::uint64_t texels, int bytes_per_texel) {
    (bytes_per_texel <= 4 ? bits32 : bytes_per_texel <= 8 ? bits64 : bits128) += texels;
  }
};

/// A texel that a fragment program stores to a target of its pass. Stores take effect when the pass ends,
/// target by target, in the order of screen bins, batches and lanes: so the last one does not depend on
/// threads.
struct ImageStore {
  std::uint64_t order = 0;  ///< bin, batch, lane
  std::uint32_t target = 0, texel = 0, word = 0;
};

struct FragmentBatch {
  int quad_count = 0;              ///< quads whose fields below are set
  std::uint64_t valid_lanes = 0;   ///< lanes of quads that run, helpers included
  std::uint64_t active_lanes = 0;  ///< valid lanes that are fragments
  int sample_index = -1;           ///< sample-rate shading: the sample; -1 at pixel rate
  int layer = 0;                   ///< the layer of the attachments that is drawn to
  float texture_footprint = 1.0f;  ///< RasterState's

  // One value a quad
  std::array<std::int32_t, kBatchQuads> quad_x, quad_y;  ///< top left pixel
  std::array<const float*, kBatchQuads>
      varyings[3];  ///< the three vertices' values; null in full-screen passes
  std::array<std::uint32_t, kBatchQuads> primitive;
  std::array<bool, kBatchQuads> front_facing;
  std::array<const RasterTriangle*, kBatchQuads> triangle;

  // One value a lane
  alignas(64) std::array<float, kBatchLanes> b1,
      b2;  ///< perspective-correct barycentrics at the shading point
  alignas(64) std::array<float, kBatchLanes> b1_center, b2_center;  ///< at the pixel center, for derivatives
  alignas(64) std::array<std::int32_t, kBatchLanes> pixel_x, pixel_y;
  alignas(64) std::array<std::uint32_t, kBatchLanes> coverage;  ///< bit s: sample s, as the shader sees it
  alignas(64) std::array<std::uint32_t, kBatchLanes> primitive_coverage;  ///< before depth and stencil

  const MaterialView* material = nullptr;
  const ResourceView* resources = nullptr;
  PassCounters* counters = nullptr;  ///< the current chunk's

  std::vector<ImageStore>* stores = nullptr;  ///< the worker's own
  std::uint64_t store_order = 0;              ///< the batch's place, with room for the lane

  // Results
  alignas(64) float depth[kBatchLanes];  ///< set by programs that write it
  alignas(64) float color[kMaxColorTargets][4][kBatchLanes];
  alignas(64) std::array<std::uint32_t, kBatchLanes> output_mask;  ///< set by programs that write one
  std::uint64_t discarded_lanes = 0;
  BlockTrips blocks;
  std::uint64_t tex_bilinear_probes = 0;  ///< beyond the first of each request
  std::uint64_t image_probes = 0;         ///< filtered requests to the pass's images
  TexelCounts image_texels;               ///< unfiltered texels loaded from the pass's images
  std::uint64_t image_read_bytes = 0;     ///< read by probes and texels
  std::uint64_t storage_read_bytes = 0, storage_write_bytes = 0;  ///< the pass's buffers and stored texels
  std::uint64_t narrow_stores = 0;                                ///< stored texels of fewer than 32 bits
};

/// Up to 64 vertices in a vertex shader.
struct VertexBatch {
  int count = 0;
  alignas(64) float position[3][kBatchLanes];
  alignas(64) float normal[3][kBatchLanes];
  alignas(64) float tangent[4][kBatchLanes];
  alignas(64) float uv0[2][kBatchLanes];
  alignas(64) float uv1[2][kBatchLanes];
  int alpha_uv_set = 0;  ///< where the material's base color texture lies: 0 or 1
  alignas(64) float color[4][kBatchLanes];
  alignas(64) float radius[kBatchLanes];
  const float* world_from_local = nullptr;   ///< 4x4, column-major
  const float* normal_from_local = nullptr;  ///< 3x3, column-major: inverse transpose, not normalized

  alignas(64) float clip_position[4][kBatchLanes];
  static constexpr int kMaxVaryings = 24;
  alignas(64) float varyings[kMaxVaryings][kBatchLanes];
};

/// An addition of floats by an atomic unit: it rounds, so its place among the others is kept.
struct FloatAdd {
  int lane = 0, slot = 0;
  std::int32_t index = 0;
  float value = 0.0f;
};

/// A compute group. Its program runs phase after phase over all of the group's invocations; what would be a
/// barrier in a shader is the end of a phase here.
struct GroupBatch {
  int group_x = 0, group_y = 0;
  int width = 0, height = 0;              ///< invocations of the group
  int image_width = 0, image_height = 0;  ///< the pass's
  const ResourceView* resources = nullptr;
  std::uint32_t* group_memory = nullptr;   ///< zeroed before the group starts
  const MaterialView* material = nullptr;  ///< the program chooses one of the resources'
  const ComputeProgram* program = nullptr;
  PassCounters* counters = nullptr;
  BlockTrips blocks;                 ///< the current wave's 64 invocations
  std::vector<FloatAdd> float_adds;  ///< the current wave's; they take effect when it ends, lane by lane
};

}  // namespace hwsim::pipeline
