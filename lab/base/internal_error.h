#pragma once
// What hwsim says when it, not its user, is wrong.
#include <stdexcept>

namespace hwsim::lab {

/// A law that hwsim itself broke. Not the user's mistake: exit status 1, and the manifest is printed to
/// attach.
class InternalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hwsim::lab
