#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cost_models/validation.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/catalog/config_files.h"
#include "lab/results/scatter_plot.h"
#include "lab/studies/published_runs.h"

namespace hwsim::cli {
namespace {

namespace fs = std::filesystem;
using cost_models::Experiment;
using cost_models::Fit;
using cost_models::HeldOut;
using cost_models::RowUse;

/// What is known about a row beside what was printed.
struct RowAnswer {
  ::hwsim::cli::Cell predicted = NotApplicable{}, low = NotApplicable{}, high = NotApplicable{},
                     held_out = NotApplicable{};
  std::string excluded_because;
};

/// The parameters of the calibration, or the documented start with wide, unlabeled uncertainty.
Fit fit_for(const Experiment& experiment, const cost_models::Calibration* calibration, Log& log) {
  if (calibration)
    if (auto fit = cost_models::fit_of(*calibration, experiment.parameters)) return *fit;
  log.say(calibration
              ? "the calibration is of other parameters; documented values are used, without intervals"
              : "not calibrated: documented values are used, without intervals; `hwsim fit` calibrates");
  Fit fit;
  for (const cost_models::Parameter& p : experiment.parameters) fit.log_values.push_back(std::log(p.start));
  fit.covariance.assign(fit.log_values.size() * fit.log_values.size(), 0.0);
  return fit;
}

class Reproduction {
 public:
  Reproduction(const ReproduceOptions& options, Context& context)
      : options_(options),
        calibration_(ConfigFiles().calibration()),
        experiment_(load_experiment(published_cells({options.paper}), options.common.jobs, context.log)),
        answers_(experiment_.cells.size()) {
    const Fit fit = fit_for(experiment_, calibration_.get(), context.log);
    const bool known = fit.residual_log_sd > 0.0;
    const double quantile = known ? calibration_->quantile90.at("in_sample") : 0.0;
    predictions_ = cost_models::predict_cells(experiment_, fit, quantile, options.common.jobs);
    for (const HeldOut& p : predictions_) set_time(p, known);
    for (const cost_models::Replay& replay : experiment_.replays)
      for (const std::size_t cell : replay.cells)
        if (experiment_.cells[cell].unit != "ms")
          answers_[cell].predicted = Real{cost_models::counted(experiment_, replay, cell),
                                          experiment_.cells[cell].unit == "mib" ? 1 : 0};
    for (std::size_t i = 0; i < answers_.size(); ++i)
      answers_[i].excluded_because = experiment_.cells[i].reason;
    for (const cost_models::NotRun& n : experiment_.not_run)
      answers_[n.cell].excluded_because = "not run: " + n.reason;
  }

  /// The printed columns with the five of the contract added.
  Table full_table() const {
    Table table{{}, {}};
    for (const char* column : {"document",
                               "table",
                               "gpu",
                               "resolution",
                               "scene",
                               "view",
                               "technique",
                               "msaa",
                               "surfaces_or_aggregates",
                               "lighting",
                               "pass",
                               "quantity",
                               "value",
                               "note",
                               "use",
                               "published_absolute",
                               "unit",
                               "predicted",
                               "lo",
                               "hi",
                               "held_out_predicted",
                               "excluded_because"})
      table.columns.push_back({column, column});
    for (std::size_t i = 0; i < answers_.size(); ++i) {
      const cost_models::Cell& cell = experiment_.cells[i];
      const cost_models::PublishedRow& r = cell.row;
      const RowAnswer& a = answers_[i];
      table.rows.push_back({r.document,
                            r.table,
                            r.gpu,
                            r.resolution,
                            r.scene,
                            r.view,
                            r.technique,
                            r.msaa,
                            r.surfaces,
                            r.lighting,
                            r.pass,
                            r.quantity,
                            r.printed,
                            r.note,
                            std::string(row_use_name(cell.use)),
                            Real{cell.published, 3},
                            cell.unit,
                            a.predicted,
                            a.low,
                            a.high,
                            a.held_out,
                            a.excluded_because});
    }
    return table;
  }

  Table text_table() const {
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
    for (std::size_t i = 0; i < answers_.size(); ++i) {
      const cost_models::Cell& cell = experiment_.cells[i];
      if (cell.use == RowUse::claim) continue;
      const RowAnswer& a = answers_[i];
      ::hwsim::cli::Cell error = NotApplicable{};
      if (const Real* p = std::get_if<Real>(&a.predicted); p && cell.published > 0.0)
        error = Real{(p->value / cell.published - 1.0) * 100.0, 1};
      const cost_models::PublishedRow& r = cell.row;
      table.rows.push_back(
          {r.id(),
           r.scene + (r.view == "scene view" || r.view.empty() ? "" : " " + r.view) +
               (r.lighting == "complex" ? " complex" : ""),
           r.technique + (r.surfaces.empty() ? "" : r.surfaces) + (r.msaa.empty() ? "" : " " + r.msaa + "x"),
           r.pass, cell.run.gpu, Real{cell.published, cell.unit == "samples" ? 0 : 2}, a.predicted, a.low,
           a.high, a.held_out, cell.unit, error, a.excluded_because});
    }
    return table;
  }

  std::string figures_text() const {
    std::vector<HeldOut> fitted;
    for (const HeldOut& p : predictions_)
      if (experiment_.cells[p.cell].use == RowUse::fitted) fitted.push_back(p);
    if (fitted.empty()) return "no fitted row could be run\n";
    const cost_models::Figures f = cost_models::figures_of(experiment_, fitted);
    return fmt::format(
        "{} fitted times: MAPE {:.1f} %, median {:.1f} %, Kendall {:.2f}, {:.0f} % inside their intervals\n",
        f.cells, f.mape_pct, f.median_ape_pct, f.kendall, f.coverage90_pct);
  }

  void write_pictures(const std::string& folder) const {
    fs::create_directories(folder);
    Plot scatter{"Published and predicted times: " + options_.paper,
                 "published, ms",
                 "predicted, ms",
                 {},
                 true,
                 true,
                 true,
                 {}};
    Plot residuals{
        "Errors by pass: " + options_.paper, "", "predicted over published, %", {}, false, false, false, {}};
    for (const HeldOut& p : predictions_) {
      const cost_models::Cell& cell = experiment_.cells[p.cell];
      if (cell.use != RowUse::fitted && cell.use != RowUse::derived) continue;
      const std::string label =
          fmt::format("{} {} {}: published {:.2f}, predicted {:.2f} ms", cell.row.scene, cell.row.technique,
                      cell.row.pass, cell.published, p.predicted_ms);
      scatter.points.push_back({cell.published, p.predicted_ms, p.low_ms, p.high_ms, cell.row.scene, label,
                                cell.use == RowUse::derived});
      const std::string name = cell.row.technique + " " + cell.row.pass;
      auto at = std::find(residuals.x_names.begin(), residuals.x_names.end(), name);
      if (at == residuals.x_names.end()) at = residuals.x_names.insert(at, name);
      residuals.points.push_back({static_cast<double>(at - residuals.x_names.begin()),
                                  (p.predicted_ms / cell.published - 1.0) * 100.0, 0.0, 0.0, cell.row.scene,
                                  label, cell.use == RowUse::derived});
    }
    write_file((fs::path(folder) / (options_.paper + "_scatter.svg")).string(), to_svg(scatter));
    write_file((fs::path(folder) / (options_.paper + "_residuals.svg")).string(), to_svg(residuals));
    write_file((fs::path(folder) / (options_.paper + ".csv")).string(), to_csv(full_table()));
  }

 private:
  void set_time(const HeldOut& p, bool known) {
    RowAnswer& a = answers_[p.cell];
    a.predicted = Real{p.predicted_ms, 2};
    if (!known) return;
    a.low = Real{p.low_ms, 2};
    a.high = Real{p.high_ms, 2};
    if (const auto held = calibration_->held_out_ms.find(experiment_.cells[p.cell].row.id());
        held != calibration_->held_out_ms.end())
      a.held_out = Real{held->second, 2};
  }

  const ReproduceOptions& options_;
  std::shared_ptr<const cost_models::Calibration> calibration_;
  Experiment experiment_;
  std::vector<RowAnswer> answers_;
  std::vector<HeldOut> predictions_;
};

bool is_text(const FormatRequest& request) {
  return request.format == Format::table || request.format == Format::md;
}

/// People read fewer columns than programs: each kind of format gets its own table.
void print_both(const Reproduction& reproduction, const CommonOptions& options) {
  CommonOptions text = options, data = options;
  std::erase_if(text.formats, [](const FormatRequest& f) { return !is_text(f); });
  std::erase_if(data.formats, is_text);
  if (options.formats.empty() || !text.formats.empty())
    print({.table = reproduction.text_table(), .footing = "\n" + reproduction.figures_text()}, text);
  if (!data.formats.empty()) print({.table = reproduction.full_table()}, data);
}

}  // namespace

ExitStatus reproduce(const ReproduceOptions& options, Context& context) {
  check_papers({options.paper});
  if (options.dry_run) {
    print({.table = plan_table(published_cells({options.paper}))}, options.common);
    return ExitStatus::done;
  }
  const Reproduction reproduction(options, context);
  if (!options.out.empty()) reproduction.write_pictures(options.out);
  print_both(reproduction, options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
