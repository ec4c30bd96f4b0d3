#include <fmt/format.h>

#include <algorithm>

#include "algos/techniques.h"
#include "lab/catalog/catalog.h"
#include "pipeline/open/scene_source.h"

namespace hwsim::lab {
namespace {

constexpr std::size_t kTextColumns = 72;

std::string range_text(double low, double high) { return fmt::format("{} to {}", low, high); }

std::string choice_name(std::string_view choices, double index) {
  for (; index >= 1.0; --index) choices.remove_prefix(choices.find('|') + 1);
  return std::string(choices.substr(0, choices.find('|')));
}

Table parameter_table() {
  return {{{"parameter", "parameter"},
           {"default", "default", true},
           {"range", "range"},
           {"description", "description", false, kTextColumns}},
          {}};
}

CatalogEntry describe(const algos::TechniqueInfo& info) {
  CatalogEntry entry{fmt::format("{} ({}): {}", info.id, algos::kind_name(info.kind()), info.description),
                     parameter_table()};
  for (const algos::OptionInfo& p : info.options) {
    const bool named = !p.choices.empty();
    entry.table.rows.push_back(
        {std::string(p.name),
         named ? choice_name(p.choices, p.default_value) : fmt::format("{}", p.default_value),
         named ? std::string(p.choices) : range_text(p.min, p.max), std::string(p.description)});
  }
  return entry;
}

CatalogEntry describe(const pipeline::GeneratorInfo& info) {
  CatalogEntry entry{fmt::format("{}: {}", info.name, info.description), parameter_table()};
  for (const pipeline::GeneratorParameter& p : info.parameters)
    entry.table.rows.push_back(
        {p.name, fmt::format("{}", p.default_value), range_text(p.min, p.max), p.description});
  return entry;
}

CatalogEntry describe(const CounterInfo& info) {
  return {.table = {{{"id", "id"}, {"unit", "unit"}, {"unit_kind", "kind"}, {"description", "one count is"}},
                    {{std::string(info.id), std::string(info.unit), std::string(info.unit_kind),
                      std::string(info.description)}}}};
}

}  // namespace

std::optional<CatalogEntry> Catalog::entry(const std::string& name) const {
  for (const algos::TechniqueInfo& info : algos::techniques())
    if (info.id == name) return describe(info);
  for (const pipeline::GeneratorInfo& info : pipeline::generators())
    if (info.name == name) return describe(info);
  for (const auto& [info, place] : algos::counters())
    if (info.id == name) return describe(info);
  const std::vector<std::string> tables = names_of(published_tables());
  if (std::find(tables.begin(), tables.end(), name) == tables.end()) return std::nullopt;
  return CatalogEntry{.table = read_table(folder_.published() + "/" + name + ".csv")};
}

}  // namespace hwsim::lab
