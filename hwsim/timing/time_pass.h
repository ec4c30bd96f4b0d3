#pragma once
// The engines: chunks' costs to the time of a pass. T is double to predict, a Jet to fit.
#include <cmath>
#include <type_traits>
#include <utility>

#include "hwsim/timing/engine.h"
#include "hwsim/timing/packet_flow.h"
#include "hwsim/timing/service.h"
#include "hwsim/timing/transition.h"

namespace hwsim {

template <class T>
struct PassTime {
  T time_ns{0.0};
  T overhead_ns{0.0};
  std::array<T, kUnitCount> busy_ns, stack_ns;
  StreamBytesOf<T> dram;
  PassTime() {
    busy_ns.fill(T(0.0));
    stack_ns.fill(T(0.0));
  }
};

/// `shape` is shape_of(pass): a fit keeps it for hundreds of replays.
template <class T>
std::vector<ChunkCost<T>> chunk_costs(const PassWork& pass, const PassShape& shape,
                                      const GpuRates<T>& rates) {
  std::vector<ChunkCost<T>> costs;
  if (pass.kind == PassKind::clear) {
    costs.push_back(clear_cost(pass, rates));
    const ChunkTraffic<T> none;
    costs.front().ns[index_of(Unit::fe)] =
        units::FrontEnd::service_ns(UnitWork<T>{shape.sum, pass, none}, rates);
    return costs;
  }
  const TrafficModel<T> model = model_traffic(shape, pass, rates);
  costs.reserve(pass.chunks.size());
  for (const PassCounters& chunk : pass.chunks) costs.push_back(chunk_cost(chunk, pass, model, rates));
  return costs;
}

template <class T>
std::vector<ChunkCost<T>> chunk_costs(const PassWork& pass, const GpuRates<T>& rates) {
  return chunk_costs(pass, shape_of(pass), rates);
}

/// Shaders' share of the time, split between vertex and pixel work: they run on the same cores.
template <class T>
void split_shader_stack(PassTime<T>& time) {
  T& shader = time.stack_ns[index_of(Unit::shader)];
  const T& busy = time.busy_ns[index_of(Unit::shader)];
  if (!(busy > T(0.0))) return;
  const T vertex = shader * smaller(T(1.0), T(time.busy_ns[index_of(Unit::vs)] / busy));
  time.stack_ns[index_of(Unit::vs)] += vertex;
  shader -= vertex;
}

/// The units' totals over the largest of them, raised to a power.
template <class T>
struct PowerShares {
  T peak{0.0}, sum{0.0};  ///< zero where no unit has work
  std::array<T, kUnitCount> powers;

  PowerShares(const std::array<T, kUnitCount>& busy_ns, const T& exponent) {
    using std::pow;
    for (const T& busy : busy_ns) peak = larger(peak, busy);
    if (!(peak > T(0.0))) return;
    for (std::size_t u = 0; u < kUnitCount; ++u) {
      const bool idle = !(busy_ns[u] > T(0.0));  // pow of a Jet has no derivative at zero
      powers[u] = idle ? T(0.0) : T(pow(T(busy_ns[u] / peak), exponent));
      sum += powers[u];
    }
  }
  /// Gives each unit its part of the sum.
  void share(PassTime<T>& time) const {
    for (std::size_t u = 0; u < kUnitCount; ++u) time.stack_ns[u] = time.time_ns * powers[u] / sum;
  }
};

/// Smooth maximum: the p-norm of the units' totals, at least the largest of them. A unit's share is its part
/// of the sum.
template <class T>
void roofline_time(PassTime<T>& time, const GpuRates<T>& rates) {
  using std::pow;
  const PowerShares<T> shares(time.busy_ns, rates.roofline_exponent);
  if (!(shares.peak > T(0.0))) return;
  time.time_ns = shares.peak * pow(shares.sum, T(1.0 / rates.roofline_exponent));
  shares.share(time);
}

/// The chunks up to one that together fill a place once, as the last of them goes there.
template <class T>
struct FillWindow {
  const std::vector<ChunkCost<T>>& costs;
  T ChunkCost<T>::*fills;
  T inside{0.0};  ///< fills of chunks [first, k]
  double packets = 0.0;
  std::size_t first = 0;

  void take(std::size_t k) {
    inside += costs[k].*fills;
    packets += costs[k].packets;
    for (; !(inside - costs[first].*fills < T(1.0)) && first < k; ++first) {
      inside -= costs[first].*fills;
      packets -= costs[first].packets;
    }
  }
  bool is_empty() const { return !(inside > T(0.0)); }
  T over() const { return inside - T(1.0); }
};

/// For each chunk, the packets up to its end that fill a place once; more than there are while it is not
/// full. Those that put nothing there count as packets all the same: they pass between the others. Where
/// nothing has come yet, nothing is held: depth alone passes by the cores, and waits for its lines.
template <class T>
std::vector<T> packets_of_a_fill(const std::vector<ChunkCost<T>>& costs, T ChunkCost<T>::*fills) {
  std::vector<T> packets;
  packets.reserve(costs.size());
  FillWindow<T> window{costs, fills};
  for (std::size_t k = 0; k < costs.size(); ++k) {
    window.take(k);
    const T over = window.over();
    const ChunkCost<T>& first = costs[window.first];
    if (window.is_empty())
      packets.push_back(T(0.0));
    else if (over < T(0.0))
      packets.push_back(T(2.0 * window.packets + 1.0));
    else
      packets.push_back(window.packets - over / (first.*fills) * first.packets);
  }
  return packets;
}

/// The queue engine's input: units without work in this pass are bypassed.
template <class T>
FlowTable<T> flow_table(const std::vector<ChunkCost<T>>& costs, const std::vector<std::size_t>& units,
                        const GpuRates<T>& rates) {
  FlowTable<T> table{units.size(), costs.size(), {}, {}, {}, {}};
  const std::vector<T> resident = packets_of_a_fill(costs, &ChunkCost<T>::core_fills),
                       lines_ahead = packets_of_a_fill(costs, &ChunkCost<T>::line_fills);
  table.packets.reserve(costs.size());
  for (std::vector<T>* column : {&table.ns, &table.latency_ns, &table.room_packets})
    column->reserve(costs.size() * units.size());
  for (std::size_t k = 0; k < costs.size(); ++k) {
    const ChunkCost<T>& cost = costs[k];
    // How far a unit may run ahead of the next one that has work: the queue between them, what the cores
    // hold, and lines on their way.
    const auto room = [&](std::size_t unit, std::size_t next) {
      T packets(rates.queue_packets);
      if (stands_in(unit, UnitPlace::cores)) packets += resident[k];
      if (stands_in(next, UnitPlace::memory)) packets += lines_ahead[k];
      return packets;
    };
    table.packets.push_back(cost.packets);
    for (std::size_t i = 0; i < units.size(); ++i) {
      const bool last = i + 1 == units.size();
      table.ns.push_back(cost.ns[units[i]]);
      table.room_packets.push_back(last ? T(0.0) : room(units[i], units[i + 1]));
      const bool in_cores = !last && stands_in(units[i + 1], UnitPlace::cores);
      const bool leaves_cores = stands_in(units[i], UnitPlace::cores) && !in_cores;
      table.latency_ns.push_back(leaves_cores ? cost.shader_latency_ns : T(0.0));
    }
  }
  return table;
}

/// The derivatives of a pass's time by what its chunks cost.
struct PassSlopes {
  std::vector<std::size_t> units;  ///< columns of the flow
  FlowSlopes flow;
};

/// The units that have work.
template <class T>
std::vector<std::size_t> busy_units(const PassTime<T>& time) {
  std::vector<std::size_t> units;
  for (std::size_t u = 0; u < kUnitCount; ++u)
    if (time.busy_ns[u] > T(0.0)) units.push_back(u);
  return units;
}

template <class T>
void queue_time(PassTime<T>& time, const std::vector<ChunkCost<T>>& costs, const GpuRates<T>& rates,
                PassSlopes* slopes) {
  std::vector<std::size_t> units = busy_units(time);
  if (units.empty()) return;
  const FlowTable<T> table = flow_table(costs, units, rates);
  PacketFlow<T> flow(table);
  const FlowResult<T> result = flow.run();
  time.time_ns = result.makespan_ns;
  for (std::size_t i = 0; i < units.size(); ++i) time.stack_ns[units[i]] = result.critical_ns[i];
  if constexpr (std::is_same_v<T, double>)
    if (slopes) *slopes = {std::move(units), flow.slopes()};
}

/// `waits`: the pass begins after everything before it has drained, and pays for that. `slopes` is filled by
/// the queue engine over doubles.
template <class T>
PassTime<T> time_costs(const std::vector<ChunkCost<T>>& costs, const GpuRates<T>& rates, Engine engine,
                       bool waits, PassSlopes* slopes = nullptr) {
  PassTime<T> time;
  for (const ChunkCost<T>& cost : costs) {
    for (std::size_t u = 0; u < kUnitCount; ++u) time.busy_ns[u] += cost.ns[u];
    time.dram += cost.dram;
  }
  if (engine == Engine::roofline)
    roofline_time(time, rates);
  else
    queue_time(time, costs, rates, slopes);
  split_shader_stack(time);
  if (waits) time.overhead_ns = rates.pass_overhead_ns;
  time.time_ns += time.overhead_ns;
  time.stack_ns[index_of(Unit::fe)] += time.overhead_ns;
  return time;
}

/// The pass with all that comes before it.
template <class T>
PassTime<T> time_whole(const PassWork& pass, const std::vector<ChunkCost<T>>& costs, const GpuRates<T>& rates,
                       Engine engine, bool waits, PassSlopes* slopes = nullptr) {
  PassTime<T> time = time_costs(costs, rates, engine, waits, slopes);
  add_transition(transition_before(pass, rates), time);
  return time;
}

template <class T>
PassTime<T> time_pass(const PassWork& pass, const GpuRates<T>& rates, Engine engine, bool waits) {
  return time_whole(pass, chunk_costs(pass, rates), rates, engine, waits);
}

/// A pass waits for everything before it where the graph says so; the first of a frame always does.
inline bool waits(const WorkTrace& trace, std::size_t pass) {
  return pass == 0 || trace.passes[pass].barrier_before;
}

/// The time of a frame: the sum of its passes, which do not overlap. `time_ns_of(pass, waits)` is one's.
template <class T, class TimeOf>
T sum_of_passes_ns(const WorkTrace& trace, const TimeOf& time_ns_of) {
  T sum(0.0);
  for (std::size_t p = 0; p < trace.passes.size(); ++p) sum += time_ns_of(trace.passes[p], waits(trace, p));
  return sum;
}

}  // namespace hwsim
