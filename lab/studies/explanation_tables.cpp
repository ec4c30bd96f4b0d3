#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "lab/studies/explanation.h"

namespace hwsim::lab {
namespace {

constexpr double kPercent = 100.0;
constexpr std::size_t kTopUnits = 5;
constexpr double kShownElasticity = 0.0005;  // less than 0.05 % of time for 100 % of value
constexpr double kShortestMs = 1e-15;        // a pass that takes no time has no shares

/// "crop 93, fe 5": the largest values above 0, as `format` shows one.
template <class Format>
std::string largest(NamedValues<double> values, const Format& format) {
  std::ranges::stable_sort(values, std::greater{}, &std::pair<std::string, double>::second);
  values.resize(std::min(kTopUnits, values.size()));
  std::string text;
  for (const auto& [name, value] : values)
    if (value > 0.0) text += (text.empty() ? "" : ", ") + format(name, value);
  return text;
}

double change_pct(double before, double after) {
  return kPercent * relative_change(before, after).value_or(0.0);
}

TableCell doubled_cell(double frame_ms, const SensitivityResult& s) {
  if (!s.doubled_ms) return NotApplicable{};
  return Real{change_pct(frame_ms, *s.doubled_ms), 2};
}

}  // namespace

Table explained_passes(const Explanation& explanation) {
  Table table{{{"pass", "pass"},
               {"time_ms", "ms", true},
               {"limiter", "limiter"},
               {"stack", "time stack", false, 60},
               {"top_sol", "busiest units, SOL %", false, 60}},
              {}};
  for (std::size_t i = 0; i < explanation.result.passes.size(); ++i) {
    const PassResult& pass = explanation.result.passes[i];
    const double time_ms = std::max(pass.time_ms, kShortestMs);
    table.rows.push_back({pass.name, Real{pass.time_ms, 4}, pass.limiter,
                          largest(explanation.stack_ms[i],
                                  [&](const std::string& unit, double stack_ms) {
                                    return fmt::format("{} {:.0f} %", unit, kPercent * stack_ms / time_ms);
                                  }),
                          largest(pass.units, [](const std::string& unit, double sol_ratio) {
                            return fmt::format("{} {:.0f}", unit, kPercent * sol_ratio);
                          })});
  }
  return table;
}

Table headroom_table(const Explanation& explanation) {
  Table table{
      {{"unit", "if this unit took no time"}, {"time_ms", "ms", true}, {"change_pct", "change %", true}}, {}};
  for (const UnitHeadroomResult& unit : explanation.headroom)
    table.rows.push_back(
        {unit.unit, Real{unit.time_ms, 4}, Real{change_pct(explanation.analyzed_ms, unit.time_ms), 1}});
  return table;
}

Table sensitivity_table(const Explanation& explanation, bool every) {
  Table table{{{"parameter", "parameter"},
               {"value", "value", true},
               {"elasticity", "% of time a % of it", true},
               {"doubled_change_pct", "doubled: change %", true}},
              {}};
  for (const SensitivityResult& s : explanation.sensitivities) {
    if (!every && std::abs(s.elasticity) < kShownElasticity) continue;
    table.rows.push_back(
        {s.parameter, Real{s.value, 3}, Real{s.elasticity, 4}, doubled_cell(explanation.analyzed_ms, s)});
  }
  return table;
}

double limiter_share_ratio(const Explanation& explanation) {
  const PassResult* slowest = slowest_pass(explanation.result);
  if (!slowest || slowest->time_ms <= 0.0) return 0.0;
  const auto index = static_cast<std::size_t>(slowest - explanation.result.passes.data());
  for (const auto& [unit, stack_ms] : explanation.stack_ms[index])
    if (unit == slowest->limiter) return stack_ms / slowest->time_ms;
  return 0.0;
}

}  // namespace hwsim::lab
