#include "cost_models/baselines.h"

#include <algorithm>
#include <cmath>

#include "cost_models/statistics.h"
#include "hwsim/engines/timing.h"

namespace hwsim::cost_models {

std::vector<SimpleWork> simple_work(const Experiment& experiment) {
  std::vector<SimpleWork> work(experiment.cells.size());
  for (const Replay& replay : experiment.replays) {
    const GpuConfig& gpu = experiment.gpus[replay.gpu];
    const FrameTiming timing = time_frame(*replay.trace, gpu, Engine::roofline);
    for (const std::size_t cell : replay.cells)
      for (std::size_t p = 0; p < timing.passes.size(); ++p) {
        if (!pass_matches(experiment.cells[cell].passes, timing.passes[p].name)) continue;
        const StreamBytes& bytes = timing.passes[p].dram_bytes;
        const PassCounters sum = total(replay.trace->passes[p]);
        work[cell].dram_bytes += bytes.total_read() + bytes.total_write();
        work[cell].shaded_samples +=
            static_cast<double>(sum.ps.invocations + sum.stats.compute_shader_invocations);
      }
    for (const std::size_t cell : replay.cells)
      work[cell].bandwidth_ms = work[cell].dram_bytes / gpu.dram_bandwidth_gb_s * 1e-6;
  }
  return work;
}

std::map<std::string, std::vector<double>> baseline_predictions(const Experiment& experiment,
                                                                const std::vector<SimpleWork>& work,
                                                                const std::vector<bool>& train,
                                                                const std::vector<bool>& test) {
  constexpr double kLeastMs = 1e-3;  // a line may cross zero, a time does not
  std::vector<std::vector<double>> x;
  std::vector<double> y;
  double sum_log = 0.0;
  for (std::size_t i = 0; i < train.size(); ++i) {
    if (!train[i]) continue;
    x.push_back({work[i].dram_bytes, work[i].shaded_samples});
    y.push_back(experiment.cells[i].published);
    sum_log += std::log(y.back());
  }
  std::map<std::string, std::vector<double>> predictions;
  if (y.size() < 4) return predictions;
  const double center = std::exp(sum_log / static_cast<double>(y.size()));
  const std::vector<double> line = linear_regression(x, y);
  for (std::size_t i = 0; i < test.size(); ++i) {
    if (!test[i]) continue;
    predictions["mean"].push_back(center);
    predictions["bytes_over_bandwidth"].push_back(std::max(kLeastMs, work[i].bandwidth_ms));
    predictions["linear_regression"].push_back(
        std::max(kLeastMs, line[0] * work[i].dram_bytes + line[1] * work[i].shaded_samples + line[2]));
  }
  return predictions;
}

}  // namespace hwsim::cost_models
