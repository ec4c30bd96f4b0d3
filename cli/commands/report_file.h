#pragma once
// The page that `hwsim report` and the flag --report write.
#include <functional>
#include <string>

#include "cli/arguments/command.h"
#include "cli/terminal/terminal.h"
#include "lab/lab.h"

namespace hwsim::cli {

/// A place that cannot take a page is told before the work. Throws InputError U010, and U013 for a file that
/// is there already, unless `force` replaces it.
void check_report_place(const std::string& file, bool force);

/// Writes what `gather` gives to the file; nothing without a name.
void write_report(const Lab& lab, const std::string& file, Context& context,
                  const std::function<Report()>& gather);

}  // namespace hwsim::cli
