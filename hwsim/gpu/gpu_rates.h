#pragma once
// What the timing engines use: costs in nanoseconds an item, derived from a GpuConfig after every override.
// No file can set them, so doubling a base value cannot leave a stale product behind. T is double, or a Jet
// while fitting.
#include "hwsim/base/units_of_measure.h"
#include "hwsim/gpu/gpu_config.h"
#include "hwsim/units/units.h"

namespace hwsim {

#define HWSIM_PART_RATES(id, Name) units::Name::Rates<T>,
template <class T>
struct GpuRates : HWSIM_GPU_PARTS(HWSIM_PART_RATES) NoValues {
  using Scalar = T;
};
#undef HWSIM_PART_RATES

/// In the order of the units: each may use what those before it derived.
template <class T>
GpuRates<T> derive_rates(const GpuValues<T>& c) {
  GpuRates<T> r;
  const T clk_ns = kNsPerUs / c.core_clock_mhz;
#define HWSIM_PART_DERIVES(id, Name) units::Name::derive(c, clk_ns, r);
  HWSIM_GPU_PARTS(HWSIM_PART_DERIVES)
#undef HWSIM_PART_DERIVES
  return r;
}

}  // namespace hwsim
