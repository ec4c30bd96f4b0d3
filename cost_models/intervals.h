#pragma once
// 90 % intervals of predictions: of a frame's time, and of the ratio of two frames, in which much cancels.
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cost_models/calibration.h"
#include "hwsim/engines/timing.h"

namespace hwsim::cost_models {

/// What the error of a frame's time comes from.
struct ErrorSources {
  /// d ln(time) / d ln(parameter), by the parameter's id: "gtx980.alu_efficiency_ratio".
  std::vector<std::pair<std::string, double>> by_parameter;
  /// Part of the time that each unit holds up, by its name; they add up to 1.
  std::vector<std::pair<std::string, double>> by_unit;
};

struct FrameInterval {
  Support support = Support::uncalibrated;
  std::optional<std::array<double, 2>> interval_ns;
  std::vector<std::pair<std::string, double>> by_parameter;  ///< as ErrorSources has it
};

/// A frame that the queue engine timed on a GPU, with the slopes of its time by interval_keys().
struct TimedFrame {
  double time_ns = 0.0;
  std::vector<double> slopes_ns;
};

/// The GPU itself where it was fitted, else the nearest that its file extends and that was: its numbers are
/// changed ones of that. Empty: none.
std::string calibrated_id(const Calibration& calibration, const GpuConfig& gpu);

/// Whether no fitted number that frames on a fitted GPU depend on has paid for what the model or a scene
/// lacks.
bool credible(const Calibration& calibration, const std::string& gpu);

/// The fitted keys of a GPU, which its intervals come from.
std::vector<std::string> interval_keys(const Calibration& calibration, const std::string& gpu);

/// 90 % interval of a frame; none on a GPU that was not fitted. calibrated: the technique with these
/// parameters was fitted on this GPU, all of whose numbers are credible; interpolated: it was fitted with
/// other parameters or on another GPU; extrapolated: a technique without published times, or changed numbers
/// of the GPU. (A key that came after the fit changes a GPU when an overlay or the command line sets it.)
FrameInterval frame_interval(const Calibration& calibration, const TimedFrame& frame, const GpuConfig& gpu,
                             const std::string& technique);

/// What two frames have in common.
struct Likeness {
  bool technique = false, gpu = false;      ///< by name; a GPU whose numbers were changed keeps its name
  bool scene = false;                       ///< scene and resolution
  Support support = Support::uncalibrated;  ///< the worse of the two
};

/// Divided and multiplied with a ratio of two frames' times, the ends of its 90 % interval; none when a
/// frame has no interval of its own. Its logarithm's variance is what the fitted numbers give (what both
/// frames depend on alike cancels), and
/// - of two techniques, the spread of published ratios about predicted ones,
/// - of one technique, the model's error for each part of the time that moved from one unit to another: an
///   unchanged unit is as wrong before as after,
/// - of two GPUs or scenes, both frames' own errors.
std::optional<double> ratio_half_width(const Calibration& calibration, const ErrorSources& before,
                                       const ErrorSources& after, const Likeness& likeness);

/// All that intervals are computed from, for who replays frames elsewhere (a report's page), as the functions
/// above compute them.
struct IntervalModel {
  double residual_log_sd = 0.0, ratio_log_sd = 0.0;
  std::map<Support, double> quantile90{}, ratio_quantile90{};
  std::vector<std::string> parameters{};  ///< ids
  std::vector<double> covariance{};       ///< that of their logarithms, row by row
};
IntervalModel interval_model(const Calibration& calibration);

/// The parameters that a frame's time on a GPU depends on, by the GPU's keys: in the order of
/// interval_keys().
std::vector<std::string> interval_parameters(const Calibration& calibration, const std::string& gpu);

/// How near a frame is to what was fitted; uncalibrated on a GPU that was not.
Support support_of(const Calibration& calibration, const GpuConfig& gpu, const std::string& technique);

}  // namespace hwsim::cost_models
