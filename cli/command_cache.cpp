#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "cli/cache.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/table.h"

namespace hwsim::cli {
namespace {

namespace fs = std::filesystem;

struct CachedFile {
  std::string folder;
  fs::path path;
  std::uint64_t bytes = 0;
  double age_days = 0.0;
};

/// Only the folders that hwsim writes: whatever else lies in the cache directory is not ours.
std::vector<CachedFile> cached_files() {
  std::vector<CachedFile> files;
  const auto now = fs::file_time_type::clock::now();
  for (const CacheFolder folder : {CacheFolder::scenes, CacheFolder::references, CacheFolder::durations}) {
    const fs::path directory = cache_directory(folder);
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory, error)) {
      if (!entry.is_regular_file(error)) continue;
      const std::chrono::duration<double, std::ratio<86400>> age = now - entry.last_write_time(error);
      files.push_back(
          {directory.filename().string(), entry.path(), entry.file_size(error), std::max(0.0, age.count())});
    }
  }
  std::sort(files.begin(), files.end(),
            [](const CachedFile& a, const CachedFile& b) { return a.path < b.path; });
  return files;
}

Table file_table(const std::vector<CachedFile>& files) {
  Table table{
      {{"folder", "folder"}, {"file", "file"}, {"bytes", "bytes", true}, {"age_days", "age, days", true}},
      {}};
  for (const CachedFile& file : files)
    table.rows.push_back({file.folder, file.path.filename().string(), file.bytes, Real{file.age_days, 1}});
  return table;
}

}  // namespace

ExitStatus cache(const CacheOptions& options, Context& context) {
  std::vector<CachedFile> files = cached_files();
  if (options.prune && !options.all)
    std::erase_if(files, [&](const CachedFile& file) { return file.age_days < options.older_than_days; });
  std::uint64_t bytes = 0;
  for (const CachedFile& file : files) bytes += file.bytes;
  if (options.prune && !options.dry_run)
    for (const CachedFile& file : files) {
      std::error_code error;
      fs::remove(file.path, error);
      if (error) fail("U010", "cannot remove `" + file.path.string() + "`: " + error.message());
    }
  print({.table = file_table(files)}, options.common);
  const char* verb = !options.prune ? "in" : options.dry_run ? "would be removed from" : "removed from";
  context.log.say(fmt::format("{} files, {:.1f} MiB {} {}", files.size(),
                              static_cast<double>(bytes) / (1024.0 * 1024.0), verb,
                              fs::path(cache_directory(CacheFolder::scenes)).parent_path().string()));
  return ExitStatus::done;
}

}  // namespace hwsim::cli
