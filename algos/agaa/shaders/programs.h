#pragma once
// Aggregate G-buffer anti-aliasing (docs/techniques/agaa.md; Crassin et al. 2016).
#include <array>
#include <glm/glm.hpp>

#include "algos/agaa/shaders/counters.h"
#include "hwsim/trace/format.h"
#include "pipeline/batch/program.h"
#include "pipeline/batch/uniforms.h"
#include "pipeline/shade/lighting.h"
#include "pipeline/state/pipeline_state.h"

namespace hwsim::algos {

enum class Ndf { toksvig, lean, sggx };
/// Which sample becomes a seed beyond the second: the one whose nearest seed is farthest, or the one with the
/// largest sum of distances to the seeds, or of their squares.
enum class SeedRule { farthest, sums, square_sums };
enum class DiffuseFilter { off, folded, geometric, samples };

/// The center rays of pixels: at view depth d pixel (x, y) sees, relative to the eye,
///   origin + x * origin_per_x + y * origin_per_y + d * (first + x * per_x + y * per_y).
struct PixelRays {
  glm::vec3 first{0.0f, 0.0f, -1.0f}, per_x{0.0f}, per_y{0.0f};
  glm::vec3 origin{0.0f}, origin_per_x{0.0f}, origin_per_y{0.0f};
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(pipeline::ContentDigest& digest, const PixelRays& uniforms) {
  const auto& [first, per_x, per_y, origin, origin_per_x, origin_per_y] = uniforms;
  digest.add(first, per_x, per_y, origin, origin_per_x, origin_per_y);
}

/// The render targets of an aggregate, by what they hold; -1: none.
struct AggregateTargets {
  int shape = 0;  ///< Toksvig vector and Y'; LEAN b and M's diagonal; SGGX diagonal and Sxy
  int albedo = 1;
  int chroma = 2;               ///< Cb, Cr, emissive, and the mask's first byte or the sample count
  int shape_rest = -1;          ///< LEAN Mxy and Y'; SGGX Sxz, Syz
  int luma = -1;                ///< SGGX: Y'
  int geometric = -1;           ///< mean of unit normals, mean gloss
  int moments = -1;             ///< means of view depth and of its square
  int mask_1 = -1;              ///< the mask's second byte
  int mask_2 = -1;              ///< its third and fourth
  int mask_word = -1;           ///< all four, in a target of their own
  bool counts_samples = false;  ///< chroma's byte counts samples instead of naming them
};

/// Attributes of fragments and aggregates that passes 3, 3m and 4 agree on.
struct AggregateUniforms {
  AggregateTargets targets;
  Ndf ndf = Ndf::toksvig;
  PixelRays rays;
  float gloss_reference = 0.0f;   ///< S of docs/techniques/agaa.md#shading; 0: infinite
  float least_exponent = 0.125f;  ///< a lobe so wide that its Toksvig vector would vanish keeps this
  float matte_exponent = 0.0f;    ///< added to exponents by the share of light that is diffuse
  /// The specular color is stored times what its lobe reflects in total, over this, the most that one does;
  /// 0: as it is.
  float most_energy = 0.0f;
  float most_chroma_energy = 2.0f;  ///< the same for its chroma, of eight bits; more is cut, hues stay
  int samples = 8;                  ///< samples of all layers together
  int code_bits = 1;                ///< bits of a sample's code; 0: there is one aggregate
  int width = 1;                    ///< width of the frame in pixels: addresses of the storage buffer
};

struct VisibilityUniforms {
  PixelRays rays;
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(pipeline::ContentDigest& digest, const VisibilityUniforms& uniforms) {
  const auto& [rays] = uniforms;
  digest.add(rays);
}
/// Pass 1: the primitive's normal as a rg8_unorm code; with `alpha`, the base color's alpha for coverage.
const pipeline::FragmentProgram& agaa_visibility_program(bool alpha);

struct DefineUniforms {
  glm::mat4 view_from_clip{1.0f};
  int width = 1, height = 1, samples = 8, aggregates = 2, code_bits = 1;
  std::array<pipeline::SamplePosition, 32> positions{};
  float inv_k2 = 100.0f;     ///< 1 / k^2, per m^2
  float footprint_k = 0.0f;  ///< k_mode footprint: k grows to this times the distance; 0: it does not
  bool perspective = true;
  float separation = 0.02f;  ///< t
  bool unit_mean_normal = true;
  SeedRule seeds = SeedRule::farthest;
  bool empty_exit = false;    ///< pixels without a surface are left after their samples were read
  bool reads_planes = false;  ///< tiles that depth compression holds as few planes take those for aggregates
  int layers = 1;             ///< layers of the depth image, with equal parts of the samples
  std::array<glm::vec2, 4> layer_shift_px{};  ///< by how much a layer's viewport moves what it shows
};
/// Pass 2: image 0 depth, 1 normal codes; target 0 the codes, eight samples a layer.
const pipeline::ComputeProgram& agaa_define_program();

struct GenerateUniforms {
  AggregateUniforms aggregate;
  bool full_varyings = false;
  int color_samples = 2;       ///< samples of the targets: one for each aggregate
  int raster_samples = 8;      ///< samples of a layer
  glm::vec4 view_z_row{0.0f};  ///< view depth of world positions
};
/// Pass 3: image 0 the codes. Into color targets by blending, or by atomics into a storage buffer.
const pipeline::FragmentProgram& agaa_generate_program(Ndf ndf, bool full_varyings, bool atomic);

/// 32-bit words of an aggregate in the storage buffer, and the fixed-point unit.
inline constexpr int kAggregateWords = 18;
inline constexpr float kFixedPoint = 1048576.0f;

struct MergeLayersUniforms {
  AggregateTargets from, to;
  int width = 1, height = 1, layers = 1, color_samples = 2, aggregates = 2;
};
/// Pass 3m: sums the records of the layers and joins their masks.
const pipeline::ComputeProgram& agaa_merge_program();

inline constexpr int kMaxShadowTaps = 8, kMaxVisibleNormals = 32;
struct ShadeUniforms {
  AggregateUniforms aggregate;
  pipeline::LightingUniforms lighting;
  glm::mat4 eye_from_clip{1.0f};  ///< to world axes around the eye
  glm::vec3 background{0.0f};
  int height = 1, aggregates = 2;
  int depth_slot = 3, code_slot = 4, normal_slot = 5;  ///< image slots; the targets come first
  std::array<pipeline::SamplePosition, 32> positions{};
  DiffuseFilter diffuse = DiffuseFilter::folded;
  bool separate_gloss = false, light_variance = false;
  bool on_receiver =
      false;  ///< shadows: the axis along which places go with depths; else along the pixel's ray
  bool covariance = false;  ///< covariance of the samples' places is used; else that of their depths alone
  glm::vec4 depth_of_z{0.0f, 1.0f, 1.0f, 0.0f};  ///< view depth of z: (x + y z) / (z + w z)
  int shadow_taps = 4;
  std::array<float, kMaxShadowTaps> tap_position{}, tap_weight{};
  int visible_normals = 8;
  std::array<glm::vec3, kMaxVisibleNormals> disk{};  ///< points on the hemisphere over the unit disk
};
/// What of its uniforms the shader's operations depend on; `buffer`: aggregates are in a storage buffer.
struct ShadeVariant {
  Ndf ndf = Ndf::toksvig;
  bool buffer = false, on_receiver = false, extended = false;
};
/// Pass 4: lights every aggregate and puts them over the background.
const pipeline::FragmentProgram& agaa_shade_program(const ShadeVariant& variant);

}  // namespace hwsim::algos
