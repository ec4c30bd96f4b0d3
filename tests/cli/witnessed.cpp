#include "cli/witnessed.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>

namespace hwsim::cli::test {
namespace {

#ifdef HWSIM_WITNESS_LIBRARY
constexpr const char* kLibrary = HWSIM_WITNESS_LIBRARY;
#else
constexpr const char* kLibrary = "";
#endif
constexpr const char* kReport = "witness.txt";

}  // namespace

std::size_t Witnessed::count(const std::vector<std::string>& paths, const std::string& part) {
  return static_cast<std::size_t>(std::count_if(paths.begin(), paths.end(), [&](const std::string& path) {
    return path.find(part) != std::string::npos;
  }));
}

bool has_witness() { return *kLibrary != '\0'; }

Witnessed watch(const Workplace& place, const std::string& arguments, const std::string& environment) {
  Witnessed seen;
  seen.outcome =
      place.hwsim(arguments, environment + " HWSIM_WITNESS=" + kReport + " LD_PRELOAD=" + kLibrary);
  std::istringstream lines(place.read(kReport));
  std::filesystem::remove(place / kReport);
  for (std::string line; std::getline(lines, line);) {
    const auto blank = line.find(' ');
    const std::string what = line.substr(0, blank), value = line.substr(blank + 1);
    if (what == "linked") seen.linked.push_back(value);
    if (what == "loaded") seen.loaded.push_back(value);
    if (what == "read") seen.read.push_back(value);
    if (what == "write") seen.written.push_back(value);
    if (what == "allocations") seen.allocations = std::stoul(value);
    if (what == "allocated_bytes") seen.allocated_bytes = std::stoul(value);
  }
  if (seen.linked.empty() || seen.allocations == 0) throw std::runtime_error("the witness reported nothing");
  return seen;
}

}  // namespace hwsim::cli::test
