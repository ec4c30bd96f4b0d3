#pragma once
// What the environment says of a lab. The program asks for it once; no lab looks there by itself.
#include "lab/base/lab_options.h"

namespace hwsim::lab {

/// Folders and limit by HWSIM_CONFIG_DIR, HWSIM_PAGE_DIR, HWSIM_CACHE (else hwsim in $XDG_CACHE_HOME, else in
/// ~/.cache, else in the system's temporary directory) and HWSIM_CACHE_MIB, HWSIM_SHARED_PASSES_MIB; the
/// other options are the defaults. Throws InputError U017.
LabOptions options_of_environment();

}  // namespace hwsim::lab
