#include "cli/terminal.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace hwsim::cli {
namespace {

bool set_and_not_empty(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

bool is_dumb() {
  const char* term = std::getenv("TERM");
  return term != nullptr && std::string_view(term) == "dumb";
}

bool decide(When when, bool automatic) {
  return when == When::always || (when == When::automatic && automatic);
}

void write_error(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

Terminal inspect_terminal(const CommonOptions& options) {
  Terminal terminal;
  terminal.output_is_terminal = isatty(STDOUT_FILENO) != 0;
  terminal.error_is_terminal = isatty(STDERR_FILENO) != 0;
  const bool plain = set_and_not_empty("NO_COLOR") || is_dumb();
  terminal.output_color = decide(options.color, terminal.output_is_terminal && !plain);
  terminal.error_color = decide(options.color, terminal.error_is_terminal && !plain);
  terminal.bar = decide(options.progress, terminal.error_is_terminal && !is_dumb());
  return terminal;
}

Log::Log(const CommonOptions& options, const Terminal& terminal)
    : verbosity_(options.verbosity), color_(terminal.error_color) {}

void Log::say(const std::string& line) {
  text_ += line + "\n";
  if (verbosity_ >= 0) write_error(line + "\n");
}

void Log::detail(const std::string& line) {
  text_ += line + "\n";
  if (verbosity_ > 0) write_error(line + "\n");
}

void Log::report(const Diagnostic& diagnostic) {
  text_ += render(diagnostic, false);
  if (verbosity_ >= 0 || diagnostic.severity == Severity::error) write_error(render(diagnostic, color_));
}

}  // namespace hwsim::cli
