#include "lab/results/folder_exchange.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "lab/base/files.h"
#include "pipeline/base/file_descriptor.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;
using pipeline::FileDescriptor;

constexpr const char* kManifest = "manifest.json";
constexpr std::string_view kPartial = ".partial-", kOld = ".old-";

fs::path beside(const fs::path& place, std::string_view middle) {
  return place.parent_path() / fmt::format(".{}{}{}", place.filename().string(), middle, ::getpid());
}

FileDescriptor open_folder(const fs::path& folder) {
  return FileDescriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

/// The name between the dot and `middle`, where digits follow it: "results" of ".results.old-4711".
std::string name_before(const std::string& file, std::string_view middle) {
  const std::size_t at = file.rfind(middle);
  if (file.empty() || file.front() != '.' || at == std::string::npos || at < 2) return {};
  const std::string digits = file.substr(at + middle.size());
  const bool is_number = !digits.empty() && digits.find_first_not_of("0123456789") == std::string::npos;
  return is_number ? file.substr(1, at - 1) : std::string();
}

/// Whether the process whose number ends the folder's name has ended.
bool is_gone(const fs::path& folder) {
  const std::string name = folder.filename().string();
  const long process = std::strtol(name.c_str() + name.rfind('-') + 1, nullptr, 10);
  return process <= 0 || (::kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH);
}

/// Whether hwsim made the folder and no process works on it. `lock` then keeps others away.
bool is_abandoned(const fs::path& folder, FileDescriptor& lock) {
  lock = open_folder(folder);
  struct stat status {};
  if (!lock.is_open() || ::fstat(lock.get(), &status) != 0 || status.st_uid != ::geteuid() || !lock.lock())
    return false;
  std::error_code error;
  return fs::exists(folder / kUnfinishedMark, error) || is_of_hwsim(folder) ||
         (fs::is_empty(folder, error) && is_gone(folder));  // a living run is about to lock and mark it
}

bool clear(const fs::path& folder) {
  const std::string file = folder.filename().string();
  const std::string aside = name_before(file, kOld);
  FileDescriptor lock;
  if ((aside.empty() && name_before(file, kPartial).empty()) || !is_abandoned(folder, lock)) return false;
  std::error_code error;
  const bool comes_back = !aside.empty() && !fs::exists(folder.parent_path() / aside, error);
  if (comes_back)
    fs::rename(folder, folder.parent_path() / aside, error);
  else
    error = remove_results(folder);
  return !error;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> paths;  // all names first: the folder changes while it is read
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    paths.push_back(entry->path());
  return paths;
}

}  // namespace

bool is_of_hwsim(const fs::path& folder) try {
  const auto json = nlohmann::json::parse(read_file((folder / kManifest).string()), nullptr, false);
  if (!json.is_object()) return false;
  const auto written_by = json.find("written_by");
  if (written_by != json.end())
    return written_by->is_string() && written_by->get<std::string>().starts_with("hwsim");
  return json.contains("model_version") && json.contains("input_hashes") && json.contains("points");
} catch (const InputError&) {
  return false;
}

fs::path partial_name(const fs::path& place) { return beside(place, kPartial); }

std::error_code exchange_folders(const fs::path& fresh, const fs::path& place) {
  if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) == 0) return {};
  if (errno == EINVAL || errno == ENOSYS) return exchange_in_steps(fresh, place);
  return {errno, std::generic_category()};
}

std::error_code exchange_in_steps(const fs::path& fresh, const fs::path& place) {
  const FileDescriptor lock = open_folder(place);  // while it lives, the old folder is not abandoned
  if (lock.is_open()) lock.lock();
  const fs::path aside = beside(place, kOld);
  std::error_code error, ignored;
  fs::rename(place, aside, error);
  if (error) return error;
  fs::rename(fresh, place, error);
  fs::rename(aside, error ? place : fresh, ignored);
  return error;
}

std::error_code remove_results(const fs::path& folder) {
  std::error_code error;
  const bool is_link = fs::is_symlink(folder, error);  // what it points to is not what was replaced
  for (const fs::path& entry : is_link ? std::vector<fs::path>() : entries_of(folder))
    if (entry.filename() != kUnfinishedMark && entry.filename() != kManifest) fs::remove_all(entry, error);
  fs::remove_all(folder, error);
  return error;
}

void remove_unfinished(const fs::path& partial) {
  const fs::path aside = beside(partial, kPartial);
  std::error_code error;
  fs::rename(partial, aside, error);
  remove_results(error ? partial : aside);
}

std::size_t clear_abandoned(const fs::path& parent) {
  std::size_t cleared = 0;
  for (const fs::path& folder : entries_of(parent.empty() ? fs::path(".") : parent))
    cleared += clear(folder) ? 1 : 0;
  return cleared;
}

}  // namespace hwsim::lab
