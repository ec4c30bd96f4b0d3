#pragma once
// What a point of a run is shown and written as: tables, sentences, and traces of events.
#include <string>
#include <vector>

#include "lab/base/table.h"
#include "lab/results/result.h"

namespace hwsim::lab {

Table pass_table(const PointResult& point);       ///< the passes as people read them
Table unit_table(const PointResult& point);       ///< the units over the frame
Table wide_pass_table(const PointResult& point);  ///< passes.csv: every time, share, byte and counter
Table counter_table(const PointResult& point);    ///< counters.csv: one row a counter

/// One row a result.
Table summary_table(const std::vector<Result>& results);

/// "1.23 ms [1.10, 1.36] calibrated", "1.23 ms uncalibrated".
std::string headline_time(const FrameResult& frame);

/// What makes the image of a point less than its technique promises, or its memory more than it asks for.
std::vector<Diagnostic> result_warnings(const PointResult& point);

/// Two sentences: the time with its interval, and the pass and unit that it goes to. The share is that of the
/// slowest pass's time which goes to its limiter.
std::string headline(const Result& result, double limiter_share_ratio);
double limiter_share_ratio(const PointResult& point);

/// Invocations of fragment shaders for fragments and of compute shaders, all passes.
std::uint64_t shader_invocations(const WorkTrace& trace);

/// Trace Event JSON for Perfetto: one track a unit, slices for passes, counter tracks.
std::string trace_event_json(const PointResult& point);

/// The slowest pass.
const PassTiming& slowest_pass(const FrameTiming& timing);

}  // namespace hwsim::lab
