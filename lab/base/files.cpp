#include "lab/base/files.h"

#include <fcntl.h>
#include <glob.h>
#include <unistd.h>

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include "hwsim/base/content_hash.h"
#include "lab/base/messages.h"
#include "pipeline/base/file_io.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTextBytes = std::size_t{64} << 20;  // far more than any text file of the project

std::string kind_of(fs::file_type type) {
  switch (type) {
    case fs::file_type::directory:
      return "it is a folder";
    case fs::file_type::fifo:
      return "it is a pipe";
    case fs::file_type::socket:
      return "it is a socket";
    default:
      return "it is a device";
  }
}

[[noreturn]] void refuse_place(const std::string& path, const std::string& why) {
  fail("U010", "cannot write `" + path + "`: " + why, "", "the name of a file, or of one that is not there");
}

/// What a link points to, and what that one points to, until something is no link.
fs::path behind_links(const std::string& path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  fs::path place = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(place, error); ++links) {
    if (links == kMostLinks) refuse_place(path, "it is a link that leads back to itself");
    const fs::path target = fs::read_symlink(place, error);
    if (error) break;  // told by who writes
    place = place.parent_path() / target;
  }
  return place;
}

/// Whether a text is given to what is there, and replaces nothing.
bool takes_text(const std::string& path) {
  std::error_code error;
  const fs::file_status there = fs::status(path, error);
  return fs::is_fifo(there) || fs::is_character_file(there);
}

/// Without O_NONBLOCK a pipe that nobody reads would be waited for without a word.
pipeline::FileDescriptor open_stream(const std::string& path) {
  constexpr int kAttempts = 100;  // a reader that was started together with this program comes in time
  constexpr std::chrono::milliseconds kPause{10};
  for (int attempt = 0;; ++attempt) {
    pipeline::FileDescriptor stream(::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (stream.is_open() || errno != ENXIO || attempt == kAttempts) return stream;
    std::this_thread::sleep_for(kPause);
  }
}

[[noreturn]] void fail_to_stream(const std::string& path, int reason) {
  if (reason == ENXIO)
    fail("U010", "cannot write `" + path + "`: nobody reads it", "", "start its reader first, or a file");
  throw InputError(problem("U010", "cannot write to `" + path + "`: " + std::strerror(reason), "",
                           "a file, or a pipe that is read"),
                   reason == EACCES || reason == EPERM ? ExitStatus::invalid_input : ExitStatus::run_failed);
}

void write_stream(const std::string& path, std::string_view text) {
  const pipeline::FileDescriptor stream = open_stream(path);
  if (!stream.is_open() || ::fcntl(stream.get(), F_SETFL, 0) != 0) fail_to_stream(path, errno);
  while (!text.empty()) {
    const ssize_t written = ::write(stream.get(), text.data(), text.size());
    if (written < 0 && errno != EINTR) fail_to_stream(path, errno);
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

std::string place_of_file(const std::string& path) {
  const fs::path place = behind_links(path);
  std::error_code error;
  const fs::file_type there = fs::status(place, error).type();
  const bool is_free = there == fs::file_type::regular || there == fs::file_type::not_found ||
                       there == fs::file_type::none;  // one that cannot be looked at is told by who writes
  if (!is_free) refuse_place(path, kind_of(there));
  return place.string();
}

void check_answer_place(const std::string& path) {
  if (!takes_text(path)) place_of_file(path);
}

void write_file(const std::string& path, std::string_view text) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  pipeline::write_file_atomically(place_of_file(path), "U010", {bytes, text.size()});
}

void write_answer(const std::string& path, std::string_view text) {
  takes_text(path) ? write_stream(path, text) : write_file(path, text);
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
