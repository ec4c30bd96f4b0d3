#include "pipeline/generate/png.h"

#include <algorithm>
#include <string_view>

namespace hwsim::pipeline::generate {
namespace {
using Bytes = std::vector<std::uint8_t>;

void append_be32(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t crc32(const std::uint8_t* data, std::size_t size) {
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = 0; i < size; ++i) {
    crc ^= data[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xedb88320u & (0u - (crc & 1u)));
  }
  return ~crc;
}

std::uint32_t adler32(const Bytes& data) {
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t byte : data) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

void append_chunk(Bytes& out, std::string_view type, const Bytes& data) {
  append_be32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  append_be32(out, crc32(out.data() + begin, out.size() - begin));
}

Bytes zlib_stored(const Bytes& data) {
  constexpr std::size_t kMaxBlock = 65535;
  Bytes out = {0x78, 0x01};
  for (std::size_t at = 0; at < data.size(); at += kMaxBlock) {
    const std::size_t size = std::min(kMaxBlock, data.size() - at);
    const auto length = static_cast<std::uint32_t>(size);
    out.push_back(at + size == data.size() ? 1 : 0);
    for (const std::uint32_t word : {length, ~length}) {
      out.push_back(static_cast<std::uint8_t>(word & 255));
      out.push_back(static_cast<std::uint8_t>((word >> 8) & 255));
    }
    out.insert(out.end(), data.begin() + static_cast<std::ptrdiff_t>(at),
               data.begin() + static_cast<std::ptrdiff_t>(at + size));
  }
  append_be32(out, adler32(data));
  return out;
}

}  // namespace

Bytes encode_png(int width, int height, const std::vector<std::uint32_t>& texels, bool with_alpha) {
  Bytes header;
  append_be32(header, static_cast<std::uint32_t>(width));
  append_be32(header, static_cast<std::uint32_t>(height));
  // 8 bits, RGBA or RGB, no interlace
  header.insert(header.end(), {8, static_cast<std::uint8_t>(with_alpha ? 6 : 2), 0, 0, 0});
  Bytes rows;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (i % static_cast<std::size_t>(width) == 0) rows.push_back(0);  // filter: none
    for (int shift = 0; shift < (with_alpha ? 32 : 24); shift += 8)
      rows.push_back(static_cast<std::uint8_t>(texels[i] >> shift));
  }
  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(out, "IHDR", header);
  append_chunk(out, "IDAT", zlib_stored(rows));
  append_chunk(out, "IEND", {});
  return out;
}

}  // namespace hwsim::pipeline::generate
