// The techniques, family by family. A family lists its own in a table beside its code; a new family is one
// line here.
#include "algos/agaa/agaa.h"
#include "algos/deferred/deferred.h"
#include "algos/filters/post_filters.h"
#include "algos/forward/forward.h"
#include "algos/sbaa/sbaa.h"
#include "algos/sss/sss.h"
#include "algos/techniques.h"
#include "algos/wire/wire_aa.h"

namespace hwsim::algos {
namespace {

constexpr std::span<const TechniqueInfo> (*kFamilies[])() = {
    forward_techniques, deferred_techniques, sbaa_techniques, agaa_techniques,
    sss_techniques,     wire_techniques,     post_filters,
};

}  // namespace

std::span<const TechniqueInfo> techniques() {
  static const std::vector<TechniqueInfo> all = [] {
    std::vector<TechniqueInfo> list;
    for (const auto family : kFamilies) list.insert(list.end(), family().begin(), family().end());
    return list;
  }();
  return all;
}

}  // namespace hwsim::algos
