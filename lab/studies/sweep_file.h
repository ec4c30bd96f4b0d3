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

/// Throws InputError U013 when a file exists that must not, and U021 when it cannot be opened or is no sweep
/// of this version with nothing of anybody else's in it. No byte of a file that was there has changed by
/// then.
Database open_sweep(const std::string& path, SweepAccess access);

/// Makes the database ready for several writers, and empties the one that is replaced.
void begin_writing(Database& database, SweepAccess access);

}  // namespace hwsim::lab
