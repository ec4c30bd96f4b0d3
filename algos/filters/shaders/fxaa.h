#pragma once
// FXAA 3.11 Quality and AXAA (docs/techniques/filters.md#fxaa): one shader, whose rules are switched by
// uniforms.
#include <array>

#include "pipeline/batch/program.h"

namespace hwsim::algos {

enum class AlphaMode { range, mid, absolute };

inline constexpr int kMaxFxaaSteps = 12;

struct FxaaUniforms {
  float subpix = 0.75f, edge_threshold = 0.166f, edge_threshold_min = 0.0833f;
  bool green_as_luma = false;  ///< luma is in green, otherwise in alpha
  int steps = 5;
  std::array<float, kMaxFxaaSteps> step_px = {1.0f, 1.5f, 2.0f, 4.0f, 12.0f};
  // AXAA's rules
  bool skip_filtered = false;    ///< 1: crosses with a value near their middle are filtered already
  bool keep_thin_lines = false;  ///< 2
  bool same_sign = false;        ///< rule 2 asks that both gradients point the same way
  bool adaptive_steps = false;   ///< 3
  bool metric_min = false;       ///< rule 3 takes the smaller contrast, as printed
  AlphaMode alpha_mode = AlphaMode::range;
  float alpha = 0.1f;
};

/// How the shader reads and writes its pixel.
struct FxaaPath {
  bool gather = true;    ///< lumas around the pixel by two gathers, as its Direct3D 11 path; else by loads
  bool discard = false;  ///< pixels that stay as they are are not written
};
/// Image slot 0: perceptual color.
const pipeline::FragmentProgram& fxaa_program(const FxaaPath& path);

struct NoUniforms {};
/// Image slot 0 with its luma in alpha, as a tone-mapping pass would leave it.
const pipeline::FragmentProgram& luma_program();

}  // namespace hwsim::algos
