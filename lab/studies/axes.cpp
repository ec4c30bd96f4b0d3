#include "lab/studies/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <set>

#include "lab/base/messages.h"
#include "lab/base/table.h"
#include "lab/base/text.h"
#include "lab/request/request_words.h"
#include "lab/studies/whole_settings.h"

namespace hwsim::lab {
namespace {

constexpr int kMaxPoints = 1'000'000;

[[noreturn]] void fail_axis(const std::string& text, const std::string& why) {
  fail_usage("U019", "--vary " + text + ": " + why, "",
             "path=a,b,c or path=lo..hi:n or path=lo..hi:n:log, e.g. gpu.l2_size_kib=256..4096:5:log");
}

template <class T>
bool read_number(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// 512.0000000001, the product of a logarithmic step, is meant as 512, which a key of whole numbers takes.
std::string number_text(double value) {
  const double whole = std::round(value);
  constexpr double kSlip = 1e-9;
  if (std::abs(value - whole) <= kSlip * std::abs(value) && std::abs(whole) < 1e15)
    return fmt::format("{:.0f}", whole);
  return exact(value);
}

double at_share(const Axis::Range& range, double share) {
  const double value = range.logarithmic ? range.low * std::pow(range.high / range.low, share)
                                         : range.low + (range.high - range.low) * share;
  return range.whole ? std::round(value) : value;
}

/// Nothing when it is not of the form lo..hi.
std::optional<Axis::Range> parse_range(const std::string& text, const std::string& bounds) {
  const auto dots = bounds.find("..");
  if (dots == std::string::npos) return std::nullopt;
  Axis::Range range;
  if (!read_number(std::string_view(bounds).substr(0, dots), range.low) ||
      !read_number(std::string_view(bounds).substr(dots + 2), range.high))
    fail_axis(text, "`" + bounds + "` is no range of two numbers");
  if (!std::isfinite(range.low) || !std::isfinite(range.high) || !(range.low < range.high))
    fail_axis(text, "the range must go from a smaller to a larger number");
  return range;
}

void fill_range(Axis& axis, const std::string& text, const std::vector<std::string>& parts) {
  if (parts.size() == 3 && parts[2] != "log") fail_axis(text, "after the count only `log` may stand");
  if (parts.size() > 3) fail_axis(text, "it has too many parts");
  axis.range->logarithmic = parts.size() == 3;
  axis.range->whole = is_whole_setting(axis.path);
  if (axis.range->logarithmic && axis.range->low <= 0.0)
    fail_axis(text, "a logarithmic range must be positive");
  if (parts.size() == 1) return;
  int count = 0;
  if (!read_number(std::string_view(parts[1]), count) || count < 2 || count > kMaxPoints)
    fail_axis(text, fmt::format("the count must be a whole number from 2 to {}", kMaxPoints));
  for (int i = 0; i < count; ++i) {
    std::string value = number_text(at_share(*axis.range, static_cast<double>(i) / (count - 1)));
    const bool is_new = axis.values.empty() || axis.values.back() != value;  // whole numbers may come twice
    if (is_new) axis.values.push_back(std::move(value));
  }
}

void require_values(const Axis& axis, const std::string& text) {
  for (const std::string& value : axis.values)
    if (value.empty()) fail_axis(text, "a value is empty");
}

/// Throws InputError C020 for a path that is neither a setting's nor a word.
Assignment parse_setting(const std::string& text) try {
  return parse_assignment(text);
} catch (const InputError& error) {
  Diagnostic d = error.diagnostics().front();
  const std::string path = text.substr(0, text.find('='));
  if (path.find('.') == std::string::npos) d.hint = did_you_mean(path, request_words());
  d.help =
      fmt::format("--vary group.key=VALUES, or --vary WORD=VALUES with {}", fmt::join(request_words(), ", "));
  throw InputError(d);
}

/// `resolution=640x360,1280x720`: a list of whole words, none of which is a range. None where the path is no
/// word.
std::optional<Axis> parse_word_axis(const std::string& text) {
  const std::string path = text.substr(0, text.find('='));
  if (!is_request_word(path) || path.size() == text.size()) return std::nullopt;
  const std::string values = text.substr(path.size() + 1);
  return Axis{path, path == "scene" ? split_techniques(values) : split(values, ','), {}};
}

/// SplitMix64 (Steele, Lea, Flood 2014): the distributions of <random> differ between libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double real() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  std::vector<int> permutation(int n) {
    std::vector<int> order(static_cast<size_t>(n));
    std::iota(order.begin(), order.end(), 0);
    for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[next() % i]);
    return order;
  }

 private:
  std::uint64_t state_;
};

}  // namespace

Axis parse_axis(const std::string& text) {
  if (auto words = parse_word_axis(text)) {
    require_values(*words, text);
    return std::move(*words);
  }
  const Assignment assignment = parse_setting(text);
  Axis axis{assignment.path, {}, {}};
  const std::vector<std::string> parts = split(assignment.value, ':');
  if ((axis.range = parse_range(text, parts.front())))
    fill_range(axis, text, parts);
  else
    axis.values = split(assignment.value, ',');
  require_values(axis, text);
  return axis;
}

std::vector<Axis> parse_axes(const std::vector<std::string>& texts) {
  std::vector<Axis> axes;
  std::set<std::string> paths;
  for (const std::string& text : texts) {
    axes.push_back(parse_axis(text));
    if (!paths.insert(axes.back().path).second) fail_axis(text, "`" + axes.back().path + "` is varied twice");
  }
  return axes;
}

int parse_sample(const std::string& text) {
  int points = 0;
  if (text.rfind("lhs:", 0) == 0 && read_number(std::string_view(text).substr(4), points) && points >= 1 &&
      points <= kMaxPoints)
    return points;
  fail_usage("U019", "--sample is `" + text + "`, must be lhs:POINTS", "--sample lhs:64");
}

PointSettings::PointSettings(std::vector<Axis> axes, Combine how)
    : axes_(std::move(axes)), how_(how), count_(1) {
  for (const Axis& axis : axes_) {
    if (axis.values.empty() && !axis.range)
      fail_usage("U019", "`" + axis.path + "` has no values: the list is empty", "", "one value at least");
    if (axis.values.empty())
      fail_usage("U019", "the range of `" + axis.path + "` has no count", "lo..hi:n, or --sample lhs:N");
    count_ = how == Combine::grid ? count_ * axis.values.size() : axis.values.size();
    if (count_ > kMaxPoints) fail_usage("U019", fmt::format("the axes span more than {} points", kMaxPoints));
  }
  if (how != Combine::zip) return;
  for (const Axis& axis : axes_)
    if (axis.values.size() != axes_.front().values.size())
      fail_usage("U019",
                 fmt::format("--zip takes lists of one length: `{}` has {} values, `{}` {}",
                             axes_.front().path, axes_.front().values.size(), axis.path, axis.values.size()));
}

PointSettings::PointSettings(std::vector<Axis> axes, int points, std::uint64_t seed)
    : axes_(std::move(axes)), count_(static_cast<std::size_t>(points)) {
  Random random(seed);
  for ([[maybe_unused]] const Axis& axis : axes_) {
    const std::vector<int> strata = random.permutation(points);
    std::vector<double>& shares = shares_.emplace_back();
    for (const int stratum : strata) shares.push_back((stratum + random.real()) / points);
  }
}

std::size_t PointSettings::size() const { return count_ > 0 ? count_ : lists_.size(); }

std::vector<std::vector<Assignment>> PointSettings::all() const {
  std::vector<std::vector<Assignment>> points;
  for (std::size_t i = 0; i < size(); ++i) points.push_back((*this)[i]);
  return points;
}

std::vector<Assignment> PointSettings::operator[](std::size_t point) const {
  if (count_ == 0) return lists_.at(point);
  std::vector<Assignment> settings;
  std::size_t rest = point, stride = count_;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const Axis& axis = axes_[a];
    const std::size_t values = axis.values.size();
    if (!shares_.empty()) {
      const double share = shares_[a][point];
      const auto index = static_cast<std::size_t>(share * static_cast<double>(values));
      settings.push_back({axis.path, axis.range ? exact(at_share(*axis.range, share))
                                                : axis.values[std::min(values - 1, index)]});
      continue;
    }
    if (how_ == Combine::grid) stride /= values;
    settings.push_back({axis.path, axis.values[how_ == Combine::zip ? point : rest / stride]});
    if (how_ == Combine::grid) rest %= stride;
  }
  return settings;
}

}  // namespace hwsim::lab
