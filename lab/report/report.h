#pragma once
// What a report shows, as plain data: points with their work traces, so that a page can replay them on other
// hardware; pictures; what a study found; and how far all of it can be believed (docs/report.md).
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cost_models/intervals.h"
#include "hwsim/gpu/gpu_config.h"
#include "lab/base/table.h"
#include "lab/report/belief.h"
#include "lab/report/pictures.h"
#include "lab/studies/explanation.h"
#include "lab/studies/paper_layout.h"
#include "lab/studies/ranking.h"
#include "lab/studies/sweep_findings.h"

namespace hwsim::lab {

inline constexpr int kReportSchemaVersion = 1;

/// An image or a buffer of a frame, and the passes between which it takes memory.
struct LiveMemory {
  std::string name{};
  std::uint64_t bytes = 0;
  int first_pass = 0, last_pass = 0;  ///< among the passes that run
};

/// How long a frame's images and buffers live.
struct FrameMemory {
  std::vector<std::string> passes{};
  std::vector<LiveMemory> parts{};
};

struct ReportedPoint {
  Explanation explanation{};
  std::string technique{};   ///< with all its options
  std::string view_words{};  ///< the scene and the flags that give the same view: "hall --resolution 320x180"
  std::string view{};  ///< what of it differs between the report's points: "street, 640x360"; empty: nothing
  GpuConfig gpu{};
  bool calibrated = true;             ///< its times have intervals where its GPU was fitted
  std::vector<std::uint8_t> trace{};  ///< encode_trace()
  FrameMemory memory{};
  PointPictures pictures{};                ///< none where an earlier point has the very same
  std::size_t pictures_of = 0;             ///< the index of the point that has them
  std::optional<std::size_t> reference{};  ///< index into Report::references
};

/// A GPU that the page offers.
struct OfferedGpu {
  GpuConfig config{};
  std::vector<Support> supports{};                            ///< one a point
  std::vector<std::pair<std::string, std::string>> fitted{};  ///< key, and its parameter's id
};

/// A named change of hardware: an overlay.
struct WhatIf {
  std::string name{}, about{};
  std::vector<Assignment> changes{};  ///< "l2_size_kib", "x4"
};

/// A variation that a comparison tried, with the GPU that it made.
struct TriedVariation {
  std::string label{};
  std::size_t point = 0;  ///< that it changes
  GpuConfig gpu{};
};

/// The points of a sweep's database, and what they show together.
struct ReportedSweep {
  Table rows{};  ///< every point, up to a limit
  SweepFindings findings{};
};

struct Report {
  std::string command{};  ///< that repeats it
  std::string title{};
  std::vector<ReportedPoint> points{};
  /// 90 % interval of the change of the time from the fastest point to the slowest; none without intervals.
  std::optional<std::array<double, 2>> spread_interval{};
  std::vector<Picture> references{};
  std::vector<Region> regions{};  ///< where the images of the points err most
  std::vector<OfferedGpu> gpus{};
  std::optional<cost_models::IntervalModel> intervals{};  ///< none without a calibration
  std::map<std::string, std::string> catalog_hashes{};    ///< content_hash by id of the GPUs that hwsim has
  std::vector<WhatIf> what_ifs{};
  std::vector<TriedVariation> variations{};
  std::vector<Ranking> rankings{};
  std::optional<Comparison> comparison{};
  std::optional<ReportedSweep> sweep{};
  std::optional<Reproduction> reproduction{};
  std::vector<PaperTable> paper_tables{};  ///< those of the reproduction
  Belief belief{};
  std::vector<std::string> limits{};  ///< what is not modeled, extrapolated, or by default
};

/// "msaa4x on gtx980", and the view where points have several: what the page calls a point.
std::string label_of(const ReportedPoint& point);

/// The fastest and the slowest of the points, of which there must be one.
std::pair<const ReportedPoint*, const ReportedPoint*> extremes_of(const Report& report);

/// The answer in a sentence: what was found, with its interval.
std::string answer_of(const Report& report);

/// What the page's script reads: everything but the pictures' bytes.
nlohmann::ordered_json to_json(const Report& report);

}  // namespace hwsim::lab
