#pragma once
// What a frame's time would do if numbers of the GPU changed: exact derivatives for little more than the time
// itself, as only what lies on the longest path is differentiated.
#include <span>
#include <string>
#include <vector>

#include "hwsim/gpu/gpu_config.h"
#include "hwsim/timing/dual.h"
#include "hwsim/timing/time_pass.h"

namespace hwsim {

class TimeSlopes {
 public:
  /// `keys`: real numbers of the GPU that enter the timing, by their names in a file; others leave the time
  /// as it is.
  TimeSlopes(const GpuValues<double>& gpu, std::span<const std::string> keys);

  /// Adds a pass that the queue engine has timed: what its chunks cost, and the slopes of its time by that.
  void add(const PassWork& pass, const PassShape& shape, const std::vector<ChunkCost<double>>& costs,
           const PassSlopes& slopes, bool waits);

  /// d(time) / d(key) of the passes added so far, in ns for one of the key's unit, one for each key.
  const std::vector<double>& ns() const { return ns_; }

 private:
  static constexpr std::size_t kWidth = 8;  ///< derivatives at a time: one vector register with AVX-512
  using Number = Dual<kWidth>;

  std::vector<GpuRates<Number>> rates_;  ///< one for each kWidth keys
  std::vector<double> ns_;
};

}  // namespace hwsim
