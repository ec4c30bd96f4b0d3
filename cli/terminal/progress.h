#pragma once
// The progress bar.
#include <chrono>
#include <mutex>
#include <string>

#include "cli/arguments/command.h"
#include "cli/terminal/terminal.h"

namespace hwsim::cli {

/// On a terminal a bar with the time left, redrawn in place; elsewhere a line every 10 %. On standard error
/// only. update() may be called from any thread.
class Progress {
 public:
  Progress(const CommonArguments& options, const Terminal& terminal);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(double done_ratio, const std::string& what);
  void finish();  ///< clears the bar

 private:
  void draw_bar(double done_ratio, const std::string& what);

  using Clock = std::chrono::steady_clock;
  std::mutex mutex_;
  Clock::time_point start_ = Clock::now(), last_draw_{};
  bool silent_, bar_;
  bool drawn_ = false;
  int printed_tenths_ = 0;
};

/// "12 s", "3 min 20 s".
std::string duration_text(double seconds);

}  // namespace hwsim::cli
