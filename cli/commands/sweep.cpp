#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>

#include "cli/arguments/argument_values.h"
#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/progress.h"
#include "hwsim/base/content_hash.h"
#include "lab/base/build_info.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/request/run_file.h"
#include "lab/results/run_directory.h"
#include "lab/studies/axes.h"
#include "lab/studies/sweep_store.h"

namespace hwsim::cli {
namespace {

constexpr size_t kMaxProblems = 20;  // a thousand points may have the same mistake

struct Shard {
  size_t index = 0, count = 1;
};

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

/// A point with all that it takes to run it.
struct PlannedPoint {
  SweepPoint point;
  const RunPlan* plan = nullptr;
  const algos::TechniqueChoice* technique = nullptr;
  const GpuConfig* gpu = nullptr;
  SceneView* scene = nullptr;
  std::string work;  ///< equal where one emulation serves both
};

class Sweep {
 public:
  Sweep(const SweepOptions& options, Context& context) : options_(options), context_(context) {}
  ExitStatus run();

 private:
  void plan();
  void plan_points(const RunPlan& plan, const std::vector<Assignment>& settings);
  SceneView& scene_of(const View& view);
  Table dry_table() const;
  void simulate(SweepStore& store);
  void run_point(SweepStore& store, TraceStore& traces, const PlannedPoint& planned);
  std::vector<size_t> order() const;

  const SweepOptions& options_;
  Context& context_;
  ConfigFiles files_;
  std::vector<std::unique_ptr<RunPlan>> plans_;
  std::vector<std::unique_ptr<SceneView>> scenes_;
  std::vector<PlannedPoint> points_;
};

SceneView& Sweep::scene_of(const View& view) {
  for (const auto& scene : scenes_)
    if (scene->plan() == view) return *scene;
  scenes_.push_back(std::make_unique<SceneView>(view, context_.log));
  return *scenes_.back();
}

std::string point_id(const PlannedPoint& planned) {
  const std::string text =
      fmt::format("model {}|{}|{}|{} {}", kModelVersion, planned.work, content_hash(*planned.gpu),
                  engine_name(planned.plan->engine), planned.plan->timing.detailed_sample_ratio);
  ContentHash hash;
  hash.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return hash.hex().substr(0, 16);
}

void Sweep::plan_points(const RunPlan& plan, const std::vector<Assignment>& settings) {
  for (const algos::TechniqueChoice& technique : plan.techniques)
    for (const GpuConfig& gpu : plan.gpus) {
      PlannedPoint planned{{}, &plan, &technique, &gpu, &scene_of(plan.view), {}};
      planned.work = TraceStore::work_text(*planned.scene, technique, gpu, {plan.skip, false});
      planned.point = {.id = point_id(planned),
                       .number = static_cast<std::int64_t>(points_.size()) + 1,
                       .scene = planned.scene->summary().name,
                       .technique = technique_text(technique),
                       .gpu = gpu.id,
                       .engine = std::string(engine_name(plan.engine)),
                       .resolution = plan.view.resolution,
                       .settings = settings,
                       .run_file = run_file_text(plan, technique, "gpu.toml"),
                       .gpu_file = show(gpu, false)};
      points_.push_back(std::move(planned));
    }
}

/// All points are decided, and all mistakes reported, before the first one runs.
void Sweep::plan() {
  const std::vector<Axis> axes = parse_axes(options_.vary);
  const std::vector<std::vector<Assignment>> settings =
      options_.sample ? latin_hypercube(axes, parse_sample(*options_.sample), options_.seed)
                      : combine(axes, options_.zip ? Combine::zip : Combine::grid);
  std::vector<Diagnostic> problems;
  for (const std::vector<Assignment>& point : settings) try {
      RunOptions run = options_;
      run.no_image = true;
      for (const Assignment& set : point) run.view.sets.push_back(set.path + "=" + set.value);
      plans_.push_back(std::make_unique<RunPlan>(plan_of(run, files_)));
      plan_points(*plans_.back(), point);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
      if (problems.size() >= kMaxProblems) break;
    }
  if (!problems.empty()) throw InputError(problems);
}

Table Sweep::dry_table() const {
  Table table{{{"number", "#", true}, {"point_id", "point"}, {"technique", "technique"}, {"gpu", "GPU"}}, {}};
  for (const Assignment& set : points_.front().point.settings)
    table.columns.push_back({set.path, set.path, true});
  for (const PlannedPoint& planned : points_) {
    const SweepPoint& p = planned.point;
    auto& row = table.rows.emplace_back(
        std::vector<Cell>{static_cast<std::uint64_t>(p.number), p.id, p.technique, p.gpu});
    for (const Assignment& set : p.settings) row.push_back(set.value);
  }
  return table;
}

/// Points that share an emulation follow each other.
std::vector<size_t> Sweep::order() const {
  std::vector<size_t> order(points_.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::map<std::string, size_t> first;
  for (size_t i = 0; i < points_.size(); ++i) first.emplace(points_[i].work, i);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return first.at(points_[a].work) < first.at(points_[b].work); });
  return order;
}

void Sweep::run_point(SweepStore& store, TraceStore& traces, const PlannedPoint& planned) {
  store.start(planned.point.id);
  try {
    Simulator simulator(*planned.plan, *planned.scene, nullptr, traces);
    store.finish(planned.point.id, simulator.run(*planned.technique, *planned.gpu, nullptr));
  } catch (const InputError& error) {
    if (error.diagnostics().front().code == "U021") throw;  // the database itself
    store.fail(planned.point.id, error.what());
    for (Diagnostic note : error.diagnostics()) {
      note.severity = Severity::warning;
      note.notes.push_back(fmt::format("point {}: {} on {}", planned.point.number, planned.point.technique,
                                       planned.point.gpu));
      context_.log.report(note);
    }
  }
}

void Sweep::simulate(SweepStore& store) {
  const Shard shard = options_.shard ? parse_shard(*options_.shard) : Shard{};
  TraceStore traces({.jobs = options_.common.jobs, .disk = !options_.no_cache}, context_.log);
  Progress progress(options_.common, context_.terminal);
  size_t done = 0;
  for (const size_t i : order()) {
    const PlannedPoint& planned = points_[i];
    const bool mine = i % shard.count == shard.index;
    if (mine && store.state_of(planned.point.id) != "done") run_point(store, traces, planned);
    progress.update(static_cast<double>(++done) / static_cast<double>(points_.size()),
                    planned.point.technique + " on " + planned.point.gpu);
  }
}

ExitStatus Sweep::run() {
  const bool has_scene = !options_.view.scene.empty();
  if (options_.shard) parse_shard(*options_.shard);
  if (!has_scene && options_.merge.empty() && !std::filesystem::exists(options_.database))
    fail_usage("U002", "no scene, and no database `" + options_.database + "` to print", "",
               "`hwsim sweep --help` shows examples");
  if (has_scene) {
    plan();
    context_.log.say(fmt::format("plan: {}, {} points, database {}", options_.view.scene, points_.size(),
                                 options_.database));
  }
  if (options_.dry_run) {
    print({.table = has_scene ? dry_table() : Table{}}, options_.common);
    return ExitStatus::done;
  }
  InterruptGuard guard("interrupted: finished points are kept, --resume goes on with the others");
  if (options_.out.force && has_scene && !options_.resume) {
    SweepStore(options_.database, true);  // replaces a sweep, and no other file
    for (const char* part : {"", "-wal", "-shm"}) std::filesystem::remove(options_.database + part);
  }
  SweepStore store(options_.database, options_.resume || !has_scene || !options_.merge.empty());
  for (const std::string& other : options_.merge)
    context_.log.say(fmt::format("merged {} points of {}", store.merge(other), other));
  if (has_scene) {
    std::string words;
    for (const std::string& word : context_.arguments) words += (words.empty() ? "" : " ") + word;
    store.remember("command_line", words);
    store.remember("version", std::string(build_info().version));
    store.remember("model_version", std::to_string(kModelVersion));
    std::vector<SweepPoint> points;
    for (const PlannedPoint& planned : points_) points.push_back(planned.point);
    store.add(points);
    simulate(store);
  }
  const size_t failed = store.count("failed");
  print({.table = store.points()}, options_.common);
  context_.log.say(fmt::format("{} points done, {} failed, {} left, in {}", store.count("done"), failed,
                               store.count("pending") + store.count("interrupted"), options_.database));
  return failed > 0 ? ExitStatus::some_points_failed : ExitStatus::done;
}

}  // namespace

ExitStatus sweep(const SweepOptions& options, Context& context) { return Sweep(options, context).run(); }

}  // namespace hwsim::cli
