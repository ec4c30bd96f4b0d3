#pragma once
// Files that the application reads and writes.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hwsim::lab {

/// The file that is made or replaced by who writes to `path`: itself, or what it leads to as a link. Throws
/// InputError U010 where something is there that is no file: a folder, a pipe, a device.
std::string place_of_file(const std::string& path);

/// Throws what `place_of_file` throws where `write_answer` would, before the work.
void check_answer_place(const std::string& path);

/// Written beside the file's place and renamed, so that a file that exists is complete. Throws InputError
/// U010.
void write_file(const std::string& path, std::string_view text);

/// Writes where somebody asked for it: a pipe that is read or a device of characters gets the text itself.
/// Throws InputError U010, also for a pipe that nobody reads.
void write_answer(const std::string& path, std::string_view text);

/// Throws InputError U011 when it cannot be read.
std::string read_file(const std::string& path);

/// The file of this name; else those that a pattern with `*`, `?` or `[...]` stands for, sorted. None: empty.
std::vector<std::string> matching_files(const std::string& pattern);

/// 64-bit FNV-1a as 16 hex digits: names of cached files, ids of runs. Not for untrusted keys.
std::string hash_hex(std::string_view bytes);

/// A folder of its own below the system's temporary directory, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder();  ///< throws InputError U010 when it cannot be made
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace hwsim::lab
