// The Trace Event format, as Perfetto and chrome://tracing open it: complete ("X") and counter ("C") events,
// and the metadata ("M") that names the tracks. Times are microseconds.
#include <algorithm>
#include <nlohmann/json.hpp>

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

void append_pass(Json& events, const PassTiming& pass, double start_ns) {
  events.push_back(slice(kPassTrack, pass.name, start_ns, pass.time_ns,
                         {{"kind", pass_kind_name(pass.kind)}, {"limiter", unit_name(pass.limiter)}}));
  for (int u = 0; u < kUnitCount; ++u) {
    const auto i = static_cast<size_t>(u);
    if (pass.busy_ns[i] <= 0.0) continue;
    events.push_back(
        slice(1 + u, pass.name, start_ns, std::min(pass.busy_ns[i], pass.time_ns),
              {{"sol_pct", 100.0 * pass.sol_ratio[i]}, {"stack_us", microseconds(pass.stack_ns[i])}}));
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
  double start_ns = 0.0;
  for (const PassTiming& pass : point.timing.passes) {
    append_pass(events, pass, start_ns);
    start_ns += pass.time_ns;
  }
  events.push_back(counter("dram read GB/s", start_ns, 0.0));
  events.push_back(counter("dram write GB/s", start_ns, 0.0));
  return json_text(Json{{"displayTimeUnit", "ns"}, {"traceEvents", std::move(events)}}, -1) + "\n";
}

}  // namespace hwsim::lab
