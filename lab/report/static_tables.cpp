#include "lab/report/static_tables.h"

#include <algorithm>
#include <cmath>

#include "hwsim/base/units_of_measure.h"
#include "lab/results/results.h"

namespace hwsim::lab {
namespace {

constexpr double kPercent = 100.0;
constexpr std::size_t kInfluences = 16;

std::uint64_t counted(const PassResult& pass, std::string_view id) {
  for (const auto& [name, count] : pass.counters)
    if (name == id) return count;
  return 0;
}

std::uint64_t counted(const Result& result, std::string_view id) {
  std::uint64_t sum = 0;
  for (const PassResult& pass : result.passes) sum += counted(pass, id);
  return sum;
}

}  // namespace

Table point_table(const Report& report) {
  std::vector<Result> results;
  for (const ReportedPoint& point : report.points) results.push_back(point.explanation.result);
  return summary_table(results);
}

Table pass_table(const ReportedPoint& point) {
  Table table{{{"pass", "pass"}, {"kind", "kind"}, {"time_ms", "ms", true}, {"limiter", "limiter"}}, {}};
  const std::vector<PassResult>& passes = point.explanation.result.passes;
  if (passes.empty()) return table;
  for (const auto& [unit, share] : passes.front().units)
    table.columns.push_back({unit + "_pct", unit + " %", true});
  for (const PassResult& pass : passes) {
    std::vector<TableCell>& row = table.rows.emplace_back();
    row = {pass.name, pass.kind, Real{pass.time_ms, 4}, pass.limiter};
    for (const auto& [unit, share] : pass.units) row.emplace_back(Real{kPercent * share, 0});
  }
  return table;
}

Table byte_table(const ReportedPoint& point) {
  Table table{{{"pass", "pass"}}, {}};
  const std::vector<PassResult>& passes = point.explanation.result.passes;
  if (passes.empty()) return table;
  for (const auto& [stream, bytes] : passes.front().bytes)
    table.columns.push_back({stream + "_mb", stream + " MB", true});
  for (const PassResult& pass : passes) {
    std::vector<TableCell>& row = table.rows.emplace_back();
    row = {pass.name};
    for (const auto& [stream, bytes] : pass.bytes) row.emplace_back(Real{bytes / kBytesPerMb, 3});
  }
  return table;
}

Table flow_table(const ReportedPoint& point) {
  struct Stage {
    const char *name, *in, *killed, *out;
  };
  static constexpr std::array kStages = {
      Stage{"culling and set-up, triangles", "setup.in_primitives", "", "setup.out_primitives"},
      Stage{"coarse depth test, tiles", "hiz.tested_tiles", "hiz.killed_tiles", ""},
      Stage{"early depth test, samples", "zrop.early_z_tested_samples", "zrop.early_z_killed_samples", ""},
      Stage{"shading, fragments", "ps.invocations", "ps.discarded_invocations", ""},
      Stage{"late depth test, samples", "zrop.late_z_tested_samples", "zrop.late_z_killed_samples", ""},
      Stage{"color, samples", "crop.written_samples", "", "crop.written_samples"}};
  Table table{{{"stage", "stage"}, {"in", "in", true}, {"killed", "killed", true}, {"out", "out", true}}, {}};
  const Result& result = point.explanation.result;
  for (const Stage& stage : kStages) {
    const std::uint64_t in = counted(result, stage.in);
    const std::uint64_t out = *stage.out ? counted(result, stage.out) : in - counted(result, stage.killed);
    table.rows.push_back({std::string(stage.name), in, in - std::min(in, out), out});
  }
  return table;
}

Table influence_table(const ReportedPoint& point) {
  Table table{{{"parameter", "number of the GPU"},
               {"value", "value", true},
               {"elasticity", "% of time for 1 % more", true},
               {"doubled_ms", "ms with twice of it", true}},
              {}};
  for (const SensitivityResult& s : point.explanation.sensitivities) {
    if (table.rows.size() == kInfluences || s.elasticity == 0.0) break;
    table.rows.push_back({s.parameter, Real{s.value, 3}, Real{s.elasticity, 3},
                          s.doubled_ms ? TableCell{Real{*s.doubled_ms, 3}} : TableCell{NotApplicable{}}});
  }
  return table;
}

Table memory_table(const ReportedPoint& point) {
  Table table{
      {{"part", "image or buffer"}, {"mib", "MiB", true}, {"first", "from pass"}, {"last", "to pass"}}, {}};
  const FrameMemory& memory = point.memory;
  for (const LiveMemory& part : memory.parts)
    table.rows.push_back({part.name, Real{static_cast<double>(part.bytes) / kBytesPerMib, 2},
                          memory.passes[static_cast<std::size_t>(part.first_pass)],
                          memory.passes[static_cast<std::size_t>(part.last_pass)]});
  return table;
}

}  // namespace hwsim::lab
