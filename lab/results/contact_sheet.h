#pragma once
// Crops of every technique side by side, where the techniques differ most.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/image/image.h"

namespace hwsim::lab {

/// An image and its error map as they are shown: eight bits and one float a pixel, an eighth of the full
/// precision.
struct ShownImage {
  std::string label;
  int width = 0, height = 0;
  std::vector<std::uint32_t> srgb8;  ///< r in the lowest byte
  std::vector<float> error;          ///< FLIP, 0 to 1; empty for the reference itself
};
ShownImage shown_image(std::string label, const pipeline::Image& color, const pipeline::Image* error);

struct Region {
  int x = 0, y = 0, side = 0;
};

/// The squares in which the errors of the images differ most, the worst first, none overlapping another: the
/// largest sums over pixels of the variance of their errors. With one image, those where it errs most. Fewer
/// than `count` where the images have no room for more.
std::vector<Region> worst_regions(std::span<const ShownImage> images, int side, int count);

/// A row an image: its label, the regions enlarged, and their error maps (black 0, white 1).
pipeline::Image contact_sheet(std::span<const ShownImage> images, std::span<const Region> regions);

}  // namespace hwsim::lab
