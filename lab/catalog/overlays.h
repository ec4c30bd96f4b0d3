#pragma once
// Overlays that come with hwsim (configs/overlays): what-ifs and hardware wishes, a file each.
#include <string>
#include <vector>

#include "lab/base/table.h"

namespace hwsim::lab {

std::vector<std::string> overlay_names();

/// The file of an overlay: a path that ends in .toml as it is, a name from the folder. Throws InputError
/// U018.
std::string overlay_file(const std::string& name_or_path);

/// Name, what it is, what it changes.
Table overlay_catalog();

}  // namespace hwsim::lab
