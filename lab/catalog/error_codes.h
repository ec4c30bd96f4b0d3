#pragma once
// The codes of all messages, with explanations.
#include <span>
#include <string_view>
#include <vector>

namespace hwsim::lab {

struct ErrorCode {
  std::string_view code, title, explanation;
  std::string_view remedy{};  ///< how to go on; empty for notes
};

/// Every code of a message, sorted. A test compares them with those that the sources use.
std::vector<ErrorCode> error_codes();

}  // namespace hwsim::lab
