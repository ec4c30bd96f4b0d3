#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "hwsim/base/file_name.h"
#include "hwsim/config/settings.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/studies/axes.h"

namespace hwsim::cli {
namespace {

bool is_result(const std::string& input) {
  std::error_code error;
  return std::filesystem::is_directory(input, error) || has_extension(input, ".json");
}

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

/// --set and --overlay together are one variation; each what-if and each point of --vary is another.
std::vector<Variation> variations_of(const CompareOptions& options) {
  std::vector<Variation> variations;
  if (!options.view.sets.empty() || !options.overlays.empty()) {
    std::vector<std::string> words = options.overlays;
    words.insert(words.end(), options.view.sets.begin(), options.view.sets.end());
    variations.push_back({joined(words), options.overlays, parse_sets(options.view.sets)});
  }
  for (const std::string& list : options.what_ifs)
    for (const std::string& what_if : split(list, ','))
      variations.push_back({what_if, split(what_if, '+'), {}});
  if (options.vary.empty()) return variations;
  for (std::vector<Assignment>& point :
       combine(parse_axes(options.vary), options.zip ? Combine::zip : Combine::grid)) {
    std::vector<std::string> words;
    for (const Assignment& set : point) words.push_back(set.path + "=" + set.value);
    variations.push_back({joined(words), {}, std::move(point)});
  }
  return variations;
}

Comparison simulate(const CompareOptions& options, Context& context) {
  RunOptions base = options;
  base.view.scene = options.inputs.front();
  base.view.sets.clear();
  base.overlays.clear();
  const Request request = request_of(base);
  return Lab(lab_options(options, context.log)).compare(request, variations_of(options));
}

Comparison read_all(const CompareOptions& options) {
  std::vector<LabeledResult> results;
  for (const std::string& input : options.inputs)
    for (LabeledResult& result : read_results(input)) results.push_back(std::move(result));
  if (results.size() < 2)
    fail_usage("U002", "there is nothing to compare `" + options.inputs.front() + "` with", "",
               "give the folders of two runs");
  return lab::compare(results);
}

}  // namespace

ExitStatus compare(const CompareOptions& options, Context& context) {
  const bool results_given = std::any_of(options.inputs.begin(), options.inputs.end(), is_result);
  if (!results_given && options.inputs.size() > 1)
    fail_usage("U004", "one scene, or the folders of several results, can be compared", "",
               "`hwsim run SCENE --out DIR` for each scene, then `hwsim compare DIR DIR`");
  const Comparison comparison = results_given ? read_all(options) : simulate(options, context);
  const nlohmann::ordered_json json = to_json(comparison);
  print({.table = pass_comparison(comparison),
         .heading = to_text(frame_comparison(comparison)) + "\n",
         .footing = options.counters ? "\n" + to_text(counter_comparison(comparison)) : std::string(),
         .json = &json},
        options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
