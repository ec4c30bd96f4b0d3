#pragma once
// What the fit may move: physical numbers, each with a range, a start and a scope, declared in
// configs/calibration/parameters.csv. None belongs to a cell, a technique or a row.
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/gpu/gpu_config.h"

namespace hwsim::cost_models {

/// gpu: a key of one GPU's file. all: the same key of every GPU that has no own. scene: a factor between the
/// original scene of a paper and its stand-in.
enum class Scope { gpu, all, scene };
std::string_view scope_name(Scope scope);

/// The two factors that a scene may have.
inline constexpr std::string_view kGeometryLoad = "geometry_load";  ///< work of draws, original over stand-in
inline constexpr std::string_view kLightReach = "light_reach";      ///< the same of the point lights' work

/// A parameter of a GPU, but of no pass: what the papers' whole frames contain beside the passes (present,
/// host). `run` predicts the passes alone.
inline constexpr std::string_view kPresent = "present_us";
/// The name by which mapping files count it among the passes of a row; "*" includes it.
inline constexpr std::string_view kPresentPass = "present";

struct FittedParameter {
  Scope scope = Scope::gpu;
  std::string member;  ///< GPU or scene; "all" for scope all
  std::string name;    ///< key of a GPU file, or a factor of a scene
  double start = 0.0, low = 0.0, high = 0.0;
  double prior_log_sd = 0.0;  ///< standard deviation of ln(value / center); 0: no prior
  std::string unit, meaning;
  std::string id() const { return member + "." + name; }
  bool concerns(const std::string& gpu, const std::string& scene) const;
  std::vector<std::string> own_of;  ///< scope all: GPUs that have a parameter of this name themselves
  /// The center of the prior: the parameter of the same name for all GPUs (partial pooling: a GPU differs
  /// from the others by about the prior's factor), or none: the start.
  std::optional<std::size_t> pooled_with{};
};

/// The prior of a parameter, as the fit uses it: ln(value) is about a center that is known, or fitted itself.
struct Prior {
  std::size_t of = 0;
  std::optional<std::size_t> around;  ///< a parameter
  double log_center = 0.0;            ///< where there is none
  double log_sd = 0.0;
  double offset(const std::vector<double>& log_values) const;  ///< from the center, in units of log_sd
};

/// Priors of the parameters that `used` marks.
std::vector<Prior> priors_of(const std::vector<FittedParameter>& parameters, const std::vector<bool>& used);

/// Reads the declarations. "file" for start or range stands for what the GPU's file says (value, interval).
/// Throws InputError M003 with every mistake.
std::vector<FittedParameter> load_parameters(const std::string& path,
                                             const std::map<std::string, GpuConfig>& gpus);

}  // namespace hwsim::cost_models
