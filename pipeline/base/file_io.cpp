#include "pipeline/base/file_io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace hwsim::pipeline {
namespace {

[[noreturn]] void fail(const std::string& code, const std::string& message, const std::string& path) {
  Diagnostic d{.code = code, .message = message};
  d.place.file = path;
  throw InputError(d);
}

[[noreturn]] void fail_to_write(const std::string& code, int reason, const std::string& path) {
  Diagnostic d{.code = code, .message = std::string("cannot write the file: ") + std::strerror(reason)};
  d.place.file = path;
  d.help = "check that the folder exists, may be written and has space";
  throw InputError(d, write_failure_status(reason));
}

std::string reason() { return std::strerror(errno); }

constexpr std::string_view kUnfinished = ".hwsim-tmp-";
constexpr int kAttempts = 1000;  // far more than writers of one file

bool write_all(int descriptor, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

bool write_all(int descriptor, const std::vector<ByteSpan>& pieces) {
  for (const ByteSpan piece : pieces)
    if (!write_all(descriptor, piece)) return false;
  return true;
}

using Place = int (*)(const char* from, const char* to);

void write_file(const std::string& path, const std::string& code, const std::vector<ByteSpan>& pieces,
                Place place) {
  std::string unfinished;
  FileDescriptor file = open_unfinished(path, unfinished);
  if (!file.is_open()) fail_to_write(code, errno, path);
  const bool written = write_all(file.get(), pieces) && ::fsync(file.get()) == 0 &&
                       place(unfinished.c_str(), path.c_str()) == 0 && file.close();
  if (written) return;
  const int why = errno;
  ::unlink(unfinished.c_str());
  fail_to_write(code, why, path);
}

int link_and_unlink(const char* from, const char* to) {
  if (::link(from, to) != 0) return -1;
  ::unlink(from);
  return 0;
}

}  // namespace

FileDescriptor open_unfinished(const std::string& target, std::string& path) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    path = target + std::string(kUnfinished) + std::to_string(attempt);
    remove_if_abandoned(path);
    FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!file.is_open() && errno != EEXIST) break;
    struct stat status {};  // between the calls another process may take the file for abandoned
    if (file.is_open() && file.lock() && ::fstat(file.get(), &status) == 0 && status.st_nlink > 0)
      return file;
  }
  return FileDescriptor();
}

ExitStatus write_failure_status(int reason) {
  const bool out_of_space = reason == ENOSPC || reason == EDQUOT || reason == EFBIG || reason == EIO;
  return out_of_space ? ExitStatus::run_failed : ExitStatus::invalid_input;
}

std::vector<std::uint8_t> read_file(const std::string& path, const std::string& code, std::size_t max_bytes) {
  // Without waiting: a pipe that nobody writes to is refused below.
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0)
    fail(code, "cannot read the file: " + reason(), path);
  if (!S_ISREG(status.st_mode)) fail(code, "not a file", path);
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > max_bytes)
    fail(
        code,
        "the file has " + std::to_string(size) + " bytes, at most " + std::to_string(max_bytes) + " are read",
        path);
  std::vector<std::uint8_t> bytes(size);
  std::size_t have = 0;
  while (have < size) {
    const ssize_t got = ::read(file.get(), bytes.data() + have, size - have);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(code, "cannot read the file: " + reason(), path);
    if (got == 0) break;  // it shrank meanwhile
    have += static_cast<std::size_t>(got);
  }
  bytes.resize(have);
  return bytes;
}

void write_file_atomically(const std::string& path, const std::string& code, ByteSpan bytes) {
  write_file(path, code, {bytes}, std::rename);
}

void write_file_atomically(const std::string& path, const std::string& code,
                           const std::vector<ByteSpan>& pieces) {
  write_file(path, code, pieces, std::rename);
}

void write_new_file(const std::string& path, const std::string& code, ByteSpan bytes) {
  write_file(path, code, {bytes}, link_and_unlink);
}

bool is_unfinished_name(std::string_view name) {
  const std::size_t at = name.rfind(kUnfinished);
  const std::size_t digits = at + kUnfinished.size();
  return at != std::string_view::npos && digits < name.size() &&
         name.find_first_not_of("0123456789", digits) == std::string_view::npos;
}

bool remove_if_abandoned(const std::string& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat opened {
  }, there{};
  return file.is_open() && ::fstat(file.get(), &opened) == 0 && S_ISREG(opened.st_mode) &&
         opened.st_uid == ::geteuid() && file.lock() && ::stat(path.c_str(), &there) == 0 &&
         there.st_ino == opened.st_ino && ::unlink(path.c_str()) == 0;
}

}  // namespace hwsim::pipeline
