#include "hwsim/timing/time_slopes.h"

#include <algorithm>

#include "hwsim/gpu/gpu_lift.h"

namespace hwsim {
namespace {

/// What a pass's time gains by the parts of its chunks' costs.
struct CostSlopes {
  std::vector<double> shader_latency_ns, core_fills, line_fills;  ///< one a chunk
};

bool all_zero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0; });
}

/// packets_of_a_fill backwards: from the packets of each chunk to the fills of those in its window.
std::vector<double> fill_slopes(const std::vector<ChunkCost<double>>& costs, double ChunkCost<double>::*fills,
                                const std::vector<double>& by_packets) {
  std::vector<double> slopes(costs.size(), 0.0);
  if (all_zero(by_packets)) return slopes;
  std::vector<double> steps(costs.size() + 1, 0.0);  // what all chunks of a window share
  FillWindow<double> window{costs, fills};
  for (std::size_t k = 0; k < costs.size(); ++k) {
    window.take(k);
    if (by_packets[k] == 0.0 || window.is_empty() || window.over() < 0.0) continue;
    const ChunkCost<double>& first = costs[window.first];
    const double weight = by_packets[k] * first.packets / (first.*fills);
    steps[window.first] -= weight;
    steps[k + 1] += weight;
    slopes[window.first] += weight * window.over() / (first.*fills);
  }
  double shared = 0.0;
  for (std::size_t k = 0; k < costs.size(); ++k) slopes[k] += shared += steps[k];
  return slopes;
}

/// flow_table backwards: what is not a service time.
CostSlopes cost_slopes(const std::vector<ChunkCost<double>>& costs, const PassSlopes& pass) {
  const std::size_t units = pass.units.size();
  CostSlopes slopes;
  slopes.shader_latency_ns.assign(costs.size(), 0.0);
  std::vector<double> resident(costs.size(), 0.0), lines_ahead(costs.size(), 0.0);
  for (std::size_t k = 0; k < costs.size(); ++k)
    for (std::size_t i = 0; i < units; ++i) {
      const bool last = i + 1 == units, in_cores = stands_in(pass.units[i], UnitPlace::cores);
      if (in_cores && (last || !stands_in(pass.units[i + 1], UnitPlace::cores)))
        slopes.shader_latency_ns[k] += pass.flow.latency_ns[k * units + i];
      const double room = pass.flow.room_packets[k * units + i];
      if (last || room == 0.0) continue;
      if (in_cores) resident[k] += room;
      if (stands_in(pass.units[i + 1], UnitPlace::memory)) lines_ahead[k] += room;
    }
  slopes.core_fills = fill_slopes(costs, &ChunkCost<double>::core_fills, resident);
  slopes.line_fills = fill_slopes(costs, &ChunkCost<double>::line_fills, lines_ahead);
  return slopes;
}

template <class T>
T service_time_ns(Unit unit, const UnitWork<T>& work, const GpuRates<T>& rates) {
  switch (unit) {
#define HWSIM_UNIT_CASE(id, Name) \
  case Unit::id:                  \
    return units::Name::service_ns(work, rates);
    HWSIM_UNITS(HWSIM_UNIT_CASE)
#undef HWSIM_UNIT_CASE
  }
  return T(0.0);
}

/// Whether the unit's service time depends on a chunk's traffic: the pipes of the cores wait for lines, and
/// the memory moves them.
constexpr bool asks_memory(Unit unit) {
  return info(unit).place == UnitPlace::cores || info(unit).place == UnitPlace::memory;
}

/// The derivatives of one pass's time, summed over its chunks: parts of a cost that the time does not depend
/// on are never asked for theirs.
template <class Number>
class PassGradient {
 public:
  PassGradient(const PassWork& pass, const PassShape& shape, const GpuRates<Number>& rates)
      : pass_(pass), rates_(rates), model_(model_traffic(shape, pass, rates)) {}

  void chunk(std::size_t k, const PassSlopes& slopes, const CostSlopes& by) {
    const PassCounters& counters = pass_.chunks[k];
    const double* by_ns = &slopes.flow.ns[k * slopes.units.size()];
    const bool waits = by.shader_latency_ns[k] != 0.0 || by.core_fills[k] != 0.0 || by.line_fills[k] != 0.0;
    bool needs_traffic = waits;
    for (std::size_t i = 0; i < slopes.units.size(); ++i)
      needs_traffic |= by_ns[i] != 0.0 && asks_memory(static_cast<Unit>(slopes.units[i]));
    ChunkTraffic<Number> traffic;
    if (needs_traffic) traffic = chunk_traffic(counters, model_, rates_);
    const UnitWork<Number> work{counters, pass_, traffic};
    for (std::size_t i = 0; i < slopes.units.size(); ++i)
      if (by_ns[i] != 0.0) add(by_ns[i], service_time_ns(static_cast<Unit>(slopes.units[i]), work, rates_));
    if (!waits) return;
    ChunkCost<Number> cost;
    set_waiting(counters, pass_, traffic, rates_, cost);
    add(by.shader_latency_ns[k], cost.shader_latency_ns);
    add(by.core_fills[k], cost.core_fills);
    add(by.line_fills[k], cost.line_fills);
  }
  void add(double weight, const Number& of) { sum_.d += weight * of.d; }
  const Number& sum() const { return sum_; }

 private:
  const PassWork& pass_;
  const GpuRates<Number>& rates_;
  TrafficModel<Number> model_;
  Number sum_;
};

}  // namespace

TimeSlopes::TimeSlopes(const GpuValues<double>& gpu, std::span<const std::string> keys)
    : ns_(keys.size(), 0.0) {
  for (std::size_t first = 0; first < keys.size(); first += kWidth) {
    const std::span<const std::string> block = keys.subspan(first, std::min(kWidth, keys.size() - first));
    rates_.push_back(derive_rates<Number>(lift<Number>(gpu, [&](std::string_view key, double value) {
      const auto found = std::find(block.begin(), block.end(), key);
      return found == block.end() ? Number(value)
                                  : Number(value, static_cast<std::size_t>(found - block.begin()));
    })));
  }
}

void TimeSlopes::add(const PassWork& pass, const PassShape& shape,
                     const std::vector<ChunkCost<double>>& costs, const PassSlopes& slopes, bool waits) {
  const CostSlopes by = cost_slopes(costs, slopes);
  for (std::size_t block = 0; block < rates_.size(); ++block) {
    const GpuRates<Number>& rates = rates_[block];
    PassGradient<Number> gradient(pass, shape, rates);
    if (pass.kind == PassKind::clear) {  // one cost, whatever its chunks are
      const ChunkCost<Number> cost = chunk_costs(pass, shape, rates).front();
      for (std::size_t i = 0; i < slopes.units.size(); ++i)
        gradient.add(slopes.flow.ns[i], cost.ns[slopes.units[i]]);
    } else if (!slopes.units.empty()) {
      for (std::size_t k = 0; k < costs.size(); ++k) gradient.chunk(k, slopes, by);
    }
    if (waits) gradient.add(1.0, rates.pass_overhead_ns);
    gradient.add(1.0, transition_before(pass, rates).ns);
    for (std::size_t i = 0; i < kWidth && block * kWidth + i < ns_.size(); ++i)
      ns_[block * kWidth + i] += gradient.sum().d[i];
  }
}

}  // namespace hwsim
