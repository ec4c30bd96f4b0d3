#pragma once
// Finds and opens the image module when the first file is read or written.
#include <string>
#include <vector>

#include "pipeline/image/module/image_module.h"

namespace hwsim::pipeline {

/// Where the image module is looked for, in this order: $HWSIM_MODULE_DIR, ../lib and . from the program's
/// folder, the folder where the project is installed; last its name alone, which the system's loader looks
/// for where the library or program that holds this code says (RUNPATH): a module of Python is no program.
std::vector<std::string> image_module_paths();

/// Opens the first of the paths that exists and is a module of this version. Throws InputError (I001) with
/// what was wrong with each.
const HwsimImageModule& open_image_module(const std::vector<std::string>& paths);

/// Opens the module at the first call (0.26 s). Throws as above.
const HwsimImageModule& image_module();

}  // namespace hwsim::pipeline
