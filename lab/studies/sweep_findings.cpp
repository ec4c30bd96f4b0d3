#include "lab/studies/sweep_findings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <unordered_map>

#include "lab/request/request_words.h"

namespace hwsim::lab {
namespace {

constexpr std::size_t kBest = 5, kFrontMost = 20;
constexpr std::size_t kBins =
    8;  // an axis with more values than 1.5 times this many is shown by so many bins

using Row = std::vector<TableCell>;

std::optional<double> number_of(const TableCell& cell) {
  const auto* real = std::get_if<Real>(&cell);
  return real ? std::optional(real->value) : std::nullopt;
}

std::optional<double> number_of(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Where what is asked of a row stands in it.
class Columns {
 public:
  explicit Columns(const std::vector<Column>& columns) {
    for (std::size_t i = 0; i < columns.size(); ++i) place_[columns[i].id] = i;
    axes_ = {"technique", "gpu"};
    for (const Column& column : columns)
      if (column.id.find('.') != std::string::npos || column.id == "overlay") axes_.push_back(column.id);
    frame_ = {"scene", "resolution"};
    if (place_.contains("camera")) frame_.push_back("camera");
    const auto of_frame = [](const std::string& axis) { return is_of_frame(axis); };
    std::ranges::copy_if(axes_, std::back_inserter(frame_), of_frame);
    std::erase_if(axes_, of_frame);
  }
  const std::vector<std::string>& choice_axes() const { return axes_; }
  const std::vector<std::string>& frame_axes() const { return frame_; }

  std::string text(const Row& row, const std::string& axis) const {
    if (axis == "resolution") return text(row, "width_px") + "x" + text(row, "height_px");
    return text_of(row[place_.at(axis)]);
  }
  std::optional<double> number(const Row& row, const std::string& column) const {
    const auto found = place_.find(column);
    return found == place_.end() ? std::nullopt : number_of(row[found->second]);
  }
  bool is_done(const Row& row) const {
    const auto time_ms = number(row, "time_ms");
    return text(row, "state") == "done" && time_ms && *time_ms > 0.0;
  }
  std::size_t key(const Row& row, const std::vector<std::string>& axes) const {
    std::string joined;
    for (const std::string& axis : axes) joined += text(row, axis) + '\n';
    return std::hash<std::string>{}(joined);
  }

 private:
  std::map<std::string, std::size_t> place_;
  std::vector<std::string> axes_, frame_;
};

/// Sums of a choice over the frames that have it.
struct ChoiceSums {
  std::size_t row = 0;  ///< the first one that has it
  std::size_t frames = 0, intervals = 0, errors = 0;
  double log_time = 0.0, log_low = 0.0, log_high = 0.0, flip = 0.0, psnr = 0.0, memory = 0.0;

  void add(const Columns& columns, const Row& row) {
    ++frames;
    log_time += std::log(*columns.number(row, "time_ms"));
    const auto low = columns.number(row, "lo_ms"), high = columns.number(row, "hi_ms");
    if (low && high && *low > 0.0) {
      ++intervals;
      log_low += std::log(*low);
      log_high += std::log(*high);
    }
    if (const auto flip_mean = columns.number(row, "flip_mean")) {
      ++errors;
      flip += *flip_mean;
      psnr += columns.number(row, "psnr_db").value_or(0.0);
    }
    memory = std::max(memory, columns.number(row, "memory_mib").value_or(0.0));
  }
  double time_ms() const { return std::exp(log_time / static_cast<double>(frames)); }
  std::optional<double> error() const {
    if (errors == 0 || errors < frames) return std::nullopt;
    return flip / static_cast<double>(errors);
  }
  SweepChoice choice() const {
    SweepChoice choice{.time_ms = time_ms(), .memory_mib = memory};
    const auto count = static_cast<double>(frames);
    if (intervals == frames) choice.interval_ms = {std::exp(log_low / count), std::exp(log_high / count)};
    choice.flip_mean = error();
    if (choice.flip_mean) choice.psnr_db = psnr / count;
    return choice;
  }
};

/// The values of an axis, or bins of them where there are many numbers, with the times that they have.
class AxisTimes {
 public:
  explicit AxisTimes(std::string axis) : axis_(std::move(axis)) {}
  const std::string& axis() const { return axis_; }

  void know(const std::string& value) { values_.insert(value); }
  bool varies() const { return values_.size() > 1; }

  void make_bins() {
    std::vector<double> numbers;
    for (const std::string& value : values_)
      if (const auto number = number_of(value)) numbers.push_back(*number);
    if (values_.size() <= kBins + kBins / 2 || numbers.size() != values_.size()) return;
    std::ranges::sort(numbers);
    for (std::size_t bin = 0; bin < kBins; ++bin) bounds_.push_back(numbers[bin * numbers.size() / kBins]);
    last_ = numbers.back();
  }
  void add(const std::string& value, double log_time) {
    Sum& sum = sums_[place_of(value)];
    sum.log_time += log_time;
    ++sum.count;
  }
  AxisEffect effect(double mean, double variance_sum) const {
    AxisEffect effect{.axis = axis_, .values = values_.size()};
    double between = 0.0;
    for (const auto& [place, sum] : sums_) {
      const double own = sum.log_time / static_cast<double>(sum.count), time_ms = std::exp(own);
      between += static_cast<double>(sum.count) * (own - mean) * (own - mean);
      if (effect.fastest.empty() || time_ms < effect.fastest_ms) {
        effect.fastest = name_of(place);
        effect.fastest_ms = time_ms;
      }
      if (effect.slowest.empty() || time_ms > effect.slowest_ms) {
        effect.slowest = name_of(place);
        effect.slowest_ms = time_ms;
      }
    }
    effect.share_ratio = variance_sum > 0.0 ? std::min(1.0, between / variance_sum) : 0.0;
    return effect;
  }

 private:
  struct Sum {
    double log_time = 0.0;
    std::size_t count = 0;
  };
  std::string place_of(const std::string& value) const {
    if (bounds_.empty()) return value;
    const auto above = std::ranges::upper_bound(bounds_, number_of(value).value_or(bounds_.front()));
    return std::to_string(above - bounds_.begin() - 1);
  }
  std::string name_of(const std::string& place) const {
    if (bounds_.empty()) return place;
    const auto bin = static_cast<std::size_t>(std::stoul(place));
    const auto rounded = [](double value) {
      std::array<char, 32> text{};
      const auto end =
          std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 4);
      return std::string(text.data(), end.ptr);
    };
    return rounded(bounds_[bin]) + ".." + rounded(bin + 1 < bounds_.size() ? bounds_[bin + 1] : last_);
  }

  std::string axis_;
  std::set<std::string> values_;
  std::vector<double> bounds_;  ///< where bins begin; empty: a value is its own
  double last_ = 0.0;
  std::map<std::string, Sum> sums_;
};

void each_done(const RowSource& points, const Columns& columns,
               const std::function<void(std::size_t, const Row&)>& take) {
  std::size_t number = 0;
  if (points.each)
    points.each([&](const Row& row) {
      if (columns.is_done(row)) take(number, row);
      ++number;
    });
}

/// Those that nobody beats in time and error, the fastest first; `choices` are sorted by time.
std::vector<ChoiceSums> front_of(const std::vector<ChoiceSums>& choices) {
  std::vector<ChoiceSums> front;
  double least = HUGE_VAL;
  for (const ChoiceSums& choice : choices)
    if (const auto error = choice.error(); error && *error < least) {
      least = *error;
      front.push_back(choice);
    }
  if (front.size() > kFrontMost) front.resize(kFrontMost);
  return front;
}

/// The choices with their words, which only the rows have.
std::vector<SweepChoice> with_words(const std::vector<ChoiceSums>& sums, const RowSource& points,
                                    const Columns& columns, const std::vector<std::string>& axes) {
  std::vector<SweepChoice> choices;
  for (const ChoiceSums& sum : sums) choices.push_back(sum.choice());
  each_done(points, columns, [&](std::size_t number, const Row& row) {
    for (std::size_t i = 0; i < sums.size(); ++i)
      if (sums[i].row == number)
        for (const std::string& axis : axes) choices[i].what.emplace_back(axis, columns.text(row, axis));
  });
  return choices;
}

std::vector<AxisTimes> axes_of(const RowSource& points, const Columns& columns) {
  std::vector<AxisTimes> axes;
  for (const auto& names : {columns.choice_axes(), columns.frame_axes()})
    for (const std::string& name : names) axes.emplace_back(name);
  each_done(points, columns, [&](std::size_t, const Row& row) {
    for (AxisTimes& axis : axes) axis.know(columns.text(row, axis.axis()));
  });
  std::erase_if(axes, [](const AxisTimes& axis) { return !axis.varies(); });
  for (AxisTimes& axis : axes) axis.make_bins();
  return axes;
}

}  // namespace

SweepFindings findings_of(const RowSource& points) {
  const Columns columns(points.columns);
  std::vector<AxisTimes> axes = axes_of(points, columns);
  SweepFindings findings;
  std::unordered_map<std::size_t, ChoiceSums> choices;
  std::set<std::size_t> frames;
  double sum = 0.0, squares = 0.0;
  each_done(points, columns, [&](std::size_t number, const Row& row) {
    const double time_ms = *columns.number(row, "time_ms"), log_time = std::log(time_ms);
    findings.fastest_ms = findings.points == 0 ? time_ms : std::min(findings.fastest_ms, time_ms);
    findings.slowest_ms = std::max(findings.slowest_ms, time_ms);
    ++findings.points;
    sum += log_time;
    squares += log_time * log_time;
    frames.insert(columns.key(row, columns.frame_axes()));
    const auto [choice, is_new] = choices.try_emplace(columns.key(row, columns.choice_axes()));
    if (is_new) choice->second.row = number;
    choice->second.add(columns, row);
    for (AxisTimes& axis : axes) axis.add(columns.text(row, axis.axis()), log_time);
  });
  findings.frames = frames.size();
  std::vector<ChoiceSums> whole;
  for (const auto& [key, choice] : choices)
    if (choice.frames == frames.size()) whole.push_back(choice);
  std::ranges::sort(
      whole, {}, [](const ChoiceSums& c) { return std::tuple(c.log_time, c.error().value_or(0.0), c.row); });
  std::vector<std::string> varied;
  for (const AxisTimes& axis : axes)
    if (!is_of_frame(axis.axis())) varied.push_back(axis.axis());
  findings.front = with_words(front_of(whole), points, columns, varied);
  whole.resize(std::min(whole.size(), kBest));
  findings.best = with_words(whole, points, columns, varied);
  const double mean = findings.points ? sum / static_cast<double>(findings.points) : 0.0;
  for (const AxisTimes& axis : axes) findings.effects.push_back(axis.effect(mean, squares - sum * mean));
  std::ranges::stable_sort(findings.effects, std::greater{}, &AxisEffect::share_ratio);
  return findings;
}

Table choice_table(const std::vector<SweepChoice>& choices) {
  Table table;
  if (choices.empty()) return table;
  const bool with_errors = choices.front().flip_mean.has_value();
  for (const auto& [axis, value] : choices.front().what) table.columns.push_back({axis, axis});
  for (const auto& [id, title] : {std::pair("time_ms", "ms"), {"lo_ms", "lo"}, {"hi_ms", "hi"}})
    table.columns.push_back({id, title, true});
  if (with_errors)
    table.columns.insert(table.columns.end(), {{"flip_mean", "FLIP", true}, {"psnr_db", "PSNR dB", true}});
  table.columns.push_back({"memory_mib", "memory MiB", true});
  const auto cell = [](const std::optional<double>& value, int decimals) -> TableCell {
    return value ? TableCell{Real{*value, decimals}} : TableCell{NotApplicable{}};
  };
  for (const SweepChoice& choice : choices) {
    std::vector<TableCell>& row = table.rows.emplace_back();
    for (const auto& [axis, value] : choice.what) row.emplace_back(value);
    row.emplace_back(Real{choice.time_ms, 4});
    for (const std::size_t end : {0u, 1u})
      row.push_back(choice.interval_ms ? TableCell{Real{(*choice.interval_ms)[end], 4}} : NotApplicable{});
    if (with_errors) row.insert(row.end(), {cell(choice.flip_mean, 4), cell(choice.psnr_db, 2)});
    row.emplace_back(Real{choice.memory_mib, 1});
  }
  return table;
}

Table effect_table(const std::vector<AxisEffect>& effects) {
  constexpr double kPercent = 100.0;
  Table table{{{"axis", "axis"},
               {"values", "values", true},
               {"share_pct", "% of variance", true},
               {"fastest", "fastest"},
               {"fastest_ms", "ms", true},
               {"slowest", "slowest"},
               {"slowest_ms", "ms", true},
               {"ratio", "ratio", true}},
              {}};
  for (const AxisEffect& e : effects)
    table.rows.push_back({e.axis, std::uint64_t{e.values}, Real{kPercent * e.share_ratio, 1}, e.fastest,
                          Real{e.fastest_ms, 4}, e.slowest, Real{e.slowest_ms, 4},
                          Real{e.slowest_ms / e.fastest_ms, 2}});
  return table;
}

}  // namespace hwsim::lab
