#pragma once
// Words that came twice in a list.
#include "cli/arguments/command.h"
#include "lab/base/observer.h"

namespace hwsim::cli {

/// Each technique, GPU, what-if, value of `--vary`, paper and input once, at its first place; what came again
/// is told in one note. Equal points would be emulated, timed and shown again, and share one folder. `--zip`
/// pairs values, and folders to be compared are sides: those stay.
void drop_repeats(Command& command, lab::Observer& log);

}  // namespace hwsim::cli
