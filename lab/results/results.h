#pragma once
// What a point of a run is shown and written as. Table, CSV and JSON read the same PointResult.
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "lab/base/table.h"
#include "lab/point/simulate.h"

namespace hwsim::lab {

inline constexpr int kResultSchemaVersion = 1;

/// The JSON contract of docs/results.md.
nlohmann::ordered_json result_json(const PointResult& point, const RunPlan& plan,
                                   const std::string& scene_name);

Table pass_table(const PointResult& point);       ///< the passes as people read them
Table unit_table(const PointResult& point);       ///< the units over the frame
Table wide_pass_table(const PointResult& point);  ///< passes.csv: every time, share, byte and counter
Table counter_table(const PointResult& point);    ///< counters.csv: one row a counter

/// One row of the summary of several points; `point` may go afterwards.
std::vector<Cell> summary_row(const PointResult& point);
Table summary_table(std::vector<std::vector<Cell>> rows);

/// "1.23 ms [1.10, 1.36] calibrated", "1.23 ms uncalibrated".
std::string headline_time(const FrameTiming& timing);

/// What makes the image of a point less than its technique promises, or its memory more than it asks for.
std::vector<Diagnostic> result_warnings(const PointResult& point);

/// Two sentences: the time with its interval, and the pass and unit that it goes to.
std::string headline(const PointResult& point, const RunPlan& plan, const std::string& scene_name);

/// Invocations of fragment shaders for fragments and of compute shaders, all passes.
std::uint64_t shader_invocations(const WorkTrace& trace);

/// Trace Event JSON for Perfetto: one track a unit, slices for passes, counter tracks.
std::string trace_event_json(const PointResult& point);

/// The slowest pass.
const PassTiming& slowest_pass(const FrameTiming& timing);

}  // namespace hwsim::lab
