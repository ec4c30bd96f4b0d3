#pragma once
// Whether a finished frame shows anything: empty, burnt-out and black pictures come with no error of their
// own, and every figure computed from them is worthless.
#include <cstdint>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "pipeline/image/image.h"

namespace hwsim::pipeline {

/// Shares of the pixels; `white` and `black` are of those that do not show the background.
struct FrameLook {
  double drawn = 0.0;  ///< pixels unlike the background
  double white = 0.0;  ///< every channel at the end of its range
  double black = 0.0;  ///< every channel below code 2 of 255
};
FrameLook look_at(const Image& color, const glm::vec3& background);

/// Warnings, with how to go on: nothing is drawn (P001), more than half of what is drawn is white (P002) or
/// black (P003).
std::vector<Diagnostic> check_frame(const Image& color, const glm::vec3& background);

}  // namespace hwsim::pipeline
