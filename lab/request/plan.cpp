#include "lab/request/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "hwsim/gpu/gpu_rules.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/request/image_input.h"

namespace hwsim::lab {
namespace {

constexpr std::array<std::string_view, 4> kLightProfiles = {"scene", "simple", "complex", "added"};

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
      if (set.group() == "technique" && part.info->has_option(key_of(set))) own.push_back(set);
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
        for (const algos::OptionInfo& option : part.info->options) known.emplace(option.name);
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
                                 const std::vector<Assignment>& sets, bool calibrated, ConfigFiles& from,
                                 std::vector<Diagnostic>& problems) {
  std::vector<GpuConfig> gpus;
  std::vector<std::string> files;
  for (const std::string& overlay : overlays) try {
      files.push_back(from.folder().overlay_file(overlay));
    } catch (const InputError& error) {
      append(problems, error);
    }
  for (const std::string& name : names) try {
      gpus.push_back(from.gpu(name, files, sets, calibrated));
    } catch (const InputError& error) {
      append(problems, error);
    }
  check_ids(gpus, problems);
  return gpus;
}

/// An image has nothing to draw.
void check_image_run(const RunPlan& plan, std::vector<Diagnostic>& problems) {
  if (plan.reference_samples > 0)
    problems.push_back(
        problem("U030", "a ray-traced reference has no meaning for the image `" + plan.view.scene + "`", "",
                "an image is filtered as it is"));
  for (const algos::TechniqueChoice& choice : plan.techniques) try {
      algos::require_filters(choice);
    } catch (const InputError& error) {
      append(problems, error);
    }
}

}  // namespace

std::optional<algos::LightProfile> light_profile_from_name(std::string_view name) {
  const auto found = std::find(kLightProfiles.begin(), kLightProfiles.end(), name);
  if (found == kLightProfiles.end()) return std::nullopt;
  return static_cast<algos::LightProfile>(found - kLightProfiles.begin());
}

std::string skip_text(const pipeline::SkipSwitches& skip) {
  std::string names;
  std::size_t count = 0;
  for (const pipeline::SkipInfo& info : pipeline::kSkips) {
    if (!(skip.*info.flag)) continue;
    names += (count++ == 0 ? "" : ",") + std::string(info.name);
  }
  if (count == pipeline::kSkips.size()) return "all";
  return count == 0 ? "none" : names;
}

RunPlan make_plan(const Request& request, ConfigFiles& files, std::vector<Diagnostic>& problems) {
  const Settings& settings = request.settings;
  RunPlan plan;
  plan.overrides = request.sets;
  plan.view = request.view;
  check_choices(plan.view, problems);
  plan.engine = plan_engine(settings.engine, problems);
  plan.timing.detailed_sample_ratio = settings.detailed_sample;
  plan.skip = plan_skip(settings.skip, problems);
  plan.techniques = plan_techniques(request.techniques, request.sets, problems);
  plan.gpus = plan_gpus(request.gpus, request.overlays, request.sets, settings.calibrated, files, problems);
  plan.reference_samples = settings.reference_samples;
  plan.images = settings.images;
  plan.calibrated = settings.calibrated;
  if (plan.calibrated) try {
      plan.calibration = files.calibration();
    } catch (const InputError& error) {
      append(problems, error);
    }
  if (is_image_file(plan.view.scene)) check_image_run(plan, problems);
  return plan;
}

std::string plan_key(const RunPlan& plan, int jobs) {
  std::string key = fmt::format("{}|{}x{}|{}|{}|{}|{}|{}", plan.view.scene, plan.view.resolution.width_px,
                                plan.view.resolution.height_px, plan.view.point_lights, plan.view.lights,
                                plan.reference_samples, plan.images, jobs);
  for (const auto& technique : plan.techniques) key += "|" + algos::technique_text(technique, true);
  for (const GpuConfig& gpu : plan.gpus) key += "|" + gpu.id;
  return key;
}

Settings settings_of(const RunPlan& plan) {
  return {.skip = skip_text(plan.skip),
          .engine = std::string(engine_name(plan.engine)),
          .detailed_sample = plan.timing.detailed_sample_ratio,
          .calibrated = plan.calibrated,
          .reference_samples = plan.reference_samples,
          .images = plan.images};
}

RunPlan make_plan(const Request& request, ConfigFiles& files) {
  std::vector<Diagnostic> problems;
  RunPlan plan = make_plan(request, files, problems);
  if (!problems.empty()) throw InputError(problems);
  return plan;
}

}  // namespace hwsim::lab
