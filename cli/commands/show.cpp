#include <fmt/format.h>

#include <algorithm>

#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "hwsim/base/file_name.h"
#include "lab/base/messages.h"
#include "lab/catalog/gpu_view.h"

namespace hwsim::cli {
namespace {

[[noreturn]] void fail_unknown(const std::string& name, const std::vector<std::string>& gpus,
                               const Catalog& catalog) {
  std::vector<std::string> names = gpus;
  for (std::string& entry : catalog.entry_names()) names.push_back(std::move(entry));
  fail("U016", "no GPU, scene, technique, counter or table is called `" + name + "`",
       did_you_mean(name, names), "`hwsim list gpus` (scenes, techniques, counters, tables) lists them");
}

/// The name alone, or behind the kind that it has: `show gpu gtx980`.
std::string name_of(const std::vector<std::string>& words) {
  static const std::vector<std::string> kinds = {"gpu", "scene", "technique", "counter", "table"};
  if (words.size() == 1) return words.front();
  if (std::ranges::find(kinds, words.front()) == kinds.end())
    fail_usage("U016", "`" + words.front() + "` is no kind of thing to show",
               did_you_mean(words.front(), kinds),
               "gpu, scene, technique, counter or table, or the name alone");
  return words.back();
}

}  // namespace

ExitStatus show_entry(const ShowArguments& options, Context& context) {
  const std::string name = name_of(options.words);
  const Lab lab(lab_options(options.common, context.log));
  const ConfigFolder& folder = lab.catalog().folder();
  const std::vector<std::string> gpus = list_gpus(folder.gpus());
  if (has_extension(name, ".toml") || std::find(gpus.begin(), gpus.end(), name) != gpus.end()) {
    const GpuConfig gpu = load_gpu_from_options(folder, name, options.overlays, options.sets);
    print({.table = key_table(gpu, options.origin), .heading = fmt::format("{}: {}\n\n", gpu.id, gpu.title)},
          options.common);
    return ExitStatus::done;
  }
  const std::optional<CatalogEntry> entry = lab.catalog().entry(name);
  if (!entry) fail_unknown(name, gpus, lab.catalog());
  print({.table = entry->table, .heading = entry->title.empty() ? "" : entry->title + "\n\n"},
        options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
