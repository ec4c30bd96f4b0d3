#include "pipeline/image/make_png.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

namespace hwsim::pipeline::testing {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::string_view kTwoColorJpeg =
    "ffd8ffe000104a46494600010100000100010000ffdb00430002010101010102010101020202020204030202020205040403"
    "04060506060605060606070908060709070606080b08090a0a0a0a0a06080b0c0b0a0c090a0a0affdb004301020202020202"
    "050303050a0706070a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a"
    "0a0a0a0a0a0a0a0affc00011080008001003012200021101031101ffc4001f00000105010101010101000000000000000001"
    "02030405060708090a0bffc400b5100002010303020403050504040000017d01020300041105122131410613516107227114"
    "328191a1082342b1c11552d1f02433627282090a161718191a25262728292a3435363738393a434445464748494a53545556"
    "5758595a636465666768696a737475767778797a838485868788898a92939495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5"
    "b6b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae1e2e3e4e5e6e7e8e9eaf1f2f3f4f5f6f7f8f9faffc4001f010003"
    "0101010101010101010000000000000102030405060708090a0bffc400b51100020102040403040705040400010277000102"
    "031104052131061241510761711322328108144291a1b1c109233352f0156272d10a162434e125f11718191a262728292a35"
    "363738393a434445464748494a535455565758595a636465666768696a737475767778797a82838485868788898a92939495"
    "969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae2e3e4e5e6e7e8e9ea"
    "f2f3f4f5f6f7f8f9faffda000c03010002110311003f00c3af1ba28af6be833ff3507fdca7feec9f45f4b0ff009937fdcc7f"
    "ee03ffd9";

void put32(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t crc32(const Bytes& bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

std::uint32_t adler32(const Bytes& bytes) {
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t byte : bytes) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

void put_chunk(Bytes& out, std::string_view type, const Bytes& payload) {
  Bytes checked(type.begin(), type.end());
  checked.insert(checked.end(), payload.begin(), payload.end());
  put32(out, static_cast<std::uint32_t>(payload.size()));
  out.insert(out.end(), checked.begin(), checked.end());
  put32(out, crc32(checked));
}

Bytes stored_zlib(const Bytes& data) {
  Bytes out = {0x78, 0x01};
  for (std::size_t at = 0;;) {
    const auto size = static_cast<std::uint16_t>(std::min<std::size_t>(data.size() - at, 0xFFFF));
    const bool last = at + size == data.size();
    const auto inverse = static_cast<std::uint16_t>(~size);
    out.insert(out.end(), {static_cast<std::uint8_t>(last), static_cast<std::uint8_t>(size & 0xFF),
                           static_cast<std::uint8_t>(size >> 8), static_cast<std::uint8_t>(inverse & 0xFF),
                           static_cast<std::uint8_t>(inverse >> 8)});
    for (std::size_t i = 0; i < size; ++i) out.push_back(data[at + i]);
    at += size;
    if (last) break;
  }
  put32(out, adler32(data));
  return out;
}

}  // namespace

Bytes make_png(const PngHeader& header, const Bytes& rows) {
  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'}, start, filtered;
  put32(start, header.width);
  put32(start, header.height);
  start.insert(start.end(), {header.bit_depth, header.color_type, 0, 0, 0});
  put_chunk(out, "IHDR", start);
  const std::size_t row_bytes = rows.size() / header.height;
  for (std::size_t at = 0; at < rows.size(); ++at) {
    if (at % row_bytes == 0) filtered.push_back(0);
    filtered.push_back(rows[at]);
  }
  put_chunk(out, "IDAT", stored_zlib(filtered));
  put_chunk(out, "IEND", {});
  return out;
}

Bytes two_color_jpeg() {
  const auto digit = [](char c) { return static_cast<std::uint8_t>(c <= '9' ? c - '0' : c - 'a' + 10); };
  Bytes out;
  for (std::size_t i = 0; i < kTwoColorJpeg.size(); i += 2)
    out.push_back(static_cast<std::uint8_t>(digit(kTwoColorJpeg[i]) << 4 | digit(kTwoColorJpeg[i + 1])));
  return out;
}

std::string scratch_folder(const std::string& name) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("hwsim_" + name + "_" + std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder.string();
}

}  // namespace hwsim::pipeline::testing
