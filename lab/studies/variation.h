#pragma once
// A request and what is tried in its place: other overlays, other settings.
#include <string>
#include <vector>

#include "lab/request/plan.h"

namespace hwsim::lab {

struct Variation {
  std::string label;                  ///< as the comparison shows it
  std::vector<std::string> overlays;  ///< laid over the GPUs behind those of the request
  std::vector<Assignment> sets;       ///< act behind those of the request
};

/// What is to be tried, as words say it.
struct Trials {
  std::vector<std::string> overlays{};  ///< together with `sets` one variation
  std::vector<Assignment> sets{};
  std::vector<std::string> what_ifs{};            ///< overlays, each a variation; "a+b" lays both
  std::vector<std::vector<Assignment>> points{};  ///< each a variation
};

/// Labels are the words.
std::vector<Variation> variations_of(const Trials& trials);

/// The request with a variation. Appends what is wrong with the settings to `problems`.
Request varied(const Request& base, const Variation& variation, std::vector<Diagnostic>& problems);

/// The plan of the request, then one for each variation. Throws InputError with the problems of all; those of
/// the request alone when it has some, since each variation would repeat them.
std::vector<RunPlan> plans_of(const Request& base, const std::vector<Variation>& variations,
                              ConfigFiles& files);

}  // namespace hwsim::lab
