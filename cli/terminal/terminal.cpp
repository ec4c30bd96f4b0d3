#include "cli/terminal/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "cli/terminal/progress.h"
#include "hwsim/base/printable.h"
#include "lab/catalog/remedies.h"

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

Terminal inspect_terminal(const CommonArguments& options) {
  Terminal terminal;
  terminal.output_is_terminal = isatty(STDOUT_FILENO) != 0;
  terminal.error_is_terminal = isatty(STDERR_FILENO) != 0;
  const bool plain = set_and_not_empty("NO_COLOR") || is_dumb();
  terminal.output_color = decide(options.color, terminal.output_is_terminal && !plain);
  terminal.error_color = decide(options.color, terminal.error_is_terminal && !plain);
  if (terminal.output_is_terminal) {
    winsize size{};
    const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0;
    terminal.columns = known ? size.ws_col : 80;
    terminal.lines = known ? size.ws_row : 24;
  }
  terminal.bar = decide(options.progress, terminal.error_is_terminal && !is_dumb());
  return terminal;
}

Log::Log(const CommonArguments& options, const Terminal& terminal) : options_(options), terminal_(terminal) {}

void Log::say(const std::string& line) {
  text_ += line + "\n";
  if (options_.verbosity >= 0) write_error(printable(line) + "\n");
}

void Log::detail(const std::string& line) {
  text_ += line + "\n";
  if (options_.verbosity > 0) write_error(printable(line) + "\n");
}

void Log::report(const Diagnostic& given) {
  Diagnostic diagnostic = given;  // every message says how to go on
  if (diagnostic.help.empty()) diagnostic.help = remedy_of(diagnostic.code);
  text_ += render(diagnostic, false);
  if (options_.verbosity >= 0 || diagnostic.severity == Severity::error)
    write_error(render(diagnostic, terminal_.error_color));
}

void Log::progress(double done_ratio, const std::string& what) {
  if (!bar_) bar_ = std::make_shared<Progress>(options_, terminal_);
  bar_->update(done_ratio, what);
}

void Log::progress_ended() {
  if (bar_) bar_->finish();
  bar_.reset();
}

void Context::suggest(const std::string& command) {
  if (terminal.error_is_terminal) log.say("next: " + command);
}

}  // namespace hwsim::cli
