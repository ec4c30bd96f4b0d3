#include "lab/report/pictures.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "lab/base/base64.h"
#include "pipeline/image/known_srgb.h"

namespace hwsim::lab {
namespace {

std::uint8_t byte_of(double ratio) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(ratio, 0.0, 1.0) * 255.0));
}

/// Every texel of the result is the mean of those that it covers.
Picture scaled(const Picture& picture, double scale) {
  if (scale >= 1.0) return picture;
  Picture small{.width = std::max(1, static_cast<int>(picture.width * scale)),
                .height = std::max(1, static_cast<int>(picture.height * scale)),
                .channels = picture.channels,
                .full_scale = picture.full_scale};
  const auto from = [](int at, int of, int all) { return static_cast<int>(std::int64_t{at} * all / of); };
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      for (int c = 0; c < small.channels; ++c) {
        const int top = from(y, small.height, picture.height), left = from(x, small.width, picture.width);
        const int bottom = std::max(top + 1, from(y + 1, small.height, picture.height));
        const int right = std::max(left + 1, from(x + 1, small.width, picture.width));
        int sum = 0;
        for (int j = top; j < bottom; ++j)
          for (int i = left; i < right; ++i)
            sum += picture.texels[static_cast<std::size_t>((j * picture.width + i) * picture.channels + c)];
        const int count = (bottom - top) * (right - left);
        small.texels.push_back(static_cast<std::uint8_t>((sum + count / 2) / count));
      }
  return small;
}

std::string jpeg_uri(const Picture& picture, int quality) {
  const std::unique_ptr<void, int (*)(tjhandle)> handle(tjInitCompress(), &tjDestroy);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool gray = picture.channels == 1;
  const int failed = tjCompress2(handle.get(), picture.texels.data(), picture.width, 0, picture.height,
                                 gray ? TJPF_GRAY : TJPF_RGB, &bytes, &size, gray ? TJSAMP_GRAY : TJSAMP_444,
                                 quality, TJFLAG_ACCURATEDCT | TJFLAG_PROGRESSIVE);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(bytes, &tjFree);
  if (failed != 0) throw std::runtime_error(tjGetErrorStr2(handle.get()));
  return "data:image/jpeg;base64," + base64({bytes, size});
}

struct Step {
  int quality;
  double scale;
};
/// A picture in which edges are judged loses pixels last.
constexpr std::array kSteps = {Step{95, 1.0}, Step{90, 1.0}, Step{82, 1.0},  Step{70, 1.0},
                               Step{80, 0.5}, Step{60, 0.5}, Step{60, 0.25}, Step{40, 0.125}};

}  // namespace

Picture color_picture(const pipeline::Image& image) {
  Picture picture{.width = image.width, .height = image.height};
  picture.texels.reserve(image.pixels.size() * 3);
  pipeline::KnownSrgb encoded;
  for (const glm::vec4& pixel : image.pixels)
    for (const float linear : {pixel.x, pixel.y, pixel.z})
      picture.texels.push_back(byte_of(encoded(std::clamp(linear, 0.0f, 1.0f))));
  return picture;
}

Picture value_picture(const pipeline::Image& image, double full_scale) {
  Picture picture{.width = image.width, .height = image.height, .channels = 1, .full_scale = full_scale};
  picture.texels.reserve(image.pixels.size());
  for (const glm::vec4& pixel : image.pixels)
    picture.texels.push_back(byte_of(static_cast<double>(pixel.x) / full_scale));
  return picture;
}

std::vector<EncodedPicture> encode_within(std::span<const Picture* const> pictures, std::size_t budget_bytes,
                                          PictureFit& fit) {
  std::vector<EncodedPicture> encoded;
  for (const Step& step : kSteps) {
    encoded.clear();
    fit = {step.quality, step.scale, 0};
    for (const Picture* picture : pictures) {
      EncodedPicture& next = encoded.emplace_back();
      if (picture->empty() || fit.bytes > budget_bytes) continue;
      const Picture shown = scaled(*picture, step.scale);
      next = {jpeg_uri(shown, step.quality), shown.width, shown.height};
      fit.bytes += next.uri.size();
    }
    if (fit.bytes <= budget_bytes) break;
  }
  return encoded;
}

}  // namespace hwsim::lab
