#include "pipeline/base/sealed_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "hwsim/base/byte_codec.h"
#include "hwsim/base/content_hash.h"
#include "hwsim/base/diagnostics.h"
#include "pipeline/base/file_descriptor.h"

namespace hwsim::pipeline {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{8} << 30;  // a 16384x16384 image and its heat map
constexpr mode_t kOthers = S_IRWXG | S_IRWXO, kOthersWrite = S_IWGRP | S_IWOTH;

/// Whether there is a file, and this user's. `damage` says what is wrong with one that is there.
bool is_own_file(const std::string& path, std::string& damage) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return false;
  if (!S_ISREG(status.st_mode))
    damage = "it is no file";
  else if (status.st_uid != ::geteuid())
    damage = "it belongs to another user";
  return damage.empty();
}

std::string make_folder(const std::string& path, bool hidden) {
  const std::filesystem::path folder(path);
  std::error_code error;
  if (folder.has_parent_path()) std::filesystem::create_directories(folder.parent_path(), error);
  if (error) return error.message();
  if (::mkdir(path.c_str(), S_IRWXU) != 0 && errno != EEXIST) return std::strerror(errno);
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::strerror(errno);
  if (!S_ISDIR(status.st_mode)) return "it is no folder";
  if (status.st_uid != ::geteuid()) return "it belongs to another user";
  const bool hides = hidden && (status.st_mode & kOthers) != 0 && ::chmod(path.c_str(), S_IRWXU) == 0;
  return hides || (status.st_mode & kOthersWrite) == 0 ? "" : "others may write to it";
}

}  // namespace

SealedContent read_sealed(const std::string& path, const SealKind& kind) try {
  SealedContent content;
  if (!is_own_file(path, content.damage)) return content;
  std::vector<std::uint8_t> bytes = read_file(path, "K001", kMaxBytes);
  open_seal(kind.name, fnv1a(kind.sources), bytes);
  bytes.erase(bytes.begin(), bytes.begin() + kSealBytes);
  content.bytes = std::move(bytes);
  return content;
} catch (const DamagedBytes& damage) {
  return {{}, damage.what()};
} catch (const InputError& error) {
  return {{}, error.what()};
}

void write_sealed(const std::string& path, const SealKind& kind, const std::string& code, ByteSpan payload) {
  const std::vector<std::uint8_t> header = seal_of(kind.name, fnv1a(kind.sources), payload);
  write_file_atomically(path, code, {ByteSpan(header), payload});
}

std::string make_own_folder(const std::string& path) { return make_folder(path, false); }
std::string make_private_folder(const std::string& path) { return make_folder(path, true); }

}  // namespace hwsim::pipeline
