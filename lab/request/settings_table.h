#pragma once
// All that `--set` takes, but for the options of techniques and of generators, which `show` lists.
#include "lab/base/table.h"

namespace hwsim::lab {

/// One row a setting: its path, its range or its words, and what it is.
Table settings_table();

}  // namespace hwsim::lab
