#pragma once
// A run of the program with a witness inside: which libraries it loads, which files it opens, how often it
// allocates.
#include <cstddef>
#include <string>
#include <vector>

#include "cli/program.h"

namespace hwsim::cli::test {

struct Witnessed {
  Outcome outcome;
  std::vector<std::string> linked;   ///< shared libraries before main
  std::vector<std::string> loaded;   ///< shared libraries at the end
  std::vector<std::string> read;     ///< files opened to read, each time that they were
  std::vector<std::string> written;  ///< files opened to write, likewise
  std::size_t allocations = 0;       ///< calls of malloc, calloc and realloc
  std::size_t allocated_bytes = 0;   ///< the sum of what they asked for

  /// How many of `paths` contain `part`.
  static std::size_t count(const std::vector<std::string>& paths, const std::string& part);
};

/// Whether this build can be watched: the sanitizers have an allocator of their own.
bool has_witness();

/// Runs "hwsim ARGUMENTS" as Workplace::hwsim does.
Witnessed watch(const Workplace& place, const std::string& arguments, const std::string& environment = "");

}  // namespace hwsim::cli::test
