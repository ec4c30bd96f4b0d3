#pragma once
// Progress over stages that take about as long as each other. The observer hears of the end also when an
// error ends the work.
#include <cstddef>
#include <string>

#include "lab/base/observer.h"

namespace hwsim::lab {

class StageProgress {
 public:
  StageProgress(Observer& observer, std::size_t stages) : observer_(observer), stages_(stages) {}
  ~StageProgress() { observer_.progress_ended(); }
  StageProgress(const StageProgress&) = delete;
  StageProgress& operator=(const StageProgress&) = delete;

  /// `done_ratio` is that of the stage, 0 to 1. May come from any thread.
  void update(double done_ratio, const std::string& what) const {
    if (stages_ > 0)
      observer_.progress((static_cast<double>(stage_) + done_ratio) / static_cast<double>(stages_), what);
  }
  void next(const std::string& what) {
    ++stage_;
    update(0.0, what);
  }

 private:
  Observer& observer_;
  std::size_t stages_, stage_ = 0;
};

}  // namespace hwsim::lab
