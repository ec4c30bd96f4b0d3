#include "lab/report/belief.h"

#include <fmt/format.h>

#include "cost_models/statistics.h"
#include "cost_models/validation.h"
#include "lab/studies/published_runs.h"

namespace hwsim::lab {
namespace {

using Json = nlohmann::ordered_json;

/// A cell whose prediction by a fit without its scene is kept.
struct HeldCell {
  cost_models::Cell cell;
  double held_out_ms = 0.0;
};

std::vector<HeldCell> held_cells(const cost_models::Calibration& calibration, const ConfigFolder& folder) {
  std::vector<HeldCell> held;
  for (cost_models::Cell& cell : published_cells({}, folder)) {
    const auto found = calibration.held_out_ms.find(cell.row.id());
    if (found != calibration.held_out_ms.end() && cell.unit == "ms" && cell.published > 0.0)
      held.push_back({std::move(cell), found->second});
  }
  return held;
}

std::string scene_of(const cost_models::PublishedRow& row) {
  return row.scene + (row.view.empty() ? "" : ", " + row.view);
}

PublishedPoint point_of(const HeldCell& held, bool own) {
  const cost_models::PublishedRow& row = held.cell.row;
  return {.row = row.id(),
          .paper = row.document,
          .gpu = held.cell.run.gpu,
          .technique = held.cell.run.technique,
          .scene = scene_of(row),
          .what = row.pass,
          .published_ms = held.cell.published,
          .held_out_ms = held.held_out_ms,
          .own = own};
}

/// The pairs that `validate` counts: alike in all but the technique.
std::vector<PublishedRatio> ratios_of(const std::vector<HeldCell>& cells, const std::set<std::string>& gpus) {
  std::vector<PublishedRatio> ratios;
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t j = i + 1; j < cells.size(); ++j) {
      const cost_models::Cell &first = cells[i].cell, &second = cells[j].cell;
      if (cost_models::rank_group(first) != cost_models::rank_group(second) ||
          first.run.technique == second.run.technique)
        continue;
      ratios.push_back({.first = first.row.id(),
                        .second = second.row.id(),
                        .paper = first.row.document,
                        .gpu = first.run.gpu,
                        .techniques = second.run.technique + " / " + first.run.technique,
                        .scene = scene_of(first.row),
                        .what = first.row.pass,
                        .published = second.published / first.published,
                        .held_out = cells[j].held_out_ms / cells[i].held_out_ms,
                        .own = gpus.contains(first.run.gpu)});
    }
  return ratios;
}

template <class Row, class Published, class Predicted>
void add_errors(std::vector<BeliefErrors>& errors, const std::string& what, const std::vector<Row>& rows,
                const Published& published, const Predicted& predicted, bool own_only) {
  std::vector<double> apes;
  for (const Row& row : rows)
    if (row.own || !own_only) apes.push_back(cost_models::percent_error(predicted(row), published(row)));
  if (!apes.empty())
    errors.push_back({what, apes.size(), cost_models::mean(apes), cost_models::median(apes), std::nullopt});
}

void add_external(std::vector<BeliefErrors>& errors, const std::string& what, const ExternalErrors& e) {
  errors.push_back({what, e.rows, e.mape_pct, e.median_ape_pct,
                    e.width_ratio > 0.0 ? std::optional(e.coverage90_pct) : std::nullopt});
}

void summarize(Belief& belief, const ExternalValidation& external) {
  const auto published_ms = [](const PublishedPoint& p) { return p.published_ms; };
  const auto held_out_ms = [](const PublishedPoint& p) { return p.held_out_ms; };
  const auto published = [](const PublishedRatio& r) { return r.published; };
  const auto held_out = [](const PublishedRatio& r) { return r.held_out; };
  for (const bool own : {true, false}) {
    const std::string where = own ? " on GPUs of this report" : " on all calibrated GPUs";
    add_errors(belief.errors, "times of scenes held out," + where, belief.times, published_ms, held_out_ms,
               own);
    add_errors(belief.errors, "ratios of two techniques, scenes held out," + where, belief.ratios, published,
               held_out, own);
  }
  if (external.all.rows == 0) return;
  add_external(belief.errors, "other renderers' times, which no fit saw", external.all);
  for (const auto& [gpu, errors] : external.gpus) add_external(belief.errors, "the same on " + gpu, errors);
}

}  // namespace

Belief belief_of(const std::set<std::string>& gpus, Session& session) {
  Belief belief;
  const auto calibration = session.files().calibration();
  if (!calibration) return belief;
  const std::vector<HeldCell> cells = held_cells(*calibration, session.files().folder());
  for (const HeldCell& cell : cells) belief.times.push_back(point_of(cell, gpus.contains(cell.cell.run.gpu)));
  belief.ratios = ratios_of(cells, gpus);
  ExternalValidation external;
  try {
    external = validate_external(external_traces({}, session), session);
  } catch (const InputError& error) {  // a configuration without kept work still reports
    session.observer().say("without times of other renderers: " + error.diagnostics().front().message);
  }
  belief.external = external.rows;
  summarize(belief, external);
  return belief;
}

Table error_table(const Belief& belief) {
  Table table{{{"what", "predictions of"},
               {"count", "number", true},
               {"mape_pct", "mean error %", true},
               {"median_ape_pct", "median %", true},
               {"coverage90_pct", "% in their 90 % interval", true}},
              {}};
  for (const BeliefErrors& e : belief.errors)
    table.rows.push_back({e.what, std::uint64_t{e.count}, Real{e.mape_pct, 1}, Real{e.median_ape_pct, 1},
                          e.coverage90_pct ? TableCell{Real{*e.coverage90_pct, 0}} : NotApplicable{}});
  return table;
}

Table published_table(const Belief& belief) {
  Table table{{{"paper", "paper"},
               {"gpu", "GPU"},
               {"technique", "technique"},
               {"scene", "scene"},
               {"what", "what"},
               {"published_ms", "published ms", true},
               {"held_out_ms", "predicted ms", true},
               {"ratio", "predicted / published", true},
               {"row", "row"}},
              {}};
  for (const PublishedPoint& p : belief.times)
    table.rows.push_back({p.paper, p.gpu, p.technique, p.scene, p.what, Real{p.published_ms, 3},
                          Real{p.held_out_ms, 3}, Real{p.held_out_ms / p.published_ms, 2}, p.row});
  return table;
}

std::vector<PublishedRatio> ratios_of(const Belief& belief, const std::string& paper) {
  std::vector<PublishedRatio> own;
  std::ranges::copy_if(belief.ratios, std::back_inserter(own),
                       [&](const PublishedRatio& ratio) { return ratio.paper == paper; });
  return own;
}

std::size_t in_published_order(const std::vector<PublishedRatio>& ratios) {
  return static_cast<std::size_t>(std::ranges::count_if(
      ratios, [](const PublishedRatio& r) { return (r.held_out > 1.0) == (r.published > 1.0); }));
}

Table ratio_table(const std::vector<PublishedRatio>& ratios) {
  Table table{{{"paper", "paper"},
               {"gpu", "GPU"},
               {"techniques", "techniques"},
               {"scene", "scene"},
               {"what", "what"},
               {"published", "published ratio", true},
               {"held_out", "predicted ratio", true},
               {"ratio", "predicted / published", true},
               {"first", "row"},
               {"second", "over row"}},
              {}};
  for (const PublishedRatio& r : ratios)
    table.rows.push_back({r.paper, r.gpu, r.techniques, r.scene, r.what, Real{r.published, 3},
                          Real{r.held_out, 3}, Real{r.held_out / r.published, 2}, r.second, r.first});
  return table;
}

Table external_table(const Belief& belief) { return external_rows_table({.rows = belief.external}); }

Json to_json(const Belief& belief) {
  Json json = {{"published", Json::array()},
               {"published_ratios", Json::array()},
               {"external", to_json(ExternalValidation{.rows = belief.external}).at("rows")},
               {"errors", to_json(error_table(belief))}};
  for (const PublishedPoint& p : belief.times)
    json["published"].push_back({{"row", p.row},
                                 {"paper", p.paper},
                                 {"gpu", p.gpu},
                                 {"technique", p.technique},
                                 {"scene", p.scene},
                                 {"what", p.what},
                                 {"published_ms", p.published_ms},
                                 {"held_out_ms", p.held_out_ms},
                                 {"own", p.own}});
  for (const PublishedRatio& r : belief.ratios)
    json["published_ratios"].push_back({{"first", r.first},
                                        {"second", r.second},
                                        {"paper", r.paper},
                                        {"gpu", r.gpu},
                                        {"techniques", r.techniques},
                                        {"scene", r.scene},
                                        {"what", r.what},
                                        {"published", r.published},
                                        {"held_out", r.held_out},
                                        {"own", r.own}});
  return json;
}

}  // namespace hwsim::lab
