#include "cost_models/experiment.h"

#include <algorithm>

#include "hwsim/base/content_hash.h"
#include "hwsim/trace/trace_file.h"

namespace hwsim::cost_models {
namespace {

bool any_pass_matches(const WorkTrace& trace, const std::string& patterns) {
  return std::any_of(trace.passes.begin(), trace.passes.end(),
                     [&](const PassWork& pass) { return pass_matches(patterns, pass.name); });
}

/// FNV-1a of a pass as a trace file would hold it: 600 passes share a hash with a
/// probability of 1e-14.
std::vector<std::uint64_t> keys_of_passes(const WorkTrace& trace) {
  std::vector<std::uint64_t> keys;
  for (const PassWork& pass : trace.passes) {
    WorkTrace alone;
    alone.passes.push_back(pass);
    keys.push_back(fnv1a(encode_trace(alone)));
  }
  return keys;
}

class Builder {
 public:
  Builder(Experiment& experiment, const TraceSource& traces, const StepProgress& progress)
      : experiment_(experiment), traces_(traces), progress_(progress) {}

  void run() {
    std::map<RunSpec, std::vector<std::size_t>> runs;
    for (std::size_t i = 0; i < experiment_.cells.size(); ++i) {
      const Cell& cell = experiment_.cells[i];
      if (cell.has_run && cell.use != RowUse::claim) runs[cell.run].push_back(i);
    }
    std::size_t done = 0;
    for (const auto& [spec, cells] : runs) {
      progress_(done++, runs.size(), spec.to_string());
      add(spec, cells);
    }
    progress_(done, runs.size(), "");
  }

 private:
  void add(const RunSpec& spec, const std::vector<std::size_t>& cells) {
    Replay replay;
    replay.run = spec;
    replay.gpu = experiment_.gpu_index(spec.gpu);
    const GpuConfig& gpu = experiment_.gpus[replay.gpu];
    try {
      replay.trace = traces_(spec, gpu);
      if (!spec.unlit.empty()) {
        replay.unlit = traces_(without_lights(spec), gpu);
        if (!same_passes(*replay.trace, *replay.unlit)) replay.unlit = nullptr;
      }
    } catch (const InputError& error) {
      for (const std::size_t cell : cells) experiment_.not_run.push_back({cell, reason_of(error)});
      return;
    }
    for (const std::size_t cell : cells) {
      const std::string& patterns = experiment_.cells[cell].passes;
      if (any_pass_matches(*replay.trace, patterns))
        replay.cells.push_back(cell);
      else
        experiment_.not_run.push_back(
            {cell, "no pass of `" + spec.technique + "` is called `" + patterns + "`"});
    }
    replay.pass_keys = keys_of_passes(*replay.trace);
    if (replay.unlit) replay.unlit_pass_keys = keys_of_passes(*replay.unlit);
    if (!replay.cells.empty()) experiment_.replays.push_back(std::move(replay));
  }

  static bool same_passes(const WorkTrace& a, const WorkTrace& b) {
    return std::equal(a.passes.begin(), a.passes.end(), b.passes.begin(), b.passes.end(),
                      [](const PassWork& p, const PassWork& q) { return p.name == q.name; });
  }

  Experiment& experiment_;
  const TraceSource& traces_;
  const StepProgress& progress_;
};

}  // namespace

bool Experiment::predicted(std::size_t cell) const {
  return cells[cell].has_run && cells[cell].use != RowUse::claim &&
         std::none_of(not_run.begin(), not_run.end(), [&](const NotRun& n) { return n.cell == cell; });
}

std::size_t Experiment::gpu_index(const std::string& id) const {
  const auto found =
      std::find_if(gpus.begin(), gpus.end(), [&](const GpuConfig& gpu) { return gpu.id == id; });
  return static_cast<std::size_t>(found - gpus.begin());
}

Experiment make_experiment(std::vector<Cell> cells, const std::map<std::string, GpuConfig>& gpus,
                           const std::string& parameters_path, const TraceSource& traces,
                           const StepProgress& progress) {
  Experiment experiment;
  experiment.cells = std::move(cells);
  for (const auto& [id, gpu] : gpus) experiment.gpus.push_back(gpu);
  experiment.parameters = load_parameters(parameters_path, gpus);
  Builder(experiment, traces, progress).run();
  return experiment;
}

std::string reason_of(const InputError& error) {
  return error.diagnostics().empty() ? error.what() : error.diagnostics().front().message;
}

}  // namespace hwsim::cost_models
