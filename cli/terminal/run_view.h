#pragma once
// A run as people see it: its plan before, and its points while they come.
#include <optional>

#include "cli/terminal/answer.h"
#include "cli/terminal/terminal.h"
#include "lab/results/run_record.h"

namespace hwsim::cli {

/// `seconds`: what the same plan took the last time, where that is known.
std::string plan_text(const lab::RunPlan& plan, int jobs, std::optional<double> seconds);

/// Records the points, logs them, and keeps what the answer shows of a single one. Both must outlive it.
class ShownRun : public lab::RunSink {
 public:
  ShownRun(lab::RunRecord& record, Log& log) : record_(record), log_(log) {}
  void begin(const lab::RunContext& run) override;
  void point(const lab::PointResult& point, const lab::RunContext& run) override;

  /// That of the last point, or of several.
  Answer answer(const lab::Run& run) const;

 private:
  lab::RunRecord& record_;
  Log& log_;
  Answer last_;
};

}  // namespace hwsim::cli
