#include "pipeline/image/image_io.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <optional>
#include <string_view>

#include "hwsim/base/diagnostics.h"
#include "pipeline/base/file_io.h"
#include "pipeline/image/exr_file.h"
#include "pipeline/image/image_bytes.h"
#include "pipeline/image/image_signature.h"
#include "pipeline/image/known_srgb.h"
#include "pipeline/image/module_loader.h"
#include "pipeline/image/png_file.h"

namespace hwsim::pipeline {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{2} << 30;
constexpr std::size_t kMostScans = 256;  // every one goes over the whole picture; programs write about ten
constexpr float kLargestHalf = 65504.0f;

[[noreturn]] void fail(const std::string& code, const std::string& message, const std::string& file,
                       const std::string& help) {
  Diagnostic d{.code = code, .message = message};
  d.place.file = file;
  d.help = help;
  throw InputError(d);
}

// Exceptions must not pass through the module's frames: a failed allocation is answered with null.
template <class Target>
void* allocate_in(void* user, int width, int height) {
  try {
    return static_cast<Target*>(user)->allocate(width, height);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

struct RawTarget {
  RawImage image;
  void* allocate(int width, int height) {
    image = {width, height, {}};
    image.texels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return image.texels.data();
  }
};

struct FloatTarget {
  Image image;
  void* allocate(int width, int height) {
    image = Image(width, height);
    return image.pixels.data();
  }
};

// Who exports a reference or a map of radiance as PNG or JPEG loses its range.
[[noreturn]] void report(int status, const std::string& reason, const std::string& what, ImageFormat format) {
  const bool exr = format == ImageFormat::exr;
  const std::string tail = reason.empty() ? std::string() : ": " + reason;
  if (status == kHwsimImageNoMemory) throw std::bad_alloc();
  if (status == kHwsimImageTooLarge)
    fail("I003", "the image is too large" + tail, what,
         "reduce it to at most " + std::to_string(kHwsimImageMaxExtentPx) + " pixels a side");
  if (status == kHwsimImageDamaged)
    fail("I002", "the image is damaged" + tail, what,
         exr ? "export it again, as OpenEXR" : "export it again, as PNG or JPEG");
  fail("I004", "the image cannot be read" + tail, what,
       exr ? "save it as OpenEXR of half or float channels" : "convert it to an 8-bit PNG");
}

void check_format(std::span<const std::uint8_t> bytes, const std::string& what, bool exr_allowed) {
  const ImageFormat format = image_format(bytes);
  if (format == ImageFormat::unknown || (format == ImageFormat::exr && !exr_allowed))
    fail("I006", bytes.empty() ? "the image is empty" : "unknown image format", what,
         exr_allowed ? "PNG, JPEG and OpenEXR are read" : "PNG and JPEG are read");
  if (format == ImageFormat::png && !png_is_intact(bytes))
    report(kHwsimImageDamaged, "bytes are missing or changed", what, format);
  if (format == ImageFormat::jpeg && !jpeg_is_complete(bytes))
    report(kHwsimImageDamaged, "its end is missing", what, format);
  if (format == ImageFormat::exr) return;
  const ImageSize size = image_size(bytes);
  if (size.width == 0 || size.height == 0) report(kHwsimImageDamaged, "its size is zero", what, format);
  if (size.width > kHwsimImageMaxExtentPx || size.height > kHwsimImageMaxExtentPx)
    report(kHwsimImageTooLarge,
           "it is " + std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels", what,
           format);
  if (format == ImageFormat::png && !png_data_fits(bytes))
    report(kHwsimImageDamaged, "it holds more than its size can use", what, format);
  if (format == ImageFormat::jpeg && jpeg_scans(bytes) > kMostScans)
    report(kHwsimImageDamaged, "it has more than " + std::to_string(kMostScans) + " scans", what, format);
}

template <class Target>
Target decode(std::span<const std::uint8_t> bytes, const std::string& what, bool as_float) {
  Target target;
  std::array<char, 512> error{};
  const HwsimImageOutput output{&target, &allocate_in<Target>, error.data(), error.size()};
  const int status = image_module().decode(bytes.data(), bytes.size(), as_float ? 1 : 0, &output);
  if (status != kHwsimImageOk) report(status, error.data(), what, image_format(bytes));
  return target;
}

}  // namespace

RawImage decode_image(std::span<const std::uint8_t> bytes, const std::string& what) {
  check_format(bytes, what, false);
  if (std::optional<RawImage> plain = decode_plain_png(bytes)) return std::move(*plain);
  return decode<RawTarget>(bytes, what, false).image;
}

Image read_image(const std::string& path) { return read_image(read_file(path, "I004", kMaxFileBytes), path); }

Image read_image(std::span<const std::uint8_t> bytes, const std::string& what) {
  check_format(bytes, what, true);
  Image image = decode<FloatTarget>(bytes, what, true).image;
  if (image_format(bytes) == ImageFormat::exr) return image;
  for (glm::vec4& pixel : image.pixels)
    for (int c = 0; c < 3; ++c) pixel[c] = linear_from_srgb(pixel[c]);
  return image;
}

std::vector<std::uint8_t> encode_png(const Image& image) {
  KnownSrgb encoded;
  std::vector<std::uint8_t> rgb(image.pixels.size() * 3);
  std::uint8_t* next = rgb.data();
  for (const glm::vec4& pixel : image.pixels)
    for (int c = 0; c < 3; ++c)
      *next++ = static_cast<std::uint8_t>(std::min(encoded(pixel[c]), 1.0f) * 255.0f + 0.5f);
  return encode_png(image.width, image.height, rgb);
}

// Finite values beyond the half format saturate: a bright pixel must not turn into an infinite one.
std::vector<std::uint8_t> encode_exr(const Image& image) {
  std::vector<std::uint16_t> rgb(image.pixels.size() * 3);
  std::uint16_t* next = rgb.data();
  for (const glm::vec4& pixel : image.pixels)
    for (int c = 0; c < 3; ++c)
      *next++ = half_from_float(std::isfinite(pixel[c]) ? std::clamp(pixel[c], -kLargestHalf, kLargestHalf)
                                                        : pixel[c]);
  return encode_exr_halves(image.width, image.height, rgb);
}

void write_image(const Image& image, const std::string& path) {
  const std::string_view name(path);
  const bool png = name.ends_with(".png"), exr = name.ends_with(".exr");
  if (!png && !exr) fail("I006", "unknown image format", path, "name the file .png or .exr");
  if (image.width <= 0 || image.height <= 0)
    fail("I005", "the image is empty", path, "write at least one pixel");
  write_file_atomically(path, "I005", png ? encode_png(image) : encode_exr(image));
}

}  // namespace hwsim::pipeline
