#pragma once
#include <string>
#include <vector>

#include "pipeline/image/module/image_module.h"

namespace hwsim::pipeline {

/// Where the image module is looked for, in this order: $HWSIM_MODULE_DIR, ../lib and . from the program's
/// folder, the folder where the project is installed.
std::vector<std::string> image_module_paths();

/// Opens the module at the first call (0.26 s). Throws InputError (I001) that lists the paths tried.
const HwsimImageModule& image_module();

}  // namespace hwsim::pipeline
