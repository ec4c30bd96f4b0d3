#include "lab/store/process_id.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <sstream>

namespace hwsim::lab {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "unknown";
}

/// Field 22 of /proc/PID/stat (proc(5)), counted behind the name, which may hold blanks. Empty: no process.
std::string start_of(const std::string& process) {
  std::ifstream file("/proc/" + process + "/stat");
  std::string line;
  std::getline(file, line);
  const std::size_t name_end = line.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream fields(line.substr(name_end + 1));
  constexpr int kStartField = 22, kFirstField = 3;
  std::string field;
  for (int i = kFirstField; i <= kStartField; ++i) fields >> field;
  return field;
}

}  // namespace

std::string own_process_id() {
  const std::string process = std::to_string(::getpid());
  return fmt::format("{} {} {}", host_name(), process, start_of(process));
}

bool has_ended(const std::string& process_id) {
  std::istringstream words(process_id);
  std::string host, process, start, more;
  const bool is_ours = static_cast<bool>(words >> host >> process >> start) && !(words >> more) &&
                       process.find_first_not_of("0123456789") == std::string::npos;
  return is_ours && host == host_name() && start_of(process) != start;
}

}  // namespace hwsim::lab
