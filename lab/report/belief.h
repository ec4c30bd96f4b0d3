#pragma once
// How far a report's times can be believed: published times and ratios beside predictions by fits that had
// not seen their scene, and other renderers' times, which no fit saw.
#include <set>
#include <string>
#include <vector>

#include "lab/base/table.h"
#include "lab/catalog/config_files.h"
#include "lab/point/session.h"
#include "lab/studies/external.h"

namespace hwsim::lab {

/// A published time beside what a fit predicted that did not see its scene.
struct PublishedPoint {
  std::string row{}, paper{}, gpu{}, technique{}, scene{}, what{};
  double published_ms = 0.0, held_out_ms = 0.0;
  bool own = false;  ///< on a GPU of the report
};

/// How many times as long one technique takes as another, of one scene, GPU and stage.
struct PublishedRatio {
  std::string first{}, second{};  ///< rows; the ratio is second over first
  std::string paper{}, gpu{}, techniques{}, scene{}, what{};
  double published = 0.0, held_out = 0.0;
  bool own = false;
};

/// Errors of some predictions.
struct BeliefErrors {
  std::string what{};
  std::size_t count = 0;
  double mape_pct = 0.0, median_ape_pct = 0.0;
  std::optional<double> coverage90_pct{};  ///< none where the predictions have no intervals of their own
};

struct Belief {
  std::vector<PublishedPoint> times{};
  std::vector<PublishedRatio> ratios{};
  std::vector<ExternalRow> external{};
  std::vector<BeliefErrors> errors{};
};

/// Everything published that `configs` holds, on all calibrated GPUs; `gpus`: ids of those of the report.
/// Empty without a calibration.
Belief belief_of(const std::set<std::string>& gpus, Session& session);

/// The ratios of one paper, and how many of them are on the published side of 1: who of two techniques is
/// faster.
std::vector<PublishedRatio> ratios_of(const Belief& belief, const std::string& paper);
std::size_t in_published_order(const std::vector<PublishedRatio>& ratios);

Table error_table(const Belief& belief);                       ///< a row a kind of prediction
Table published_table(const Belief& belief);                   ///< a row a published time
Table ratio_table(const std::vector<PublishedRatio>& ratios);  ///< a row a pair of published times
Table external_table(const Belief& belief);                    ///< a row a time of another renderer

/// The fields that a page's script reads.
nlohmann::ordered_json to_json(const Belief& belief);

}  // namespace hwsim::lab
