#include "support/places.h"

namespace hwsim::test {

std::string source_dir() { return HWSIM_SOURCE_DIR; }
std::string shared_dir() { return HWSIM_SOURCE_DIR "/../shared"; }
std::string binary_dir() { return HWSIM_BINARY_DIR; }

}  // namespace hwsim::test
