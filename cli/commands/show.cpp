#include <fmt/format.h>

#include <algorithm>

#include "algos/techniques.h"
#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "hwsim/base/file_name.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/catalog/catalog.h"
#include "lab/catalog/gpu_view.h"
#include "pipeline/open/scene_source.h"

namespace hwsim::cli {
namespace {

std::string range_text(double low, double high) { return fmt::format("{} to {}", low, high); }

std::string choice_name(std::string_view choices, double index) {
  for (; index >= 1.0; --index) choices.remove_prefix(choices.find('|') + 1);
  return std::string(choices.substr(0, choices.find('|')));
}

Table parameter_table() {
  return {{{"parameter", "parameter"},
           {"default", "default", true},
           {"range", "range"},
           {"description", "description", false, 72}},
          {}};
}

Answer describe(const algos::TechniqueInfo& info) {
  Answer answer{
      .table = parameter_table(),
      .heading = fmt::format("{} ({}): {}\n\n", info.id, algos::kind_name(info.kind()), info.description)};
  for (const algos::OptionInfo& p : info.options) {
    const bool named = !p.choices.empty();
    answer.table.rows.push_back(
        {std::string(p.name),
         named ? choice_name(p.choices, p.default_value) : fmt::format("{}", p.default_value),
         named ? std::string(p.choices) : range_text(p.min, p.max), std::string(p.description)});
  }
  return answer;
}

Answer describe(const pipeline::GeneratorInfo& info) {
  Answer answer{.table = parameter_table(),
                .heading = fmt::format("{}: {}\n\n", info.name, info.description)};
  for (const pipeline::GeneratorParameter& p : info.parameters)
    answer.table.rows.push_back(
        {p.name, fmt::format("{}", p.default_value), range_text(p.min, p.max), p.description});
  return answer;
}

Answer describe(const CounterInfo& info) {
  return {.table = {{{"id", "id"}, {"unit", "unit"}, {"unit_kind", "kind"}, {"description", "one count is"}},
                    {{std::string(info.id), std::string(info.unit), std::string(info.unit_kind),
                      std::string(info.description)}}}};
}

/// The entry that is no GPU, if there is one of this name.
std::optional<Answer> find_entry(const std::string& name) {
  for (const algos::TechniqueInfo& info : algos::techniques())
    if (info.id == name) return describe(info);
  for (const pipeline::GeneratorInfo& info : pipeline::generators())
    if (info.name == name) return describe(info);
  for (const auto& [info, place] : algos::counters())
    if (info.id == name) return describe(info);
  const std::vector<std::string> tables = names_of(table_catalog());
  if (std::find(tables.begin(), tables.end(), name) != tables.end())
    return Answer{.table = read_table(published_table_path(name))};
  return std::nullopt;
}

[[noreturn]] void fail_unknown(const std::string& name, const std::vector<std::string>& gpus) {
  std::vector<std::string> names = gpus;
  for (const Table& catalog :
       {scene_catalog(), technique_catalog(), counter_catalog_table(), table_catalog()})
    for (std::string& entry : names_of(catalog)) names.push_back(std::move(entry));
  fail("U016", "no GPU, scene, technique, counter or table is called `" + name + "`",
       did_you_mean(name, names), "`hwsim list gpus` (scenes, techniques, counters, tables) lists them");
}

}  // namespace

ExitStatus show_entry(const ShowOptions& options, Context&) {
  const std::string directory = gpu_directory();
  const std::vector<std::string> gpus = list_gpus(directory);
  if (has_extension(options.name, ".toml") ||
      std::find(gpus.begin(), gpus.end(), options.name) != gpus.end()) {
    const GpuConfig gpu = load_gpu_from_options(options.name, options.overlays, options.sets);
    print({.table = key_table(gpu, options.origin), .heading = fmt::format("{}: {}\n\n", gpu.id, gpu.title)},
          options.common);
    return ExitStatus::done;
  }
  const std::optional<Answer> entry = find_entry(options.name);
  if (!entry) fail_unknown(options.name, gpus);
  print(*entry, options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
