#include "lab/studies/validation_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "cost_models/statistics.h"

namespace hwsim::lab {
namespace {

using cost_models::Experiment;
using cost_models::Figures;
using cost_models::SplitResult;
using cost_models::Validation;
using Json = nlohmann::ordered_json;

Json figures_json(const Experiment& experiment, const Figures& f) {
  Json json = {{"cells", f.cells}, {"mape_pct", f.mape_pct}, {"median_ape_pct", f.median_ape_pct}};
  json["worst"] = nullptr;
  if (f.worst)
    json["worst"] = {{"row", experiment.cells[f.worst->cell].row.id()},
                     {"cell", cell_name(experiment.cells[f.worst->cell])},
                     {"ape_pct", f.worst->ape_pct}};
  json["kendall"] = f.kendall;
  json["coverage90_pct"] = f.coverage90_pct;
  return json;
}

std::vector<Cell> figures_row(const Experiment& experiment, const std::string& name, const Figures& f,
                              bool intervals) {
  return {name,
          std::uint64_t{f.cells},
          Real{f.mape_pct, 1},
          Real{f.median_ape_pct, 1},
          Real{f.kendall, 2},
          intervals ? ::hwsim::lab::Cell{Real{f.coverage90_pct, 0}} : ::hwsim::lab::Cell{NotApplicable{}},
          f.worst ? fmt::format("{:.0f} % {}", f.worst->ape_pct, cell_name(experiment.cells[f.worst->cell]))
                  : std::string()};
}

Table figures_table(const std::string& first) {
  return {{{"name", first},
           {"cells", "cells", true},
           {"mape_pct", "MAPE %", true},
           {"median_ape_pct", "median %", true},
           {"kendall", "Kendall", true},
           {"coverage90_pct", "in 90 % interval", true},
           {"worst", "worst cell", false, 60}},
          {}};
}

}  // namespace

std::string cell_name(const cost_models::Cell& cell) {
  return fmt::format("{}{}, {} on {}, {} ({})", cell.scene_group,
                     cell.run.camera == "0" ? "" : " " + cell.run.camera, cell.run.technique, cell.run.gpu,
                     cell.row.pass, cell.row.id());
}

Json validation_json(const Experiment& experiment, const Validation& validation) {
  Json json = {{"schema_version", 1}};
  for (const SplitResult& split : validation.splits) {
    const std::string name(cost_models::split_name(split.split));
    json["splits"][name] = figures_json(experiment, split.figures);
    for (const auto& [baseline, figures] : split.baselines)
      json["baselines"][baseline][name] = figures_json(experiment, figures);
  }
  json["papers"] = Json::object();
  for (const auto& [paper, figures] : validation.papers)
    json["papers"][paper] = figures_json(experiment, figures);
  json["gpus"] = Json::object();
  for (const auto& [gpu, figures] : validation.gpus) json["gpus"][gpu] = figures_json(experiment, figures);
  json["counts"] = {
      {"shaded_samples",
       {{"mape_pct", validation.shaded_samples_mape_pct}, {"cells", validation.shaded_samples_cells}}},
      {"memory", {{"worst_pct", validation.memory_worst_pct}, {"cells", validation.memory_cells}}}};
  json["parameters"] = validation.fit.used_parameters;
  json["fitted_values"] = validation.fit.fitted_values;
  json["not_run"] = Json::array();
  for (const cost_models::NotRun& n : experiment.not_run)
    json["not_run"].push_back({{"row", experiment.cells[n.cell].row.id()}, {"reason", n.reason}});
  return json;
}

Table split_table(const Experiment& experiment, const Validation& validation) {
  Table table = figures_table("split");
  for (const SplitResult& split : validation.splits) {
    table.rows.push_back(
        figures_row(experiment, std::string(cost_models::split_name(split.split)), split.figures, true));
    for (const auto& [baseline, figures] : split.baselines)
      table.rows.push_back(figures_row(experiment, "  " + baseline, figures, false));
  }
  return table;
}

Table label_table(const Experiment& experiment, const Validation& validation) {
  Table table = figures_table("in sample");
  for (const auto* labels : {&validation.papers, &validation.gpus})
    for (const auto& [name, figures] : *labels)
      table.rows.push_back(figures_row(experiment, name, figures, true));
  return table;
}

Table worst_table(const Experiment& experiment, const Validation& validation, std::size_t count) {
  Table table{{{"split", "split"},
               {"ape_pct", "error %", true},
               {"published_ms", "published ms", true},
               {"predicted_ms", "predicted ms", true},
               {"cell", "cell"}},
              {}};
  for (const SplitResult& split : validation.splits) {
    std::vector<cost_models::HeldOut> cells = split.cells;
    const auto error = [&](const cost_models::HeldOut& c) {
      return cost_models::percent_error(c.predicted_ms, experiment.cells[c.cell].published);
    };
    std::stable_sort(cells.begin(), cells.end(),
                     [&](const auto& a, const auto& b) { return error(a) > error(b); });
    for (std::size_t i = 0; i < std::min(count, cells.size()); ++i)
      table.rows.push_back({std::string(cost_models::split_name(split.split)), Real{error(cells[i]), 1},
                            Real{experiment.cells[cells[i].cell].published, 2},
                            Real{cells[i].predicted_ms, 2}, cell_name(experiment.cells[cells[i].cell])});
  }
  return table;
}

}  // namespace hwsim::lab
