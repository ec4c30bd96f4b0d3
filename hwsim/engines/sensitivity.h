#pragma once
// What a frame's time would do: by the exact derivative of the engine for every number of the GPU, by timing
// anew for switches and whole numbers, and by taking one unit's work away.
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "hwsim/engines/timing.h"

namespace hwsim {

struct Sensitivity {
  std::string_view key;
  double value = 0.0;
  double slope_ns = 0.0;             ///< d(frame time) / d(value)
  double elasticity = 0.0;           ///< percent of time a percent of value; negative: more of it is faster
  std::optional<double> doubled_ns;  ///< the frame's time with twice the value; none where that is no GPU
};

/// One entry a real number that enters the timing of a GPU of this kind, in file order. At a kink (two units
/// equally late) it is the derivative of one side.
std::vector<Sensitivity> sensitivities(const WorkTrace& trace, const GpuConfig& gpu, Engine engine);

struct UnitHeadroom {
  Unit unit = Unit::fe;
  double time_ns = 0.0;  ///< time of the frame if this unit took none: the most that a faster one can bring
};

/// Units that have work, the largest gain first.
std::vector<UnitHeadroom> headroom(const WorkTrace& trace, const GpuConfig& gpu, Engine engine);

}  // namespace hwsim
