#pragma once
// Techniques in one view and on one GPU, the best first: what each costs, how far its image is from the
// reference, and what it is under a budget. Several views and GPUs are a ranking each, and one over all.
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/base/table.h"
#include "lab/point/run_sink.h"
#include "lab/results/contact_sheet.h"
#include "lab/studies/budget.h"
#include "lab/studies/comparison.h"
#include "lab/studies/edge_error.h"

namespace hwsim::lab {

/// By which error of the image techniques are ordered.
enum class ErrorMetric { flip, psnr, ssim };
std::string_view metric_name(ErrorMetric metric);
/// Throws InputError U003.
ErrorMetric metric_from_name(const std::string& name);

struct RankedTechnique;
/// How far an image is from the reference, at edges where they were asked for: less is closer.
double error_by(ErrorMetric metric, const RankedTechnique& technique);

/// The same as the metric prints it: dB of PSNR, SSIM, mean FLIP.
double shown_error(const std::string& metric, double error);

/// How techniques are judged.
struct RankQuestion {
  std::string budget{};  ///< "aa_ms<=1.5, extra_mib<=192"; empty: none
  ErrorMetric metric = ErrorMetric::flip;
  bool edges = false;  ///< errors where the reference has edges; FLIP and PSNR alone
};

struct RankedTechnique {
  std::string technique{};
  std::string verdict{};  ///< as verdict() says, or "unsupported"
  bool pareto = false;    ///< nobody else is both faster and closer
  double frame_ms = 0.0;
  std::optional<std::array<double, 2>> interval_ms{};  ///< 90 %, of frame_ms
  std::string support{};
  double aa_ms = 0.0, extra_mib = 0.0;  ///< beyond no anti-aliasing
  /// 90 %, of aa_ms: the ratio to no anti-aliasing is known better than the two times.
  std::optional<std::array<double, 2>> aa_interval_ms{};
  double dram_mb = 0.0;
  double flip_mean = 0.0, psnr_db = 0.0, ssim = 0.0;  ///< error of the image against the reference
  std::optional<EdgeError> edges{};                   ///< the same at edges, where it was asked for
  double error = 0.0;                                 ///< by the metric that was asked for: less is closer
  std::uint64_t shaded_samples = 0;
  std::string reason{};  ///< why it cannot run on the GPU; empty when it runs
  bool runs() const { return reason.empty(); }
};

struct Ranking {
  std::string scene{}, gpu{}, camera{};
  Resolution resolution{};
  std::string budget{};         ///< as it was given; empty: none
  std::string metric = "flip";  ///< by which techniques are ordered
  bool edges = false;           ///< at edges alone
  int reference_samples = 0;
  std::vector<RankedTechnique> techniques{};     ///< the best first
  std::optional<std::vector<Region>> regions{};  ///< where the techniques differ most; none without images
};

/// A technique over several rankings.
struct OverallTechnique {
  std::string technique{};
  std::string verdict{};     ///< the worst of all
  std::size_t rankings = 0;  ///< that it runs in
  double aa_ms_most = 0.0, extra_mib_most = 0.0;
  double error_mean = 0.0;      ///< the mean of RankedTechnique::error
  std::string metric = "flip";  ///< that the error is of, as Ranking has it
  bool edges = false;
};

/// By verdict, then by error; techniques that run nowhere are last.
std::vector<OverallTechnique> overall(const std::vector<Ranking>& rankings);

/// Whether something may be within the budget: verdicts ok, unknown and at risk.
bool may_be_within(const std::string& verdict);

/// Marks the techniques that no other one beats in both time and error; one that cannot run beats nobody.
void mark_pareto(std::vector<RankedTechnique>& techniques);

/// Every base on its own, and every filter that smooths behind no anti-aliasing.
std::vector<std::string> rankable_techniques();

/// The plan with `none` in front, since costs are those beyond a frame without anti-aliasing, and with a
/// reference.
RunPlan ranking_plan(RunPlan plan);

/// Collects the points of a ranking_plan and judges them, a ranking for each GPU.
class RankingSink : public RunSink {
 public:
  /// Throws InputError U022 for a budget that cannot be read, and U003 for a metric that edges do not have.
  explicit RankingSink(RankQuestion question);

  void begin(const RunContext& run) override;
  void point(const PointResult& point, const RunContext& run) override;
  bool takes_failures() const override { return true; }
  void failed(const algos::TechniqueChoice& technique, const GpuConfig& gpu,
              const InputError& error) override;

  std::vector<Ranking> rankings() const;
  /// Crops of all techniques side by side where they differ most, for Ranking::regions. There must be images.
  pipeline::Image sheet() const;

 private:
  struct OnGpu {
    Ranking ranking;
    std::vector<Costs> costs;
    std::vector<Result> results;  ///< as costs; what ratios to the first come from
  };
  OnGpu& of(const GpuConfig& gpu);
  std::optional<EdgeError> edges_of(const PointResult& point, const RunContext& run);
  Ranking judged(const OnGpu& collected) const;

  RankQuestion question_;
  std::vector<Limit> limits_;
  std::vector<OnGpu> on_gpus_;
  std::shared_ptr<const cost_models::Calibration> calibration_;
  std::vector<ShownImage> shown_;
  std::vector<char> edge_mask_;
  const pipeline::Emulation* last_frame_ = nullptr;  ///< that last_edges_ is of
  std::optional<EdgeError> last_edges_;
};

nlohmann::ordered_json to_json(const Ranking& ranking);
/// Throws nlohmann::json::exception where a field is missing or of another type.
Ranking ranking_from_json(const nlohmann::ordered_json& json);

Table ranking_table(const Ranking& ranking);

/// Rows of all rankings, their GPU and view first; and what techniques are over all of them.
Table joined_table(const std::vector<Ranking>& rankings);
Table overall_table(const std::vector<OverallTechnique>& techniques);
nlohmann::ordered_json to_json(const std::vector<Ranking>& rankings);
/// What to_json() made of one ranking or of several. Throws nlohmann::json::exception where a field is
/// missing or of another type.
std::vector<Ranking> rankings_from_json(const nlohmann::ordered_json& json);

/// Which technique, in a sentence; there must be a ranking, and each must have a technique.
std::string answer_of(const std::vector<Ranking>& rankings);
/// The best technique of each ranking, under the same condition.
Table best_table(const std::vector<Ranking>& rankings);

}  // namespace hwsim::lab
