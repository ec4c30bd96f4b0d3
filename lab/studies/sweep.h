#pragma once
// A sweep: all points are decided, and all mistakes reported, before the first one runs; then results go into
// the database, those of at most a fifth of a second together.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/studies/sweep_plan.h"

namespace hwsim::lab {

/// Part `index` of `count` of the points, those whose number modulo `count` is `index`.
struct Shard {
  std::size_t index = 0, count = 1;
};

/// "1/4" is the first of four. Throws InputError U003.
Shard parse_shard(const std::string& text);

struct SweepJob {
  std::string database{};
  bool resume = false;  ///< finished points of the database are kept
  bool force = false;   ///< a sweep's database is replaced
  bool alone = false;   ///< no other process works on the database: points that one had claimed are free
  Shard shard{};
  /// Other databases whose finished points are taken over first; `*`, `?` and `[...]` stand for names as in a
  /// shell. The database itself is left out.
  std::vector<std::string> merge{};
  std::string command_line{};  ///< remembered in the database
};

struct SweepSummary {
  std::string database{};
  std::size_t done = 0, failed = 0;
  std::size_t left = 0;  ///< waiting, interrupted, or running: in another process, or in one that was killed
  RowSource points{};    ///< every point of the database, read anew each time
};

nlohmann::ordered_json to_json(const SweepSummary& summary);
/// Throws nlohmann::json::exception where a field is missing or of another type.
SweepSummary sweep_summary_from_json(const nlohmann::ordered_json& json);

/// Runs what is not done. Without points it merges and reads the database only; without databases to merge it
/// opens it read-only. A point that cannot run is failed, with a warning to the observer; throws InputError
/// U013 or U021 for the database itself. Killed, it loses the results of the last fifth of a second at most.
SweepSummary run_sweep(const SweepPlan& plan, const SweepJob& job, Session& session);

}  // namespace hwsim::lab
