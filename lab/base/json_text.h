#pragma once
// JSON as it is written to files and terminals.
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hwsim::lab {

/// Everything but ASCII is escaped, so that a name from a file cannot move a terminal's cursor; bytes that
/// are no UTF-8 become U+FFFD. Ends with a line end where it is indented; `indent` -1: one line.
std::string json_text(const nlohmann::ordered_json& json, int indent = 2);

}  // namespace hwsim::lab
