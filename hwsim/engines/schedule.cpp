#include "hwsim/engines/schedule.h"

#include "hwsim/timing/time_pass.h"

namespace hwsim {
namespace {

PassSchedule pass_schedule(const PassWork& pass, const GpuRates<double>& rates, bool waits, double begin_ns) {
  const std::vector<ChunkCost<double>> costs = chunk_costs(pass, rates);
  const PassTime<double> time = time_whole(pass, costs, rates, Engine::queue, waits);
  PassSchedule schedule{begin_ns, begin_ns + time.time_ns, {}};
  const PassTime<double> flow_time = time_costs(costs, rates, Engine::queue, false);
  const std::vector<std::size_t> units = busy_units(flow_time);
  if (units.empty()) return schedule;
  const FlowTable<double> table = flow_table(costs, units, rates);
  PacketFlow<double> flow(table);
  flow.run();
  const double first_ns = schedule.end_ns - flow_time.time_ns;  // launch and decompression come before
  const std::vector<FlowSpan<double>> spans = flow.spans();
  for (std::size_t i = 0; i < units.size(); ++i)
    schedule.units[units[i]] = UnitSpan{first_ns + spans[i].begin_ns, first_ns + spans[i].end_ns};
  return schedule;
}

}  // namespace

std::vector<PassSchedule> frame_schedule(const WorkTrace& trace, const GpuConfig& gpu) {
  const GpuRates<double> rates = derive_rates<double>(gpu);
  std::vector<PassSchedule> schedules;
  double begin_ns = 0.0;
  for (std::size_t p = 0; p < trace.passes.size(); ++p) {
    schedules.push_back(pass_schedule(trace.passes[p], rates, waits(trace, p), begin_ns));
    begin_ns = schedules.back().end_ns;
  }
  return schedules;
}

}  // namespace hwsim
