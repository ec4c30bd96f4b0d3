#pragma once
// From a work trace and a GPU to times: one interface, several engines.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/gpu/gpu_config.h"
#include "hwsim/timing/engine.h"
#include "hwsim/timing/traffic.h"
#include "hwsim/trace/work_trace.h"
#include "hwsim/units/units.h"

namespace hwsim {

/// Distance from the region where the model was calibrated.
enum class Support : std::uint8_t { calibrated, interpolated, extrapolated, uncalibrated };
std::string_view support_name(Support support);

struct PassTiming {
  std::string name;
  PassKind kind = PassKind::draw;
  double time_ns = 0.0;
  std::array<double, kUnitCount> busy_ns{};    ///< time a unit would need alone
  std::array<double, kUnitCount> sol_ratio{};  ///< busy / pass time, 0..1
  std::array<double, kUnitCount> stack_ns{};   ///< exclusive share of the pass time; sums to time_ns
  double overhead_ns = 0.0;  ///< fixed part of the time: launch, drain, barrier (in the stack of fe)
  Unit limiter = Unit::fe;   ///< the unit with the largest share
  std::optional<std::array<double, 2>> sampling_interval_ns;  ///< 90 %, where a sample was simulated
  StreamBytes dram_bytes;
};

struct FrameTiming {
  Engine engine = Engine::queue;
  double time_ns = 0.0;                              ///< sum of the passes
  std::optional<std::array<double, 2>> interval_ns;  ///< 90 % prediction interval; none while uncalibrated
  Support support = Support::uncalibrated;
  std::optional<std::array<double, 2>> sampling_interval_ns;  ///< 90 %, of the sampling of engine detailed
  std::vector<PassTiming> passes;
  StreamBytes dram_bytes;  ///< sum of the passes
};

class TimeSlopes;

/// `slopes`, made for the same GPU, is given the frame's derivatives by the queue engine; others leave it as
/// it is.
FrameTiming time_frame(const WorkTrace& trace, const GpuConfig& gpu, Engine engine,
                       const TimingOptions& options = {}, TimeSlopes* slopes = nullptr);

/// The invariants of docs/glossary.md#invariants (bytes/time <= peak, sums); empty when all hold.
std::vector<std::string> check_timing(const FrameTiming& timing, const WorkTrace& trace,
                                      const GpuConfig& gpu);

}  // namespace hwsim
