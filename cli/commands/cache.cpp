#include <fmt/format.h>

#include <filesystem>

#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "hwsim/base/units_of_measure.h"
#include "lab/base/messages.h"
#include "lab/base/table.h"
#include "lab/results/folder_exchange.h"
#include "lab/store/cache_entries.h"

namespace hwsim::cli {
namespace {

namespace fs = std::filesystem;

/// Files that are gone are told by their names alone.
Table file_table(const std::vector<CachedFile>& files, const std::vector<std::string>& titles) {
  Table table{{{"folder", "folder"},
               {"entry", "what it is"},
               {"file", "file"},
               {"bytes", "bytes", true},
               {"age_days", "age, days", true}},
              {}};
  for (std::size_t i = 0; i < files.size(); ++i)
    table.rows.push_back({files[i].folder, titles[i], files[i].path.filename().string(), files[i].bytes,
                          Real{files[i].age_days, 1}});
  return table;
}

}  // namespace

ExitStatus cache(const CacheArguments& options, Context& context) {
  const Lab lab(lab_options(options.common, context.log));
  if (options.prune && !options.dry_run)
    if (const std::size_t abandoned = lab.cache().remove_abandoned() + clear_abandoned("runs"); abandoned > 0)
      context.log.say(fmt::format("{} unfinished files and folders of killed runs removed", abandoned));
  std::vector<CachedFile> files = lab.cache().files();
  if (options.prune && options.keep_mib)
    files = least_recently_used(std::move(files), std::uint64_t{*options.keep_mib} << 20);
  else if (options.prune && !options.all)
    std::erase_if(files, [&](const CachedFile& file) { return file.age_days < options.older_than_days; });
  std::uint64_t bytes = 0;
  for (const CachedFile& file : files) bytes += file.bytes;
  std::vector<std::string> titles;
  for (const CachedFile& file : files) titles.push_back(entry_title(file, lab.cache()));
  if (options.prune && !options.dry_run)
    for (const CachedFile& file : files) {
      std::error_code error;
      fs::remove(file.path, error);
      if (error) fail("U010", "cannot remove `" + file.path.string() + "`: " + error.message());
    }
  print({.table = file_table(files, titles)}, options.common);
  const char* verb = !options.prune ? "in" : options.dry_run ? "would be removed from" : "removed from";
  context.log.say(fmt::format("{} files, {:.1f} MiB {} {}", files.size(),
                              static_cast<double>(bytes) / kBytesPerMib, verb, lab.cache().folder()));
  return ExitStatus::done;
}

}  // namespace hwsim::cli
