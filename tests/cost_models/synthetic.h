#pragma once
// An experiment whose truth is known: hand-made work, two GPUs, and published times that the model itself
// made.
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "cost_models/fit.h"
#include "cost_models/predictor.h"
#include "hwsim/sample_gpu.h"

namespace hwsim::cost_models::test {

/// Pseudo-random numbers in [0, 1), the same everywhere.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * 0x1.0p-53;
  }
  std::uint64_t count(double low, double high) {
    return static_cast<std::uint64_t>(low + next() * (high - low));
  }

 private:
  std::uint64_t state_;
};

/// Geometry, arithmetic and bytes in changing proportions, so that each pass has another limiter.
inline PassWork random_pass(const std::string& name, PassKind kind, Numbers& numbers) {
  PassWork pass;
  pass.name = name;
  pass.kind = kind;
  pass.barrier_before = true;
  for (int i = 0; i < 6; ++i) {
    PassCounters c;
    const double tilt = numbers.next();
    if (kind == PassKind::draw)
      c.setup.in_primitives = c.setup.out_primitives = numbers.count(1e3, 1e5 * tilt * tilt + 2e3);
    c.shader.alu_lane_ops = numbers.count(1e5, 4e7 * (1.0 - tilt) + 2e5);
    c.shader.alu_issued_lane_ops_w32 = c.shader.alu_lane_ops;
    c.shader.load_lane_ops = numbers.count(1e3, 1e6);
    c.tex.requests = c.tex.bilinear_probes = numbers.count(1e4, 1e6 * tilt + 2e4);
    c.tex.texels = c.tex.requests * 4;
    c.mem.texture_read_bytes = 64 * numbers.count(1e3, 4e5 * tilt + 2e3);  // without reuse: all of them move
    pass.chunks.push_back(c);
  }
  return pass;
}

inline std::shared_ptr<const WorkTrace> random_trace(std::uint64_t seed) {
  Numbers numbers(seed);
  auto trace = std::make_shared<WorkTrace>();
  trace->passes = {random_pass("draw", PassKind::draw, numbers),
                   random_pass("light", PassKind::full_screen, numbers),
                   random_pass("analysis", PassKind::compute, numbers)};
  return trace;
}

inline FittedParameter parameter(Scope scope, const std::string& member, const std::string& name,
                                 double start, double low, double high) {
  return {scope, member, name, start, low, high, std::log(3.0), "ratio", "", {}};
}

struct Synthetic {
  Experiment experiment;
  std::vector<double> truth;  ///< logarithms of the parameters
};

/// `scenes` scenes on each of two GPUs, `techniques` runs each, every pass a row.
inline Synthetic make_synthetic(int scenes = 3, int techniques = 4) {
  Synthetic s;
  Experiment& e = s.experiment;
  for (const char* id : {"a", "b"}) {
    GpuConfig gpu = hwsim::test::sample_gpu();
    gpu.id = id;
    gpu.core_clock_mhz = id[0] == 'a' ? 1000.0 : 700.0;
    gpu.dram_bandwidth_gb_s = id[0] == 'a' ? 60.0 : 90.0;
    e.gpus.push_back(gpu);
    e.parameters.push_back(parameter(Scope::gpu, id, "dram_efficiency_ratio", 0.8, 0.3, 1.0));
    e.parameters.push_back(parameter(Scope::gpu, id, "pass_overhead_us", 10.0, 1.0, 100.0));
    e.parameters.push_back(parameter(Scope::gpu, id, "setup_drawn_triangles_per_clk", 2.0, 0.2, 4.0));
  }
  e.parameters.push_back(parameter(Scope::all, "all", "alu_efficiency_ratio", 0.8, 0.1, 1.0));
  for (std::size_t g = 0; g < e.gpus.size(); ++g)
    for (int scene = 0; scene < scenes; ++scene) {
      const std::string name =
          "scene" + std::to_string(g * static_cast<std::size_t>(scenes) + static_cast<std::size_t>(scene));
      e.parameters.push_back(parameter(Scope::scene, name, std::string(kGeometryLoad), 1.0, 0.1, 30.0));
      for (int technique = 0; technique < techniques; ++technique) {
        Replay replay;
        replay.gpu = g;
        replay.run = {name, "0", "t" + std::to_string(technique), e.gpus[g].id,
                      64,   64,  "scene.shadows=false",           ""};
        WorkTrace trace = *random_trace(1000 * g + 100 * static_cast<std::size_t>(scene) +
                                        static_cast<std::size_t>(technique) + 1);
        trace.technique = replay.run.technique;
        replay.trace = std::make_shared<WorkTrace>(std::move(trace));
        for (const PassWork& pass : replay.trace->passes) {
          Cell cell;
          cell.row.document = "SYN";
          cell.row.table = "synthetic";
          cell.row.line = static_cast<int>(e.cells.size()) + 2;
          cell.row.scene = name;
          cell.row.pass = pass.name;
          cell.use = RowUse::fitted;
          cell.unit = "ms";
          cell.run = replay.run;
          cell.has_run = true;
          cell.scene_group = name;
          cell.passes = pass.name;
          replay.cells.push_back(e.cells.size());
          e.cells.push_back(cell);
        }
        e.replays.push_back(replay);
      }
    }
  Numbers numbers(7);
  for (const FittedParameter& p : e.parameters)
    s.truth.push_back(std::log(p.low) + (0.3 + 0.5 * numbers.next()) * std::log(p.high / p.low));
  Predictor predictor(e, 1);
  predictor.evaluate(s.truth, false);
  for (std::size_t i = 0; i < e.cells.size(); ++i) e.cells[i].published = predictor[i].ms;
  return s;
}

/// Errors of `percent` at most, the same each time.
inline void add_noise(Experiment& experiment, double percent) {
  Numbers numbers(11);
  for (Cell& cell : experiment.cells) cell.published *= 1.0 + (numbers.next() * 2.0 - 1.0) * percent / 100.0;
}

inline void forget_priors(Experiment& experiment) {
  for (FittedParameter& p : experiment.parameters) p.prior_log_sd = 0.0;
}

inline std::vector<double> predictions(const Experiment& experiment, const Fit& fit) {
  Predictor predictor(experiment, 1);
  predictor.evaluate(fit.log_values, false);
  std::vector<double> ms;
  for (std::size_t i = 0; i < experiment.cells.size(); ++i) ms.push_back(predictor[i].ms);
  return ms;
}

inline Fit fit_all(const Experiment& experiment, int starts = 1) {
  FitOptions options;
  options.starts = starts;
  return fit(experiment, fitted_cells(experiment), Predictor(experiment, 1).start(), options);
}

}  // namespace hwsim::cost_models::test
