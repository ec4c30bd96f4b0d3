#include "lab/studies/ranking.h"

#include <algorithm>

#include "lab/base/messages.h"
#include "lab/results/result.h"

namespace hwsim::lab {
namespace {

constexpr int kRegionSidePx = 48, kRegions = 4;

/// Within the budget, then without an interval that could say so, then at risk, then the others.
int grade(const RankedTechnique& technique) {
  if (technique.verdict == "ok") return 0;
  if (technique.verdict == "unknown") return 1;
  if (technique.verdict == "at risk") return 2;
  return technique.verdict == "unsupported" ? 4 : 3;
}

bool beats(const RankedTechnique& a, const RankedTechnique& b) {
  const double time = a.frame_ms - b.frame_ms;
  const double error = a.flip_mean - b.flip_mean;
  return a.runs() && time <= 0.0 && error <= 0.0 && (time < 0.0 || error < 0.0);
}

}  // namespace

void mark_pareto(std::vector<RankedTechnique>& techniques) {
  for (RankedTechnique& technique : techniques)
    technique.pareto = technique.runs() &&
                       std::ranges::none_of(
                           techniques, [&](const RankedTechnique& other) { return beats(other, technique); });
}

std::vector<std::string> rankable_techniques() {
  std::vector<std::string> names;
  for (const algos::TechniqueInfo& info : algos::techniques())
    if (info.kind() != algos::TechniqueKind::modifier) names.emplace_back(info.id);
  return names;
}

RunPlan ranking_plan(RunPlan plan) {
  if (plan.gpus.size() != 1)
    fail_usage("U004", "techniques are ranked on one GPU at a time", "", "one --gpu");
  if (plan.reference_samples == 0) plan.reference_samples = kDefaultReferenceSamples;
  std::vector<algos::TechniqueChoice>& techniques = plan.techniques;
  const auto found = std::ranges::find_if(
      techniques, [](const algos::TechniqueChoice& t) { return algos::technique_text(t) == "none"; });
  if (found == techniques.end())
    techniques.insert(techniques.begin(), algos::parse_technique("none"));
  else
    std::rotate(techniques.begin(), found, found + 1);
  return plan;
}

RankingSink::RankingSink(const std::string& budget) {
  if (!budget.empty()) limits_ = parse_budget(budget);
  ranking_.budget = budget;
}

void RankingSink::begin(const RunContext& run) {
  ranking_.scene = run.scene.name;
  ranking_.gpu = run.plan.gpus.front().id;
  ranking_.resolution = run.plan.view.resolution;
  ranking_.reference_samples = run.plan.reference_samples;
  if (run.plan.images) shown_.push_back(shown_image("reference", run.reference->image, nullptr));
}

void RankingSink::point(const PointResult& point, const RunContext& run) {
  const FrameResult frame = make_result(point, run.plan, run.scene.name).frame;
  RankedTechnique& technique = ranking_.techniques.emplace_back();
  technique.technique = algos::technique_text(*point.technique);
  technique.frame_ms = frame.time_ms;
  technique.interval_ms = frame.interval_ms;
  technique.support = frame.support;
  technique.dram_mb = frame.dram_mb;
  technique.shaded_samples = frame.shaded_samples;
  technique.flip_mean = point.image_error->flip_mean;
  technique.psnr_db = point.image_error->psnr_db;
  costs_.push_back({.frame_ms = frame.time_ms,
                    .memory_mib = frame.memory_mib,
                    .dram_mb = frame.dram_mb,
                    .interval_ms = frame.interval_ms});
  if (run.plan.images)
    shown_.push_back(shown_image(technique.technique, point.emulation->color, &point.flip_map));
}

void RankingSink::failed(const algos::TechniqueChoice& technique, const GpuConfig&, const InputError& error) {
  if (ranking_.techniques.empty()) throw;  // not even a plain frame can be drawn
  RankedTechnique& unsupported = ranking_.techniques.emplace_back();
  unsupported.technique = algos::technique_text(technique);
  unsupported.verdict = "unsupported";
  unsupported.reason = error.what();
  costs_.emplace_back();
}

Ranking RankingSink::ranking() {
  Ranking ranking = ranking_;
  const Costs none = costs_.front();
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    RankedTechnique& technique = ranking.techniques[i];
    if (!technique.runs()) continue;
    Costs costs = costs_[i];
    technique.aa_ms = costs.aa_ms = costs.frame_ms - none.frame_ms;
    technique.extra_mib = costs.extra_mib = costs.memory_mib - none.memory_mib;
    technique.verdict = verdict(costs, limits_);
  }
  mark_pareto(ranking.techniques);
  std::ranges::stable_sort(ranking.techniques, {}, [](const RankedTechnique& technique) {
    return std::pair(grade(technique), technique.flip_mean);
  });
  if (!shown_.empty()) ranking.regions = worst_regions(shown_, kRegionSidePx, kRegions);
  return ranking;
}

pipeline::Image RankingSink::sheet() const {
  return contact_sheet(shown_, worst_regions(shown_, kRegionSidePx, kRegions));
}

}  // namespace hwsim::lab
