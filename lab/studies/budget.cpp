#include "lab/studies/budget.h"

#include <charconv>
#include <cmath>
#include <map>

#include "lab/base/messages.h"
#include "lab/base/text.h"

namespace hwsim::lab {
namespace {

using IntervalMember = std::optional<std::array<double, 2>> Costs::*;

struct Quantity {
  double Costs::*member;
  IntervalMember interval;  ///< none of what is counted
};

const std::map<std::string, Quantity>& quantities() {
  static const std::map<std::string, Quantity> known = {{"aa_ms", {&Costs::aa_ms, &Costs::aa_interval_ms}},
                                                        {"frame_ms", {&Costs::frame_ms, &Costs::interval_ms}},
                                                        {"extra_mib", {&Costs::extra_mib, nullptr}},
                                                        {"memory_mib", {&Costs::memory_mib, nullptr}},
                                                        {"dram_mb", {&Costs::dram_mb, nullptr}}};
  return known;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

}  // namespace

std::vector<Limit> parse_budget(const std::string& text) {
  std::vector<Limit> limits;
  std::vector<std::string> names;
  for (const auto& [name, quantity] : quantities()) names.push_back(name);
  for (const std::string& piece : split(text, ',')) {
    const auto relation = piece.find("<=");
    const std::string name = trimmed(piece.substr(0, relation));
    const std::string number = relation == std::string::npos ? "" : trimmed(piece.substr(relation + 2));
    Limit limit{name, 0.0};
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), limit.at_most);
    if (relation == std::string::npos || error != std::errc() || end != number.data() + number.size() ||
        !std::isfinite(limit.at_most))
      fail_usage("U022", "`" + trimmed(piece) + "` in --budget is not of the form quantity<=number", "",
                 "--budget \"aa_ms<=1.5, extra_mib<=192\"");
    if (!quantities().contains(name))
      fail_usage("U022",
                 "--budget limits `" + name + "`, must be aa_ms, dram_mb, extra_mib, frame_ms or memory_mib",
                 did_you_mean(name, names));
    if (limit.at_most < 0.0)
      fail_usage("U022",
                 "the limit of `" + trimmed(piece) + "` in --budget is negative: nothing stays within it", "",
                 "a limit of 0 or more");
    limits.push_back(std::move(limit));
  }
  return limits;
}

std::string_view verdict(const Costs& costs, const std::vector<Limit>& budget) {
  bool over_memory = false, over_time = false, at_risk = false, unknown = false;
  for (const Limit& limit : budget) {
    const Quantity quantity = quantities().at(limit.quantity);
    const double value = costs.*quantity.member;
    if (!quantity.interval) {
      over_memory = over_memory || value > limit.at_most;
      continue;
    }
    const auto& interval = costs.*quantity.interval;
    over_time = over_time || value > limit.at_most;
    at_risk = at_risk || (interval && (*interval)[1] > limit.at_most);
    unknown = unknown || (!interval && value > 0.0);
  }
  return over_memory ? "over memory"
         : over_time ? "over time"
         : at_risk   ? "at risk"
         : unknown   ? "unknown"
                     : "ok";
}

}  // namespace hwsim::lab
