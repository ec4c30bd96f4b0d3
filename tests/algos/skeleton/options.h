#pragma once
// Options of the skeleton.
#include "algos/base/options.h"

namespace hwsim::algos {

/// Fields have the defaults that users see. A number of things is an int, any other number a double; what has
/// names is an enum class or a bool.
struct SkeletonOptions {
  int samples = 4;
  double tolerance = 0.0;  ///< linear color
  bool centroid = true;
};

/// Declares each field once: its name, its range or choices, and a sentence. Parsing, `hwsim show`,
/// completion and messages follow from it.
void describe(OptionList& list, SkeletonOptions& o);

}  // namespace hwsim::algos
