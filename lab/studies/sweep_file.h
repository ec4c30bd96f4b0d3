#pragma once
// Which file is the database of a sweep: its first bytes say so. SQLite never opens a file of another
// program, and nothing is written to one.
#include <string>

#include "lab/store/database.h"

namespace hwsim::lab {

/// What is meant to be done with the database of a sweep.
enum class SweepAccess {
  look,    ///< it is there and is only read
  create,  ///< it must not be there yet
  go_on,   ///< it is made when it is not there
  replace  ///< as go_on, then emptied in one transaction
};

/// Throws InputError U013 when a file exists that must not, and U021 when it is no sweep of this version
/// (`replace` takes every version) or cannot be opened. The file is then as it was before.
Database open_sweep(const std::string& path, SweepAccess access);

}  // namespace hwsim::lab
