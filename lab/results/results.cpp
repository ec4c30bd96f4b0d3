#include "lab/results/results.h"

#include <fmt/format.h>

#include <algorithm>

#include "hwsim/base/units_of_measure.h"
#include "pipeline/image/frame_check.h"
#include "pipeline/scene/scene.h"

namespace hwsim::lab {
namespace {

using Json = nlohmann::ordered_json;

double dram_bytes(const StreamBytes& bytes) { return bytes.total_read() + bytes.total_write(); }

Json pass_json(const PassTiming& pass, const PassWork& work) {
  Json json;
  json["name"] = pass.name;
  json["kind"] = pass_kind_name(pass.kind);
  json["time_ms"] = pass.time_ns / kNsPerMs;
  json["limiter"] = unit_name(pass.limiter);
  for (int u = 0; u < kUnitCount; ++u)
    json["units"][std::string(unit_name(static_cast<Unit>(u)))] = pass.sol_ratio[static_cast<size_t>(u)];
  for (int s = 0; s < kStreamCount; ++s) {
    const auto i = static_cast<size_t>(s);
    json["bytes"][std::string(stream_name(static_cast<Stream>(s)))] =
        pass.dram_bytes.read[i] + pass.dram_bytes.write[i];
  }
  const PassCounters counters = total(work);
  for (const auto& [info, place] : algos::counters())
    json["counters"][std::string(info.id)] = values(counters)[place];
  return json;
}

Json frame_json(const PointResult& point) {
  const FrameTiming& timing = point.timing;
  Json json;
  json["time_ms"] = timing.time_ns / kNsPerMs;
  json["interval_ms"] = nullptr;
  if (timing.interval_ns)
    json["interval_ms"] = {(*timing.interval_ns)[0] / kNsPerMs, (*timing.interval_ns)[1] / kNsPerMs};
  json["support"] = support_name(timing.support);
  json["memory_mib"] = static_cast<double>(point.emulation->trace.peak_memory_bytes) / kBytesPerMib;
  json["allocated_mib"] = static_cast<double>(point.emulation->trace.allocated_memory_bytes) / kBytesPerMib;
  json["dram_mb"] = dram_bytes(timing.dram_bytes) / kBytesPerMb;
  json["shaded_samples"] = algos::shaded_samples(point.emulation->trace);
  return json;
}

Json image_json(const PointResult& point) {
  if (!point.image_error) return nullptr;
  const pipeline::ImageError& error = *point.image_error;
  return {{"psnr_db", error.psnr_db},         {"flip_mean", error.flip_mean}, {"rmse", error.rmse},
          {"flip_median", error.flip_median}, {"flip_p99", error.flip_p99},   {"ssim", error.ssim}};
}

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

Json result_json(const PointResult& point, const RunPlan& plan, const std::string& scene_name) {
  Json json;
  json["schema_version"] = kResultSchemaVersion;
  json["scene"] = scene_name;
  json["technique"] = algos::technique_text(*point.technique);
  json["gpu"] = point.gpu->id;
  json["engine"] = engine_name(plan.engine);
  json["resolution"] = {plan.view.resolution.width_px, plan.view.resolution.height_px};
  json["frame"] = frame_json(point);
  json["passes"] = Json::array();
  for (size_t i = 0; i < point.timing.passes.size(); ++i)
    json["passes"].push_back(pass_json(point.timing.passes[i], point.emulation->trace.passes[i]));
  json["image"] = image_json(point);
  Json skipped = Json::object();
  for (const auto& [name, count] : point.emulation->skipped) skipped[name] = count;
  json["emulation"] = {
      {"wall_s", point.emulation->wall_s}, {"from_cache", point.from_cache}, {"skipped", skipped}};
  json["timing"] = {{"wall_s", point.timing_wall_s}};
  for (const Diagnostic& warning : result_warnings(point)) json["warnings"].push_back(warning.message);
  if (const auto& sampled = point.timing.sampling_interval_ns)
    json["timing"]["sampling_interval_ms"] = {(*sampled)[0] / kNsPerMs, (*sampled)[1] / kNsPerMs};
  return json;
}

std::vector<Diagnostic> result_warnings(const PointResult& point) {
  std::vector<Diagnostic> warnings = algos::frame_notes(*point.technique, point.emulation->trace);
  if (!draws_a_scene(point.emulation->trace)) return warnings;
  const auto look = pipeline::check_frame(point.emulation->color, pipeline::Scene{}.background);
  warnings.insert(warnings.end(), look.begin(), look.end());
  return warnings;
}

std::string headline_time(const FrameTiming& timing) {
  std::string text = fmt::format("{:.3g} ms", timing.time_ns / kNsPerMs);
  if (timing.interval_ns)
    text += fmt::format(" [{:.3g}, {:.3g}]", (*timing.interval_ns)[0] / kNsPerMs,
                        (*timing.interval_ns)[1] / kNsPerMs);
  return text + " " + std::string(support_name(timing.support));
}

std::string headline(const PointResult& point, const RunPlan& plan, const std::string& scene_name) {
  std::string text = fmt::format(
      "{}, {} on {} at {}x{}: {}\n", scene_name, algos::technique_text(*point.technique), point.gpu->id,
      plan.view.resolution.width_px, plan.view.resolution.height_px, headline_time(point.timing));
  if (!point.timing.passes.empty()) {
    const PassTiming& slowest = slowest_pass(point.timing);
    text += fmt::format("slowest pass: {}, {:.3g} ms, limited by {} ({} of its time)\n", slowest.name,
                        slowest.time_ns / kNsPerMs, unit_name(slowest.limiter),
                        share_text(slowest, 0).substr(unit_name(slowest.limiter).size() + 1));
  }
  if (point.image_error)
    text += fmt::format("error of the image: FLIP {:.4f}, PSNR {:.2f} dB\n", point.image_error->flip_mean,
                        point.image_error->psnr_db);
  return text;
}

Table pass_table(const PointResult& point) {
  Table table{{{"pass", "pass"},
               {"kind", "kind"},
               {"time_ms", "ms", true},
               {"share_pct", "% of frame", true},
               {"limiter", "limiter"},
               {"runner_up", "next"},
               {"fragments", "fragments", true},
               {"shaded", "shaded", true},
               {"depth_mb", "depth MB", true},
               {"color_mb", "color MB", true},
               {"texture_mb", "texture MB", true},
               {"other_mb", "other MB", true}},
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
    std::vector<Cell> row = {pass.name, std::string(pass_kind_name(pass.kind)), Real{pass.time_ns / kNsPerMs},
                             std::string(unit_name(pass.limiter)), Real{pass.overhead_ns}};
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

std::vector<Cell> summary_row(const PointResult& point) {
  const FrameTiming& timing = point.timing;
  const auto error = [&](double pipeline::ImageError::*member, int decimals) -> Cell {
    if (!point.image_error) return NotApplicable{};
    return Real{(*point.image_error).*member, decimals};
  };
  const auto bound = [&](size_t i) -> Cell {
    if (!timing.interval_ns) return NotApplicable{};
    return Real{(*timing.interval_ns)[i] / kNsPerMs, 3};
  };
  const Cell limiter =
      timing.passes.empty()
          ? Cell{NotApplicable{}}
          : Cell{fmt::format("{} in {}", unit_name(slowest_pass(timing).limiter), slowest_pass(timing).name)};
  return {algos::technique_text(*point.technique),
          point.gpu->id,
          Real{timing.time_ns / kNsPerMs, 3},
          bound(0),
          bound(1),
          std::string(support_name(timing.support)),
          limiter,
          Real{dram_bytes(timing.dram_bytes) / kBytesPerMb, 1},
          Real{static_cast<double>(point.emulation->trace.peak_memory_bytes) / kBytesPerMib, 1},
          algos::shaded_samples(point.emulation->trace),
          error(&pipeline::ImageError::flip_mean, 4),
          error(&pipeline::ImageError::psnr_db, 2)};
}

Table summary_table(std::vector<std::vector<Cell>> rows) {
  return {{{"technique", "technique"},
           {"gpu", "GPU"},
           {"time_ms", "ms", true},
           {"lo_ms", "lo", true},
           {"hi_ms", "hi", true},
           {"support", "support"},
           {"limiter", "limiter of the slowest pass"},
           {"dram_mb", "DRAM MB", true},
           {"memory_mib", "memory MiB", true},
           {"shaded_samples", "shaded samples", true},
           {"flip_mean", "FLIP", true},
           {"psnr_db", "PSNR dB", true}},
          std::move(rows)};
}

}  // namespace hwsim::lab
