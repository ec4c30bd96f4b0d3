#include "lab/studies/sweep_work.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "lab/point/frame_cost.h"

namespace hwsim::lab {
namespace {

FrameNeeds needs_of(const RunPlan& plan) { return {plan.skip, plan.reference_samples > 0}; }

PlannedWork describe(const PlannedPoint& point, std::size_t index, Session& session) {
  SceneView& scene = *point.scene;
  const FrameCost cost = expected_cost(scene, *point.technique, point.gpu);
  return {.first_point = index,
          .scene = scene.summary().name,
          .camera = scene.plan().camera,
          .technique = algos::technique_text(*point.technique),
          .gpu = point.gpu.id,
          .resolution = scene.plan().resolution,
          .expected_s = cost.frame_s,
          .expected_load_s = cost.load_s,
          .kept = session.traces().is_kept(scene, *point.technique, point.gpu, needs_of(*point.plan))};
}

/// Longest processing time first (Graham 1969): at most 4/3 of the best sharing, without the scenes.
void share_out(std::vector<PlannedWork>& works, const std::vector<std::uint32_t>& scenes,
               std::size_t shards) {
  std::vector<std::size_t> order(works.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) { return works[i].expected_s; });
  std::vector<double> busy(shards, 0.0);
  std::vector<std::set<std::uint32_t>> loaded(shards);
  for (const std::size_t i : order) {
    const auto ready = [&](std::size_t shard) {
      return busy[shard] + (loaded[shard].contains(scenes[i]) ? 0.0 : works[i].expected_load_s);
    };
    std::size_t first = 0;
    for (std::size_t shard = 1; shard < shards; ++shard)
      if (ready(shard) < ready(first)) first = shard;
    busy[first] = ready(first) + works[i].expected_s;
    loaded[first].insert(scenes[i]);
    works[i].shard = first;
  }
}

}  // namespace

std::vector<PlannedWork> works_of(const SweepPlan& plan, std::size_t shards, Session& session) {
  std::vector<PlannedWork> works(plan.works());
  std::vector<std::uint32_t> scenes;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    PlannedWork& work = works[plan.work_of(i)];
    if (work.points++ == 0) {
      work = describe(plan[i], i, session);
      work.points = 1;
    }
  }
  for (std::uint32_t w = 0; w < works.size(); ++w) scenes.push_back(plan.scene_of(w));
  share_out(works, scenes, shards);
  return works;
}

std::vector<double> expected_seconds(const std::vector<PlannedWork>& works, std::size_t shards) {
  std::vector<double> seconds(shards, 0.0);
  std::set<std::pair<std::size_t, std::string>> loaded;
  for (const PlannedWork& work : works) {
    seconds[work.shard] += work.expected_s;
    if (loaded.emplace(work.shard, work.scene).second) seconds[work.shard] += work.expected_load_s;
  }
  return seconds;
}

EmulationSummary emulate_works(const SweepPlan& plan, const Shard& shard, Session& session) {
  std::vector<PlannedWork> works = works_of(plan, shard.count, session);
  EmulationSummary summary;
  std::erase_if(works, [&](const PlannedWork& work) { return work.shard != shard.index; });
  summary.others = plan.works() - works.size();
  std::ranges::stable_sort(works, {},
                           [&](const PlannedWork& w) { return plan.scene_of(plan.work_of(w.first_point)); });
  const auto start = std::chrono::steady_clock::now();
  StageProgress progress(session.observer(), works.size());
  std::string scene;
  for (const PlannedWork& work : works) {
    const PlannedPoint point = plan[work.first_point];
    const std::string name = point_name(*point.technique, point.gpu);
    if (scene != point.scene->load_text()) session.release_scenes();
    scene = point.scene->load_text();
    try {
      if (point.plan->reference_samples > 0)
        session.reference(*point.scene, point.plan->reference_samples, [](double, const std::string&) {});
      const EmulatedFrame frame = session.traces().frame(
          *point.scene, *point.technique, point.gpu, needs_of(*point.plan),
          [&](double done, const std::string& pass) { progress.update(done, name + ": " + pass); });
      ++(frame.from_cache ? summary.kept : summary.emulated);
      if (!frame.from_cache) summary.expected_s += work.expected_s;
    } catch (const InputError& error) {
      ++summary.failed;
      for (Diagnostic note : error.diagnostics()) {
        note.severity = Severity::warning;
        note.notes.push_back(name);
        session.observer().report(note);
      }
    }
    progress.next(name);
  }
  summary.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

Table work_table(const std::vector<PlannedWork>& works) {
  Table table{{{"work", "#", true},
               {"scene", "scene"},
               {"camera", "camera"},
               {"resolution", "resolution"},
               {"technique", "technique"},
               {"gpu", "GPU"},
               {"points", "points", true},
               {"expected_s", "expected s", true},
               {"expected_load_s", "load s", true},
               {"shard", "shard", true},
               {"kept", "kept"}},
              {}};
  for (std::size_t i = 0; i < works.size(); ++i) {
    const PlannedWork& work = works[i];
    table.rows.push_back(
        {std::uint64_t{i + 1}, work.scene, work.camera,
         std::to_string(work.resolution.width_px) + "x" + std::to_string(work.resolution.height_px),
         work.technique, work.gpu, std::uint64_t{work.points}, Real{work.expected_s, 2},
         Real{work.expected_load_s, 2}, std::uint64_t{work.shard + 1}, work.kept ? "yes" : "no"});
  }
  return table;
}

nlohmann::ordered_json to_json(const SweepPlan& plan, const std::vector<PlannedWork>& works) {
  nlohmann::ordered_json json = {{"schema_version", kResultSchemaVersion},
                                 {"works", to_json(work_table(works))}};
  json["points"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const PlannedPoint point = plan[i];
    nlohmann::ordered_json settings = nlohmann::ordered_json::object();
    for (const Assignment& set : point.settings) settings[set.path] = set.value;
    json["points"].push_back({{"number", point.number},
                              {"point_id", point.id},
                              {"work", plan.work_of(i) + 1},
                              {"technique", algos::technique_text(*point.technique)},
                              {"gpu", point.gpu.id},
                              {"settings", settings}});
  }
  return json;
}

}  // namespace hwsim::lab
