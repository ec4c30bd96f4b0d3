#pragma once
// When the units of a GPU work on the passes of a frame, as the queue engine has it.
#include <array>
#include <optional>
#include <vector>

#include "hwsim/gpu/gpu_config.h"
#include "hwsim/trace/work_trace.h"

namespace hwsim {

/// From the begin of a unit's first work on a pass to the end of its last, counted from the begin of the
/// frame.
struct UnitSpan {
  double begin_ns = 0.0, end_ns = 0.0;
};

/// A pass begins when the one before it has ended, with what it waits for; none: the unit has no work in it.
struct PassSchedule {
  double begin_ns = 0.0, end_ns = 0.0;
  std::array<std::optional<UnitSpan>, kUnitCount> units{};
};

std::vector<PassSchedule> frame_schedule(const WorkTrace& trace, const GpuConfig& gpu);

}  // namespace hwsim
