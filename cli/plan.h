#pragma once
// From the command line to a plan with every value decided, before anything is loaded or drawn. What is wrong
// is reported all at once.
#include <map>
#include <string>
#include <vector>

#include "algos/techniques.h"
#include "cli/options.h"
#include "hwsim/config/toml_value.h"
#include "hwsim/engines/timing.h"
#include "hwsim/gpu/gpu_config.h"
#include "pipeline/emulate/emulator.h"

namespace hwsim::cli {

/// What is drawn, from flags, --set scene.* and defaults.
struct ViewPlan {
  std::string scene;  ///< as pipeline::open_scene takes it: a path, or a generator with its parameters
  Resolution resolution;
  std::string camera = "0";
  int point_lights = 0;
  double light_range = 0.15;  ///< reach of lights that are added, as a part of the scene's diagonal
  algos::LightProfile lights = algos::LightProfile::scene;
  bool shadows = true;
  int shadow_map_px = 2048;
  bool operator==(const ViewPlan&) const = default;
};

struct RunPlan {
  ViewPlan view;
  std::vector<algos::TechniqueChoice> techniques;
  std::vector<GpuConfig> gpus;
  Engine engine = Engine::queue;
  TimingOptions timing;
  pipeline::SkipSwitches skip;
  int reference_samples = 0;  ///< 0: no reference
  bool images = true;
  bool calibrated = true;  ///< fitted numbers and intervals, where there are
  std::vector<Assignment> overrides;
};

/// "scene", "simple" or "complex"; nothing for other names.
std::optional<algos::LightProfile> light_profile_from_name(std::string_view name);
std::string_view light_profile_name(algos::LightProfile profile);

/// Throws InputError with every problem found.
RunPlan make_run_plan(const RunOptions& options);
ViewPlan make_view_plan(const ViewOptions& options);

/// "grass:seed=3" with further parameters or other values for those it has.
std::string with_parameters(const std::string& text, const std::vector<Assignment>& parameters);

}  // namespace hwsim::cli
