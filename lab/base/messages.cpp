#include "lab/base/messages.h"

namespace hwsim::lab {

Diagnostic problem(std::string code, std::string message, std::string hint, std::string help) {
  Diagnostic d;
  d.code = std::move(code);
  d.message = std::move(message);
  d.hint = std::move(hint);
  d.help = std::move(help);
  return d;
}

void fail(std::string code, std::string message, std::string hint, std::string help) {
  throw InputError(problem(std::move(code), std::move(message), std::move(hint), std::move(help)));
}

void fail_usage(std::string code, std::string message, std::string hint, std::string help) {
  throw InputError(problem(std::move(code), std::move(message), std::move(hint), std::move(help)),
                   ExitStatus::usage);
}

}  // namespace hwsim::lab
