#include "cost_models/predictor.h"

#include <ceres/jet.h>

#include <atomic>
#include <cmath>
#include <map>
#include <thread>
#include <tuple>

#include "hwsim/config/gpu_keys.h"
#include "hwsim/timing/time_pass.h"

namespace hwsim::cost_models {
namespace {

using Jet = ceres::Jet<double, kJetWidth>;

/// Copies a config to another scalar type; `place` says what a key becomes.
template <class T, class Place>
struct Lifter {
  std::vector<Key> keys;
  Place place;
  std::size_t next = 0;
  void key(const KeyInfo& info, T& value) { value = place(info.name, *std::get<double*>(keys[next++].slot)); }
  void key(const KeyInfo&, int& value) { value = *std::get<int*>(keys[next++].slot); }
  void key(const KeyInfo&, bool& value) { value = *std::get<bool*>(keys[next++].slot); }
};

template <class T, class Place>
GpuValues<T> lift(const GpuConfig& gpu, const Place& place) {
  GpuValues<double> base = gpu;
  GpuValues<T> lifted;
  Lifter<T, Place> lifter{keys_of(base), place};
  describe(lifter, lifted);
  return lifted;
}

double seeded(double value, int, double) { return value; }
Jet seeded(double value, int lane, Jet) {
  Jet jet(value);
  jet.v[lane] = value;  // by the logarithm
  return jet;
}

double value_of(double t) { return t; }
double value_of(const Jet& t) { return t.a; }

/// What an evaluation needs to know about one GPU.
template <class T>
GpuRates<T> rates_of(const GpuConfig& gpu, const std::vector<Parameter>& parameters,
                     const std::vector<std::size_t>& active, std::span<const double> log_values) {
  const auto place = [&](std::string_view key, double value) {
    for (std::size_t lane = 0; lane < active.size(); ++lane)
      if (parameters[active[lane]].name == key)
        return seeded(std::exp(log_values[active[lane]]), static_cast<int>(lane), T());
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
PartedTime<T> parted_time(const PassWork& pass, const GpuRates<T>& rates, bool waits) {
  const PassTime<T> time = time_pass(pass, rates, Engine::queue, waits);
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

Present present_of(const std::vector<Parameter>& parameters, const std::vector<std::size_t>& active,
                   std::span<const double> log_values) {
  for (const std::size_t i : active)
    if (parameters[i].name == kPresent)
      return {std::exp(log_values[i]) * 1000.0, static_cast<std::ptrdiff_t>(i)};
  return {};
}

SceneFactors factors_of(const std::vector<Parameter>& parameters, const std::string& scene,
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

/// A replay's passes with their times; `unlit` is empty where no factor asks for it.
template <class T>
struct ReplayTimes {
  std::vector<const PartedTime<T>*> lit, unlit;
};

template <class T>
void predict_replay(const Experiment& experiment, const Replay& replay, ReplayTimes<T> times,
                    const std::vector<std::size_t>& active, std::span<const double> log_values,
                    std::vector<Prediction>& out) {
  const std::string& scene = experiment.cells[replay.cells.front()].scene_group;
  const SceneFactors f = factors_of(experiment.parameters, scene, log_values);
  const Present present = present_of(experiment.parameters, active, log_values);
  if (f.reach_index < 0) times.unlit.clear();

  for (const std::size_t cell : replay.cells) {
    T ms(0.0);
    double by_load = 0.0, by_reach = 0.0;
    for (std::size_t p = 0; p < times.lit.size(); ++p) {
      if (!pass_matches(experiment.cells[cell].passes, replay.trace->passes[p].name)) continue;
      const PartedTime<T>& lit = *times.lit[p];
      const double load = lit.draw ? f.load : 1.0;
      T work = lit.work;
      if (!times.unlit.empty()) {
        const T of_lights = lit.work - times.unlit[p]->work;
        work = times.unlit[p]->work + f.reach * of_lights;
        by_reach += f.reach * load * value_of(of_lights);
      }
      if (lit.draw) by_load += load * value_of(work);
      ms += load * work + lit.fixed;
    }
    const bool presents = pass_matches(experiment.cells[cell].passes, kPresentPass);
    const double repeat = experiment.cells[cell].repeat;
    ms *= repeat;
    by_load *= repeat;
    by_reach *= repeat;
    if (presents) ms += present.ns;
    Prediction& prediction = out[cell];
    const double total = value_of(ms);
    prediction.ms = total * 1e-6;
    if constexpr (!std::is_same_v<T, double>) {
      prediction.gradient.assign(experiment.parameters.size(), 0.0);
      for (std::size_t lane = 0; lane < active.size(); ++lane)
        prediction.gradient[active[lane]] = ms.v[static_cast<Eigen::Index>(lane)] / total;
      if (presents && present.index >= 0)
        prediction.gradient[static_cast<std::size_t>(present.index)] = present.ns / total;
      if (f.load_index >= 0) prediction.gradient[static_cast<std::size_t>(f.load_index)] = by_load / total;
      if (f.reach_index >= 0) prediction.gradient[static_cast<std::size_t>(f.reach_index)] = by_reach / total;
    }
  }
}

}  // namespace

Predictor::Predictor(const Experiment& experiment, int jobs)
    : experiment_(experiment), jobs_(jobs), predictions_(experiment.cells.size()) {
  for (const GpuConfig& gpu : experiment.gpus) {
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < experiment.parameters.size(); ++i) {
      const Parameter& p = experiment.parameters[i];
      if (p.scope != Scope::scene && p.concerns(gpu.id, "")) own.push_back(i);
    }
    if (own.size() > kJetWidth)
      throw InputError(Diagnostic{.code = "M004",
                                  .message = "GPU `" + gpu.id + "` has " + std::to_string(own.size()) +
                                             " parameters, at most " + std::to_string(kJetWidth) +
                                             " are possible"});
    active_.push_back(std::move(own));
  }
  collect_passes();
}

void Predictor::collect_passes() {
  std::map<std::tuple<std::size_t, bool, std::uint64_t>, std::size_t> known;
  const auto add = [&](const WorkTrace& trace, const std::vector<std::uint64_t>& keys, std::size_t gpu) {
    std::vector<std::size_t> indices;
    for (std::size_t p = 0; p < trace.passes.size(); ++p) {
      const bool waits = trace.passes[p].barrier_before || p == 0;
      std::size_t index = passes_.size();
      if (!keys.empty()) index = known.emplace(std::tuple(gpu, waits, keys[p]), index).first->second;
      if (index == passes_.size()) passes_.push_back({&trace.passes[p], gpu, waits});
      indices.push_back(index);
    }
    return indices;
  };
  for (const Replay& replay : experiment_.replays) {
    lit_.push_back(add(*replay.trace, replay.pass_keys, replay.gpu));
    unlit_.push_back(replay.unlit ? add(*replay.unlit, replay.unlit_pass_keys, replay.gpu)
                                  : std::vector<std::size_t>());
  }
}

void Predictor::evaluate(std::span<const double> log_values, bool gradients) {
  if (gradients)
    evaluate_as<Jet>(log_values);
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
      times[i] = parted_time(*passes_[i].work, rates[passes_[i].gpu], passes_[i].waits);
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i < jobs_; ++i) threads.emplace_back(work);
    work();
  }
  for (std::size_t r = 0; r < experiment_.replays.size(); ++r) {
    const Replay& replay = experiment_.replays[r];
    ReplayTimes<T> of_replay;
    for (const std::size_t i : lit_[r]) of_replay.lit.push_back(&times[i]);
    for (const std::size_t i : unlit_[r]) of_replay.unlit.push_back(&times[i]);
    predict_replay<T>(experiment_, replay, std::move(of_replay), active_[replay.gpu], log_values,
                      predictions_);
  }
}

std::vector<double> Predictor::start() const {
  std::vector<double> values;
  for (const Parameter& p : experiment_.parameters) values.push_back(std::log(p.start));
  return values;
}

Prediction predict_frame(const WorkTrace& trace, const GpuConfig& gpu, const std::vector<std::string>& keys) {
  Prediction prediction;
  prediction.gradient.assign(keys.size(), 0.0);
  for (std::size_t first = 0; first == 0 || first < keys.size(); first += kJetWidth) {
    const auto place = [&](std::string_view key, double value) {
      for (std::size_t k = first; k < std::min(keys.size(), first + kJetWidth); ++k)
        if (keys[k] == key) return seeded(value, static_cast<int>(k - first), Jet());
      return Jet(value);
    };
    Jet total(0.0);
    const auto rates = derive_rates<Jet>(lift<Jet>(gpu, place));
    for (std::size_t p = 0; p < trace.passes.size(); ++p) {
      const auto time = parted_time(trace.passes[p], rates, trace.passes[p].barrier_before || p == 0);
      total += time.work + time.fixed;
    }
    prediction.ms = total.a * 1e-6;
    for (std::size_t k = first; k < std::min(keys.size(), first + kJetWidth); ++k)
      prediction.gradient[k] = total.v[static_cast<Eigen::Index>(k - first)] / total.a;
  }
  return prediction;
}

}  // namespace hwsim::cost_models
