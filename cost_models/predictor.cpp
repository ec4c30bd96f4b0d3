#include "cost_models/predictor.h"

#include <ceres/jet.h>

#include <atomic>
#include <cmath>
#include <thread>

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
std::vector<PartedTime<T>> pass_times(const WorkTrace& trace, const GpuRates<T>& rates) {
  std::vector<PartedTime<T>> times;
  for (const PassWork& pass : trace.passes) {
    const PassTime<T> time = time_pass(pass, rates, Engine::queue, pass.barrier_before || times.empty());
    times.push_back({time.time_ns - time.overhead_ns, time.overhead_ns, pass.kind == PassKind::draw});
  }
  return times;
}

/// The factors of the scene, as values and as parameters (or none).
struct SceneFactors {
  double load = 1.0, reach = 1.0;
  std::ptrdiff_t load_index = -1, reach_index = -1;
};

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

template <class T>
void predict_replay(const Experiment& experiment, const Replay& replay,
                    const std::vector<std::size_t>& active, std::span<const double> log_values,
                    std::vector<Prediction>& out) {
  const auto rates = rates_of<T>(experiment.gpus[replay.gpu], experiment.parameters, active, log_values);
  const std::vector<PartedTime<T>> lit = pass_times(*replay.trace, rates);
  std::vector<PartedTime<T>> unlit;
  const std::string& scene = experiment.cells[replay.cells.front()].scene_group;
  const SceneFactors f = factors_of(experiment.parameters, scene, log_values);
  if (replay.unlit && f.reach_index >= 0) unlit = pass_times(*replay.unlit, rates);

  for (const std::size_t cell : replay.cells) {
    T ms(0.0);
    double by_load = 0.0, by_reach = 0.0;
    for (std::size_t p = 0; p < lit.size(); ++p) {
      if (!pass_matches(experiment.cells[cell].passes, replay.trace->passes[p].name)) continue;
      const double load = lit[p].draw ? f.load : 1.0;
      T work = lit[p].work;
      if (!unlit.empty()) {
        const T of_lights = lit[p].work - unlit[p].work;
        work = unlit[p].work + f.reach * of_lights;
        by_reach += f.reach * load * value_of(of_lights);
      }
      if (lit[p].draw) by_load += load * value_of(work);
      ms += load * work + lit[p].fixed;
    }
    Prediction& prediction = out[cell];
    const double total = value_of(ms);
    prediction.ms = total * 1e-6;
    if constexpr (!std::is_same_v<T, double>) {
      prediction.gradient.assign(experiment.parameters.size(), 0.0);
      for (std::size_t lane = 0; lane < active.size(); ++lane)
        prediction.gradient[active[lane]] = ms.v[static_cast<Eigen::Index>(lane)] / total;
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
}

void Predictor::evaluate(std::span<const double> log_values, bool gradients) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t r = next++; r < experiment_.replays.size(); r = next++) {
      const Replay& replay = experiment_.replays[r];
      if (gradients)
        predict_replay<Jet>(experiment_, replay, active_[replay.gpu], log_values, predictions_);
      else
        predict_replay<double>(experiment_, replay, active_[replay.gpu], log_values, predictions_);
    }
  };
  std::vector<std::jthread> threads;
  for (int i = 1; i < jobs_; ++i) threads.emplace_back(work);
  work();
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
    for (const PartedTime<Jet>& time : pass_times(trace, derive_rates<Jet>(lift<Jet>(gpu, place))))
      total += time.work + time.fixed;
    prediction.ms = total.a * 1e-6;
    for (std::size_t k = first; k < std::min(keys.size(), first + kJetWidth); ++k)
      prediction.gradient[k] = total.v[static_cast<Eigen::Index>(k - first)] / total.a;
  }
  return prediction;
}

}  // namespace hwsim::cost_models
