#pragma once
// Where things lie on this machine. Functions of one source file, so that no other object file depends on the
// folder that the project was built in.
#include <string>

namespace hwsim::test {

std::string source_dir();  ///< the project's root
std::string shared_dir();  ///< further assets beside it; may be missing
std::string binary_dir();  ///< the build folder

}  // namespace hwsim::test
