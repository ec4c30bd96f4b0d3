#pragma once
// From a work trace and a GPU to times: one interface, several engines.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/gpu/gpu_config.h"
#include "hwsim/trace/work_trace.h"

namespace hwsim {

/// Hardware units in pipeline order; the ids are those of the glossary.
enum class Unit : std::uint8_t { fe, ia, vs, setup, raster, hiz, zrop, shader, tex, crop, resolve, l2, dram };
inline constexpr int kUnitCount = 13;
std::string_view unit_name(Unit unit);

enum class Stream : std::uint8_t { depth, color, texture, storage, vertex, index, constant, shader, other };
inline constexpr int kStreamCount = 9;
std::string_view stream_name(Stream stream);

/// Distance from the region where the model was calibrated.
enum class Support : std::uint8_t { calibrated, interpolated, extrapolated, uncalibrated };
std::string_view support_name(Support support);

enum class Engine : std::uint8_t { roofline, queue, detailed };
std::string_view engine_name(Engine engine);
std::optional<Engine> engine_from_name(std::string_view name);

struct TimingOptions {
  double detailed_sample_ratio = 1.0;  ///< engine detailed: part of a pass that is simulated
  std::uint64_t events_without_progress_max = 100'000'000;  ///< engine detailed: then it stops with a report
};

/// DRAM bytes of a stream; reals, because a miss ratio scales integer counts.
struct StreamBytes {
  std::array<double, kStreamCount> read{}, write{};
  double total_read() const;
  double total_write() const;
};

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

FrameTiming time_frame(const WorkTrace& trace, const GpuConfig& gpu, Engine engine,
                       const TimingOptions& options = {});

/// The invariants of docs/glossary.md#invariants (bytes/time <= peak, sums); empty when all hold.
std::vector<std::string> check_timing(const FrameTiming& timing, const WorkTrace& trace,
                                      const GpuConfig& gpu);

}  // namespace hwsim
