#pragma once
// What standard output and standard error are, judged apart, and the messages that go to the latter.
#include <string>
#include <vector>

#include "cli/options.h"
#include "hwsim/base/diagnostics.h"

namespace hwsim::cli {

struct Terminal {
  bool output_is_terminal = false;
  bool error_is_terminal = false;
  bool output_color = false;
  bool error_color = false;
  bool bar = false;  ///< a progress bar is drawn in place
};

/// NO_COLOR (set, not empty) and TERM=dumb win over `auto`, a flag wins over them.
Terminal inspect_terminal(const CommonOptions& options);

/// Messages: to standard error as they come, and kept for log.txt.
class Log {
 public:
  Log(const CommonOptions& options, const Terminal& terminal);
  void say(const std::string& line);     ///< not with --quiet
  void detail(const std::string& line);  ///< with --verbose
  void report(const Diagnostic& diagnostic);
  const std::string& text() const { return text_; }

 private:
  int verbosity_;
  bool color_;
  std::string text_;
};

/// What every command is given beside its own options.
struct Context {
  std::vector<std::string> arguments;  ///< argv, for the manifest
  Terminal terminal;
  Log log;
};

}  // namespace hwsim::cli
