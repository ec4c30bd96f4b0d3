#pragma once
// What Ctrl-C does while a command works.
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

namespace hwsim::cli {

/// While it lives, SIGINT, SIGTERM and SIGHUP (unless it is ignored, as by nohup) remove `folder` (when not
/// empty) and end the process with status 130, 143 or 129, at once, whatever the other threads are doing.
/// Signals are blocked in the threads started later. Make it first.
class InterruptGuard {
 public:
  explicit InterruptGuard(std::string message = "interrupted: nothing was kept");
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  void remove_on_interrupt(const std::filesystem::path& folder);
  void keep();  ///< nothing is left to remove

 private:
  void wait();

  std::mutex mutex_;
  std::string message_;
  std::filesystem::path folder_;
  std::thread thread_;
};

}  // namespace hwsim::cli
