// An image's file, read as a texture and as a picture. Check sums of a PNG are made to fit, as they would in
// a file that was made to harm.
#include <cmath>

#include "fuzz/fuzz_input.h"
#include "pipeline/image/image_bytes.h"
#include "pipeline/image/image_io.h"
#include "pipeline/image/image_signature.h"

namespace {
using namespace hwsim;

std::uint32_t crc32(fuzz::Bytes bytes) {
  std::uint32_t crc = ~0u;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

std::uint32_t word(fuzz::Bytes bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
         std::uint32_t{bytes[at + 2]} << 8 | bytes[at + 3];
}

void mend_check_sums(std::vector<std::uint8_t>& png) {
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const std::size_t length = word(png, at);
    if (length > png.size() - at - 12) return;
    const std::uint32_t sum = crc32(fuzz::Bytes(png).subspan(at + 4, length + 4));
    for (std::size_t i = 0; i < 4; ++i)
      png[at + 8 + length + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    at += length + 12;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> bytes(data, data + size);
  if (pipeline::image_format(bytes) == pipeline::ImageFormat::png) mend_check_sums(bytes);
  fuzz::answer_or_refuse([&] {
    const pipeline::RawImage image = pipeline::decode_image(bytes, "input");
    fuzz::require(
        image.texels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
        "an image has all of its texels");
  });
  fuzz::answer_or_refuse([&] {
    const pipeline::Image image = pipeline::read_image(bytes, "input");
    fuzz::require(image.width > 0 && image.height > 0, "an image is not empty");
  });
  return 0;
}
