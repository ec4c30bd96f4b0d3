#include "hwsim/engines/sensitivity.h"

#include <algorithm>
#include <string>

#include "hwsim/config/assign.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/gpu_lift.h"
#include "hwsim/gpu/gpu_rules.h"
#include "hwsim/timing/dual.h"
#include "hwsim/timing/time_pass.h"

namespace hwsim {
namespace {

constexpr std::size_t kWidth = 8;  // derivatives at a time: two vector registers of doubles with AVX-512
using Number = Dual<kWidth>;

/// The numbers of a GPU as duals; the reals from `first` on become the parameters 0, 1, ...
GpuValues<Number> seeded(const GpuValues<double>& values, std::size_t first) {
  std::size_t reals = 0;
  return lift<Number>(values, [&](std::string_view, double value) {
    const std::size_t index = reals++;
    const bool is_parameter = index >= first && index < first + kWidth;
    return is_parameter ? Number(value, index - first) : Number(value);
  });
}

template <class T>
T frame_time_ns(const WorkTrace& trace, const GpuValues<T>& gpu, Engine engine) {
  const GpuRates<T> rates = derive_rates<T>(gpu);
  return sum_of_passes_ns<T>(
      trace, [&](const PassWork& pass, bool waits) { return time_pass(pass, rates, engine, waits).time_ns; });
}

/// Whether twice the value makes a GPU, alone and beside the other keys.
bool is_gpu(const GpuConfig& gpu, const Key& key) {
  std::vector<Diagnostic> problems;
  if (check_range(key)) return false;
  check_rules(gpu, problems);
  return problems.empty();
}

std::optional<double> doubled_time_ns(const WorkTrace& trace, const GpuConfig& gpu, const Key& key,
                                      Engine engine) {
  double& slot = *std::get<double*>(key.slot);
  const double value = slot;
  std::optional<double> time;
  slot = 2.0 * value;
  if (is_gpu(gpu, key)) time = frame_time_ns<double>(trace, gpu, engine);
  slot = value;
  return time;
}

}  // namespace

std::vector<Sensitivity> sensitivities(const WorkTrace& trace, const GpuConfig& gpu, Engine engine) {
  GpuConfig changed = gpu;
  GpuValues<double>& values = changed;
  const std::vector<Key> keys = keys_of(values);
  std::vector<Key> reals;
  for (const Key& key : keys)
    if (std::holds_alternative<double*>(key.slot)) reals.push_back(key);
  std::vector<Sensitivity> result;
  for (std::size_t first = 0; first < reals.size(); first += kWidth) {
    const Number time = frame_time_ns(trace, seeded(values, first), engine);
    for (std::size_t i = 0; i < kWidth && first + i < reals.size(); ++i) {
      const Key& key = reals[first + i];
      if (!applies(key.info.name, values)) continue;
      Sensitivity s{key.info.name, *std::get<double*>(key.slot), time.d[i], 0.0, {}};
      s.elasticity = time.v > 0.0 ? s.slope_ns * s.value / time.v : 0.0;
      s.doubled_ns = doubled_time_ns(trace, changed, key, engine);
      result.push_back(s);
    }
  }
  return result;
}

std::vector<UnitHeadroom> headroom(const WorkTrace& trace, const GpuConfig& gpu, Engine engine) {
  const GpuRates<double> rates = derive_rates<double>(gpu);
  std::vector<UnitHeadroom> result;
  for (std::size_t u = 0; u < kUnitCount; ++u) {
    UnitHeadroom entry{static_cast<Unit>(u), 0.0};
    double busy_ns = 0.0;
    entry.time_ns = sum_of_passes_ns<double>(trace, [&](const PassWork& pass, bool waits) {
      std::vector<ChunkCost<double>> costs = chunk_costs(pass, rates);
      for (ChunkCost<double>& cost : costs) {
        busy_ns += cost.ns[u];
        cost.ns[u] = 0.0;
      }
      return time_whole(pass, costs, rates, engine, waits).time_ns;
    });
    if (busy_ns > 0.0) result.push_back(entry);
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const UnitHeadroom& a, const UnitHeadroom& b) { return a.time_ns < b.time_ns; });
  return result;
}

}  // namespace hwsim
