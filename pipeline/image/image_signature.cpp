#include "pipeline/image/image_signature.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "pipeline/image/deflate.h"

namespace hwsim::pipeline {
namespace {

template <std::size_t N>
bool starts_with(std::span<const std::uint8_t> bytes, const std::array<std::uint8_t, N>& magic) {
  return bytes.size() >= N && std::equal(magic.begin(), magic.end(), bytes.begin());
}

constexpr std::uint8_t kStartOfScan = 0xDA, kEndOfImage = 0xD9;

bool has_no_payload(std::uint8_t marker) { return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8); }

std::uint32_t big_endian_32(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
  return value;
}

// From the start-of-frame segment, as ISO 10918-1 section B.2.2 gives it.
ImageSize jpeg_size(std::span<const std::uint8_t> bytes) {
  const auto word = [&](std::size_t at) {
    return static_cast<std::uint32_t>(bytes[at] << 8 | bytes[at + 1]);
  };
  for (std::size_t at = 2; at + 9 < bytes.size();) {
    if (bytes[at] != 0xFF) return {};
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF || has_no_payload(marker)) {
      at += marker == 0xFF ? 1 : 2;
      continue;
    }
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) return {word(at + 7), word(at + 5)};
    at += 2 + word(at + 2);
  }
  return {};
}

/// Goes from marker to marker; the number of scans, none where the end-of-image marker is missing.
std::optional<std::size_t> scans_to_the_end(std::span<const std::uint8_t> bytes) {
  std::size_t at = 2, scans = 0;
  bool in_scan = false;
  while (at + 1 < bytes.size()) {
    if (bytes[at] != 0xFF) {
      if (!in_scan) return std::nullopt;
      ++at;
      continue;
    }
    const std::uint8_t marker = bytes[at + 1];
    if (marker == kEndOfImage) return scans;
    if (marker == 0xFF) {  // a fill byte
      ++at;
    } else if (has_no_payload(marker) || (in_scan && marker == 0x00)) {  // FF 00 is a stuffed FF of the scan
      at += 2;
    } else {
      if (at + 3 >= bytes.size()) return std::nullopt;
      at += 2 + (std::size_t{bytes[at + 2]} << 8 | bytes[at + 3]);
      in_scan = marker == kStartOfScan;
      scans += in_scan ? 1 : 0;
    }
  }
  return std::nullopt;
}

}  // namespace

ImageFormat image_format(std::span<const std::uint8_t> bytes) {
  if (starts_with<8>(bytes, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'})) return ImageFormat::png;
  if (starts_with<3>(bytes, {0xFF, 0xD8, 0xFF})) return ImageFormat::jpeg;
  if (starts_with<4>(bytes, {0x76, 0x2F, 0x31, 0x01})) return ImageFormat::exr;
  return ImageFormat::unknown;
}

ImageSize image_size(std::span<const std::uint8_t> bytes) {
  const ImageFormat format = image_format(bytes);
  if (format == ImageFormat::png && bytes.size() >= 24)
    return {big_endian_32(bytes, 16), big_endian_32(bytes, 20)};
  if (format == ImageFormat::jpeg) return jpeg_size(bytes);
  return {};
}

bool png_is_intact(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kFraming = 12;  // length, type, checksum
  std::size_t at = 8;
  while (at <= bytes.size() && bytes.size() - at >= kFraming) {
    const std::size_t length = big_endian_32(bytes, at);
    if (length > bytes.size() - at - kFraming) return false;
    const auto type_and_data = bytes.subspan(at + 4, 4 + length);
    const bool critical = (type_and_data[0] & 0x20) == 0;
    if (critical && crc32_of(type_and_data) != big_endian_32(bytes, at + 8 + length)) return false;
    constexpr std::array<std::uint8_t, 4> end = {'I', 'E', 'N', 'D'};
    if (starts_with(type_and_data, end)) return true;
    at += kFraming + length;
  }
  return false;
}

bool png_data_fits(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kFraming = 12, kSlack = std::size_t{64} << 10;
  const ImageSize size = image_size(bytes);
  constexpr std::size_t kMostBytesPerPixel = 8;  // four channels of 16 bits
  const std::size_t most = 2 * (std::size_t{size.width} * kMostBytesPerPixel + 1) * size.height + kSlack;
  std::size_t at = 8, data = 0;
  while (at <= bytes.size() && bytes.size() - at >= kFraming) {
    const std::size_t length = big_endian_32(bytes, at);
    if (length > bytes.size() - at - kFraming) break;
    if (starts_with<4>(bytes.subspan(at + 4), {'I', 'D', 'A', 'T'})) data += length;
    at += kFraming + length;
  }
  return data <= most;
}

bool jpeg_is_complete(std::span<const std::uint8_t> bytes) { return scans_to_the_end(bytes).has_value(); }

std::size_t jpeg_scans(std::span<const std::uint8_t> bytes) { return scans_to_the_end(bytes).value_or(0); }

}  // namespace hwsim::pipeline
