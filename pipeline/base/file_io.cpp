#include "pipeline/base/file_io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "hwsim/base/diagnostics.h"

namespace hwsim::pipeline {
namespace {

[[noreturn]] void fail(const std::string& code, const std::string& message, const std::string& path,
                       const std::string& help = {}) {
  Diagnostic d{.code = code, .message = message};
  d.place.file = path;
  d.help = help;
  throw InputError(d);
}

std::string reason() { return std::strerror(errno); }

class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  int get() const { return descriptor_; }
  bool close() { return ::close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

bool write_all(int descriptor, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

std::vector<std::uint8_t> read_file(const std::string& path, const std::string& code, std::size_t max_bytes) {
  const File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
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

void write_file_atomically(const std::string& path, const std::string& code,
                           std::span<const std::uint8_t> bytes) {
  const std::string help = "check that the folder exists, may be written and has space";
  std::string temporary;
  int descriptor = -1;
  for (int attempt = 0; attempt < 1000 && descriptor < 0; ++attempt) {  // O_EXCL: two writers never share one
    temporary = path + ".tmp." + std::to_string(::getpid()) + "." + std::to_string(attempt);
    descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno != EEXIST) break;
  }
  if (descriptor < 0) fail(code, "cannot write the file: " + reason(), path, help);
  File file(descriptor);
  if (write_all(descriptor, bytes) && file.close() && std::rename(temporary.c_str(), path.c_str()) == 0)
    return;
  const std::string why = reason();
  ::unlink(temporary.c_str());
  fail(code, "cannot write the file: " + why, path, help);
}

}  // namespace hwsim::pipeline
