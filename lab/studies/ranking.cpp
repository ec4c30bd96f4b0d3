#include "lab/studies/ranking.h"

#include <algorithm>
#include <cmath>

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

/// 90 % interval of what `after` takes beyond `before`. Two errors add up: the one that both frames have in
/// common, which acts on the difference, and that of their ratio, which acts on the frame.
std::optional<std::array<double, 2>> extra_interval(const Result& before, const Result& after,
                                                    const cost_models::Calibration* calibration) {
  const double extra_ms = after.frame.time_ms - before.frame.time_ms;
  if (!after.frame.interval_ms) return std::nullopt;
  if (after.technique == before.technique) return std::array{0.0, 0.0};
  const auto change = calibration ? time_change_interval(before, after, *calibration) : std::nullopt;
  if (!change) return std::nullopt;
  const double common = std::log((*after.frame.interval_ms)[1] / after.frame.time_ms) * extra_ms;
  const double own = 0.5 * std::log((1.0 + (*change)[1]) / (1.0 + (*change)[0])) * after.frame.time_ms;
  const double half_ms = std::hypot(common, own);
  return std::array{extra_ms - half_ms, extra_ms + half_ms};
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
    if (info.kind() != algos::TechniqueKind::modifier && !info.linear_input) names.emplace_back(info.id);
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
  calibration_ = run.plan.calibration;
  if (run.plan.images) shown_.push_back(shown_image("reference", run.reference->image, nullptr));
}

void RankingSink::point(const PointResult& point, const RunContext& run) {
  Result result = make_result(point, run.plan, run.scene.name);
  result.passes.clear();
  const FrameResult& frame = results_.emplace_back(std::move(result)).frame;
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
                    .interval_ms = frame.interval_ms,
                    .aa_interval_ms = std::nullopt});
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
  results_.emplace_back();
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
    technique.aa_interval_ms = costs.aa_interval_ms =
        extra_interval(results_.front(), results_[i], calibration_.get());
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
