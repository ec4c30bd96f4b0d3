#include <fmt/format.h>

#include <algorithm>

#include "cost_models/statistics.h"
#include "lab/studies/validation.h"

namespace hwsim::lab {
namespace {

std::vector<TableCell> errors_row(const std::string& name, const Errors& e, bool intervals) {
  return {name,
          std::uint64_t{e.cells},
          Real{e.mape_pct, 1},
          Real{e.median_ape_pct, 1},
          Real{e.kendall, 2},
          intervals ? TableCell{Real{e.coverage90_pct, 0}} : TableCell{NotApplicable{}},
          intervals ? TableCell{Real{e.width_ratio, 2}} : TableCell{NotApplicable{}},
          e.worst ? fmt::format("{:.0f} % {}", e.worst->ape_pct, e.worst->cell) : std::string()};
}

Table errors_table(const std::string& first) {
  return {{{"name", first},
           {"cells", "cells", true},
           {"mape_pct", "MAPE %", true},
           {"median_ape_pct", "median %", true},
           {"kendall", "Kendall", true},
           {"coverage90_pct", "in 90 % interval", true},
           {"width_ratio", "its width", true},
           {"worst", "worst cell", false, 60}},
          {}};
}

std::string state_of(const cost_models::Estimate& e) {
  if (!e.used) return "no data";
  if (!e.credible) return e.at_bound ? "not credible: at bound" : "not credible: far from the others";
  if (e.at_bound) return "at bound, as documented";
  return e.identified ? "" : "not identified";
}

}  // namespace

std::string cell_name(const cost_models::Cell& cell) {
  return fmt::format("{}{}, {} on {}, {} ({})", cell.scene_group,
                     cell.run.camera == "0" ? "" : " " + cell.run.camera, cell.run.technique, cell.run.gpu,
                     cell.row.pass, cell.row.id());
}

Table split_table(const Validation& validation) {
  Table table = errors_table("split");
  for (const SplitErrors& split : validation.splits) {
    table.rows.push_back(errors_row(split.split, split.errors, true));
    for (const auto& [baseline, errors] : split.baselines)
      table.rows.push_back(errors_row("  " + baseline, errors, false));
  }
  return table;
}

Table ratio_table(const Validation& validation) {
  Table table{{{"split", "ratios of techniques"},
               {"pairs", "pairs", true},
               {"median_ape_pct", "median %", true},
               {"coverage90_pct", "in 90 % interval", true},
               {"width_ratio", "its width", true}},
              {}};
  for (const SplitErrors& split : validation.splits)
    if (const RatioErrors& r = split.ratios; r.pairs > 0)
      table.rows.push_back({split.split, std::uint64_t{r.pairs}, Real{r.median_ape_pct, 1},
                            Real{r.coverage90_pct, 0}, Real{r.width_ratio, 2}});
  return table;
}

Table label_table(const Validation& validation) {
  Table table = errors_table("in sample");
  for (const auto* labels : {&validation.papers, &validation.gpus})
    for (const auto& [name, errors] : *labels) table.rows.push_back(errors_row(name, errors, true));
  return table;
}

Table worst_table(const FittedModel& model, std::size_t count) {
  const std::vector<cost_models::Cell>& known = model.experiment.cells;
  Table table{{{"split", "split"},
               {"ape_pct", "error %", true},
               {"published_ms", "published ms", true},
               {"predicted_ms", "predicted ms", true},
               {"cell", "cell"}},
              {}};
  for (const cost_models::SplitResult& split : model.figures.splits) {
    std::vector<cost_models::HeldOut> cells = split.cells;
    const auto error = [&](const cost_models::HeldOut& c) {
      return cost_models::percent_error(c.predicted_ms, known[c.cell].published);
    };
    std::stable_sort(cells.begin(), cells.end(),
                     [&](const auto& a, const auto& b) { return error(a) > error(b); });
    for (std::size_t i = 0; i < std::min(count, cells.size()); ++i)
      table.rows.push_back({std::string(cost_models::split_name(split.split)), Real{error(cells[i]), 1},
                            Real{known[cells[i].cell].published, 2}, Real{cells[i].predicted_ms, 2},
                            cell_name(known[cells[i].cell])});
  }
  return table;
}

Table parameter_table(const FittedModel& model) {
  Table table{{{"parameter", "parameter"},
               {"unit", "unit"},
               {"start", "start", true},
               {"low", "low", true},
               {"high", "high", true},
               {"value", "fitted", true},
               {"low90", "90 % from", true},
               {"high90", "to", true},
               {"state", "state"},
               {"meaning", "meaning", false, 60}},
              {}};
  for (std::size_t i = 0; i < model.experiment.parameters.size(); ++i) {
    const cost_models::FittedParameter& p = model.experiment.parameters[i];
    const cost_models::Estimate& e = model.figures.fit.estimates[i];
    table.rows.push_back({p.id(), p.unit, Real{p.start, 3}, Real{p.low, 3}, Real{p.high, 3}, Real{e.value, 3},
                          Real{e.low90, 3}, Real{e.high90, 3}, state_of(e), p.meaning});
  }
  return table;
}

}  // namespace hwsim::lab
