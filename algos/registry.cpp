// The techniques, family by family. A family lists its own in a table beside its code; a new family is one
// line here.
#include "algos/deferred.h"
#include "algos/forward_techniques.h"
#include "algos/sss.h"
#include "algos/technique.h"
#include "algos/wire_aa.h"

namespace hwsim::algos {
namespace {

constexpr std::span<const TechniqueInfo> (*kFamilies[])() = {
    forward_techniques,
    deferred_techniques,
    sss_techniques,
    wire_techniques,
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
