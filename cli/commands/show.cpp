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
  for (std::string& key : names_of(catalog.sources())) names.push_back(std::move(key));
  fail("U016", "no GPU, scene, technique, counter, table or source is called `" + name + "`",
       did_you_mean(name, names),
       "`hwsim list gpus` (scenes, techniques, counters, tables, sources) lists them");
}

/// The name alone, or behind the kind that it has: `show gpu gtx980`.
std::string name_of(const std::vector<std::string>& words) {
  static const std::vector<std::string> kinds = {"gpu", "scene", "technique", "counter", "table", "source"};
  if (words.size() == 1) return words.front();
  if (std::ranges::find(kinds, words.front()) == kinds.end())
    fail_usage("U016", "`" + words.front() + "` is no kind of thing to show",
               did_you_mean(words.front(), kinds),
               "gpu, scene, technique, counter, table or source, or the name alone");
  return words.back();
}

/// The documents that the GPU's values come from.
Passage sources_of(const GpuConfig& gpu, const Catalog& catalog) {
  std::vector<std::string> texts;
  for (const auto& [key, origin] : gpu.origins) texts.push_back(origin.source);
  const Table sources = catalog.sources_in(texts);
  return sources.rows.empty() ? Passage() : Passage("\n").add(sources);
}

}  // namespace

ExitStatus show_entry(const ShowArguments& options, Context& context) {
  const std::string name = name_of(options.words);
  const Lab lab(lab_options(options.common, context.log));
  const ConfigFolder& folder = lab.catalog().folder();
  const std::vector<std::string> gpus = list_gpus(folder.gpus());
  if (has_extension(name, ".toml") || std::find(gpus.begin(), gpus.end(), name) != gpus.end()) {
    const GpuConfig gpu = load_gpu_from_options(folder, name, options.overlays, options.sets);
    print({.table = key_table(gpu, options.origin),
           .heading = fmt::format("{}: {}\n\n", gpu.id, gpu.title),
           .footing = options.origin ? sources_of(gpu, lab.catalog()) : Passage()},
          options.common);
    return ExitStatus::done;
  }
  if (const Table source = lab.catalog().sources_in({"[" + name + "]"}); !source.rows.empty()) {
    print({.table = source}, options.common);
    return ExitStatus::done;
  }
  const std::optional<CatalogEntry> entry = lab.catalog().entry(name);
  if (!entry) fail_unknown(name, gpus, lab.catalog());
  print({.table = entry->table, .heading = entry->title.empty() ? "" : entry->title + "\n\n"},
        options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
