#pragma once
// Pictures as 8-bit sRGB codes, and back.
#include "pipeline/image/image.h"
#include "pipeline/image/image_io.h"

namespace hwsim::pipeline {

/// The image as 8-bit sRGB targets and files hold it: nearest codes, what is outside of [0,1] clamped,
/// opaque.
RawImage srgb_codes(const Image& linear);
/// Linear values of sRGB codes; alpha 1.
Image linear_image(const RawImage& codes);

}  // namespace hwsim::pipeline
