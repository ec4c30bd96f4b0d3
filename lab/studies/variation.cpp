#include "lab/studies/variation.h"

#include <fmt/format.h>

#include "lab/base/text.h"

namespace hwsim::lab {
namespace {

Variation labeled(const std::vector<std::string>& overlays, const std::vector<Assignment>& sets) {
  std::vector<std::string> words = overlays;
  for (const Assignment& set : sets) words.push_back(set.path + "=" + set.value);
  return {fmt::format("{}", fmt::join(words, " ")), overlays, sets};
}

}  // namespace

std::vector<Variation> variations_of(const Trials& trials) {
  std::vector<Variation> variations;
  if (!trials.sets.empty() || !trials.overlays.empty())
    variations.push_back(labeled(trials.overlays, trials.sets));
  for (const std::string& what_if : trials.what_ifs) variations.push_back({what_if, split(what_if, '+'), {}});
  for (const std::vector<Assignment>& point : trials.points) variations.push_back(labeled({}, point));
  return variations;
}

Request varied(const Request& base, const Variation& variation, std::vector<Diagnostic>& problems) {
  Request request = base;
  request.overlays.insert(request.overlays.end(), variation.overlays.begin(), variation.overlays.end());
  apply(request, variation.sets, problems);
  return request;
}

std::vector<RunPlan> plans_of(const Request& base, const std::vector<Variation>& variations,
                              ConfigFiles& files) {
  std::vector<RunPlan> plans = {make_plan(base, files)};
  std::vector<Diagnostic> problems;
  for (const Variation& variation : variations)
    plans.push_back(make_plan(varied(base, variation, problems), files, problems));
  if (!problems.empty()) throw InputError(problems);
  return plans;
}

}  // namespace hwsim::lab
