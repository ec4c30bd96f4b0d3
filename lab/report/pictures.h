#pragma once
// The pictures of a report as JPEG, within a number of bytes.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/image/image.h"

namespace hwsim::lab {

/// A picture as eight bits a channel.
struct Picture {
  int width = 0, height = 0;
  int channels = 3;         ///< 3: sRGB; 1: a value, which who shows it colors
  double full_scale = 1.0;  ///< one channel: the value that 255 stands for
  std::vector<std::uint8_t> texels{};
  bool empty() const { return texels.empty(); }
};

struct PointPictures {
  Picture color{}, flip{}, heat{};  ///< empty where there is none
};

/// What a viewer sees: sRGB.
Picture color_picture(const pipeline::Image& image);
/// The first channel over `full_scale`.
Picture value_picture(const pipeline::Image& image, double full_scale);

/// A JPEG as a data URI.
struct EncodedPicture {
  std::string uri{};
  int width = 0, height = 0;
};

/// How pictures were made to fit.
struct PictureFit {
  int quality = 95;       ///< the JPEGs'
  double scale = 1.0;     ///< what their sides were multiplied with
  std::size_t bytes = 0;  ///< what all data URIs take
};

/// Encodes all pictures so that their data URIs take no more than `budget_bytes`: with less quality, then
/// smaller. Empty pictures have empty URIs, as have those that find no room even so.
std::vector<EncodedPicture> encode_within(std::span<const Picture* const> pictures, std::size_t budget_bytes,
                                          PictureFit& fit);

}  // namespace hwsim::lab
