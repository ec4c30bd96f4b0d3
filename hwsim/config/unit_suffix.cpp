#include "hwsim/config/unit_suffix.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "hwsim/base/plain_name.h"

namespace hwsim {
namespace {

enum class Measure : unsigned char { frequency, size, rate, time };

struct Unit {
  std::string_view suffix, name;
  Measure measure;
  double factor;  ///< so many of the measure's first unit
};

constexpr double kKib = 1024.0;
constexpr std::array<Unit, 18> kUnits = {{{"_hz", "Hz", Measure::frequency, 1.0},
                                          {"_khz", "kHz", Measure::frequency, 1e3},
                                          {"_mhz", "MHz", Measure::frequency, 1e6},
                                          {"_ghz", "GHz", Measure::frequency, 1e9},
                                          {"_bytes", "bytes", Measure::size, 1.0},
                                          {"_kib", "KiB", Measure::size, kKib},
                                          {"_mib", "MiB", Measure::size, kKib* kKib},
                                          {"_gib", "GiB", Measure::size, kKib* kKib* kKib},
                                          {"_kb", "KB", Measure::size, kKib},  // data sheets mean KiB
                                          {"_mb", "MB", Measure::size, kKib* kKib},
                                          {"_gb", "GB", Measure::size, kKib* kKib* kKib},
                                          {"_mb_s", "MB/s", Measure::rate, 1e6},
                                          {"_gb_s", "GB/s", Measure::rate, 1e9},
                                          {"_tb_s", "TB/s", Measure::rate, 1e12},
                                          {"_ns", "ns", Measure::time, 1.0},
                                          {"_us", "us", Measure::time, 1e3},
                                          {"_ms", "ms", Measure::time, 1e6},
                                          {"_s", "s", Measure::time, 1e9}}};

/// The longest suffix that the name ends in: "_gb_s", not "_s".
const Unit* unit_of(std::string_view name) {
  const Unit* found = nullptr;
  for (const Unit& unit : kUnits)
    if (name.ends_with(unit.suffix) && (!found || unit.suffix.size() > found->suffix.size())) found = &unit;
  return found;
}

std::string text_of(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

std::optional<double> number_in(const std::optional<TomlValue>& value) {
  if (!value) return std::nullopt;
  if (const auto* whole = std::get_if<std::int64_t>(&*value)) return static_cast<double>(*whole);
  if (const auto* real = std::get_if<double>(&*value)) return *real;
  return std::nullopt;
}

}  // namespace

std::string other_unit_hint(std::string_view name, const std::optional<TomlValue>& value,
                            std::span<const std::string> names) {
  const Unit* given = unit_of(name);
  if (!given) return "";
  const std::string stem = plain_name(name.substr(0, name.size() - given->suffix.size()));
  for (const std::string& other : names) {
    const Unit* unit = unit_of(other);
    if (!unit || unit->measure != given->measure) continue;
    if (plain_name(other.substr(0, other.size() - unit->suffix.size())) != stem) continue;
    const double factor = given->factor / unit->factor;
    const std::string hint = "did you mean `" + other + "`, in " + std::string(unit->name);
    if (const auto number = number_in(value)) return hint + ": " + text_of(*number * factor) + "?";
    return hint + ", " + text_of(factor) + " times the number?";
  }
  return "";
}

}  // namespace hwsim
