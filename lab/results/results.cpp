#include "lab/results/results.h"

#include <fmt/format.h>

#include <algorithm>

#include "hwsim/base/units_of_measure.h"
#include "lab/catalog/data_sheet.h"
#include "lab/catalog/plausible.h"
#include "pipeline/image/frame_check.h"
#include "pipeline/scene/scene.h"

namespace hwsim::lab {
namespace {

/// Units that did something, the largest share of time first.
std::vector<size_t> units_by_share(const std::array<double, kUnitCount>& stack_ns) {
  std::vector<size_t> order;
  for (size_t u = 0; u < kUnitCount; ++u)
    if (stack_ns[u] > 0.0) order.push_back(u);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return stack_ns[a] > stack_ns[b]; });
  return order;
}

std::string share_text(const PassTiming& pass, size_t rank) {
  const std::vector<size_t> order = units_by_share(pass.stack_ns);
  if (rank >= order.size() || pass.time_ns <= 0.0) return "";
  return fmt::format("{} {:.0f} %", unit_name(static_cast<Unit>(order[rank])),
                     100.0 * pass.stack_ns[order[rank]] / pass.time_ns);
}

Real stream_mb(const PassTiming& pass, std::initializer_list<Stream> streams) {
  double bytes = 0.0;
  for (const Stream stream : streams)
    bytes += pass.dram_bytes.read[static_cast<size_t>(stream)] +
             pass.dram_bytes.write[static_cast<size_t>(stream)];
  return {bytes / kBytesPerMb, 2};
}

std::string band_of(double sol_ratio) {  // the bands of the performance-triage literature
  return sol_ratio >= 0.8 ? "close to its peak" : sol_ratio >= 0.6 ? "well used" : "under-used";
}

/// Filters of a finished picture draw none.
bool draws_a_scene(const WorkTrace& trace) {
  return std::ranges::any_of(trace.passes, [](const PassWork& pass) { return pass.kind == PassKind::draw; });
}

}  // namespace

std::uint64_t shader_invocations(const WorkTrace& trace) {
  const PassCounters sum = total(trace);
  return sum.ps.invocations + sum.stats.compute_shader_invocations;
}

const PassTiming& slowest_pass(const FrameTiming& timing) {
  return *std::max_element(timing.passes.begin(), timing.passes.end(),
                           [](const PassTiming& a, const PassTiming& b) { return a.time_ns < b.time_ns; });
}

std::vector<Diagnostic> result_warnings(const PointResult& point) {
  std::vector<Diagnostic> warnings =
      algos::frame_notes(*point.technique, {point.emulation->trace, point.surfaces});
  for (Diagnostic& warning : kept_rates(*point.gpu)) warnings.push_back(std::move(warning));
  for (Diagnostic& warning : implausible_numbers(*point.gpu)) warnings.push_back(std::move(warning));
  if (!draws_a_scene(point.emulation->trace)) return warnings;
  const auto look = pipeline::check_frame(point.emulation->color, pipeline::Scene{}.background);
  warnings.insert(warnings.end(), look.begin(), look.end());
  return warnings;
}

std::string headline_time(const FrameResult& frame) {
  std::string text = fmt::format("{:.3g} ms", frame.time_ms);
  if (frame.interval_ms)
    text += fmt::format(" [{:.3g}, {:.3g}]", (*frame.interval_ms)[0], (*frame.interval_ms)[1]);
  return text + " " + frame.support;
}

double limiter_share_ratio(const PointResult& point) {
  if (point.timing.passes.empty()) return 0.0;
  const PassTiming& slowest = slowest_pass(point.timing);
  if (slowest.time_ns <= 0.0) return 0.0;
  return slowest.stack_ns[static_cast<size_t>(slowest.limiter)] / slowest.time_ns;
}

std::string headline(const Result& result, double limiter_share_ratio) {
  std::string text =
      fmt::format("{}, {} on {} at {}x{}: {}\n", result.scene, result.technique, result.gpu,
                  result.resolution.width_px, result.resolution.height_px, headline_time(result.frame));
  if (const PassResult* slowest = slowest_pass(result))
    text += fmt::format("slowest pass: {}, {:.3g} ms, limited by {} ({:.0f} % of its time)\n", slowest->name,
                        slowest->time_ms, slowest->limiter, 100.0 * limiter_share_ratio);
  if (result.image)
    text += fmt::format("error of the image: FLIP {:.4f}, PSNR {:.2f} dB\n", result.image->flip_mean,
                        result.image->psnr_db);
  return text;
}

Table pass_table(const PointResult& point) {
  Table table{{{"pass", "pass"},
               {"kind", "kind", false, 0, true},
               {"time_ms", "ms", true},
               {"share_pct", "% of frame", true},
               {"limiter", "limiter"},
               {"runner_up", "next"},
               {"fragments", "fragments", true},
               {"shaded", "shaded", true},
               {"depth_mb", "depth MB", true, 0, true},
               {"color_mb", "color MB", true, 0, true},
               {"texture_mb", "texture MB", true, 0, true},
               {"other_mb", "other MB", true, 0, true}},
              {}};
  for (size_t i = 0; i < point.timing.passes.size(); ++i) {
    const PassTiming& pass = point.timing.passes[i];
    const PassCounters counters = total(point.emulation->trace.passes[i]);
    const double share = point.timing.time_ns > 0.0 ? 100.0 * pass.time_ns / point.timing.time_ns : 0.0;
    table.rows.push_back({pass.name, std::string(pass_kind_name(pass.kind)), Real{pass.time_ns / kNsPerMs, 4},
                          Real{share, 1}, share_text(pass, 0), share_text(pass, 1), counters.raster.fragments,
                          counters.ps.invocations + counters.stats.compute_shader_invocations,
                          stream_mb(pass, {Stream::depth}), stream_mb(pass, {Stream::color}),
                          stream_mb(pass, {Stream::texture}),
                          stream_mb(pass, {Stream::storage, Stream::vertex, Stream::index, Stream::constant,
                                           Stream::shader, Stream::other})});
  }
  return table;
}

Table unit_table(const PointResult& point) {
  Table table{{{"unit", "unit"},
               {"busy_ms", "busy ms", true},
               {"stack_ms", "share ms", true},
               {"share_pct", "% of frame", true},
               {"sol_pct", "SOL %", true},
               {"band", "use"}},
              {}};
  for (size_t u = 0; u < kUnitCount; ++u) {
    double busy_ns = 0.0, stack_ns = 0.0;
    for (const PassTiming& pass : point.timing.passes) {
      busy_ns += pass.busy_ns[u];
      stack_ns += pass.stack_ns[u];
    }
    const double frame_ns = std::max(point.timing.time_ns, 1e-9);
    table.rows.push_back({std::string(unit_name(static_cast<Unit>(u))), Real{busy_ns / kNsPerMs, 4},
                          Real{stack_ns / kNsPerMs, 4}, Real{100.0 * stack_ns / frame_ns, 1},
                          Real{100.0 * busy_ns / frame_ns, 1},
                          busy_ns > 0.0 ? band_of(busy_ns / frame_ns) : "idle"});
  }
  return table;
}

Table wide_pass_table(const PointResult& point) {
  Table table{{{"pass", ""}, {"kind", ""}, {"time_ms", ""}, {"limiter", ""}, {"overhead_ns", ""}}, {}};
  for (const char* quantity : {"busy_ns", "sol_ratio", "stack_ns"})
    for (int u = 0; u < kUnitCount; ++u)
      table.columns.push_back({fmt::format("{}.{}", unit_name(static_cast<Unit>(u)), quantity), ""});
  for (const char* direction : {"read_bytes", "write_bytes"})
    for (int s = 0; s < kStreamCount; ++s)
      table.columns.push_back(
          {fmt::format("dram.{}_{}", stream_name(static_cast<Stream>(s)), direction), ""});
  for (const auto& [info, place] : algos::counters()) table.columns.push_back({std::string(info.id), ""});

  for (size_t i = 0; i < point.timing.passes.size(); ++i) {
    const PassTiming& pass = point.timing.passes[i];
    std::vector<TableCell> row = {pass.name, std::string(pass_kind_name(pass.kind)),
                                  Real{pass.time_ns / kNsPerMs}, std::string(unit_name(pass.limiter)),
                                  Real{pass.overhead_ns}};
    for (const auto* list : {&pass.busy_ns, &pass.sol_ratio, &pass.stack_ns})
      for (const double value : *list) row.push_back(Real{value});
    for (const auto* list : {&pass.dram_bytes.read, &pass.dram_bytes.write})
      for (const double value : *list) row.push_back(Real{value});
    const PassCounters counters = total(point.emulation->trace.passes[i]);
    for (const auto& [info, place] : algos::counters()) row.push_back(values(counters)[place]);
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table counter_table(const PointResult& point) {
  Table table{{{"pass", ""}, {"unit", ""}, {"counter", ""}, {"value", ""}, {"unit_kind", ""}}, {}};
  for (const PassWork& pass : point.emulation->trace.passes) {
    const PassCounters counters = total(pass);
    for (const auto& [info, place] : algos::counters())
      table.rows.push_back({pass.name, std::string(info.unit), std::string(info.id), values(counters)[place],
                            std::string(info.unit_kind)});
  }
  return table;
}

Table summary_table(const std::vector<Result>& results) {
  Table table{{{"technique", "technique"},
               {"gpu", "GPU"},
               {"time_ms", "ms", true},
               {"lo_ms", "lo", true},
               {"hi_ms", "hi", true},
               {"support", "support"},
               {"limiter", "limiter of the slowest pass"},
               {"dram_mb", "DRAM MB", true, 0, true},
               {"memory_mib", "memory MiB", true, 0, true},
               {"shaded_samples", "shaded samples", true, 0, true},
               {"flip_mean", "FLIP", true},
               {"psnr_db", "PSNR dB", true, 0, true}},
              {}};
  for (const Result& result : results) {
    const FrameResult& frame = result.frame;
    const auto bound = [&](size_t i) -> TableCell {
      return frame.interval_ms ? TableCell{Real{(*frame.interval_ms)[i], 3}} : TableCell{NotApplicable{}};
    };
    const auto error = [&](double pipeline::ImageError::*member, int decimals) -> TableCell {
      return result.image ? TableCell{Real{(*result.image).*member, decimals}} : TableCell{NotApplicable{}};
    };
    const PassResult* slowest = slowest_pass(result);
    table.rows.push_back(
        {result.technique, result.gpu, Real{frame.time_ms, 3}, bound(0), bound(1), frame.support,
         slowest ? TableCell{slowest->limiter + " in " + slowest->name} : TableCell{NotApplicable{}},
         Real{frame.dram_mb, 1}, Real{frame.memory_mib, 1}, frame.shaded_samples,
         error(&pipeline::ImageError::flip_mean, 4), error(&pipeline::ImageError::psnr_db, 2)});
  }
  return table;
}

}  // namespace hwsim::lab
