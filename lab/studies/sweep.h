#pragma once
// A sweep: all points are decided, and all mistakes reported, before the first one runs; then each result
// goes into the database as it comes.
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/point/session.h"
#include "lab/studies/sweep_store.h"

namespace hwsim::lab {

/// Part `index` of `count` of the points, those whose number modulo `count` is `index`.
struct Shard {
  std::size_t index = 0, count = 1;
};

/// "1/4" is the first of four. Throws InputError U003.
Shard parse_shard(const std::string& text);

/// A point with all that it takes to run it.
struct PlannedPoint {
  SweepPoint point{};
  std::shared_ptr<const RunPlan> plan;
  const algos::TechniqueChoice* technique = nullptr;  ///< the plan's
  const GpuConfig* gpu = nullptr;                     ///< the plan's
  SceneView* scene = nullptr;                         ///< the session's
  std::string work{};                                 ///< equal where one emulation serves both
};

/// One list of settings gives each technique on each GPU a point. Throws InputError with the problems of all
/// points, at most about twenty, since a thousand points may have the same mistake.
std::vector<PlannedPoint> plan_sweep(const Request& request,
                                     const std::vector<std::vector<Assignment>>& settings, Session& session);

/// The points as they are planned, nothing run.
Table planned_table(const std::vector<PlannedPoint>& points);

struct SweepJob {
  std::string database{};
  bool resume = false;  ///< finished points of the database are kept
  bool force = false;   ///< a sweep's database is replaced
  Shard shard{};
  std::vector<std::string> merge{};  ///< other databases whose finished points are taken over first
  std::string command_line{};        ///< remembered in the database
};

struct SweepSummary {
  std::string database{};
  std::size_t done = 0, failed = 0;
  std::size_t left = 0;  ///< waiting, interrupted, or running: in another process, or in one that was killed
  Table points{};        ///< every point of the database
};

nlohmann::ordered_json to_json(const SweepSummary& summary);
/// Throws nlohmann::json::exception where a field is missing or of another type.
SweepSummary sweep_summary_from_json(const nlohmann::ordered_json& json);

/// Runs what is not done. Without points it merges and reads the database only; without databases to merge it
/// opens it read-only. A point that cannot
/// run is failed, with a warning to the observer; throws InputError U013 or U021 for the database itself.
SweepSummary run_sweep(const std::vector<PlannedPoint>& points, const SweepJob& job, Session& session);

}  // namespace hwsim::lab
