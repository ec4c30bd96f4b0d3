#pragma once
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "cli/options.h"

namespace hwsim::cli {

/// A folder that appears only when all that belongs in it is there: written beside its place as
/// ".<name>.partial-<pid>" and renamed by commit(). Removed when it is not committed, on Ctrl-C too.
class RunDirectory {
 public:
  /// Throws InputError U013 when the place is taken (unless options.force and it holds results of hwsim) and
  /// U010 when it cannot be written.
  RunDirectory(const OutOptions& options, const std::string& id_source);
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const std::filesystem::path& partial() const { return partial_; }
  const std::filesystem::path& final_place() const { return final_; }
  std::string path(const std::string& name) const { return (partial_ / name).string(); }
  void commit();

 private:
  void point_latest_here() const;

  std::filesystem::path final_, partial_;
  bool replace_ = false, named_by_us_ = false, made_parent_ = false, committed_ = false;
};

/// While it lives, SIGINT and SIGTERM remove `folder` (when not empty) and end the process with status 130 or
/// 143, at once, whatever the other threads are doing. Signals are blocked in the threads started later. Make
/// it first.
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
