#pragma once
// A request with every value decided and every name found, before anything is loaded or drawn.
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "algos/techniques.h"
#include "hwsim/engines/timing.h"
#include "hwsim/gpu/gpu_config.h"
#include "lab/catalog/config_files.h"
#include "lab/request/request.h"
#include "pipeline/emulate/emulator.h"

namespace hwsim::lab {

struct RunPlan {
  View view;
  std::vector<algos::TechniqueChoice> techniques;
  std::vector<GpuConfig> gpus;
  Engine engine = Engine::queue;
  TimingOptions timing;
  pipeline::SkipSwitches skip;
  int reference_samples = 0;  ///< 0: no reference
  bool images = true;
  bool calibrated = true;  ///< fitted numbers and intervals, where there are
  std::shared_ptr<const cost_models::Calibration> calibration;  ///< null: no intervals
  std::vector<Assignment> overrides;
};

/// Appends every problem found to `problems`; the plan is complete when there is none. GPUs and the
/// calibration come from `files`, which a lab keeps: a thousand plans read each file once.
RunPlan make_plan(const Request& request, ConfigFiles& files, std::vector<Diagnostic>& problems);

/// The same, with all problems thrown as one InputError.
RunPlan make_plan(const Request& request, ConfigFiles& files);

/// All that a run of the plan with so many threads takes its time for, but the numbers of the GPUs.
std::string plan_key(const RunPlan& plan, int jobs);

/// What a plan has decided, as the settings of a request.
Settings settings_of(const RunPlan& plan);

/// "scene", "simple" or "complex"; nothing for other names.
std::optional<algos::LightProfile> light_profile_from_name(std::string_view name);

/// "all", "none", or the names of those that are on.
std::string skip_text(const pipeline::SkipSwitches& skip);

}  // namespace hwsim::lab
