#pragma once
// The points of a sweep as rows. A database is read as if a stranger had written it: whatever is not what
// `hwsim sweep` writes is an error with its place.
#include <string>

#include "lab/base/table.h"
#include "lab/store/database.h"

namespace hwsim::lab {

/// Every point in order, with a column for all that is varied. Valid as long as the database. Asking for the
/// rows, and this function, throw InputError U021 for values of a wrong type or outside of their range;
/// `path` names the file in it.
RowSource point_rows(Database& database, const std::string& path);

/// Throws InputError U021 where a row of a point or of a pass is none that `hwsim sweep` writes.
void require_valid_rows(Database& database, const std::string& path);

}  // namespace hwsim::lab
