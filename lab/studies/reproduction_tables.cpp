#include <fmt/format.h>

#include <array>

#include "lab/studies/reproduction.h"

namespace hwsim::lab {
namespace {

using cost_models::PublishedRow;
using cost_models::RowUse;
using Json = nlohmann::ordered_json;

/// A column that shows a row as it was printed.
struct PrintedColumn {
  const char* name;
  std::string PublishedRow::*text;
};
constexpr std::array<PrintedColumn, 14> kPrinted = {{{"document", &PublishedRow::document},
                                                     {"table", &PublishedRow::table},
                                                     {"gpu", &PublishedRow::gpu},
                                                     {"resolution", &PublishedRow::resolution},
                                                     {"scene", &PublishedRow::scene},
                                                     {"view", &PublishedRow::view},
                                                     {"technique", &PublishedRow::technique},
                                                     {"msaa", &PublishedRow::msaa},
                                                     {"surfaces_or_aggregates", &PublishedRow::surfaces},
                                                     {"lighting", &PublishedRow::lighting},
                                                     {"pass", &PublishedRow::pass},
                                                     {"quantity", &PublishedRow::quantity},
                                                     {"value", &PublishedRow::printed},
                                                     {"note", &PublishedRow::note}}};

/// A column that shows what is known of a row's number.
struct KnownColumn {
  const char* name;
  std::optional<double> ReproducedRow::*value;
};
constexpr std::array<KnownColumn, 4> kKnown = {{{"predicted", &ReproducedRow::predicted},
                                                {"lo", &ReproducedRow::low},
                                                {"hi", &ReproducedRow::high},
                                                {"held_out_predicted", &ReproducedRow::held_out}}};

int decimals_of(const std::string& unit) { return unit == "ms" ? 2 : unit == "mib" ? 1 : 0; }

TableCell number_cell(const std::optional<double>& value, const std::string& unit) {
  if (!value) return NotApplicable{};
  return Real{*value, decimals_of(unit)};
}

TableCell error_cell(const ReproducedRow& row) {
  if (!row.predicted || row.cell.published <= 0.0) return NotApplicable{};
  return Real{(*row.predicted / row.cell.published - 1.0) * 100.0, 1};
}

RowUse use_from_name(const std::string& name) {
  for (const RowUse use : {RowUse::fitted, RowUse::derived, RowUse::count, RowUse::excluded})
    if (row_use_name(use) == name) return use;
  return RowUse::claim;
}

std::vector<TableCell> short_row(const ReproducedRow& row) {
  const cost_models::Cell& cell = row.cell;
  const PublishedRow& r = cell.row;
  return {r.id(),
          r.scene + (r.view == "scene view" || r.view.empty() ? "" : " " + r.view) +
              (r.lighting == "complex" ? " complex" : ""),
          r.technique + (r.surfaces.empty() ? "" : r.surfaces) + (r.msaa.empty() ? "" : " " + r.msaa + "x"),
          r.pass,
          cell.run.gpu,
          Real{cell.published, cell.unit == "samples" ? 0 : 2},
          number_cell(row.predicted, cell.unit),
          number_cell(row.low, cell.unit),
          number_cell(row.high, cell.unit),
          number_cell(row.held_out, cell.unit),
          cell.unit,
          error_cell(row),
          row.excluded_because};
}

}  // namespace

Table reproduction_table(const Reproduction& reproduction) {
  Table table;
  for (const PrintedColumn& column : kPrinted) table.columns.push_back({column.name, column.name});
  for (const char* name : {"use", "published_absolute", "unit"}) table.columns.push_back({name, name});
  for (const KnownColumn& column : kKnown) table.columns.push_back({column.name, column.name});
  table.columns.push_back({"excluded_because", "excluded_because"});
  for (const ReproducedRow& row : reproduction.rows) {
    auto& cells = table.rows.emplace_back();
    for (const PrintedColumn& column : kPrinted) cells.push_back(row.cell.row.*column.text);
    cells.push_back(std::string(row_use_name(row.cell.use)));
    cells.push_back(Real{row.cell.published, 3});
    cells.push_back(row.cell.unit);
    for (const KnownColumn& column : kKnown) cells.push_back(number_cell(row.*column.value, row.cell.unit));
    cells.push_back(row.excluded_because);
  }
  return table;
}

Table short_reproduction_table(const Reproduction& reproduction) {
  Table table{{{"row", "row"},
               {"scene", "scene"},
               {"technique", "technique"},
               {"pass", "pass"},
               {"gpu", "GPU"},
               {"published", "published", true},
               {"predicted", "predicted", true},
               {"lo", "90 % from", true},
               {"hi", "to", true},
               {"held_out_predicted", "scene held out", true},
               {"unit", "unit"},
               {"error_pct", "error %", true},
               {"excluded_because", "not fitted because", false, 48}},
              {}};
  for (const ReproducedRow& row : reproduction.rows)
    if (row.cell.use != RowUse::claim) table.rows.push_back(short_row(row));
  return table;
}

Json to_json(const Reproduction& reproduction) { return to_json(reproduction_table(reproduction)); }

Reproduction reproduction_from_json(const std::string& paper, const Json& json) {
  Reproduction reproduction{.paper = paper};
  for (const Json& from : json) {
    ReproducedRow row;
    for (const PrintedColumn& column : kPrinted)
      row.cell.row.*column.text = from.at(column.name).get<std::string>();
    row.cell.use = use_from_name(from.at("use").get<std::string>());
    row.cell.published = from.at("published_absolute").get<double>();
    row.cell.unit = from.at("unit").get<std::string>();
    for (const KnownColumn& column : kKnown)
      if (const Json& value = from.at(column.name); !value.is_null()) row.*column.value = value.get<double>();
    row.excluded_because = from.at("excluded_because").get<std::string>();
    reproduction.rows.push_back(std::move(row));
  }
  return reproduction;
}

}  // namespace hwsim::lab
