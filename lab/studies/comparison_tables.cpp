#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/studies/comparison.h"

namespace hwsim::lab {
namespace {

constexpr double kPercent = 100.0;

/// In percent; what would be shown as -0.0 is 0.
double percent(double change) {
  const double value = change * kPercent;
  return std::abs(value) < 0.05 ? 0.0 : value;
}

TableCell change_cell(double before, double after) {
  const auto change = relative_change(before, after);
  return change ? TableCell{Real{percent(*change), 1}} : TableCell{NotApplicable{}};
}

TableCell change_cell(const Change<double>& change) { return change_cell(change.before, change.after); }

/// "+66.0 to +81.2", in percent.
TableCell interval_cell(const std::optional<std::array<double, 2>>& interval) {
  if (!interval) return NotApplicable{};
  return fmt::format("{:+.1f} to {:+.1f}", percent((*interval)[0]), percent((*interval)[1]));
}

/// Whether the change can be seen in the table's digits.
bool visible(const Change<double>& change) {
  const auto ratio = relative_change(change.before, change.after);
  return !ratio || std::abs(*ratio) * kPercent >= 0.05;
}

bool changed(const PassDifference& pass) {
  return visible(pass.time_ms) || visible(pass.dram_mb) || pass.limiter.before != pass.limiter.after;
}

/// "+73 % [+66, +81]".
std::string change_text(const Difference& difference) {
  const auto change = relative_change(difference.time_ms.before, difference.time_ms.after);
  std::string text = change ? fmt::format("{:+.1f} %", percent(*change)) : "n/a";
  if (const auto& interval = difference.time_change_interval)
    text += fmt::format(" [{:+.1f}, {:+.1f}]", percent((*interval)[0]), percent((*interval)[1]));
  return text;
}

TableCell limiter_cell(const std::optional<std::string>& limiter) {
  return limiter ? TableCell{*limiter} : TableCell{NotApplicable{}};
}

TableCell time_cell(double time_ms, const std::optional<std::string>& limiter) {
  return limiter ? TableCell{Real{time_ms, 4}} : TableCell{NotApplicable{}};
}

std::string slowest_limiter(const Result& result) {
  const PassResult* slowest = slowest_pass(result);
  return slowest && slowest->time_ms > 0.0 ? fmt::format("{} in {}", slowest->limiter, slowest->name) : "n/a";
}

std::string slowest_limiter(const Difference& difference) {
  const PassDifference* slowest = nullptr;
  for (const PassDifference& pass : difference.passes)
    if (pass.limiter.after && pass.time_ms.after > (slowest ? slowest->time_ms.after : 0.0)) slowest = &pass;
  return slowest ? fmt::format("{} in {}", *slowest->limiter.after, slowest->name) : "n/a";
}

}  // namespace

Table frame_comparison(const Comparison& comparison) {
  Table table{{{"result", "result"},
               {"technique", "technique", false, 0, true},
               {"gpu", "GPU", false, 0, true},
               {"time_ms", "ms", true},
               {"time_change_pct", "change %", true},
               {"time_change_interval90", "90 % interval", true},
               {"base", "against"},
               {"limiter", "limiter of the slowest pass", false, 0, true},
               {"dram_mb", "DRAM MB", true, 0, true},
               {"dram_change_pct", "change %", true, 0, true},
               {"memory_mib", "memory MiB", true, 0, true},
               {"shaded_samples", "shaded samples", true, 0, true}},
              {}};
  const Result& base = comparison.baseline;
  table.rows.push_back({comparison.baseline_label, base.technique, base.gpu, Real{base.frame.time_ms, 4},
                        Real{0.0, 1}, NotApplicable{}, NotApplicable{}, slowest_limiter(base),
                        Real{base.frame.dram_mb, 1}, Real{0.0, 1}, Real{base.frame.memory_mib, 1},
                        base.frame.shaded_samples});
  for (const Difference& d : comparison.differences)
    table.rows.push_back({d.label, d.technique, d.gpu, Real{d.time_ms.after, 4}, change_cell(d.time_ms),
                          interval_cell(d.time_change_interval), d.base, slowest_limiter(d),
                          Real{d.dram_mb.after, 1}, change_cell(d.dram_mb), Real{d.memory_mib.after, 1},
                          static_cast<std::uint64_t>(d.shaded_samples.after)});
  return table;
}

Table variation_matrix(const Comparison& comparison) {
  Table table{{{"technique", "technique"}, {"gpu", "GPU"}}, {}};
  std::vector<std::string> variations;
  for (const Difference& d : comparison.differences)
    if (!d.variation.empty() && std::ranges::find(variations, d.variation) == variations.end()) {
      variations.push_back(d.variation);
      table.columns.push_back({d.variation, d.variation, true});
    }
  std::vector<std::pair<std::string, std::string>> points;
  for (const Difference& d : comparison.differences) {
    if (d.variation.empty()) continue;
    const std::pair point(d.technique, d.gpu);
    auto row = std::ranges::find(points, point);
    if (row == points.end()) {
      row = points.insert(points.end(), point);
      table.rows.push_back({d.technique, d.gpu});
      table.rows.back().resize(table.columns.size(), NotApplicable{});
    }
    const auto column = std::ranges::find(variations, d.variation) - variations.begin() + 2;
    table.rows[static_cast<std::size_t>(row - points.begin())][static_cast<std::size_t>(column)] =
        change_text(d);
  }
  return table;
}

Table pass_comparison(const Comparison& comparison, bool all) {
  Table table{{{"result", "result"},
               {"pass", "pass"},
               {"before_ms", "before ms", true},
               {"after_ms", "after ms", true},
               {"time_change_pct", "change %", true},
               {"limiter_before", "limiter before"},
               {"limiter_after", "after"},
               {"dram_before_mb", "DRAM before MB", true, 0, true},
               {"dram_after_mb", "after MB", true, 0, true},
               {"dram_change_pct", "change %", true, 0, true}},
              {}};
  for (const Difference& difference : comparison.differences)
    for (const PassDifference& pass : difference.passes)
      if (all || changed(pass))
        table.rows.push_back(
            {difference.label, pass.name, time_cell(pass.time_ms.before, pass.limiter.before),
             time_cell(pass.time_ms.after, pass.limiter.after), change_cell(pass.time_ms),
             limiter_cell(pass.limiter.before), limiter_cell(pass.limiter.after),
             Real{pass.dram_mb.before, 2}, Real{pass.dram_mb.after, 2}, change_cell(pass.dram_mb)});
  return table;
}

Table counter_comparison(const Comparison& comparison) {
  Table table{{{"result", "result"},
               {"pass", "pass"},
               {"counter", "counter"},
               {"before", "before", true},
               {"after", "after", true},
               {"change_pct", "change %", true}},
              {}};
  for (const Difference& difference : comparison.differences)
    for (const PassDifference& pass : difference.passes)
      for (const auto& [id, change] : pass.counters)
        table.rows.push_back(
            {difference.label, pass.name, id, change.before, change.after,
             change_cell(static_cast<double>(change.before), static_cast<double>(change.after))});
  return table;
}

}  // namespace hwsim::lab
