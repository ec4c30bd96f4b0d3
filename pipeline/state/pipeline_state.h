#pragma once
// Fixed-function state of a draw or full-screen pass, as a driver would set it.
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace hwsim::pipeline {

enum class Compare : std::uint8_t {
  never,
  less,
  equal,
  less_equal,
  greater,
  not_equal,
  greater_equal,
  always
};
enum class StencilOp : std::uint8_t {
  keep,
  zero,
  replace,
  increment_saturate,
  decrement_saturate,
  invert,
  increment_wrap,
  decrement_wrap
};
/// A viewport's shift from the pass's own, in 1/256 pixel (x right, y down): the geometry moves by it.
/// Snapped vertices shift exactly.
struct ViewportShift {
  std::int32_t x = 0;
  std::int32_t y = 0;
};
inline constexpr std::size_t kMaxViewports = 16;

enum class CullMode : std::uint8_t { none, back, front };
enum class BlendFactor : std::uint8_t {
  zero,
  one,
  src_alpha,
  one_minus_src_alpha,
  dst_alpha,
  one_minus_dst_alpha,
  src_color,
  dst_color
};
/// Points are squares of primitive_size_px centered on their vertex, never culled; line strips are rectangles
/// of that width along each segment (wires that are drawn without geometry of their own).
enum class Topology : std::uint8_t { triangles, points, line_strip };

struct DepthState {
  bool test = false;
  bool write = false;
  Compare compare = Compare::less;
};

struct StencilState {
  bool test = false;
  Compare compare = Compare::always;
  std::uint8_t reference = 0;
  std::uint8_t read_mask = 0xff;
  std::uint8_t write_mask = 0xff;
  StencilOp on_fail = StencilOp::keep;
  StencilOp on_depth_fail = StencilOp::keep;
  StencilOp on_pass = StencilOp::keep;
};

/// result = src * src_factor + dst * dst_factor, one pair for color and alpha each; write_mask bit 0 is red.
struct BlendState {
  bool enabled = false;
  BlendFactor src_color = BlendFactor::one, dst_color = BlendFactor::zero;
  BlendFactor src_alpha = BlendFactor::one, dst_alpha = BlendFactor::zero;
  std::uint8_t write_mask = 0xf;
};

/// A sample's offset from the pixel center in 1/16 pixel, -8..7 (docs/techniques/conventions.md#samples).
struct SamplePosition {
  std::int8_t x = 0;
  std::int8_t y = 0;
};

struct RasterState {
  Topology topology = Topology::triangles;
  float primitive_size_px = 1.0f;  ///< points and line strips
  CullMode cull = CullMode::back;
  bool conservative = false;  ///< every pixel that the triangle touches counts as wholly covered
  bool centroid = false;      ///< attributes of partly covered pixels are taken inside the triangle
  bool sample_rate = false;   ///< the shader runs once for each covered sample
  std::vector<SamplePosition> sample_positions;  ///< empty: the standard pattern of the sample count
  /// The part of a pixel that textures are filtered for: less where several shadings share a pixel, as a
  /// sampler's bias of log2(this).
  float texture_footprint = 1.0f;
};

/// How a fragment's coverage reaches its shader and leaves it (docs/techniques/conventions.md#coverage,
/// docs/techniques/forward.md#alpha-to-coverage).
struct CoverageState {
  bool post_depth =
      false;  ///< shaders read what early tests left, which must be forced; else the primitive's
  bool override_output = false;    ///< a shader's output mask replaces the coverage; else it is ANDed
  bool alpha_to_coverage = false;  ///< by color 0's alpha; without effect if the shader writes a mask
  bool alpha_dither = true;        ///< alpha to coverage dithers over 2x2 pixels
};

struct PipelineState {
  DepthState depth;
  StencilState stencil;
  RasterState raster;
  CoverageState coverage;
  std::vector<BlendState> blend;  ///< one a color attachment; missing ones are opaque
  bool force_early_z = false;     ///< [earlydepthstencil]
};

}  // namespace hwsim::pipeline
