#include "lab/studies/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <utility>

#include "lab/base/build_info.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"

namespace hwsim::lab {
namespace {

void warn_of_failure(const PlannedPoint& planned, const InputError& error, Observer& observer) {
  for (Diagnostic note : error.diagnostics()) {
    note.severity = Severity::warning;
    note.notes.push_back(fmt::format("point {}: {} on {}", planned.number, technique_text(*planned.technique),
                                     planned.gpu.id));
    observer.report(note);
  }
}

/// Results on their way to the database, written together: a transaction takes as long as a point. The
/// database is locked only while they are written.
class ResultBatch {
 public:
  explicit ResultBatch(SweepStore& store) : store_(store) {}
  ~ResultBatch() {
    try {
      write();
    } catch (const InputError&) {  // the database failed before, and that was told
    }
  }
  ResultBatch(const ResultBatch&) = delete;
  ResultBatch& operator=(const ResultBatch&) = delete;

  void add(const std::string& id, PointResult result) {
    if (results_.empty()) oldest_ = Clock::now();
    result.technique = nullptr;  // those of a plan that is gone by then
    result.gpu = nullptr;
    results_.push_back({id, std::move(result)});
    if (Clock::now() - oldest_ >= kLongest) write();
  }
  void write() {
    if (!results_.empty()) store_.finish(std::exchange(results_, {}));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kLongest{200};
  SweepStore& store_;
  std::vector<FinishedPoint> results_;
  Clock::time_point oldest_;
};

/// How many points are claimed at a time: as many as take about a fifth of a second, so that the transaction
/// costs little and other processes find work.
class BlockSize {
 public:
  std::size_t points() const { return points_; }
  template <class Work>
  void measure(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    points_ =
        took.count() < kShortest_s ? std::min(2 * points_, kMost) : std::max(points_ / 2, std::size_t{1});
  }

 private:
  static constexpr double kShortest_s = 0.2;
  static constexpr std::size_t kMost = 256;
  std::size_t points_ = 1;
};

class SweepRunner {
 public:
  SweepRunner(SweepStore& store, Session& session) : store_(store), session_(session), batch_(store) {}

  /// Runs the points that no other process has done or runs now.
  void run(std::span<const PlannedPoint> block, StageProgress& progress) {
    std::vector<std::string> ids;
    for (const PlannedPoint& planned : block) ids.push_back(planned.id);
    const std::vector<bool> claimed = store_.claim(ids);
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (claimed[i]) run(block[i]);
      progress.next(point_name(*block[i].technique, block[i].gpu));
    }
  }
  void end() { batch_.write(); }

 private:
  void run(const PlannedPoint& planned) {
    if (!is_quick(planned)) batch_.write();  // or a kill in its minutes would take results with it
    if (scene_ && scene_->load_text() != planned.scene->load_text()) session_.release_scenes();
    scene_ = planned.scene;
    try {
      Simulator simulator(*planned.plan, *planned.scene, session_.traces());
      if (planned.plan->reference_samples > 0)
        simulator.compare_with(
            session_.reference(*planned.scene, planned.plan->reference_samples, [](double, const auto&) {}),
            session_.image_errors());
      batch_.add(planned.id, simulator.run(*planned.technique, planned.gpu, nullptr));
    } catch (const InputError& error) {
      if (error.diagnostics().front().code == "U021") throw;  // the database itself
      store_.fail(planned.id, error.what());
      warn_of_failure(planned, error, session_.observer());
    }
  }
  /// Whether the point is only timed.
  bool is_quick(const PlannedPoint& planned) const {
    return planned.plan->engine != Engine::detailed &&
           session_.traces().holds(*planned.scene, *planned.technique, planned.gpu,
                                   {planned.plan->skip, planned.plan->reference_samples > 0});
  }

  SweepStore& store_;
  Session& session_;
  ResultBatch batch_;
  const SceneView* scene_ = nullptr;  ///< the last point's
};

/// Frames that come next on one scene share passes.
class FramesAhead {
 public:
  FramesAhead(const SweepPlan& plan, Session& session) : plan_(plan), session_(session) {}
  ~FramesAhead() { session_.traces().expect_nothing(); }
  FramesAhead(const FramesAhead&) = delete;
  FramesAhead& operator=(const FramesAhead&) = delete;

  /// Before the first of `points` runs, and then the others.
  void reach(std::span<const std::size_t> points) {
    if (known_.contains(plan_.work(points.front()))) return;
    known_.clear();
    std::vector<PlannedPoint> planned;  // one of each emulation
    for (const std::size_t i : points) {
      if (known_.contains(plan_.work(i))) continue;
      if (planned.size() == kMostFrames) break;
      PlannedPoint point = plan_[i];
      if (!planned.empty() && point.scene != planned.front().scene) break;
      known_.insert(plan_.work(i));
      planned.push_back(std::move(point));
    }
    std::vector<TraceStore::WantedFrame> frames;
    for (const PlannedPoint& point : planned) frames.push_back({point.technique, &point.gpu});
    const RunPlan& first = *planned.front().plan;
    session_.traces().expect(*planned.front().scene, frames, {first.skip, first.reference_samples > 0});
  }

 private:
  static constexpr std::size_t kMostFrames = 32;
  const SweepPlan& plan_;
  Session& session_;
  std::set<std::uint32_t> known_;
};

void run_points(const SweepPlan& plan, const SweepJob& job, SweepStore& store, Session& session) {
  store.remember("command_line", job.command_line);
  store.remember("version", std::string(build_info().version));
  store.add(plan.size(), [&plan](std::size_t i) { return plan.row(i); });
  std::vector<std::size_t> ours;
  for (const std::size_t i : plan.order())
    if (i % job.shard.count == job.shard.index) ours.push_back(i);
  StageProgress progress(session.observer(), ours.size());
  SweepRunner runner(store, session);
  BlockSize size;
  FramesAhead ahead(plan, session);
  for (std::size_t at = 0; at < ours.size();) {
    ahead.reach(std::span(ours).subspan(at));
    std::vector<PlannedPoint> block;
    for (; block.size() < size.points() && at < ours.size(); ++at) block.push_back(plan[ours[at]]);
    size.measure([&] { runner.run(block, progress); });
  }
  runner.end();
}

SweepAccess access_of(const SweepJob& job, bool has_points) {
  if (!has_points) return job.merge.empty() ? SweepAccess::look : SweepAccess::go_on;
  if (job.resume) return SweepAccess::go_on;
  if (job.force) return SweepAccess::replace;
  return job.merge.empty() ? SweepAccess::create : SweepAccess::go_on;
}

/// Files of their own names, and those that patterns stand for.
std::vector<std::string> merged_files(const SweepJob& job) {
  std::vector<std::string> files;
  for (const std::string& pattern : job.merge) {
    const std::vector<std::string> found = matching_files(pattern);
    if (found.empty())
      fail("U021", "there is no database `" + pattern + "`", "",
           "the name of a database that `hwsim sweep` wrote");
    std::error_code error;
    for (const std::string& file : found)
      if (file == pattern || !std::filesystem::equivalent(file, job.database, error)) files.push_back(file);
  }
  return files;
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const std::vector<std::string> parts = split(text, '/');
  const auto whole = [](const std::string& part) {
    return !part.empty() && part.size() < 7 && part.find_first_not_of("0123456789") == std::string::npos;
  };
  if (parts.size() == 2 && whole(parts[0]) && whole(parts[1])) {
    const Shard shard{std::stoul(parts[0]) - 1, std::stoul(parts[1])};
    if (shard.index < shard.count) return shard;
  }
  fail_usage("U003", "--shard is `" + text + "`, must be I/N with I from 1 to N", "--shard 1/4");
}

nlohmann::ordered_json to_json(const SweepSummary& summary) {
  return {{"schema_version", kResultSchemaVersion},
          {"database", summary.database},
          {"done", summary.done},
          {"failed", summary.failed},
          {"left", summary.left},
          {"points", to_json(collected(summary.points))}};
}

SweepSummary sweep_summary_from_json(const nlohmann::ordered_json& json) {
  return {.database = json.at("database").get<std::string>(),
          .done = json.at("done").get<std::size_t>(),
          .failed = json.at("failed").get<std::size_t>(),
          .left = json.at("left").get<std::size_t>(),
          .points = rows_of(table_from_json(json.at("points")))};
}

SweepSummary run_sweep(const SweepPlan& plan, const SweepJob& job, Session& session) {
  SweepSummary summary{.database = job.database};
  const std::vector<std::string> others = merged_files(job);
  for (const std::string& other : others) open_sweep(other, SweepAccess::look);  // before one is made
  {
    SweepStore store(job.database, access_of(job, plan.size() > 0));
    if (job.alone) store.take_over();
    for (const std::string& other : others)
      session.observer().say(fmt::format("merged {} points of {}", store.merge(other), other));
    if (plan.size() > 0) run_points(plan, job, store, session);
    const std::map<std::string, std::size_t> states = store.states();
    for (const auto& [state, count] : states)
      (state == "done" ? summary.done : state == "failed" ? summary.failed : summary.left) += count;
  }
  summary.points = sweep_rows(job.database);
  return summary;
}

}  // namespace hwsim::lab
