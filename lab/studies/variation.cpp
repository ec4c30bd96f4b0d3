#include "lab/studies/variation.h"

namespace hwsim::lab {

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
