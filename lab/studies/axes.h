#pragma once
// `--vary path=a,b,c`, `path=lo..hi:n` and `path=lo..hi:n:log`, and the points that several of them span. A
// path is that of a setting, or a word of lab/request/request_words.h.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hwsim/config/toml_value.h"

namespace hwsim::lab {

struct Axis {
  struct Range {
    double low = 0.0, high = 0.0;
    bool logarithmic = false;
    bool whole = false;  ///< what varies counts things: values are rounded
  };
  std::string path;
  std::vector<std::string> values;  ///< empty for a range without a count, which only sampling takes
  std::optional<Range> range;
};

/// Throws InputError U019, and C020 for a path that is none.
Axis parse_axis(const std::string& text);
std::vector<Axis> parse_axes(const std::vector<std::string>& texts);

/// `lhs:64`: the number of points. Throws InputError U019.
int parse_sample(const std::string& text);

enum class Combine { grid, zip };

/// One list of settings a point, each made when it is asked for: a million points take no memory.
class PointSettings {
 public:
  /// One point without settings.
  PointSettings() = default;
  /// One point for each list, as it is.
  explicit PointSettings(std::vector<std::vector<Assignment>> lists) : lists_(std::move(lists)) {}
  /// The points that axes span, the last one varying fastest. Throws InputError U019 for a range without a
  /// count and for lists of different length that are to be zipped.
  PointSettings(std::vector<Axis> axes, Combine how);
  /// Latin hypercube (McKay, Beckman, Conover 1979): each axis is cut into `points` strata, each stratum is
  /// used once. It keeps a number for each axis of a point.
  PointSettings(std::vector<Axis> axes, int points, std::uint64_t seed);

  std::size_t size() const;
  std::vector<Assignment> operator[](std::size_t point) const;
  std::vector<std::vector<Assignment>> all() const;

 private:
  std::vector<std::vector<Assignment>> lists_ = std::vector<std::vector<Assignment>>(1);
  std::vector<Axis> axes_;
  Combine how_ = Combine::grid;
  std::size_t count_ = 0;  ///< how many points; 0: they are in lists_
  std::vector<std::vector<double>>
      shares_;  ///< by axis and point: where in the axis, 0 to 1; only when sampled
};

}  // namespace hwsim::lab
