#include "lab/studies/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "hwsim/base/content_hash.h"
#include "lab/base/build_info.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/request/run_file.h"

namespace hwsim::lab {
namespace {

constexpr std::size_t kMaxProblems = 20;

std::string point_id(const PlannedPoint& planned) {
  const std::string text =
      fmt::format("model {}|{}|{}|{} {}", kModelVersion, planned.work, content_hash(*planned.gpu),
                  engine_name(planned.plan->engine), planned.plan->timing.detailed_sample_ratio);
  ContentHash hash;
  hash.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return hash.hex().substr(0, 16);
}

void plan_points(const std::shared_ptr<const RunPlan>& plan, const std::vector<Assignment>& settings,
                 Session& session, std::vector<PlannedPoint>& points) {
  for (const algos::TechniqueChoice& technique : plan->techniques)
    for (const GpuConfig& gpu : plan->gpus) {
      PlannedPoint planned{{}, plan, &technique, &gpu, &session.scene(plan->view), {}};
      planned.work = TraceStore::work_text(*planned.scene, technique, gpu, {plan->skip, false});
      planned.point = {.id = point_id(planned),
                       .number = static_cast<std::int64_t>(points.size()) + 1,
                       .scene = planned.scene->summary().name,
                       .technique = technique_text(technique),
                       .gpu = gpu.id,
                       .engine = std::string(engine_name(plan->engine)),
                       .resolution = plan->view.resolution,
                       .settings = settings,
                       .run_file = run_file_text(*plan, technique, "gpu.toml"),
                       .gpu_file = show(gpu, false)};
      points.push_back(std::move(planned));
    }
}

std::shared_ptr<const RunPlan> plan_with(const Request& base, const std::vector<Assignment>& settings,
                                         ConfigFiles& files) {
  std::vector<Diagnostic> problems;
  Request request = base;
  apply(request, settings, problems);
  auto plan = std::make_shared<RunPlan>(make_plan(request, files, problems));
  plan->images = false;
  if (!problems.empty()) throw InputError(problems);
  return plan;
}

/// Points that share an emulation follow each other.
std::vector<std::size_t> order_of(const std::vector<PlannedPoint>& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::map<std::string, std::size_t> first;
  for (std::size_t i = 0; i < points.size(); ++i) first.emplace(points[i].work, i);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return first.at(points[i].work); });
  return order;
}

void warn_of_failure(const PlannedPoint& planned, const InputError& error, Observer& observer) {
  for (Diagnostic note : error.diagnostics()) {
    note.severity = Severity::warning;
    note.notes.push_back(
        fmt::format("point {}: {} on {}", planned.point.number, planned.point.technique, planned.point.gpu));
    observer.report(note);
  }
}

void run_point(const PlannedPoint& planned, SweepStore& store, Session& session) {
  store.start(planned.point.id);
  try {
    Simulator simulator(*planned.plan, *planned.scene, nullptr, session.traces());
    store.finish(planned.point.id, simulator.run(*planned.technique, *planned.gpu, nullptr));
  } catch (const InputError& error) {
    if (error.diagnostics().front().code == "U021") throw;  // the database itself
    store.fail(planned.point.id, error.what());
    warn_of_failure(planned, error, session.observer());
  }
}

void run_points(const std::vector<PlannedPoint>& points, const SweepJob& job, SweepStore& store,
                Session& session) {
  std::vector<SweepPoint> rows;
  for (const PlannedPoint& planned : points) rows.push_back(planned.point);
  store.remember("command_line", job.command_line);
  store.remember("version", std::string(build_info().version));
  store.remember("model_version", std::to_string(kModelVersion));
  store.add(rows);
  StageProgress progress(session.observer(), points.size());
  for (const std::size_t i : order_of(points)) {
    const bool mine = i % job.shard.count == job.shard.index;
    if (mine && store.state_of(points[i].point.id) != "done") run_point(points[i], store, session);
    progress.next(points[i].point.technique + " on " + points[i].point.gpu);
  }
}

SweepAccess access_of(const SweepJob& job, bool has_points) {
  if (!has_points) return job.merge.empty() ? SweepAccess::look : SweepAccess::go_on;
  if (job.resume) return SweepAccess::go_on;
  if (job.force) return SweepAccess::replace;
  return job.merge.empty() ? SweepAccess::create : SweepAccess::go_on;
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

std::vector<PlannedPoint> plan_sweep(const Request& request,
                                     const std::vector<std::vector<Assignment>>& settings, Session& session) {
  std::vector<PlannedPoint> points;
  std::vector<Diagnostic> problems;
  for (const std::vector<Assignment>& point : settings) try {
      plan_points(plan_with(request, point, session.files()), point, session, points);
    } catch (const InputError& error) {
      append(problems, error);
      if (problems.size() >= kMaxProblems) break;
    }
  if (!problems.empty()) throw InputError(problems);
  return points;
}

Table planned_table(const std::vector<PlannedPoint>& points) {
  Table table{{{"number", "#", true}, {"point_id", "point"}, {"technique", "technique"}, {"gpu", "GPU"}}, {}};
  if (points.empty()) return table;
  for (const Assignment& set : points.front().point.settings)
    table.columns.push_back({set.path, set.path, true});
  for (const PlannedPoint& planned : points) {
    const SweepPoint& p = planned.point;
    auto& row = table.rows.emplace_back(
        std::vector<Cell>{static_cast<std::uint64_t>(p.number), p.id, p.technique, p.gpu});
    for (const Assignment& set : p.settings) row.push_back(set.value);
  }
  return table;
}

nlohmann::ordered_json to_json(const SweepSummary& summary) {
  return {{"schema_version", kResultSchemaVersion},
          {"database", summary.database},
          {"done", summary.done},
          {"failed", summary.failed},
          {"left", summary.left},
          {"points", to_json(summary.points)}};
}

SweepSummary sweep_summary_from_json(const nlohmann::ordered_json& json) {
  return {.database = json.at("database").get<std::string>(),
          .done = json.at("done").get<std::size_t>(),
          .failed = json.at("failed").get<std::size_t>(),
          .left = json.at("left").get<std::size_t>(),
          .points = table_from_json(json.at("points"))};
}

SweepSummary run_sweep(const std::vector<PlannedPoint>& points, const SweepJob& job, Session& session) {
  SweepStore store(job.database, access_of(job, !points.empty()));
  for (const std::string& other : job.merge)
    session.observer().say(fmt::format("merged {} points of {}", store.merge(other), other));
  if (!points.empty()) run_points(points, job, store, session);
  return {job.database, store.count("done"), store.count("failed"),
          store.count("pending") + store.count("running") + store.count("interrupted"), store.points()};
}

}  // namespace hwsim::lab
