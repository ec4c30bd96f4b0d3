#pragma once
// A little work for a GPU that a fuzz target has loaded: numbers that are in their ranges give times.
#include <cmath>

#include "fuzz/fuzz_input.h"
#include "hwsim/sample_gpu.h"

namespace hwsim::fuzz {

inline void check_times(const WorkTrace& trace, const GpuConfig& gpu, Engine engine) {
  const FrameTiming timing = time_frame(trace, gpu, engine);
  require(std::isfinite(timing.time_ns) && timing.time_ns >= 0.0, "a time is a number");
  const std::vector<std::string> laws = check_timing(timing, trace, gpu);
  if (!laws.empty()) broken(laws.front());
}

inline void check_times(const GpuConfig& gpu) {
  static const WorkTrace trace = [] {
    WorkTrace made;
    made.passes = {test::busy_pass(3), test::fill_pass(Format::rgba16_float, true, 4096, 2)};
    return made;
  }();
  for (const Engine engine : {Engine::roofline, Engine::queue}) check_times(trace, gpu, engine);
}

}  // namespace hwsim::fuzz
