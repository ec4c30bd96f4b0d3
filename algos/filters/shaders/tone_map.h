#pragma once
// Passes of tone mapping with bloom (docs/techniques/filters.md#tone_map).
#include "pipeline/batch/program.h"

namespace hwsim::algos {

/// A target pixel stands for factor x factor pixels of the source, fewer at its right and lower edge.
struct ReduceUniforms {
  int factor = 4;
  int width = 1, height = 1;  ///< that of the source
  float threshold = 0.0f;     ///< bright_program: what is darker is black
};
/// Mean luminance of image slot 0, in one channel.
const pipeline::FragmentProgram& luminance_program();
/// Mean of image slot 0, one channel.
const pipeline::FragmentProgram& mean_program();
/// Mean of what is brighter than the threshold in image slot 0.
const pipeline::FragmentProgram& bright_program();

inline constexpr int kBlurTaps = 9;
struct BlurUniforms {
  int dx = 1, dy = 0;         ///< from one tap to the next
  int width = 1, height = 1;  ///< that of the image
};
/// Nine weighted taps of image slot 0 along a line.
const pipeline::FragmentProgram& blur_program();

struct ToneMapUniforms {
  float key = 0.18f;  ///< what the frame's mean luminance becomes
  float bloom = 0.1f;
  int factor = 4;                         ///< pixels of the frame a pixel of slot 1, each axis
  int bloom_width = 1, bloom_height = 1;  ///< that of slot 1
};
/// Slot 0: linear light; slot 1: bloom, smaller; slot 2: one texel, the frame's mean luminance.
const pipeline::FragmentProgram& tone_map_program();

}  // namespace hwsim::algos
