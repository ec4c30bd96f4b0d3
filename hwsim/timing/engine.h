#pragma once
// The engines by name, and what a caller may tell them.
#include <cstdint>
#include <optional>
#include <string_view>

namespace hwsim {

enum class Engine : std::uint8_t { roofline, queue, detailed };
std::string_view engine_name(Engine engine);
std::optional<Engine> engine_from_name(std::string_view name);

struct TimingOptions {
  double detailed_sample_ratio = 1.0;  ///< engine detailed: part of a pass that is simulated
  std::uint64_t events_without_progress_max = 100'000'000;  ///< engine detailed: then it stops with a report
};

}  // namespace hwsim
