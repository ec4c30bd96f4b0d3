#pragma once
// Rows of the engine study, their summary, and both as CSV and Markdown.
#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace hwsim::benchmarks {

/// One engine on one frame and GPU, against the whole event-driven simulation. Fixed costs of passes, alike
/// in all engines, are left out of the times that errors are computed from: they would hide them.
struct StudyRow {
  std::string scene, technique, gpu, engine;
  double time_ms = 0.0, overhead_ms = 0.0, dram_mb = 0.0, wall_ms = 0.0;
  double time_error_pct = 0.0, byte_error_pct = 0.0, times_as_fast = 1.0;
  double fragments = 0.0;  ///< and compute invocations, of the frame
};

struct Spread {
  double median = 0.0, p90 = 0.0, worst = 0.0;
};
Spread spread_of(std::vector<double> values);

struct EngineSummary {
  Spread time_pct, byte_pct;  ///< absolute errors
  double median_times_as_fast = 1.0, median_wall_ms = 0.0, fastest_wall_ms = 0.0;
};
std::map<std::string, EngineSummary> summarize(const std::vector<StudyRow>& rows);

void write_csv(const std::vector<StudyRow>& rows, std::ostream& out);
void write_table(const std::vector<StudyRow>& rows, std::ostream& out);

}  // namespace hwsim::benchmarks
