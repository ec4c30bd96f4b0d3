#include "lab/studies/sweep_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "hwsim/base/content_hash.h"
#include "lab/base/build_info.h"
#include "lab/base/messages.h"
#include "lab/request/request_words.h"
#include "lab/request/run_file.h"

namespace hwsim::lab {
namespace {

constexpr std::size_t kMaxProblems = 20;
constexpr std::size_t kMaxFailedPoints = 200;  // that may all have the same problem
constexpr std::size_t kMaxGroups = 256;        // a plan and a few texts each

bool is_of_gpu(const Assignment& set) { return set.path.starts_with("gpu."); }

/// Whether the emulator may see another GPU.
bool changes_work(const Assignment& set) {
  return set.path.starts_with("gpu.features.") || set.path.starts_with("gpu.functional.");
}

std::string work_key(const std::vector<Assignment>& settings) {
  std::string key;
  for (const Assignment& set : settings)
    if (!is_of_gpu(set)) key += set.path + "=" + set.value + ";";
  return key;
}

std::string named(std::size_t number, const std::vector<Assignment>& settings) {
  std::string text = fmt::format("point {}:", number);
  for (const Assignment& set : settings) text += " " + set.path + "=" + set.value;
  return text;
}

/// A thousand points may have the same mistake.
class Problems {
 public:
  void add(const InputError& error, std::size_t number, const std::vector<Assignment>& settings) {
    ++failed_;
    for (Diagnostic problem : error.diagnostics()) {
      if (!known_.insert(problem.code + problem.message + problem.place.line_text).second) continue;
      if (settings.size() > 1) problem.notes.push_back(named(number, settings));
      found_.push_back(std::move(problem));
    }
  }
  bool enough() const { return found_.size() >= kMaxProblems || failed_ >= kMaxFailedPoints; }
  void report() {
    if (!found_.empty()) throw InputError(std::move(found_));
  }

 private:
  std::vector<Diagnostic> found_;
  std::set<std::string> known_;
  std::size_t failed_ = 0;
};

std::string point_id(const std::string& work, const GpuConfig& gpu, const RunPlan& plan) {
  std::string text = fmt::format("model {}|{}|{}|{} {}", model_version(), work, content_hash(gpu),
                                 engine_name(plan.engine), plan.timing.detailed_sample_ratio);
  if (plan.reference_samples > 0)  // the error of the image is a result, too
    text += fmt::format("|reference {} {}", plan.reference_samples, plan.view.reference_shadows);
  ContentHash hash;
  hash.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return hash.hex().substr(0, 16);
}

std::vector<Assignment> joined(std::vector<Assignment> sets, const std::vector<Assignment>& more) {
  sets.insert(sets.end(), more.begin(), more.end());
  return sets;
}

}  // namespace

SweepPlan::SweepPlan(Request request, PointSettings settings, Session& session)
    : request_(std::move(request)), settings_(std::move(settings)), session_(&session) {
  const std::vector<Assignment> first = settings_[0];
  gpus_ = std::ranges::find(first, "gpu", &Assignment::path) == first.end() ? request_.gpus.size() : 1;
  Problems problems;
  work_.reserve(settings_.size() * techniques() * gpus());
  for (std::size_t i = 0; i < settings_.size() && !problems.enough(); ++i) {
    const std::vector<Assignment> point = settings_[i];
    try {
      check(point);
    } catch (const InputError& error) {
      problems.add(error, i * techniques() * gpus() + 1, point);
    }
  }
  problems.report();
}

/// Everything that can be wrong is, by now.
void SweepPlan::check(const std::vector<Assignment>& settings) {
  const Group& group = group_of(settings);
  std::vector<GpuConfig> configs;
  for (std::size_t g = 0; g < gpus(); ++g) configs.push_back(gpu_of(group, g, settings));
  for (std::size_t t = 0; t < techniques(); ++t)
    for (std::size_t g = 0; g < gpus(); ++g) {
      const std::string work = work_of(group, t, g, configs[g], settings);
      const auto [known, is_new] = works_.emplace(work, static_cast<std::uint32_t>(works_.size()));
      work_.push_back(known->second);
      if (!is_new) continue;
      const auto scene =
          scenes_.emplace(group.scene->load_text(), static_cast<std::uint32_t>(scenes_.size())).first;
      scene_of_work_.push_back(scene->second);
    }
}

const SweepPlan::Group& SweepPlan::group_of(const std::vector<Assignment>& settings) const {
  const std::string key = work_key(settings);
  if (const auto found = groups_.find(key); found != groups_.end()) return found->second;
  Group group = make_group(settings);
  if (groups_.size() >= kMaxGroups) groups_.clear();
  return groups_.emplace(key, std::move(group)).first->second;
}

SweepPlan::Group SweepPlan::make_group(const std::vector<Assignment>& settings) const {
  std::vector<Diagnostic> problems;
  Request request = request_;
  apply(request, settings, problems);
  auto plan = std::make_shared<RunPlan>(make_plan(request, session_->files(), problems));
  plan->images = false;
  if (!problems.empty()) throw InputError(problems);
  Group group{plan, &session_->scene(plan->view), request.gpus, {}, {}, {}};
  if (group.gpus.size() != gpus_)
    fail_usage("U019", "some points vary `gpu`, and others do not", "", "a list of GPUs for all points");
  for (const std::string& overlay : request.overlays)
    group.overlay_files.push_back(session_->files().folder().overlay_file(overlay));
  for (const algos::TechniqueChoice& technique : plan->techniques) {
    group.run_files.push_back(run_file_text(*plan, technique, "gpu.toml"));
    for (const GpuConfig& gpu : plan->gpus)
      group.works.push_back(TraceStore::work_text(*group.scene, technique, gpu, {plan->skip, false}));
  }
  return group;
}

GpuConfig SweepPlan::gpu_of(const Group& group, std::size_t gpu,
                            const std::vector<Assignment>& settings) const {
  return session_->files().gpu(group.gpus[gpu], group.overlay_files,
                               joined(request_.sets, without_words(settings)), group.plan->calibrated);
}

std::string SweepPlan::work_of(const Group& group, std::size_t technique, std::size_t gpu,
                               const GpuConfig& config, const std::vector<Assignment>& settings) const {
  if (std::ranges::none_of(settings, changes_work)) return group.works[technique * gpus() + gpu];
  return TraceStore::work_text(*group.scene, group.plan->techniques[technique], config,
                               {group.plan->skip, false});
}

PlannedPoint SweepPlan::operator[](std::size_t index) const {
  const std::size_t gpu = index % gpus(), technique = index / gpus() % techniques();
  std::vector<Assignment> settings = settings_[index / gpus() / techniques()];
  const Group& group = group_of(settings);
  GpuConfig config = gpu_of(group, gpu, settings);
  std::string id = point_id(work_of(group, technique, gpu, config, settings), config, *group.plan);
  return {.id = std::move(id),
          .number = static_cast<std::int64_t>(index) + 1,
          .settings = std::move(settings),
          .plan = group.plan,
          .technique = &group.plan->techniques[technique],
          .gpu = std::move(config),
          .scene = group.scene};
}

SweepPoint SweepPlan::row(std::size_t index) const {
  PlannedPoint planned = (*this)[index];
  const Group& group = group_of(planned.settings);
  return {.id = std::move(planned.id),
          .number = planned.number,
          .scene = planned.scene->summary().name,
          .technique = technique_text(*planned.technique),
          .gpu = planned.gpu.id,
          .engine = std::string(engine_name(planned.plan->engine)),
          .resolution = planned.scene->plan().resolution,
          .settings = std::move(planned.settings),
          .run_file = group.run_files[index / gpus() % techniques()],
          .gpu_file = show(planned.gpu, false)};
}

std::vector<std::uint32_t> SweepPlan::order() const {
  std::vector<std::uint32_t> order(size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::ranges::stable_sort(order, {},
                           [this](std::uint32_t i) { return std::pair(scene_of_work_[work_[i]], work_[i]); });
  return order;
}

RowSource planned_rows(const SweepPlan& plan) {
  if (plan.size() == 0) return {};
  RowSource rows{{{"number", "#", true}, {"point_id", "point"}, {"technique", "technique"}, {"gpu", "GPU"}},
                 {}};
  for (const Assignment& set : plan[0].settings)
    if (set.path != "gpu") rows.columns.push_back({set.path, set.path, true});
  rows.each = [&plan](const TakeRow& take) {
    for (std::size_t i = 0; i < plan.size(); ++i) {
      const PlannedPoint p = plan[i];
      std::vector<TableCell> row{static_cast<std::uint64_t>(p.number), p.id, technique_text(*p.technique),
                                 p.gpu.id};
      for (const Assignment& set : p.settings)
        if (set.path != "gpu") row.emplace_back(set.value);
      take(row);
    }
  };
  return rows;
}

}  // namespace hwsim::lab
