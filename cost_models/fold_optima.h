#pragma once
// The optima of a validation's fits as CSV: a row for each fold, a column for each parameter. The next
// validation of the same rows begins there.
#include <string>
#include <vector>

#include "cost_models/validation.h"

namespace hwsim::cost_models {

/// Values, not their logarithms, with digits enough to read the same numbers back.
std::string to_csv(const std::vector<FoldOptimum>& optima, const std::vector<FittedParameter>& parameters);

/// A parameter that the file does not name gets its declared start. Throws InputError M009 for a split that
/// does not exist and for what is no positive number.
std::vector<FoldOptimum> load_fold_optima(const std::string& path,
                                          const std::vector<FittedParameter>& parameters);

}  // namespace hwsim::cost_models
