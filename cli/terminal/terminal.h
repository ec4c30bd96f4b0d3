#pragma once
// What standard output and standard error are, judged apart, and the messages that go to the latter.
#include <memory>
#include <string>
#include <vector>

#include "cli/arguments/command.h"
#include "hwsim/base/diagnostics.h"
#include "lab/base/observer.h"

namespace hwsim::cli {

struct Terminal {
  bool output_is_terminal = false;
  bool error_is_terminal = false;
  bool output_color = false;
  bool error_color = false;
  bool bar = false;         ///< a progress bar is drawn in place
  std::size_t columns = 0;  ///< width of standard output; 0: it is no terminal
  std::size_t lines = 0;
};

/// NO_COLOR (set, not empty) and TERM=dumb win over `auto`, a flag wins over them.
Terminal inspect_terminal(const CommonArguments& options);

class Progress;

/// Messages: to standard error as they come, and kept for log.txt.
class Log : public lab::Observer {
 public:
  Log(const CommonArguments& options, const Terminal& terminal);
  void say(const std::string& line) override;     ///< not with --quiet
  void detail(const std::string& line) override;  ///< with --verbose
  void report(const Diagnostic& diagnostic) override;
  void progress(double done_ratio, const std::string& what) override;  ///< a bar, or a line every 10 %
  void progress_ended() override;
  const std::string& text() const { return text_; }

 private:
  CommonArguments options_;
  Terminal terminal_;
  std::shared_ptr<Progress> bar_;  ///< while there is progress to show
  std::string text_;
};

/// What every command is given beside its own options.
struct Context {
  std::vector<std::string> arguments;  ///< argv, for the manifest
  Terminal terminal;
  Log log;

  /// The command that most ask for next: a last line for who sits before a terminal.
  void suggest(const std::string& command);
};

}  // namespace hwsim::cli
