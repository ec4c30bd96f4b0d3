#include "lab/studies/published_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/point/simulate.h"

namespace hwsim::lab {
namespace {

using cost_models::Experiment;
using cost_models::RowUse;
using cost_models::RunSpec;

/// Traces of runs, as `run` would make them: from the cache where it has them.
class RunTraces {
 public:
  RunTraces(int jobs, const Cache& cache, Observer& observer)
      : cache_(cache), store_({.jobs = jobs, .disk = true}, cache, observer) {}

  std::shared_ptr<const WorkTrace> trace(const RunSpec& spec, const GpuConfig& gpu) {
    const View view = request_of(spec).view;
    const algos::TechniqueChoice technique = algos::parse_technique(spec.technique);
    if (!scene_ || !(scene_->plan() == view)) scene_ = std::make_unique<SceneView>(view, cache_, silent_);
    std::shared_ptr<const WorkTrace>& known =
        traces_[TraceStore::work_text(*scene_, technique, gpu, FrameNeeds{})];
    if (!known)  // a copy: without the image that a fresh emulation carries
      known = std::make_shared<const WorkTrace>(
          store_.frame(*scene_, technique, gpu, FrameNeeds{}, nullptr).emulation->trace);
    return known;
  }

 private:
  const Cache& cache_;
  TraceStore store_;
  Observer silent_;  // the loader's notes on stand-in scenes
  std::unique_ptr<SceneView> scene_;
  std::map<std::string, std::shared_ptr<const WorkTrace>> traces_;
};

/// What a user calls a paper: its name in the tables, however it is written ("WireAA", "wire_aa").
std::string folded(const std::string& text) {
  std::string result;
  for (const char c : text)
    if (c != '_') result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

bool is_one_of(const std::string& document, const std::vector<std::string>& papers) {
  return std::ranges::any_of(papers, [&](const std::string& p) { return folded(p) == folded(document); });
}

/// Papers that have no table among `cells`. Throws InputError U003.
void check_papers(const std::vector<std::string>& papers, const std::vector<cost_models::Cell>& cells) {
  std::set<std::string> known;
  for (const cost_models::Cell& cell : cells) known.insert(folded(cell.row.document));
  const std::vector<std::string> names(known.begin(), known.end());
  for (const std::string& paper : papers)
    if (!known.contains(folded(paper)))
      fail_usage("U003", fmt::format("no paper is called `{}`, only {}", paper, fmt::join(names, ", ")),
                 did_you_mean(paper, names));
}

/// Why a run is impossible whatever the scene; empty when nothing is known against it.
std::string technique_problem(const RunSpec& run) {
  try {
    algos::parse_technique(run.technique);
    return {};
  } catch (const InputError& error) {
    return cost_models::reason_of(error);
  }
}

/// Settings that no request takes, of all runs: each once, with the file that says them.
void check_settings(const std::vector<cost_models::Cell>& cells, const ConfigFolder& folder) {
  std::set<std::string> known;
  std::vector<Diagnostic> problems;
  for (const cost_models::Cell& cell : cells) {
    if (!cell.has_run || !known.insert(cell.run.settings + "|" + cell.run.unlit).second) continue;
    try {
      request_of(cell.run);
      if (!cell.run.unlit.empty()) request_of(cost_models::without_lights(cell.run));
    } catch (const InputError& error) {
      append(problems, error);
    }
  }
  for (Diagnostic& problem : problems) problem.place.file = folder.published() + "/mapping/scenes.csv";
  if (!problems.empty()) throw InputError(problems);
}

/// GPUs of runs that no file describes, each once, with the file that names them.
void check_gpus(const std::vector<cost_models::Cell>& cells, const ConfigFolder& folder) {
  std::set<std::string> known;
  std::vector<Diagnostic> problems;
  for (const cost_models::Cell& cell : cells) {
    if (!cell.has_run || !known.insert(cell.run.gpu).second) continue;
    try {
      load_gpu(cell.run.gpu, {}, {}, folder.gpus());
    } catch (const InputError& error) {
      append(problems, error);
    }
  }
  for (Diagnostic& problem : problems)
    if (problem.place.file.empty()) problem.place.file = folder.published() + "/mapping/gpus.csv";
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace

Request request_of(const RunSpec& run) {
  Request request;
  request.view.scene = run.scene;
  request.view.resolution = {run.width_px, run.height_px};
  request.view.camera = run.camera;
  request.techniques = {run.technique};
  request.gpus = {run.gpu};
  std::vector<Assignment> sets;
  for (const std::string& word : split(run.settings, ' '))
    if (!word.empty()) sets.push_back(parse_assignment(word));
  std::vector<Diagnostic> problems;
  apply(request, sets, problems);
  check_choices(request.view, problems);
  if (!problems.empty()) throw InputError(problems);
  return request;
}

std::vector<cost_models::Cell> published_cells(const std::vector<std::string>& papers,
                                               const ConfigFolder& folder) {
  std::vector<cost_models::Cell> cells =
      cost_models::map_rows(cost_models::load_published(folder.published()), folder.published());
  check_papers(papers, cells);
  check_settings(cells, folder);
  check_gpus(cells, folder);
  if (!papers.empty())
    std::erase_if(cells,
                  [&](const cost_models::Cell& cell) { return !is_one_of(cell.row.document, papers); });
  return cells;
}

cost_models::TraceSource emulated_traces(int jobs, const Cache& cache, Observer& observer) {
  return [traces = std::make_shared<RunTraces>(jobs, cache, observer)](
             const RunSpec& spec, const GpuConfig& gpu) { return traces->trace(spec, gpu); };
}

Experiment load_experiment(std::vector<cost_models::Cell> cells, const cost_models::TraceSource& traces,
                           const ConfigFolder& folder, Observer& observer) {
  std::map<std::string, GpuConfig> gpus;
  for (const cost_models::Cell& cell : published_cells({}, folder))  // parameters name GPUs of every paper
    if (cell.has_run && !gpus.contains(cell.run.gpu))
      gpus.emplace(cell.run.gpu, load_gpu(cell.run.gpu, {}, {}, folder.gpus()));
  Experiment experiment = cost_models::make_experiment(
      std::move(cells), gpus, folder.calibration() + "/parameters.csv", traces,
      [&](std::size_t done, std::size_t all, const std::string& what) {
        observer.progress(all == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(all), what);
      });
  observer.progress_ended();
  return experiment;
}

Experiment load_experiment(const std::vector<std::string>& papers, Session& session) {
  const ConfigFolder& folder = session.files().folder();
  return load_experiment(published_cells(papers, folder),
                         emulated_traces(session.jobs(), session.cache(), session.observer()), folder,
                         session.observer());
}

Table plan_table(const std::vector<cost_models::Cell>& cells) {
  Table table{{{"row", "row"},
               {"use", "use"},
               {"published", "published", true},
               {"unit", "unit"},
               {"run", "run", false, 60},
               {"passes", "passes"},
               {"reason", "reason", false, 40}},
              {}};
  for (const cost_models::Cell& cell : cells) {
    if (cell.use == RowUse::claim) continue;
    const std::string missing = cell.has_run ? technique_problem(cell.run) : std::string();
    table.rows.push_back({cell.row.id(), std::string(row_use_name(cell.use)), Real{cell.published, 3},
                          cell.unit, cell.has_run ? cell.run.to_string() : std::string(), cell.passes,
                          missing.empty() ? cell.reason : "not run: " + missing});
  }
  return table;
}

Table not_run_table(const Experiment& experiment) {
  std::map<std::string, std::uint64_t> rows;
  for (const cost_models::NotRun& n : experiment.not_run)
    if (const RowUse use = experiment.cells[n.cell].use; use == RowUse::fitted || use == RowUse::count)
      ++rows[n.reason];
  Table table{{{"rows", "rows", true}, {"not_run_because", "not run because"}}, {}};
  for (const auto& [reason, count] : rows) table.rows.push_back({count, reason});
  return table;
}

}  // namespace hwsim::lab
