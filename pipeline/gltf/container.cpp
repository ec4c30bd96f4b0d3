#include "pipeline/gltf/container.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <system_error>

#include "hwsim/base/file_name.h"

namespace hwsim::pipeline::gltf {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinChunk = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
const char* const kExportAgain = "the file is damaged or incomplete: export or copy it again";

std::uint32_t word_at(const Container& c, std::size_t offset) {
  std::uint32_t value;
  std::memcpy(&value, c.bytes.data() + offset, 4);
  return value;
}

void check_glb(Report& report, Container& c) {
  const std::size_t size = c.bytes.size();
  if (size < kHeaderBytes + kChunkHeaderBytes)
    report.fail("S002", "the GLB ends inside its header (" + std::to_string(size) + " bytes)", kExportAgain);
  if (const std::uint32_t version = word_at(c, 4); version != 2)
    report.fail("S002", "GLB version " + std::to_string(version) + " is not supported, it must be 2",
                "convert the file to glTF 2.0");
  const std::size_t total = word_at(c, 8);
  if (total > size)
    report.fail(
        "S002",
        "the GLB header promises " + std::to_string(total) + " bytes, the file has " + std::to_string(size),
        kExportAgain);
  if (total < size) report.warn("S102", "bytes after the GLB's declared length are ignored");
  c.json_begin = kHeaderBytes + kChunkHeaderBytes;
  c.json_bytes = word_at(c, 12);
  if (word_at(c, 16) != kJsonChunk) report.fail("S002", "the GLB's first chunk is not JSON", kExportAgain);
  if (c.json_bytes == 0 || c.json_bytes % 4 != 0 || c.json_begin + c.json_bytes > total)
    report.fail("S002",
                "the GLB's JSON chunk has an impossible length (" + std::to_string(c.json_bytes) + " bytes)",
                kExportAgain);
  const std::size_t next = c.json_begin + c.json_bytes;
  if (next == total) return;
  if (next + kChunkHeaderBytes > total || word_at(c, next + 4) != kBinChunk)
    report.fail("S002", "the GLB's second chunk is not a BIN chunk", kExportAgain);
  c.bin_bytes = word_at(c, next);
  c.bin_begin = next + kChunkHeaderBytes;
  // Exporters write an empty chunk where all data is elsewhere.
  if (c.bin_bytes % 4 != 0 || c.bin_begin + c.bin_bytes > total)
    report.fail("S002",
                "the GLB's BIN chunk has an impossible length (" + std::to_string(c.bin_bytes) + " bytes)",
                kExportAgain);
}

}  // namespace

bool read_bytes(const std::string& path, std::size_t max_bytes, std::vector<std::uint8_t>& out) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  const auto size = std::filesystem::file_size(path, error);
  if (error || size > max_bytes) return false;
  std::ifstream in(path, std::ios::binary);
  out.resize(static_cast<std::size_t>(size));
  in.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
  return static_cast<bool>(in) || out.empty();
}

Container read_container(Report& report, std::size_t max_file_bytes) {
  const std::string& path = report.file();
  // 32 bits: the GLB header's own limit.
  max_file_bytes = std::min<std::size_t>(max_file_bytes, std::numeric_limits<std::uint32_t>::max());
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    report.fail("S001", "no such file", "check the path, or name a generator: `hwsim list scenes`");
  if (!std::filesystem::is_regular_file(path, error)) report.fail("S001", "not a file");
  if (std::filesystem::file_size(path, error) > max_file_bytes && !error)
    report.fail("S012", "the file is larger than the limit of " + std::to_string(max_file_bytes) + " bytes");
  std::vector<std::uint8_t> bytes;
  if (!read_bytes(path, max_file_bytes, bytes)) report.fail("S001", "the file cannot be read");
  return check_container(report, std::move(bytes), has_extension(path, ".glb"));
}

Container check_container(Report& report, std::vector<std::uint8_t> bytes, bool must_be_binary) {
  Container c;
  c.bytes = std::move(bytes);
  const bool magic = c.bytes.size() >= 4 && std::memcmp(c.bytes.data(), "glTF", 4) == 0;
  if (must_be_binary && !magic)
    report.fail("S002",
                c.bytes.empty() ? "the file is empty" : "not a GLB: the file does not begin with \"glTF\"",
                kExportAgain);
  c.binary = magic;
  c.json_bytes = c.bytes.size();
  if (c.binary) check_glb(report, c);
  return c;
}

std::vector<std::uint8_t> Container::take_bin() && {
  bytes.resize(bin_begin + bin_bytes);
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(bin_begin));
  return std::move(bytes);
}

}  // namespace hwsim::pipeline::gltf
