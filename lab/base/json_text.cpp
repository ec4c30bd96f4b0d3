#include "lab/base/json_text.h"

#include <nlohmann/json.hpp>

namespace hwsim::lab {

std::string json_text(const nlohmann::ordered_json& json, int indent) {
  using Handler = nlohmann::ordered_json::error_handler_t;
  std::string text = json.dump(indent, ' ', true, Handler::replace);
  for (std::size_t at = 0; (at = text.find('\x7f', at)) != std::string::npos; at += 6)
    text.replace(at, 1, "\\u007f");  // the one control character that JSON takes as it is
  return indent < 0 ? text : text + "\n";
}

}  // namespace hwsim::lab
