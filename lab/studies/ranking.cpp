#include "lab/studies/ranking.h"

#include <algorithm>
#include <cmath>

#include "lab/base/messages.h"
#include "lab/results/result.h"

namespace hwsim::lab {
namespace {

constexpr int kRegionSidePx = 48, kRegions = 4;

/// The worse, the more.
int grade(const std::string& verdict) {
  if (verdict == "ok") return 0;
  if (verdict == "unknown") return 1;
  if (verdict == "at risk") return 2;
  return verdict == "unsupported" ? 4 : 3;
}

/// Techniques of one class are ordered by their error. A GPU without intervals has "ok" for what costs
/// nothing alone, "unknown" for the others: were it a class behind, no anti-aliasing would always be the
/// first.
int order_class(const std::string& verdict) { return verdict == "unknown" ? 0 : grade(verdict); }

bool beats(const RankedTechnique& a, const RankedTechnique& b) {
  const double time = a.frame_ms - b.frame_ms;
  const double error = a.error - b.error;
  return a.runs() && time <= 0.0 && error <= 0.0 && (time < 0.0 || error < 0.0);
}

/// 90 % interval of what `after` takes beyond `before`. With a and b, what each takes in passes that the
/// other lacks, and the frames' errors c + i of equal spread, c the same in both: the variance of a - b is (a
/// - b)^2 var(c + i) + a b var(i_a - i_b), whose first factor is that of one frame and whose second that of a
/// ratio.
std::optional<std::array<double, 2>> extra_interval(const Result& before, const Result& after,
                                                    const cost_models::Calibration* calibration) {
  if (!after.frame.interval_ms) return std::nullopt;
  if (after.technique == before.technique) return std::array{0.0, 0.0};
  const auto ratio = calibration ? ratio_log_width(before, after, *calibration) : std::nullopt;
  if (!ratio) return std::nullopt;
  const double shared_ms = shared_time_ms(before, after);
  const double own_ms = after.frame.time_ms - shared_ms, others_ms = before.frame.time_ms - shared_ms;
  const double extra_ms = own_ms - others_ms;
  const double frame = std::log((*after.frame.interval_ms)[1] / after.frame.time_ms);
  if (others_ms <= 0.0) return std::array{extra_ms * std::exp(-frame), extra_ms * std::exp(frame)};
  const double half_ms = std::hypot(frame * extra_ms, *ratio * std::sqrt(own_ms * others_ms));
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

RankingSink::RankingSink(RankQuestion question) : question_(std::move(question)) {
  if (!question_.budget.empty()) limits_ = parse_budget(question_.budget);
  if (question_.edges && question_.metric == ErrorMetric::ssim)
    fail_usage("U003", "SSIM compares windows of 11x11 pixels, which have no edges of their own", "",
               "--edges with --metric flip or psnr");
}

void RankingSink::begin(const RunContext& run) {
  calibration_ = run.plan.calibration;
  for (const GpuConfig& gpu : run.plan.gpus)
    on_gpus_.push_back({{.scene = run.scene.name,
                         .gpu = gpu.id,
                         .camera = camera_name(run.scene, run.plan.view.camera),
                         .resolution = run.plan.view.resolution,
                         .budget = question_.budget,
                         .metric = std::string(metric_name(question_.metric)),
                         .edges = question_.edges,
                         .reference_samples = run.plan.reference_samples},
                        {},
                        {}});
  if (question_.edges) edge_mask_ = edge_mask(run.reference->image);
  if (run.plan.images) shown_.push_back(shown_image("reference", run.reference->image, nullptr));
}

RankingSink::OnGpu& RankingSink::of(const GpuConfig& gpu) {
  return *std::ranges::find_if(on_gpus_, [&](const OnGpu& on) { return on.ranking.gpu == gpu.id; });
}

std::optional<EdgeError> RankingSink::edges_of(const PointResult& point, const RunContext& run) {
  if (!question_.edges) return std::nullopt;
  if (last_frame_ != point.emulation.get())  // another GPU's frame is the same
    last_edges_ = edge_error(point.emulation->color, run.reference->image, *point.flip_map, edge_mask_);
  last_frame_ = point.emulation.get();
  return last_edges_;
}

void RankingSink::point(const PointResult& point, const RunContext& run) {
  OnGpu& on = of(*point.gpu);
  Result result = make_result(point, run.plan, run.scene.name);
  for (PassResult& pass : result.passes)
    pass = {.name = pass.name, .time_ms = pass.time_ms};  // all that is needed
  const FrameResult& frame = on.results.emplace_back(std::move(result)).frame;
  RankedTechnique& technique = on.ranking.techniques.emplace_back();
  technique.technique = algos::technique_text(*point.technique);
  technique.frame_ms = frame.time_ms;
  technique.interval_ms = frame.interval_ms;
  technique.support = frame.support;
  technique.dram_mb = frame.dram_mb;
  technique.shaded_samples = frame.shaded_samples;
  technique.flip_mean = point.image_error->flip_mean;
  technique.psnr_db = point.image_error->psnr_db;
  technique.ssim = point.image_error->ssim;
  technique.edges = edges_of(point, run);
  technique.error = error_by(question_.metric, technique);
  on.costs.push_back({.frame_ms = frame.time_ms,
                      .memory_mib = frame.memory_mib,
                      .dram_mb = frame.dram_mb,
                      .interval_ms = frame.interval_ms,
                      .aa_interval_ms = std::nullopt});
  const bool shown = std::ranges::find(shown_, technique.technique, &ShownImage::label) != shown_.end();
  if (run.plan.images && !shown)
    shown_.push_back(shown_image(technique.technique, point.emulation->color, point.flip_map.get()));
}

void RankingSink::failed(const algos::TechniqueChoice& technique, const GpuConfig& gpu,
                         const InputError& error) {
  OnGpu& on = of(gpu);
  if (on.ranking.techniques.empty()) throw;  // not even a plain frame can be drawn
  RankedTechnique& unsupported = on.ranking.techniques.emplace_back();
  unsupported.technique = algos::technique_text(technique);
  unsupported.verdict = "unsupported";
  unsupported.reason = error.what();
  on.costs.emplace_back();
  on.results.emplace_back();
}

Ranking RankingSink::judged(const OnGpu& collected) const {
  Ranking ranking = collected.ranking;
  const Costs none = collected.costs.front();
  for (std::size_t i = 0; i < collected.costs.size(); ++i) {
    RankedTechnique& technique = ranking.techniques[i];
    if (!technique.runs()) continue;
    Costs costs = collected.costs[i];
    technique.aa_ms = costs.aa_ms = costs.frame_ms - none.frame_ms;
    technique.extra_mib = costs.extra_mib = costs.memory_mib - none.memory_mib;
    technique.aa_interval_ms = costs.aa_interval_ms =
        extra_interval(collected.results.front(), collected.results[i], calibration_.get());
    technique.verdict = verdict(costs, limits_);
  }
  mark_pareto(ranking.techniques);
  std::ranges::stable_sort(ranking.techniques, {}, [](const RankedTechnique& technique) {
    return std::pair(order_class(technique.verdict), technique.error);
  });
  if (!shown_.empty()) ranking.regions = worst_regions(shown_, kRegionSidePx, kRegions);
  return ranking;
}

std::vector<Ranking> RankingSink::rankings() const {
  std::vector<Ranking> rankings;
  for (const OnGpu& on : on_gpus_) rankings.push_back(judged(on));
  return rankings;
}

pipeline::Image RankingSink::sheet() const {
  return contact_sheet(shown_, worst_regions(shown_, kRegionSidePx, kRegions));
}

std::vector<OverallTechnique> overall(const std::vector<Ranking>& rankings) {
  std::vector<OverallTechnique> all;
  for (const Ranking& ranking : rankings)
    for (const RankedTechnique& ranked : ranking.techniques) {
      auto found = std::ranges::find(all, ranked.technique, &OverallTechnique::technique);
      if (found == all.end()) found = all.insert(all.end(), {.technique = ranked.technique, .verdict = "ok"});
      if (grade(ranked.verdict) > grade(found->verdict)) found->verdict = ranked.verdict;
      if (!ranked.runs()) continue;
      const bool first = found->rankings++ == 0;
      found->aa_ms_most = first ? ranked.aa_ms : std::max(found->aa_ms_most, ranked.aa_ms);
      found->extra_mib_most = first ? ranked.extra_mib : std::max(found->extra_mib_most, ranked.extra_mib);
      found->metric = ranking.metric;
      found->edges = ranking.edges;
      found->error_mean += (ranked.error - found->error_mean) / static_cast<double>(found->rankings);
    }
  std::ranges::stable_sort(all, {}, [](const OverallTechnique& technique) {
    return std::pair(order_class(technique.verdict), technique.error_mean);
  });
  return all;
}

bool may_be_within(const std::string& verdict) { return grade(verdict) <= 2; }

double error_by(ErrorMetric metric, const RankedTechnique& technique) {
  switch (metric) {
    case ErrorMetric::flip:
      return technique.edges ? technique.edges->flip_mean : technique.flip_mean;
    case ErrorMetric::psnr:
      return -(technique.edges ? technique.edges->psnr_db : technique.psnr_db);
    case ErrorMetric::ssim:
      break;
  }
  return 1.0 - technique.ssim;
}

std::string_view metric_name(ErrorMetric metric) {
  switch (metric) {
    case ErrorMetric::flip:
      return "flip";
    case ErrorMetric::psnr:
      return "psnr";
    case ErrorMetric::ssim:
      return "ssim";
  }
  return "flip";
}

ErrorMetric metric_from_name(const std::string& name) {
  for (const ErrorMetric metric : {ErrorMetric::flip, ErrorMetric::psnr, ErrorMetric::ssim})
    if (metric_name(metric) == name) return metric;
  fail_usage("U003", "--metric is `" + name + "`, must be flip, psnr or ssim", "", "--metric flip");
}

}  // namespace hwsim::lab
