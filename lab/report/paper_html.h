#pragma once
// A paper's tables as HTML, in the paper's layout.
#include <string>

#include "lab/studies/paper_layout.h"

namespace hwsim::lab {

/// A cell has the published value, the predicted one and the error, whose size its class says too.
std::string html_paper_table(const PaperTable& table, const Reproduction& reproduction);

/// Why rows are not predicted, or not fitted.
std::string paper_notes(const Reproduction& reproduction);

}  // namespace hwsim::lab
