#include "hwsim/engines/timing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hwsim/detailed/detailed.h"
#include "hwsim/timing/time_pass.h"
#include "hwsim/timing/time_slopes.h"

namespace hwsim {
namespace {

constexpr double kTolerance = 1e-9;  // relative difference of sums of doubles

PassTiming report(const PassWork& pass, const PassTime<double>& time) {
  PassTiming timing;
  timing.name = pass.name;
  timing.kind = pass.kind;
  timing.time_ns = time.time_ns;
  timing.busy_ns = time.busy_ns;
  timing.stack_ns = time.stack_ns;
  timing.overhead_ns = time.overhead_ns;
  timing.dram_bytes.read = time.dram.read;
  timing.dram_bytes.write = time.dram.write;
  if (timing.time_ns > 0.0)
    for (std::size_t u = 0; u < kUnitCount; ++u)
      timing.sol_ratio[u] = std::min(1.0, time.busy_ns[u] / time.time_ns);
  const auto largest = std::max_element(timing.stack_ns.begin(), timing.stack_ns.end());
  timing.limiter = static_cast<Unit>(largest - timing.stack_ns.begin());
  return timing;
}

void add(StreamBytes& sum, const StreamBytes& part) {
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    sum.read[i] += part.read[i];
    sum.write[i] += part.write[i];
  }
}

bool near(double a, double b) {
  return std::abs(a - b) <= kTolerance * std::max({std::abs(a), std::abs(b), 1.0});
}

template <std::size_t N>
bool all_sane(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v) && v >= 0.0; });
}

class InvariantCheck {
 public:
  explicit InvariantCheck(double peak_bytes_per_ns) : peak_(peak_bytes_per_ns) {}

  void pass(const PassTiming& p) {
    const double stack = std::accumulate(p.stack_ns.begin(), p.stack_ns.end(), 0.0);
    const double bytes = p.dram_bytes.total_read() + p.dram_bytes.total_write();
    const bool sane = std::isfinite(p.time_ns) && p.time_ns >= 0.0 && all_sane(p.busy_ns) &&
                      all_sane(p.stack_ns) && all_sane(p.sol_ratio) && all_sane(p.dram_bytes.read) &&
                      all_sane(p.dram_bytes.write);
    require(sane, p.name, "has a time or a count of bytes that is negative or not finite");
    require(
        near(stack, p.time_ns), p.name,
        "stack sums to " + std::to_string(stack) + " ns, its time is " + std::to_string(p.time_ns) + " ns");
    require(
        bytes <= peak_ * p.time_ns * (1.0 + kTolerance), p.name,
        "moves " + std::to_string(bytes) + " bytes in " + std::to_string(p.time_ns) + " ns, over the peak");
    for (std::size_t u = 0; u < kUnitCount; ++u)
      require(p.busy_ns[u] <= p.time_ns * (1.0 + kTolerance), p.name,
              "unit " + std::string(kUnits[u].id) + " is busy for longer than the pass");
  }

  void require(bool holds, const std::string& pass_name, const std::string& what) {
    if (!holds) found_.push_back("pass \"" + pass_name + "\": " + what);
  }
  void require_frame(bool holds, const std::string& what) {
    if (!holds) found_.push_back("frame: " + what);
  }
  std::vector<std::string> take() { return std::move(found_); }

 private:
  double peak_;
  std::vector<std::string> found_;
};

}  // namespace

std::string_view support_name(Support support) {
  switch (support) {
    case Support::calibrated:
      return "calibrated";
    case Support::interpolated:
      return "interpolated";
    case Support::extrapolated:
      return "extrapolated";
    case Support::uncalibrated:
      return "uncalibrated";
  }
  return "uncalibrated";
}

namespace {

/// Widens the frame's interval by that of a pass: sampling errors of passes are independent.
void add_interval(const PassTiming& pass, double& variance) {
  if (!pass.sampling_interval_ns) return;
  const double half = ((*pass.sampling_interval_ns)[1] - (*pass.sampling_interval_ns)[0]) / 2.0;
  variance += half * half;
}

PassTiming detailed_pass(const PassWork& pass, const GpuConfig& gpu, const GpuRates<double>& rates,
                         const TimingOptions& options, std::size_t number, bool waits) {
  DetailedTime detailed = detailed_time(pass, gpu, rates, options, number + 1);
  const double overhead = waits ? rates.pass_overhead_ns : 0.0;
  detailed.time.overhead_ns = overhead;
  detailed.time.time_ns += overhead;
  detailed.time.stack_ns[index_of(Unit::fe)] += overhead;
  const Transition<double> transition = transition_before(pass, rates);
  add_transition(transition, detailed.time);
  PassTiming timing = report(pass, detailed.time);
  if (detailed.interval_ns)
    timing.sampling_interval_ns = {(*detailed.interval_ns)[0] + overhead + transition.ns,
                                   (*detailed.interval_ns)[1] + overhead + transition.ns};
  return timing;
}

PassTiming chunked_pass(const PassWork& pass, const GpuRates<double>& rates, Engine engine, bool waits,
                        TimeSlopes* slopes) {
  const PassShape shape = shape_of(pass);
  const std::vector<ChunkCost<double>> costs = chunk_costs(pass, shape, rates);
  PassSlopes by_costs;
  const PassTime<double> time = time_whole(pass, costs, rates, engine, waits, slopes ? &by_costs : nullptr);
  if (slopes) slopes->add(pass, shape, costs, by_costs, waits);
  return report(pass, time);
}

}  // namespace

FrameTiming time_frame(const WorkTrace& trace, const GpuConfig& gpu, Engine engine,
                       const TimingOptions& options, TimeSlopes* slopes) {
  const GpuRates<double> rates = derive_rates<double>(gpu);
  FrameTiming frame;
  frame.engine = engine;
  frame.passes.reserve(trace.passes.size());
  double variance = 0.0;
  for (std::size_t p = 0; p < trace.passes.size(); ++p) {
    const PassWork& pass = trace.passes[p];
    // A clear has no order of work that events could follow.
    const bool events = engine == Engine::detailed && pass.kind != PassKind::clear;
    frame.passes.push_back(
        events ? detailed_pass(pass, gpu, rates, options, p, waits(trace, p))
               : chunked_pass(pass, rates, engine == Engine::roofline ? engine : Engine::queue,
                              waits(trace, p), engine == Engine::queue ? slopes : nullptr));
    frame.time_ns += frame.passes.back().time_ns;
    add(frame.dram_bytes, frame.passes.back().dram_bytes);
    add_interval(frame.passes.back(), variance);
  }
  if (variance > 0.0)
    frame.sampling_interval_ns = {frame.time_ns - std::sqrt(variance), frame.time_ns + std::sqrt(variance)};
  return frame;
}

std::vector<std::string> check_timing(const FrameTiming& timing, const WorkTrace& trace,
                                      const GpuConfig& gpu) {
  InvariantCheck check(gpu.dram_bandwidth_gb_s);
  StreamBytes bytes;
  double time_ns = 0.0;
  for (const PassTiming& pass : timing.passes) {
    check.pass(pass);
    add(bytes, pass.dram_bytes);
    time_ns += pass.time_ns;
  }
  check.require_frame(timing.passes.size() == trace.passes.size(), "not every pass of the trace has a time");
  check.require_frame(near(time_ns, timing.time_ns), "passes sum to " + std::to_string(time_ns) +
                                                         " ns, the frame takes " +
                                                         std::to_string(timing.time_ns) + " ns");
  check.require_frame(near(bytes.total_read(), timing.dram_bytes.total_read()) &&
                          near(bytes.total_write(), timing.dram_bytes.total_write()),
                      "bytes of the passes do not sum to those of the frame");
  return check.take();
}

}  // namespace hwsim
