#pragma once
// Shaders of selective shader supersampling (docs/techniques/sss.md).
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <type_traits>
#include <vector>

#include "algos/sss/shaders/counters.h"
#include "pipeline/graph/frame_graph.h"
#include "pipeline/shade/lighting.h"

namespace hwsim::algos {

/// Words of a list's node that has a mask of the pixel's places and the change of its depth.
inline constexpr int kSssPlaceNodeWords = 8;

enum class SssMode { both, either };  ///< small triangle and small highlight, or one of them

/// What of a vertex the samples need: by material, so that plain ones move fewer bytes.
enum class SssVertex { plain, textured, full };

/// body(std::integral_constant) of `vertex`: what is compiled for each kind of vertex.
template <class Body>
decltype(auto) with_vertex(SssVertex vertex, Body&& body) {
  switch (vertex) {
    case SssVertex::plain:
      return body(std::integral_constant<SssVertex, SssVertex::plain>());
    case SssVertex::textured:
      return body(std::integral_constant<SssVertex, SssVertex::textured>());
    case SssVertex::full:
      break;
  }
  return body(std::integral_constant<SssVertex, SssVertex::full>());
}
/// What `make`, as above, gives for each of them, in their order.
template <class Make>
auto for_each_vertex(Make&& make) {
  using Made = decltype(make(std::integral_constant<SssVertex, SssVertex::plain>()));
  return std::array<Made, 3>{make(std::integral_constant<SssVertex, SssVertex::plain>()),
                             make(std::integral_constant<SssVertex, SssVertex::textured>()),
                             make(std::integral_constant<SssVertex, SssVertex::full>())};
}

/// An instance's triangles for the compute variant.
struct SssDraw {
  glm::mat4 world_from_local{1.0f};
  glm::mat3 normal_from_local{1.0f};
  bool mirrored = false;
  int material = 0;
};

struct SssUniforms {
  pipeline::LightingUniforms lighting;  ///< the shadow map in slot kSssShadowSlot
  glm::mat4 clip_from_world{1.0f};
  int width_px = 1, height_px = 1;

  // Which triangles (docs/techniques/sss.md#classification)
  SssMode mode = SssMode::both;
  float triangle_px = 4.0f, highlight_px = 1.0f;
  bool early_exit = true;
  float threshold = 1.0f / 255.0f;
  bool counted = true;          ///< triangles count here: not where they are chosen once more, for marks
  float exponent_scale = 1.0f;  ///< Phong's exponent over the material's: a quarter for Blinn-Phong's
  bool normalized = false;      ///< the lobe has the factor (s + 8) / (8 pi)

  // How many samples, and where (docs/techniques/sss.md#points)
  float samples_per_px = 16.0f, samples_min = 4.0f, samples_max = 64.0f, border_share = 0.25f;
  float largest_px2 = 1e30f;  ///< a triangle on which points would lie too thinly
  float depth_bias = 0.0f, depth_slope = 1.0f;
  // The depth image's eight samples, four bits each from the lowest: the one nearest to each of 4x4 cells of
  // the pixel, row by row, and where they lie, in 1/16 px from the pixel's corner.
  std::array<std::int32_t, 2> nearest_samples{};
  std::int32_t samples_x = 0, samples_y = 0;
  std::array<std::int32_t, 8> neighbor_samples{};  ///< for each pixel around, its sample nearest to this one
  float radiance_max = 1.0f;                       ///< samples are clamped to it

  float fixed_point_scale = 1048576.0f;  // compute points (docs/techniques/sss.md#points)
  std::vector<SssDraw> draws = std::vector<SssDraw>(1);
  int vertex_words = 8;

  int grid = 4;  // lists (docs/techniques/sss.md#lists); 0: by the highlight's width
  int capacity_nodes = 0, node_words = 4, list_nodes_max = 32;
  bool conservative_raster = false;

  int mark_slot = -1;  ///< image of the frame's samples whose triangle was sampled, before that of the
                       ///< samples themselves; -1: none
  bool by_place() const { return node_words == kSssPlaceNodeWords; }
};

/// Samples of the frame below: shaders go through them one by one.
inline constexpr int kSssBaseSamples = 8;
/// And positions at which coverage is found, where the base has more than samples.
inline constexpr int kSssCoverageSamples = 32;

/// Image slots of the passes that sample.
inline constexpr int kSssDepthSlot = 0, kSssShadowSlot = 1;
/// Slots of composites: the frame, resolved or, with marks, multisampled; then what was accumulated.
inline constexpr int kSssFrameSlot = 0, kSssSumSlot = 1;

/// Who tests the depth of points from a geometry shader: the hardware, each of the frame's samples, or their
/// shader, one of them.
enum class SssPointDepth : std::uint8_t { fixed, shader };
const pipeline::GeometryProgram& sss_points_program(SssVertex vertex, SssPointDepth depth, int points_max);
/// Here and below, `extended` is the lighting's.
const pipeline::FragmentProgram& sss_point_shading_program(SssVertex vertex, SssPointDepth depth,
                                                           bool extended);

// Points from a compute shader. Buffers: triangles, vertices, groups, sums.
inline constexpr int kSssTriangleBuffer = 0, kSssVertexBuffer = 1, kSssGroupBuffer = 2, kSssSumBuffer = 3;
inline constexpr int kSssGroupWords = 4;  ///< first triangle, triangles, draw, first triangle in the draw
/// What the points of a frame take of the shader: sums by atomics of floats (GpuFeatures::float_atomics) or
/// by integer ones in fixed point; vertices with all attributes; LightingUniforms::extended.
struct SssComputeVariant {
  bool floats = false, full_vertices = false, extended = false;
};
const pipeline::ComputeProgram& sss_compute_program(const SssComputeVariant& variant);

/// Fills buffer 0 with a word, and buffer 2, if `counter`, with one zero.
struct SssClearUniforms {
  int words = 0;
  std::int32_t value = 0;
  bool counter = false;
};
inline constexpr int kSssClearWords = 4;  ///< words that an invocation clears

// Lists. Buffers: heads, nodes, the counter of nodes.
inline constexpr int kSssHeadBuffer = 0, kSssNodeBuffer = 1, kSssCounterBuffer = 2;
const pipeline::ComputeProgram& sss_clear_program();
const pipeline::GeometryProgram& sss_boxes_program(SssVertex vertex);
const pipeline::FragmentProgram& sss_list_program(SssVertex vertex, bool by_place, bool extended);
const pipeline::FragmentProgram& sss_list_resolve_program(bool by_place);

// The frame under what was sampled
const pipeline::GeometryProgram& sss_marks_program(SssVertex vertex);
const pipeline::FragmentProgram& sss_mark_program();
const pipeline::FragmentProgram& sss_composite_program();
const pipeline::FragmentProgram& sss_sum_composite_program(bool floats);

}  // namespace hwsim::algos
