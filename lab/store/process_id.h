#pragma once
// Which process of which machine did something, and whether it still lives.
#include <string>

namespace hwsim::lab {

/// "host 4711 8812": the machine, the process, and when it started, as numbers of processes are used again.
std::string own_process_id();

/// Whether the process is known to have ended. Of another machine's processes nothing is known, nor of a text
/// that own_process_id() did not write.
bool has_ended(const std::string& process_id);

}  // namespace hwsim::lab
