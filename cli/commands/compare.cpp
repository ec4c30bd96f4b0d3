#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cli/arguments/argument_values.h"
#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/progress.h"
#include "hwsim/base/file_name.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/results/results.h"
#include "lab/studies/axes.h"
#include "lab/studies/comparison.h"

namespace hwsim::cli {
namespace {

/// What differs from the baseline in one column of the comparison.
struct Variant {
  std::string label;
  std::vector<std::string> overlays, sets;
};

bool is_result(const std::string& input) {
  std::error_code error;
  return std::filesystem::is_directory(input, error) || has_extension(input, ".json");
}

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

/// --set and --overlay together are one variant; each what-if and each point of --vary is another.
std::vector<Variant> variants_of(const CompareOptions& options) {
  std::vector<Variant> variants;
  if (!options.view.sets.empty() || !options.overlays.empty()) {
    std::vector<std::string> words = options.overlays;
    words.insert(words.end(), options.view.sets.begin(), options.view.sets.end());
    variants.push_back({joined(words), options.overlays, options.view.sets});
  }
  for (const std::string& list : options.what_ifs)
    for (const std::string& what_if : split(list, ','))
      variants.push_back({what_if, split(what_if, '+'), {}});
  if (options.vary.empty()) return variants;
  const auto points = combine(parse_axes(options.vary), options.zip ? Combine::zip : Combine::grid);
  for (const std::vector<Assignment>& point : points) {
    Variant variant;
    for (const Assignment& set : point) variant.sets.push_back(set.path + "=" + set.value);
    variant.label = joined(variant.sets);
    variants.push_back(std::move(variant));
  }
  return variants;
}

RunPlan plan_of(const CompareOptions& options, const Variant& variant, ConfigFiles& files) {
  RunOptions run = options;
  run.view.scene = options.inputs.front();
  run.view.sets = variant.sets;
  run.overlays = variant.overlays;
  run.no_image = true;
  return plan_of(run, files);
}

class PointRunner {
 public:
  PointRunner(const CompareOptions& options, Context& context)
      : context_(context),
        store_({.jobs = options.common.jobs, .disk = !options.no_cache}, context.log),
        progress_(options.common, context.terminal) {}

  void run(const RunPlan& plan, const std::string& label, std::vector<ComparedResult>& results) {
    if (!scene_ || !(scene_->plan() == plan.view))
      scene_ = std::make_unique<SceneView>(plan.view, context_.log);
    Simulator simulator(plan, *scene_, nullptr, store_);
    const bool several = plan.techniques.size() * plan.gpus.size() > 1;
    for (const algos::TechniqueChoice& technique : plan.techniques)
      for (const GpuConfig& gpu : plan.gpus) {
        const std::string point = technique_text(technique) + " on " + gpu.id;
        const PointResult result = simulator.run(technique, gpu, [&](double done, const std::string& pass) {
          progress_.update(done, point + ": " + pass);
        });
        const std::string name = !several ? label : label.empty() ? point : point + " " + label;
        results.push_back({name, result_json(result, plan, scene_->summary().name)});
      }
  }

 private:
  Context& context_;
  TraceStore store_;
  Progress progress_;
  std::unique_ptr<SceneView> scene_;
};

/// Every variant is planned before the first is run: mistakes are reported first.
std::vector<ComparedResult> simulate(const CompareOptions& options, Context& context) {
  std::vector<Variant> variants = variants_of(options);
  variants.insert(variants.begin(), Variant{});
  ConfigFiles files;
  std::vector<RunPlan> plans;
  std::vector<Diagnostic> problems;
  for (const Variant& variant : variants) try {
      plans.push_back(plan_of(options, variant, files));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
      if (plans.empty()) break;  // the baseline: the variants would repeat its mistakes
    }
  if (!problems.empty()) throw InputError(problems);
  const size_t points = plans.front().techniques.size() * plans.front().gpus.size();
  if (points * plans.size() < 2)
    fail_usage("U002", "there is nothing to compare the result with", "",
               "two results, two techniques or GPUs, --set, --overlay, --vary or --what-if");
  context.log.say(
      fmt::format("plan: {}, {} results to compare", plans.front().view.scene, points * plans.size()));
  PointRunner runner(options, context);
  std::vector<ComparedResult> results;
  for (size_t i = 0; i < plans.size(); ++i)
    runner.run(plans[i], i == 0 && points == 1 ? "baseline" : variants[i].label, results);
  return results;
}

std::vector<ComparedResult> read_all(const CompareOptions& options) {
  std::vector<ComparedResult> results;
  for (const std::string& input : options.inputs)
    for (ComparedResult& result : read_results(input)) results.push_back(std::move(result));
  if (results.size() < 2)
    fail_usage("U002", "there is nothing to compare `" + options.inputs.front() + "` with", "",
               "give the folders of two runs");
  return results;
}

}  // namespace

ExitStatus compare(const CompareOptions& options, Context& context) {
  const bool results_given = std::any_of(options.inputs.begin(), options.inputs.end(), is_result);
  if (!results_given && options.inputs.size() > 1)
    fail_usage("U004", "one scene, or the folders of several results, can be compared", "",
               "`hwsim run SCENE --out DIR` for each scene, then `hwsim compare DIR DIR`");
  const std::vector<ComparedResult> results = results_given ? read_all(options) : simulate(options, context);
  const nlohmann::ordered_json json = comparison_json(results);
  const std::string footing = options.counters ? "\n" + to_text(counter_comparison(results)) : std::string();
  print({.table = pass_comparison(results),
         .heading = to_text(frame_comparison(results)) + "\n",
         .footing = footing,
         .json = &json},
        options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
