#include "lab/base/files.h"

#include <fmt/format.h>

#include <cstdlib>
#include <vector>

#include "hwsim/base/content_hash.h"
#include "lab/base/messages.h"
#include "pipeline/base/file_io.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTextBytes = std::size_t{64} << 20;  // far more than any text file of the project

}  // namespace

void write_file(const std::string& path, std::string_view text) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  pipeline::write_file_atomically(path, "U010", {bytes, text.size()});
}

std::string read_file(const std::string& path) {
  const std::vector<std::uint8_t> bytes = pipeline::read_file(path, "U011", kMaxTextBytes);
  return std::string(bytes.begin(), bytes.end());
}

std::string hash_hex(std::string_view bytes) { return fmt::format("{:016x}", fnv1a(bytes)); }

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "hwsim-XXXXXX").string();
  if (error || !mkdtemp(name.data())) fail("U010", "no temporary folder can be made: `" + name + "`");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace hwsim::lab
