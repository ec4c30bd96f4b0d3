#pragma once
// What the files of the cache are, in words.
#include <string>

#include "lab/store/cache.h"

namespace hwsim::lab {

/// "work of msaa4x of sponza_hall, 320x180". Reads the file.
std::string entry_title(const CachedFile& file, const Cache& cache);

}  // namespace hwsim::lab
