#include "cli/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "cli/argument_values.h"
#include "cli/calibration_files.h"
#include "cli/files.h"
#include "cli/help_texts.h"
#include "cli/image_input.h"
#include "cli/messages.h"
#include "cli/overlays.h"
#include "cli/run_file.h"
#include "cli/table.h"
#include "hwsim/config/settings.h"

namespace hwsim::cli {
namespace {

struct SceneSettings {
  int point_lights = 0;
  double light_range = 0.15;
  std::string lights = "scene";
  bool shadows = true;
  int shadow_map_px = 2048;
};
template <class Visitor>
void describe(Visitor& v, SceneSettings& s) {
  v.key({"point_lights", 0, 1024, kNoFlags, "seeded point lights added to those of the scene"},
        s.point_lights);
  v.key({"light_range", 1e-3, 100, kNoFlags,
         "reach of the lights that are added (also by lights=complex), over the scene's diagonal"},
        s.light_range);
  v.key({"lights", 0, 0, kNoFlags, "scene, simple (one light) or complex (16 lights)"}, s.lights);
  v.key({"shadows", 0, 1, kNoFlags, "a shadow map for the light that casts shadows"}, s.shadows);
  v.key({"shadow_map_px", 16, kMaxSidePx, kNoFlags, "side of the shadow map"}, s.shadow_map_px);
}

struct EmulatorSettings {
  std::string skip = "all";
};
template <class Visitor>
void describe(Visitor& v, EmulatorSettings& s) {
  v.key({"skip", 0, 0, kNoFlags,
         "work to leave out: all, none, or some of the skips by name, separated by commas"},
        s.skip);
}

struct TimingSettings {
  std::string engine = "queue";
  bool calibrated = true;
  double detailed_sample = 1.0;
};
template <class Visitor>
void describe(Visitor& v, TimingSettings& s) {
  v.key({"engine", 0, 0, kNoFlags, "roofline, queue or detailed"}, s.engine);
  v.key({"detailed_sample", 1e-3, 1, kNoFlags, "engine detailed: part of a pass that is simulated"},
        s.detailed_sample);
  v.key(
      {"calibrated", 0, 0, kNoFlags, "the fitted numbers of a GPU, where there are, not the documented ones"},
      s.calibrated);
}

constexpr std::array<std::string_view, 3> kLightProfiles = {"scene", "simple", "complex"};

void append(std::vector<Diagnostic>& problems, const InputError& error) {
  problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
}

std::vector<Assignment> parse_sets(const std::vector<std::string>& texts, std::vector<Diagnostic>& problems) {
  std::vector<Assignment> sets;
  for (const std::string& text : texts) try {
      sets.push_back(parse_assignment(text));
    } catch (const InputError& error) {
      append(problems, error);
    }
  return sets;
}

std::string key_of(const Assignment& set) { return set.path.substr(set.path.find('.') + 1); }

bool is_scene_file(const std::string& scene) {
  const auto dot = scene.rfind('.');
  const std::string ending = dot == std::string::npos ? "" : scene.substr(dot);
  return ending == ".gltf" || ending == ".glb" || is_image_file(scene);
}

/// scene.* holds settings of the view and, for a generated scene, the generator's own parameters; the
/// generator checks the latter.
ViewPlan plan_view(const ViewOptions& options, const std::vector<Assignment>& sets, const ViewPlan& start,
                   std::vector<Diagnostic>& problems) {
  ViewPlan plan = start;
  SceneSettings settings{start.point_lights, start.light_range, std::string(light_profile_name(start.lights)),
                         start.shadows, start.shadow_map_px};
  const std::vector<Key> keys = keys_of(settings);
  std::vector<Assignment> own, generator;
  for (const Assignment& set : sets) {
    if (set.group() != "scene") continue;
    const bool known =
        std::any_of(keys.begin(), keys.end(), [&](const Key& k) { return k.info.name == key_of(set); });
    (known || is_scene_file(plan.scene) ? own : generator).push_back(set);
  }
  apply_settings("scene", keys, own, problems);
  plan.scene = with_parameters(plan.scene, generator);
  plan.point_lights = options.point_lights.value_or(settings.point_lights);
  plan.light_range = settings.light_range;
  if (const auto profile = light_profile_from_name(settings.lights))
    plan.lights = *profile;
  else
    problems.push_back(
        problem("U003", "`scene.lights` is `" + settings.lights + "`, must be scene, simple or complex",
                did_you_mean(settings.lights,
                             std::vector<std::string>(kLightProfiles.begin(), kLightProfiles.end()))));
  plan.shadows = settings.shadows && !options.no_shadows;
  plan.shadow_map_px = settings.shadow_map_px;
  plan.resolution = options.resolution.value_or(start.resolution);
  plan.camera = options.camera.value_or(start.camera);
  return plan;
}

/// Flags that say how a scene is seen, given with an image; and techniques that would have to draw it.
void check_image_run(const RunOptions& options, const RunPlan& plan, std::vector<Diagnostic>& problems) {
  const auto refuse = [&](bool given, const std::string& what) {
    if (given)
      problems.push_back(problem("U030", what + " has no meaning for the image `" + plan.view.scene + "`", "",
                                 "an image is filtered as it is"));
  };
  refuse(options.view.resolution.has_value(), "--resolution");
  refuse(options.view.camera.has_value(), "--camera");
  refuse(options.view.point_lights.has_value(), "--point-lights");
  refuse(plan.reference_samples > 0, "a ray-traced reference");
  for (const algos::TechniqueChoice& choice : plan.techniques) try {
      algos::require_filters(choice);
    } catch (const InputError& error) {
      append(problems, error);
    }
}

Engine plan_engine(const std::string& name, std::vector<Diagnostic>& problems) {
  if (const auto engine = engine_from_name(name)) return *engine;
  problems.push_back(problem("U006",
                             "unknown timing engine `" + name + "`, must be roofline, queue or detailed",
                             did_you_mean(name, std::vector<std::string>{"roofline", "queue"})));
  return Engine::queue;
}

pipeline::SkipSwitches plan_skip(const std::string& text, std::vector<Diagnostic>& problems) {
  pipeline::SkipSwitches skip;
  for (const pipeline::SkipInfo& info : pipeline::kSkips) skip.*info.flag = text == "all";
  if (text == "all" || text == "none") return skip;
  std::vector<std::string> names = {"all", "none"};
  for (const pipeline::SkipInfo& info : pipeline::kSkips) names.emplace_back(info.name);
  for (const std::string& name : split_techniques(text)) {
    const auto* found = std::ranges::find(pipeline::kSkips, name, &pipeline::SkipInfo::name);
    if (found != pipeline::kSkips.end())
      skip.*found->flag = true;
    else
      problems.push_back(problem("U007",
                                 "`emulator.skip` names `" + name + "`, must be all, none, or some of " +
                                     fmt::format("{}", fmt::join(names.begin() + 2, names.end(), ",")),
                                 did_you_mean(name, names)));
  }
  return skip;
}

/// The choice with technique.KEY given to every part that has the parameter; names of those used are added.
algos::TechniqueChoice with_settings(const algos::TechniqueChoice& choice,
                                     const std::vector<Assignment>& sets, std::set<std::string>& used) {
  std::string text;
  bool changed = false;
  for (const algos::TechniquePart& part : choice.parts) {
    std::vector<Assignment> own;
    for (const Assignment& set : sets)
      if (set.group() == "technique" && part.parameters.contains(key_of(set))) own.push_back(set);
    for (const Assignment& set : own) used.insert(set.path);
    changed = changed || !own.empty();
    text += (text.empty() ? "" : "+") + with_parameters(algos::technique_text(part), own);
  }
  return changed ? algos::parse_technique(text) : choice;
}

/// One at least of the techniques must have a parameter that technique.* names.
std::vector<algos::TechniqueChoice> plan_techniques(const std::vector<std::string>& texts,
                                                    const std::vector<Assignment>& sets,
                                                    std::vector<Diagnostic>& problems) {
  std::vector<algos::TechniqueChoice> choices;
  std::set<std::string> used, known;
  for (const std::string& text : texts) try {
      const algos::TechniqueChoice choice = algos::parse_technique(text);
      for (const algos::TechniquePart& part : choice.parts)
        for (const auto& [name, value] : part.parameters) known.insert(name);
      choices.push_back(with_settings(choice, sets, used));
    } catch (const InputError& error) {
      append(problems, error);
    }
  const std::vector<std::string> candidates(known.begin(), known.end());
  for (const Assignment& set : sets)
    if (set.group() == "technique" && !used.contains(set.path) && choices.size() == texts.size())
      problems.push_back(problem("U008", "no chosen technique has the parameter `" + key_of(set) + "`",
                                 did_you_mean(key_of(set), candidates),
                                 "`hwsim show TECHNIQUE` lists the parameters of one"));
  return choices;
}

std::vector<GpuConfig> plan_gpus(const std::vector<std::string>& names,
                                 const std::vector<std::string>& overlays,
                                 const std::vector<Assignment>& sets, bool calibrated,
                                 std::vector<Diagnostic>& problems) {
  std::vector<GpuConfig> gpus;
  const std::string directory = gpu_directory();
  std::vector<std::string> files;
  for (const std::string& overlay : overlays) try {
      files.push_back(overlay_file(overlay));
    } catch (const InputError& error) {
      append(problems, error);
    }
  for (const std::string& name : names) try {
      gpus.push_back(load_gpu(calibrated ? gpu_file(name) : name, files, sets, directory));
    } catch (const InputError& error) {
      append(problems, error);
    }
  return gpus;
}

void check_group_names(const std::vector<Assignment>& sets, const std::vector<std::string>& groups,
                       std::vector<Diagnostic>& problems) {
  try {
    check_groups(sets, groups);
  } catch (const InputError& error) {
    append(problems, error);
  }
}

}  // namespace

std::string with_parameters(const std::string& text, const std::vector<Assignment>& parameters) {
  std::string result = text;
  for (const Assignment& set : parameters) {
    const std::string key = key_of(set) + "=";
    const auto colon = result.find(':');
    if (colon == std::string::npos) {
      result += ":" + key + set.value;
      continue;
    }
    size_t at = colon + 1;
    while (at < result.size() && result.compare(at, key.size(), key) != 0) {
      const auto comma = result.find(',', at);
      at = comma == std::string::npos ? result.size() : comma + 1;
    }
    if (at < result.size())
      result.replace(at, std::min(result.find(',', at), result.size()) - at, key + set.value);
    else
      result += "," + key + set.value;
  }
  return result;
}

ViewPlan make_view_plan(const ViewOptions& options) {
  std::vector<Diagnostic> problems;
  const std::vector<Assignment> sets = parse_sets(options.sets, problems);
  check_group_names(sets, {"scene"}, problems);
  ViewPlan start;
  start.scene = options.scene;
  const ViewPlan plan = plan_view(options, sets, start, problems);
  if (!problems.empty()) throw InputError(problems);
  return plan;
}

std::optional<algos::LightProfile> light_profile_from_name(std::string_view name) {
  const auto found = std::find(kLightProfiles.begin(), kLightProfiles.end(), name);
  if (found == kLightProfiles.end()) return std::nullopt;
  return static_cast<algos::LightProfile>(found - kLightProfiles.begin());
}

std::string_view light_profile_name(algos::LightProfile profile) {
  return kLightProfiles[static_cast<std::size_t>(profile)];
}

RunPlan make_run_plan(const RunOptions& options) {
  std::vector<Diagnostic> problems;
  const std::vector<Assignment> sets = parse_sets(options.view.sets, problems);
  check_group_names(sets, {"gpu", "scene", "technique", "emulator", "timing"}, problems);

  RunFile file;  // what a run.toml says, or the defaults
  file.view.scene = options.view.scene;
  if (options.view.scene.ends_with(".toml")) file = read_run_file(options.view.scene);
  EmulatorSettings emulator{file.skip};
  TimingSettings timing{.engine = file.engine, .detailed_sample = file.detailed_sample};
  apply_settings("emulator", keys_of(emulator), sets, problems);
  apply_settings("timing", keys_of(timing), sets, problems);

  RunPlan plan;
  plan.overrides = sets;
  plan.view = plan_view(options.view, sets, file.view, problems);
  plan.engine = plan_engine(options.engine.value_or(timing.engine), problems);
  plan.timing.detailed_sample_ratio = timing.detailed_sample;
  plan.skip = plan_skip(emulator.skip, problems);
  plan.techniques = plan_techniques(
      options.techniques.empty() ? std::vector{file.technique} : options.techniques, sets, problems);
  plan.gpus = plan_gpus(options.gpus.empty() ? std::vector{file.gpu} : options.gpus, options.overlays, sets,
                        timing.calibrated, problems);
  plan.reference_samples = options.reference_samples.value_or(file.reference_samples);
  plan.images = !options.no_image;
  plan.calibrated = timing.calibrated;
  if (is_image_file(plan.view.scene)) check_image_run(options, plan, problems);
  if (!problems.empty()) throw InputError(problems);
  return plan;
}

}  // namespace hwsim::cli
