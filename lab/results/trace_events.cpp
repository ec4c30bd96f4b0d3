// The Trace Event format, as Perfetto and chrome://tracing open it: complete ("X") and counter ("C") events,
// and the metadata ("M") that names the tracks. Times are microseconds.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "hwsim/engines/schedule.h"
#include "lab/base/json_text.h"
#include "lab/results/results.h"

namespace hwsim::lab {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kProcess = 1;
constexpr int kPassTrack = 0;  // units follow

double microseconds(double ns) { return ns / 1e3; }

Json track_name(int track, const std::string& name) {
  return {
      {"ph", "M"}, {"pid", kProcess}, {"tid", track}, {"name", "thread_name"}, {"args", {{"name", name}}}};
}

Json slice(int track, const std::string& name, double start_ns, double length_ns, Json arguments) {
  return {{"ph", "X"},
          {"pid", kProcess},
          {"tid", track},
          {"name", name},
          {"ts", microseconds(start_ns)},
          {"dur", microseconds(length_ns)},
          {"args", std::move(arguments)}};
}

Json counter(const std::string& name, double start_ns, double value) {
  return {{"ph", "C"},
          {"pid", kProcess},
          {"name", name},
          {"ts", microseconds(start_ns)},
          {"args", {{"value", value}}}};
}

/// What stands for the schedule of an engine that has none: each unit works from the begin of the pass, for
/// as long as it is busy.
PassSchedule unscheduled(const PassTiming& pass, double start_ns) {
  PassSchedule schedule{start_ns, start_ns + pass.time_ns, {}};
  for (size_t u = 0; u < kUnitCount; ++u)
    if (pass.busy_ns[u] > 0.0)
      schedule.units[u] = UnitSpan{start_ns, start_ns + std::min(pass.busy_ns[u], pass.time_ns)};
  return schedule;
}

void append_pass(Json& events, const PassTiming& pass, const PassSchedule& schedule) {
  const double start_ns = schedule.begin_ns;
  events.push_back(slice(kPassTrack, pass.name, start_ns, pass.time_ns,
                         {{"kind", pass_kind_name(pass.kind)}, {"limiter", unit_name(pass.limiter)}}));
  for (int u = 0; u < kUnitCount; ++u) {
    const auto i = static_cast<size_t>(u);
    if (const auto& span = schedule.units[i])
      events.push_back(slice(1 + u, pass.name, span->begin_ns, span->end_ns - span->begin_ns,
                             {{"busy_us", microseconds(pass.busy_ns[i])},
                              {"sol_pct", 100.0 * pass.sol_ratio[i]},
                              {"stack_us", microseconds(pass.stack_ns[i])}}));
  }
  if (pass.time_ns <= 0.0) return;
  events.push_back(counter("dram read GB/s", start_ns, pass.dram_bytes.total_read() / pass.time_ns));
  events.push_back(counter("dram write GB/s", start_ns, pass.dram_bytes.total_write() / pass.time_ns));
}

}  // namespace

std::string trace_event_json(const PointResult& point) {
  Json events = Json::array();
  events.push_back(track_name(kPassTrack, "passes"));
  for (int u = 0; u < kUnitCount; ++u)
    events.push_back(track_name(1 + u, std::string(unit_name(static_cast<Unit>(u)))));
  std::vector<PassSchedule> schedules;
  if (point.timing.engine == Engine::queue) schedules = frame_schedule(point.emulation->trace, *point.gpu);
  double start_ns = 0.0;
  for (size_t p = 0; p < point.timing.passes.size(); ++p) {
    const PassTiming& pass = point.timing.passes[p];
    append_pass(events, pass, schedules.empty() ? unscheduled(pass, start_ns) : schedules[p]);
    start_ns += pass.time_ns;
  }
  events.push_back(counter("dram read GB/s", start_ns, 0.0));
  events.push_back(counter("dram write GB/s", start_ns, 0.0));
  return json_text(Json{{"displayTimeUnit", "ns"}, {"traceEvents", std::move(events)}}, -1) + "\n";
}

}  // namespace hwsim::lab
