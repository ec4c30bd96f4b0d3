#pragma once
// The error of an image where its reference has edges: over a whole frame, sky and walls outweigh what
// anti-aliasing is for.
#include <vector>

#include "pipeline/image/image.h"

namespace hwsim::lab {

/// One entry a pixel: whether its sRGB luma differs from that of a pixel above, below or beside it by more
/// than a sixteenth of the range, or that of such a pixel's neighbor does.
std::vector<char> edge_mask(const pipeline::Image& reference);

struct EdgeError {
  double flip_mean = 0.0;
  double psnr_db = 0.0;  ///< 999 for equal pixels, as pipeline::ImageError has it
};

/// Over the pixels of the mask alone; no error where there are none.
EdgeError edge_error(const pipeline::Image& image, const pipeline::Image& reference,
                     const pipeline::Image& flip_map, const std::vector<char>& mask);

}  // namespace hwsim::lab
