#pragma once
// What a sweep found, in a screen: the best of what was tried, the front of time and error, and how much each
// axis mattered.
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/base/table.h"

namespace hwsim::lab {

/// All that was chosen but the frame: technique, GPU, what is varied. Its times are those of all frames that
/// the sweep draws (scenes, cameras, resolutions): their geometric mean.
struct SweepChoice {
  std::vector<std::pair<std::string, std::string>> what{};  ///< by axis; those that stay are left out
  double time_ms = 0.0;
  std::optional<std::array<double, 2>> interval_ms{};  ///< 90 %; as if the frames were all as wrong
  std::optional<double> flip_mean{}, psnr_db{};        ///< mean over the frames
  double memory_mib = 0.0;                             ///< the most of a frame
};

/// How the time follows an axis, all others being what they are.
struct AxisEffect {
  std::string axis{};
  std::size_t values = 0;
  double share_ratio = 0.0;          ///< part of the variance of ln(time): 1 where nothing else matters
  std::string fastest{}, slowest{};  ///< values with the least and the largest time
  double fastest_ms = 0.0, slowest_ms = 0.0;  ///< geometric means
};

struct SweepFindings {
  std::size_t points = 0, frames = 0;
  double fastest_ms = 0.0, slowest_ms = 0.0;  ///< a point's
  std::vector<SweepChoice> best{};            ///< the fastest first; those that have all frames
  std::vector<SweepChoice> front{};           ///< nobody is faster and closer; empty without errors of images
  std::vector<AxisEffect> effects{};          ///< the largest share first
};

/// From the points of a database that are done; asks for the rows several times, and keeps a few numbers a
/// point.
SweepFindings findings_of(const RowSource& points);

Table choice_table(const std::vector<SweepChoice>& choices);
Table effect_table(const std::vector<AxisEffect>& effects);

}  // namespace hwsim::lab
