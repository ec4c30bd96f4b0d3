#pragma once
// `--vary path=a,b,c`, `path=lo..hi:n` and `path=lo..hi:n:log`, and the points that several of them span.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hwsim/config/toml_value.h"

namespace hwsim::lab {

struct Axis {
  struct Range {
    double low = 0.0, high = 0.0;
    bool logarithmic = false;
  };
  std::string path;
  std::vector<std::string> values;  ///< empty for a range without a count, which only sampling takes
  std::optional<Range> range;
};

/// Throws InputError U019.
Axis parse_axis(const std::string& text);
std::vector<Axis> parse_axes(const std::vector<std::string>& texts);

/// `lhs:64`: the number of points. Throws InputError U019.
int parse_sample(const std::string& text);

enum class Combine { grid, zip };

/// One list of settings a point, the last axis varying fastest; one empty list when there are no axes. Throws
/// InputError U019 for a range without a count and for lists of different length that are to be zipped.
std::vector<std::vector<Assignment>> combine(const std::vector<Axis>& axes, Combine how);

/// Latin hypercube (McKay, Beckman, Conover 1979): each axis is cut into `points` strata, each stratum is
/// used once.
std::vector<std::vector<Assignment>> latin_hypercube(const std::vector<Axis>& axes, int points,
                                                     std::uint64_t seed);

}  // namespace hwsim::lab
