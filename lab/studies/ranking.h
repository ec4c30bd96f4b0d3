#pragma once
// Techniques on one scene and GPU, the best first: what each costs, how far its image is from the reference,
// and what it is under a budget.
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

namespace hwsim::lab {

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
  double flip_mean = 0.0, psnr_db = 0.0;  ///< error of the image against the reference
  std::uint64_t shaded_samples = 0;
  std::string reason{};  ///< why it cannot run on the GPU; empty when it runs
  bool runs() const { return reason.empty(); }
};

struct Ranking {
  std::string scene{}, gpu{};
  Resolution resolution{};
  std::string budget{};  ///< as it was given; empty: none
  int reference_samples = 0;
  std::vector<RankedTechnique> techniques{};     ///< the best first
  std::optional<std::vector<Region>> regions{};  ///< where the images err most; none without images
};

/// Marks the techniques that no other one beats in both time and error; one that cannot run beats nobody.
void mark_pareto(std::vector<RankedTechnique>& techniques);

/// Every base on its own, and every filter that smooths behind no anti-aliasing.
std::vector<std::string> rankable_techniques();

/// The plan with `none` in front, since costs are those beyond a frame without anti-aliasing, and with a
/// reference. Throws InputError U004 unless there is one GPU.
RunPlan ranking_plan(RunPlan plan);

/// Collects the points of a ranking_plan and judges them.
class RankingSink : public RunSink {
 public:
  /// Throws InputError U022 for a budget that cannot be read.
  explicit RankingSink(const std::string& budget);

  void begin(const RunContext& run) override;
  void point(const PointResult& point, const RunContext& run) override;
  bool takes_failures() const override { return true; }
  void failed(const algos::TechniqueChoice& technique, const GpuConfig& gpu,
              const InputError& error) override;

  Ranking ranking();
  /// Crops of all techniques side by side where they err most, for ranking().regions. There must be images.
  pipeline::Image sheet() const;

 private:
  std::vector<Limit> limits_;
  Ranking ranking_;
  std::vector<Costs> costs_;
  std::vector<Result> results_;  ///< as costs_; what ratios to the first come from
  std::shared_ptr<const cost_models::Calibration> calibration_;
  std::vector<ShownImage> shown_;
};

nlohmann::ordered_json to_json(const Ranking& ranking);
/// Throws nlohmann::json::exception where a field is missing or of another type.
Ranking ranking_from_json(const nlohmann::ordered_json& json);

Table ranking_table(const Ranking& ranking);

}  // namespace hwsim::lab
