#pragma once
// What a sweep emulates: its work apart from its points, estimated, shared out evenly, and done in advance,
// so that points anywhere find it in the cache.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/studies/sweep.h"

namespace hwsim::lab {

/// A frame that some points of a sweep need.
struct PlannedWork {
  std::size_t first_point = 0;  ///< index into the plan, of the first one that needs it
  std::size_t points = 0;
  std::string scene{}, camera{}, technique{}, gpu{};
  Resolution resolution{};
  double expected_s = 0.0;       ///< one core's, without loading the scene
  double expected_load_s = 0.0;  ///< its scene's, once for all works of a process
  bool kept = false;             ///< the cache has it
  std::size_t shard = 0;
};

/// Every frame of the plan, shared out among `shards`: those that take longest first, each to the shard that
/// is ready first, where a further scene costs its loading. What is kept counts as well, so that every
/// process that asks has the same answer.
std::vector<PlannedWork> works_of(const SweepPlan& plan, std::size_t shards, Session& session);

/// Seconds that each shard is expected to take.
std::vector<double> expected_seconds(const std::vector<PlannedWork>& works, std::size_t shards);

struct EmulationSummary {
  std::size_t emulated = 0, kept = 0, failed = 0, others = 0;  ///< frames; `others`: of other shards
  double expected_s = 0.0, wall_s = 0.0;                       ///< for those that were emulated
};

/// Emulates the frames of a shard that the cache does not have. A frame that cannot be drawn is told as a
/// warning: its points fail later.
EmulationSummary emulate_works(const SweepPlan& plan, const Shard& shard, Session& session);

Table work_table(const std::vector<PlannedWork>& works);
/// The works, and every point with the number of its work.
nlohmann::ordered_json to_json(const SweepPlan& plan, const std::vector<PlannedWork>& works);

}  // namespace hwsim::lab
