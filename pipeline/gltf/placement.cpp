#include "pipeline/gltf/placement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace hwsim::pipeline::gltf {
namespace {

// By division where the exponent is negative: 10^n is exact up to 22, 10^-n never.
double times_power_of_ten(double value, int exponent) {
  return exponent >= 0 ? value * std::pow(10.0, exponent) : value / std::pow(10.0, -exponent);
}

// Rounded to a power of ten of at least four diagonals: zero for whatever lies within two of them.
glm::dvec3 round_origin(const Box& bounds) {
  glm::dvec3 origin(0.0);
  const double diagonal = bounds.diagonal();
  if (!(diagonal > 0.0)) return origin;
  const int grid = static_cast<int>(std::ceil(std::log10(4.0 * diagonal)));
  for (int i = 0; i < 3; ++i)
    origin[i] = times_power_of_ten(std::round(times_power_of_ten(bounds.center()[i], -grid)), grid);
  return origin;
}

// The exponent of ten that brings a number to 1 to 10; a power of ten comes to 1, whatever its last bit.
int unit_exponent(double number) { return -static_cast<int>(std::floor(std::log10(number) + 1e-9)); }

}  // namespace

void Box::add(const glm::dvec3& point) {
  low = glm::min(low, point);
  high = glm::max(high, point);
}

void Box::add(const Box& local, const glm::dmat4& matrix) {
  if (local.empty()) return;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner(i & 1 ? local.high.x : local.low.x, i & 2 ? local.high.y : local.low.y,
                            i & 4 ? local.high.z : local.low.z);
    add(glm::dvec3(matrix * glm::dvec4(corner, 1.0)));
  }
}

glm::dmat4 Placement::matrix() const {
  glm::dmat4 m(1.0);
  for (int i = 0; i < 3; ++i) {
    m[i][i] = scale;
    m[3][i] = -origin[i] * scale;
  }
  return m;
}

glm::dmat4 Placement::inverse_matrix() const {
  glm::dmat4 m(1.0);
  for (int i = 0; i < 3; ++i) m[i][i] = 1.0 / scale;
  m[3] = glm::dvec4(origin, 1.0);
  return m;
}

Placement place_mesh(const Box& bounds) {
  constexpr double kLeast = 1e-5, kMost = 1e7;
  Placement out;
  out.origin = round_origin(bounds);
  const double diagonal = bounds.diagonal();
  if (diagonal > 0.0 && (diagonal < kLeast || diagonal > kMost))
    out.scale = times_power_of_ten(1.0, unit_exponent(diagonal));
  return out;
}

double rounded_scale(double scale) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.5e", scale);
  return std::strtod(digits, nullptr);
}

Placement place_scene(const Box& bounds, const DrawnScale& drawn, double view_distance_m) {
  constexpr double kLeast = 0.1, kMost = 1e5, kMostInMeters = 1e3, kFarthestView = 1e12;
  const double unit = drawn.shared;
  const double meters = bounds.diagonal(), diagonal = meters / unit;
  const auto fits = [&](double d) { return d >= kLeast && d <= kMost; };
  int exponent = 0;
  if (diagonal > 0.0 && !fits(diagonal)) {
    exponent = unit_exponent(diagonal);
    if (drawn.largest > 0.0)
      if (const int undo = unit_exponent(drawn.largest / unit); fits(times_power_of_ten(diagonal, undo)))
        exponent = undo;
  }
  if (const double view = view_distance_m / unit; times_power_of_ten(view, exponent) > kFarthestView)
    exponent = static_cast<int>(std::floor(std::log10(kFarthestView / view)));
  Placement out;
  out.origin = round_origin(bounds);
  out.scale = times_power_of_ten(1.0, exponent) / unit;
  out.within_range = exponent == 0 && out.origin == glm::dvec3(0.0);
  if (meters >= kLeast && meters <= kMostInMeters) out.units_per_option_m = out.scale;
  return out;
}

Box bounds_of(const std::vector<glm::vec3>& positions) {
  Box box;
  for (const glm::vec3& p : positions) box.add(glm::dvec3(p));
  return box;
}

}  // namespace hwsim::pipeline::gltf
