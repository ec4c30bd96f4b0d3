#include "lab/base/files.h"

#include <glob.h>

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
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

void write_answer(const std::string& path, std::string_view text) {
  std::error_code error;
  const fs::file_status there = fs::status(path, error);
  const bool takes_text = fs::is_fifo(there) || fs::is_character_file(there) || fs::is_socket(there);
  if (!takes_text) {
    const fs::path place = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : fs::path(path);
    return write_file(error ? path : place.string(), text);
  }
  std::ofstream out(path, std::ios::binary);
  out << text << std::flush;
  if (!out)
    throw InputError(problem("U010", "cannot write to `" + path + "`", "", "a file, or a pipe that is read"),
                     ExitStatus::run_failed);
}

std::string read_file(const std::string& path) {
  const std::vector<std::uint8_t> bytes = pipeline::read_file(path, "U011", kMaxTextBytes);
  return std::string(bytes.begin(), bytes.end());
}

std::vector<std::string> matching_files(const std::string& pattern) {
  std::error_code error;
  if (std::filesystem::exists(pattern, error)) return {pattern};
  glob_t found{};
  std::vector<std::string> files;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0)
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  ::globfree(&found);
  return files;
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
