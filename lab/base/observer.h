#pragma once
// What the lab tells while it works. A program that wants to hear it implements the interface; the default is
// silent.
#include <filesystem>
#include <string>

#include "hwsim/base/diagnostics.h"

namespace hwsim::lab {

class Observer {
 public:
  Observer() = default;
  Observer(const Observer&) = default;
  Observer& operator=(const Observer&) = default;
  virtual ~Observer() = default;

  /// A line that everybody reads.
  virtual void say(const std::string& line) { (void)line; }
  /// A line for those who ask for more.
  virtual void detail(const std::string& line) { (void)line; }
  /// A note, a warning or an error.
  virtual void report(const Diagnostic& diagnostic) { (void)diagnostic; }

  /// The share of the work that is done, 0 to 1, and what is being done. May come from any thread. An
  /// exception ends the work, and comes out of the lab's function; the lab can be asked again.
  virtual void progress(double done_ratio, const std::string& what) {
    (void)done_ratio;
    (void)what;
  }
  virtual void progress_ended() {}

  /// A folder that is not complete yet, to be removed when the program is interrupted. An empty path: there
  /// is none.
  virtual void unfinished(const std::filesystem::path& folder) { (void)folder; }
};

}  // namespace hwsim::lab
