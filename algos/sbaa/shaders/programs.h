#pragma once
// Programs of surface based anti-aliasing (docs/techniques/sbaa.md): visibility with primitive numbers, the
// analysis that chooses surfaces, their G-buffer records, and the shading of these.
#include <cmath>

#include "algos/base/shaders/gbuffer.h"
#include "algos/sbaa/shaders/counters.h"
#include "pipeline/batch/program.h"
#include "pipeline/batch/uniforms.h"

namespace hwsim::algos {

/// What the visibility pass keeps beside depth.
enum class SbaaSample : std::uint8_t {
  id,             ///< TOP
  id_and_normal,  ///< MERGE: a normal of four bytes
  packed          ///< MERGE: number and normal in one texel of four bytes
};

/// Numbers are truncated to `id_mask`; the bit above it says that something was drawn.
struct SbaaIdUniforms {
  int id_mask = 127;
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(pipeline::ContentDigest& digest, const SbaaIdUniforms& uniforms) {
  const auto& [id_mask] = uniforms;
  digest.add(id_mask);
}
/// Colors: the number; then the normal. Varyings: none or the texture coordinates for SbaaSample::id,
/// the normal and these otherwise.
const pipeline::FragmentProgram& sbaa_id_program(SbaaSample sample, bool alpha_test);

/// The n surfaces of a pixel: an image of two integer channels, the truncated number and the sample count, a
/// slot below the other. The count of slot 0 holds the pixel's background samples too, times
/// `background_unit`. Records lie in a buffer, [pixel][slot].
struct SbaaSurfaces {
  int width = 1, height = 1;
  int slots = 1;
  int background_unit = 16;
  int record_words = 8;
};

struct SbaaAnalysisUniforms {
  SbaaSurfaces surfaces;
  int samples = 1;
  int id_mask = 127;
  float cos_alpha = 0.980785f;  ///< MERGE: samples with normals closer than this may be one surface
  float end_region = 0.25f;     ///< MERGE: share of the depth range at each end
  bool linear_depth = false;    ///< MERGE: distances instead of stored depth
  bool empty_exit = false;      ///< pixels that nothing was drawn to look for no surface
  glm::mat4 view_from_clip{1.0f};
};
/// Image slots: number (with the normal if packed), normal, depth. Target: the surfaces.
const pipeline::ComputeProgram& sbaa_analysis_program(SbaaSample sample, int id_bits);

inline constexpr int kLeastRecordBytes = 12, kFullRecordBytes = 32, kLargestRecordBytes = 64;

struct SbaaGBufferUniforms {
  SbaaSurfaces surfaces;
  int id_mask = 127;
  bool full_varyings = false;
  bool extended = false;  ///< LightingUniforms::extended
  glm::mat4 clip_from_world{1.0f}, view_from_world{1.0f};
};
/// Image slot 0: the surfaces. Writes the records of fragments that were chosen to buffer 0: the attachments
/// of GBufferEncoding::record; below 32 bytes depth instead of position; below 16 no emission.
/// Here and below, `extended` is the lighting's.
const pipeline::FragmentProgram& sbaa_gbuffer_program(bool full_record, bool full_varyings, bool alpha_test,
                                                      bool extended = false);

struct SbaaShadeUniforms {
  DeferredUniforms frame;
  SbaaSurfaces surfaces;
  bool weigh_background = true;
};
/// Image slot 0: the surfaces. Buffer 0: the records. Color: the mean of the surfaces by their samples.
const pipeline::FragmentProgram& sbaa_shade_program(bool full_record, bool extended = false);

}  // namespace hwsim::algos
