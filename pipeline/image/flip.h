#pragma once
// FLIP: the difference that a viewer sees when two pictures are flipped.
#include <array>

#include "pipeline/image/channel.h"
#include "pipeline/image/image.h"

namespace hwsim::pipeline {

/// A viewer 0.7 m from a monitor 0.7 m and 3840 pixels wide, the setting of the FLIP paper.
inline constexpr double kFlipPixelsPerDegree = 67.0206432766;

/// What FLIP compares of an image. Linear, values in [0,1].
struct FlipSide {
  Channel edge, point;
  std::array<Channel, 3> lab;  ///< filtered as the eye does, chroma scaled by lightness
};
FlipSide flip_side(const Image& image, int jobs = 1);

/// LDR FLIP (Andersson et al. 2020), the error of each pixel in [0,1]. Images of the same size.
Channel flip_error(const FlipSide& test, const FlipSide& reference, int jobs = 1);

}  // namespace hwsim::pipeline
