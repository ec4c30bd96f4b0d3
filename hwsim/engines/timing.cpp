#include "hwsim/engines/timing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hwsim/detailed/detailed.h"
#include "hwsim/timing/time_pass.h"

namespace hwsim {
namespace {

constexpr std::array<std::string_view, kUnitCount> kUnitNames = {
    "fe", "ia", "vs", "setup", "raster", "hiz", "zrop", "shader", "tex", "crop", "resolve", "l2", "dram"};
constexpr std::array<std::string_view, kStreamCount> kStreamNames = {
    "depth", "color", "texture", "storage", "vertex", "index", "constant", "shader", "other"};
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
              "unit " + std::string(kUnitNames[u]) + " is busy for longer than the pass");
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

std::string_view unit_name(Unit unit) { return kUnitNames[at(unit)]; }
std::string_view stream_name(Stream stream) { return kStreamNames[at(stream)]; }

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

std::string_view engine_name(Engine engine) {
  switch (engine) {
    case Engine::roofline:
      return "roofline";
    case Engine::queue:
      return "queue";
    case Engine::detailed:
      return "detailed";
  }
  return "queue";
}

std::optional<Engine> engine_from_name(std::string_view name) {
  for (const Engine engine : {Engine::roofline, Engine::queue, Engine::detailed})
    if (engine_name(engine) == name) return engine;
  return std::nullopt;
}

double StreamBytes::total_read() const { return std::accumulate(read.begin(), read.end(), 0.0); }
double StreamBytes::total_write() const { return std::accumulate(write.begin(), write.end(), 0.0); }

IssuedOps issued_ops(const ShaderCounters& s, int subgroup_size) {
  const auto pair = [](std::uint64_t alu, std::uint64_t sfu) {
    return IssuedOps{static_cast<double>(alu), static_cast<double>(sfu)};
  };
  if (subgroup_size <= 8) return pair(s.alu_issued_lane_ops_w8, s.sfu_issued_lane_ops_w8);
  if (subgroup_size <= 16) return pair(s.alu_issued_lane_ops_w16, s.sfu_issued_lane_ops_w16);
  if (subgroup_size <= 32) return pair(s.alu_issued_lane_ops_w32, s.sfu_issued_lane_ops_w32);
  return pair(s.alu_issued_lane_ops_w64, s.sfu_issued_lane_ops_w64);
}

double subgroups_of(const PassCounters& c, int subgroup_size) {
  return static_cast<double>(c.stats.fragment_shader_invocations + c.stats.geometry_shader_invocations +
                             c.stats.compute_shader_invocations) /
         subgroup_size;
}

double packets_of(const PassCounters& c, int subgroup_size) {
  constexpr std::uint64_t kTileItems = 16, kItemBytes = 64;
  const std::uint64_t bytes = c.mem.depth_read_bytes + c.mem.depth_write_bytes + c.mem.color_read_bytes +
                              c.mem.color_write_bytes + c.mem.texture_read_bytes + c.mem.storage_read_bytes +
                              c.mem.storage_write_bytes + c.mem.vertex_read_bytes + c.mem.index_read_bytes;
  const std::uint64_t items =
      std::max({c.stats.fragment_shader_invocations + c.stats.compute_shader_invocations, 4 * c.raster.quads,
                kTileItems * c.raster.visited_tiles, kTileItems * c.hiz.tested_tiles,
                c.stats.input_assembly_vertices, c.setup.in_primitives, c.crop.exported_fragments,
                c.resolve.written_pixels, c.fe.draws, bytes / kItemBytes});
  return std::max(1.0, std::ceil(static_cast<double>(items) / subgroup_size));
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
  detailed.time.stack_ns[at(Unit::fe)] += overhead;
  PassTiming timing = report(pass, detailed.time);
  if (detailed.interval_ns)
    timing.sampling_interval_ns = {(*detailed.interval_ns)[0] + overhead,
                                   (*detailed.interval_ns)[1] + overhead};
  return timing;
}

}  // namespace

FrameTiming time_frame(const WorkTrace& trace, const GpuConfig& gpu, Engine engine,
                       const TimingOptions& options) {
  const GpuRates<double> rates = derive_rates<double>(gpu);
  FrameTiming frame;
  frame.engine = engine;
  frame.passes.reserve(trace.passes.size());
  double variance = 0.0;
  for (const PassWork& pass : trace.passes) {
    const bool waits = pass.barrier_before || frame.passes.empty();
    // A clear has no order of work that events could follow.
    const bool events = engine == Engine::detailed && pass.kind != PassKind::clear;
    frame.passes.push_back(
        events ? detailed_pass(pass, gpu, rates, options, frame.passes.size(), waits)
               : report(pass,
                        time_pass(pass, rates, engine == Engine::roofline ? engine : Engine::queue, waits)));
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
