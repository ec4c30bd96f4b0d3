#pragma once
// Shader programs as the emulator sees them: functions over batches of lanes, and what one lane's work is.
// The functions come from templates over a lane type (simd/lanes-inl.h); the costs from the same templates
// run once on a counting type (shade/count_lane.h). There is no hand-written cost table.
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace hwsim::pipeline {

/// Operations of one lane in one pass through a block of a shader.
struct ShaderOps {
  std::uint32_t alu =
      0;  ///< add, multiply, fused multiply-add, compare, select, min, max, integer, conversion
  std::uint32_t sfu = 0;         ///< reciprocal, square root, exp2, log2, sine, cosine
  std::uint32_t interp = 0;      ///< attribute scalars
  std::uint32_t tex = 0;         ///< filtered texture requests
  std::uint32_t gather = 0;      ///< one channel of 2x2 texels
  std::uint32_t comparison = 0;  ///< 2x2 texels, compared and filtered
  std::uint32_t load = 0;        ///< 32-bit words loaded from buffers
  std::uint32_t store = 0;
  std::uint32_t atomic = 0;
  std::uint32_t group_memory = 0;

  std::uint32_t alu_chain = 0;     ///< longest chain of operations that wait for each other
  std::uint32_t memory_chain = 0;  ///< longest chain of texture requests, loads and atomics
  std::uint32_t vliw5_words = 0;   ///< five-slot words at best: slots, t slots and the chain bound them
  std::uint32_t registers = 0;     ///< values alive at once, in block 0 for the whole shader
};

/// A shader is cut into blocks at its branches and loops. Block 0 runs for every lane.
inline constexpr int kMaxBlocks = 17;
using BlockOps = std::array<ShaderOps, kMaxBlocks>;

struct FragmentBatch;  // batch/fragment_batch.h
struct VertexBatch;    // likewise
struct GroupBatch;     // likewise
struct GeometryBatch;  // batch/geometry_batch.h

struct VertexProgram {
  std::string name;
  void (*run)(VertexBatch& batch, const void* uniforms) = nullptr;
  ShaderOps ops;
  int varying_scalars = 0;  ///< values written for the rasterizer to interpolate
  /// The matrix by which the program transforms world positions; null when it also moves them, so that a
  /// mesh's bounds do not bound what is drawn.
  const glm::mat4* (*clip_from_world)(const void* uniforms) = nullptr;
};

enum class GeometryOutput { points, triangle_strip };

/// Runs on assembled triangles, between the vertex program and set-up.
struct GeometryProgram {
  std::string name;
  void (*run)(GeometryBatch& batch, const void* uniforms) = nullptr;
  BlockOps ops{};
  int block_count = 1;
  GeometryOutput output = GeometryOutput::triangle_strip;
  int max_vertices = 3;     ///< emitted for one triangle at most; further ones are dropped
  int input_scalars = 0;    ///< must equal the vertex program's varying_scalars
  int varying_scalars = 0;  ///< written for each vertex
};

struct FragmentProgram {
  std::string name;
  void (*run)(FragmentBatch& batch, const void* uniforms) = nullptr;
  BlockOps ops{};
  int block_count = 1;
  int color_outputs = 1;
  int varying_scalars = 0;   ///< must equal those of the vertex program; 0 for full-screen programs
  bool can_discard = false;  ///< depth writes wait for the shader unless early tests are forced
  bool writes_storage = false;
  bool writes_depth = false;     ///< full-screen passes: gives each fragment its depth
  bool ordered_storage = false;  ///< what it stores depends on the order of fragments
  bool reads_coverage = false;   ///< asks for its lanes' covered samples
  bool writes_mask = false;      ///< gives each lane a sample mask (pipeline_state.h, CoverageState)
};

struct ComputeProgram {
  std::string name;
  void (*run)(GroupBatch& group, const void* uniforms) = nullptr;
  BlockOps ops{};
  int block_count = 1;
  int group_width = 16, group_height = 16;  ///< invocations
  int group_memory_bytes = 0;
  bool leaves_group_memory_zero = false;  ///< clears what it used: no group finds another one's values
  bool ordered_storage = false;           ///< what it stores depends on the order of groups
};

}  // namespace hwsim::pipeline
