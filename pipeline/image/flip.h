#pragma once
// FLIP: the difference that a viewer sees when two pictures are flipped.
#include "pipeline/image/channel.h"
#include "pipeline/image/image.h"

namespace hwsim::pipeline {

/// A viewer 0.7 m from a monitor 0.7 m and 3840 pixels wide, the setting of the FLIP paper.
inline constexpr double kFlipPixelsPerDegree = 67.0206432766;

/// LDR FLIP (Andersson et al. 2020), the error of each pixel in [0,1]. Linear images of the same size with
/// values in [0,1].
Channel flip_error(const Image& test, const Image& reference);

}  // namespace hwsim::pipeline
