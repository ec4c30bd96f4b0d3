#include "cost_models/predictor.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <thread>
#include <tuple>

#include "cost_models/jet.h"
#include "hwsim/gpu/gpu_lift.h"
#include "hwsim/timing/time_pass.h"

namespace hwsim::cost_models {
namespace {

using Jets = Jet<kJetWidth>;

double seeded(double value, std::size_t, double) { return value; }
Jets seeded(double value, std::size_t lane, Jets) {
  Jets jet(value);
  jet.v[lane] = value;  // by the logarithm
  return jet;
}

double value_of(double t) { return t; }
double value_of(const Jets& t) { return t.a; }

/// What an evaluation needs to know about one GPU.
template <class T>
GpuRates<T> rates_of(const GpuConfig& gpu, const std::vector<FittedParameter>& parameters,
                     const std::vector<std::size_t>& active, std::span<const double> log_values) {
  const auto place = [&](std::string_view key, double value) {
    for (std::size_t lane = 0; lane < active.size(); ++lane)
      if (parameters[active[lane]].name == key) return seeded(std::exp(log_values[active[lane]]), lane, T());
    return T(value);
  };
  return derive_rates<T>(lift<T>(gpu, place));
}

/// Time of a pass in parts that a scene's factors act on.
template <class T>
struct PartedTime {
  T work{0.0}, fixed{0.0};
  bool draw = false;
};

template <class T>
PartedTime<T> parted_time(const PassWork& pass, const PassShape& shape, const GpuRates<T>& rates,
                          bool waits) {
  const PassTime<T> time = time_whole(pass, chunk_costs(pass, shape, rates), rates, Engine::queue, waits);
  return {time.time_ns - time.overhead_ns, time.overhead_ns, pass.kind == PassKind::draw};
}

/// The factors of the scene, as values and as parameters (or none).
struct SceneFactors {
  double load = 1.0, reach = 1.0;
  std::ptrdiff_t load_index = -1, reach_index = -1;
};

/// What a whole frame takes beside its passes: its value in ns, and its parameter (or none).
struct Present {
  double ns = 0.0;
  std::ptrdiff_t index = -1;
};

Present present_of(const std::vector<FittedParameter>& parameters, const std::vector<std::size_t>& active,
                   std::span<const double> log_values) {
  for (const std::size_t i : active)
    if (parameters[i].name == kPresent)
      return {std::exp(log_values[i]) * 1000.0, static_cast<std::ptrdiff_t>(i)};
  return {};
}

SceneFactors factors_of(const std::vector<FittedParameter>& parameters, const std::string& scene,
                        std::span<const double> log_values) {
  SceneFactors f;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].scope != Scope::scene || parameters[i].member != scene) continue;
    const bool load = parameters[i].name == kGeometryLoad;
    (load ? f.load : f.reach) = std::exp(log_values[i]);
    (load ? f.load_index : f.reach_index) = static_cast<std::ptrdiff_t>(i);
  }
  return f;
}

bool has_reach(const Experiment& experiment, const Replay& replay) {
  const std::string& scene = experiment.cells[replay.cells.front()].scene_group;
  return std::any_of(experiment.parameters.begin(), experiment.parameters.end(),
                     [&](const FittedParameter& p) {
                       return p.scope == Scope::scene && p.member == scene && p.name == kLightReach;
                     });
}

}  // namespace

Predictor::Predictor(const Experiment& experiment, int jobs, const std::vector<bool>& wanted)
    : experiment_(experiment), jobs_(jobs), predictions_(experiment.cells.size()) {
  for (const GpuConfig& gpu : experiment.gpus) {
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < experiment.parameters.size(); ++i) {
      const FittedParameter& p = experiment.parameters[i];
      if (p.scope != Scope::scene && p.concerns(gpu.id, "")) own.push_back(i);
    }
    if (own.size() > kJetWidth)
      throw InputError(Diagnostic{.code = "M004",
                                  .message = "GPU `" + gpu.id + "` has " + std::to_string(own.size()) +
                                             " parameters, at most " + std::to_string(kJetWidth) +
                                             " are possible"});
    active_.push_back(std::move(own));
  }
  collect_passes(wanted);
}

void Predictor::collect_passes(const std::vector<bool>& wanted) {
  std::map<std::tuple<std::size_t, bool, std::uint64_t>, std::size_t> known;
  std::map<const PassWork*, std::size_t> of_replay;
  const auto place = [&](const WorkTrace& trace, const std::vector<std::uint64_t>& keys, std::size_t gpu,
                         std::size_t p) {
    const PassWork& pass = trace.passes[p];
    if (const auto found = of_replay.find(&pass); found != of_replay.end()) return found->second;
    const bool waits = hwsim::waits(trace, p);
    std::size_t index = passes_.size();
    if (!keys.empty()) index = known.emplace(std::tuple(gpu, waits, keys[p]), index).first->second;
    if (index == passes_.size()) passes_.push_back({&pass, gpu, waits, shape_of(pass)});
    of_replay[&pass] = index;
    return index;
  };
  for (std::size_t r = 0; r < experiment_.replays.size(); ++r) {
    const Replay& replay = experiment_.replays[r];
    of_replay.clear();  // replays of another GPU may share the trace
    const bool unlit = replay.unlit && has_reach(experiment_, replay);
    for (const std::size_t cell : replay.cells) {
      if (!wanted.empty() && !wanted[cell]) continue;
      const std::string& patterns = experiment_.cells[cell].passes;
      CellPasses of{cell, r, pass_matches(patterns, kPresentPass), {}};
      for (std::size_t p = 0; p < replay.trace->passes.size(); ++p) {
        if (!pass_matches(patterns, replay.trace->passes[p].name)) continue;
        const std::size_t lit = place(*replay.trace, replay.pass_keys, replay.gpu, p);
        of.passes.push_back({lit, unlit ? place(*replay.unlit, replay.unlit_pass_keys, replay.gpu, p) : lit});
      }
      cells_.push_back(std::move(of));
    }
  }
}

void Predictor::evaluate(std::span<const double> log_values, bool gradients) {
  if (gradients)
    evaluate_as<Jets>(log_values);
  else
    evaluate_as<double>(log_values);
}

template <class T>
void Predictor::evaluate_as(std::span<const double> log_values) {
  std::vector<GpuRates<T>> rates;
  for (std::size_t g = 0; g < experiment_.gpus.size(); ++g)
    rates.push_back(rates_of<T>(experiment_.gpus[g], experiment_.parameters, active_[g], log_values));
  std::vector<PartedTime<T>> times(passes_.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < passes_.size(); i = next++)
      times[i] = parted_time(*passes_[i].work, passes_[i].shape, rates[passes_[i].gpu], passes_[i].waits);
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i < jobs_; ++i) threads.emplace_back(work);
    work();
  }
  for (const CellPasses& of : cells_) predict<T>(of, times, log_values);
}

template <class T, class Time>
void Predictor::predict(const CellPasses& of, const std::vector<Time>& times,
                        std::span<const double> log_values) {
  const Cell& cell = experiment_.cells[of.cell];
  const std::vector<std::size_t>& active = active_[experiment_.replays[of.replay].gpu];
  const SceneFactors f = factors_of(experiment_.parameters, cell.scene_group, log_values);
  const Present present = present_of(experiment_.parameters, active, log_values);
  T ms(0.0);
  double by_load = 0.0, by_reach = 0.0;
  for (const auto& [lit, unlit] : of.passes) {
    const double load = times[lit].draw ? f.load : 1.0;
    T work = times[lit].work;
    if (unlit != lit) {
      const T of_lights = times[lit].work - times[unlit].work;
      work = times[unlit].work + f.reach * of_lights;
      by_reach += f.reach * load * value_of(of_lights);
    }
    if (times[lit].draw) by_load += load * value_of(work);
    ms += load * work + times[lit].fixed;
  }
  ms *= cell.repeat;
  by_load *= cell.repeat;
  by_reach *= cell.repeat;
  if (of.presents) ms += present.ns;
  Prediction& prediction = predictions_[of.cell];
  const double total = value_of(ms);
  prediction.ms = total * 1e-6;
  if constexpr (!std::is_same_v<T, double>) {
    prediction.gradient.assign(experiment_.parameters.size(), 0.0);
    const auto set = [&](std::ptrdiff_t index, double ns) {
      if (index >= 0) prediction.gradient[static_cast<std::size_t>(index)] = ns / total;
    };
    for (std::size_t lane = 0; lane < active.size(); ++lane)
      prediction.gradient[active[lane]] = ms.v[lane] / total;
    if (of.presents) set(present.index, present.ns);
    set(f.load_index, by_load);
    set(f.reach_index, by_reach);
  }
}

std::vector<double> Predictor::start() const {
  std::vector<double> values;
  for (const FittedParameter& p : experiment_.parameters) values.push_back(std::log(p.start));
  return values;
}

}  // namespace hwsim::cost_models
