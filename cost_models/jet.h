#pragma once
// A value with its derivatives by N parameters, for the fit and for intervals. The arithmetic is that of
// ceres::Jet, operation by operation, so that fits end at the same bits; plain arrays take half its time.
#include <array>
#include <cmath>
#include <cstddef>

namespace hwsim::cost_models {

template <std::size_t N>
struct Jet {
  double a;                 ///< the value
  std::array<double, N> v;  ///< its derivatives

  Jet() : Jet(0.0) {}
  explicit Jet(double value) : a(value) { v.fill(0.0); }

  friend Jet operator+(const Jet& f, const Jet& g) {
    return made(f.a + g.a, [&](std::size_t i) { return f.v[i] + g.v[i]; });
  }
  friend Jet operator-(const Jet& f, const Jet& g) {
    return made(f.a - g.a, [&](std::size_t i) { return f.v[i] - g.v[i]; });
  }
  friend Jet operator*(const Jet& f, const Jet& g) {
    return made(f.a * g.a, [&](std::size_t i) { return f.a * g.v[i] + f.v[i] * g.a; });
  }
  friend Jet operator/(const Jet& f, const Jet& g) {
    const double inverse = 1.0 / g.a, ratio = f.a * inverse;
    return made(ratio, [&](std::size_t i) { return (f.v[i] - ratio * g.v[i]) * inverse; });
  }
  friend Jet operator+(const Jet& f, double s) {
    return made(f.a + s, [&](std::size_t i) { return f.v[i]; });
  }
  friend Jet operator-(const Jet& f, double s) {
    return made(f.a - s, [&](std::size_t i) { return f.v[i]; });
  }
  friend Jet operator*(const Jet& f, double s) {
    return made(f.a * s, [&](std::size_t i) { return f.v[i] * s; });
  }
  friend Jet operator/(const Jet& f, double s) { return f * (1.0 / s); }
  friend Jet operator+(double s, const Jet& f) { return f + s; }
  friend Jet operator*(double s, const Jet& f) { return f * s; }
  friend Jet operator-(double s, const Jet& f) {
    return made(s - f.a, [&](std::size_t i) { return -f.v[i]; });
  }
  friend Jet operator/(double s, const Jet& g) {
    const double slope = -s / (g.a * g.a);
    return made(s / g.a, [&](std::size_t i) { return g.v[i] * slope; });
  }
  Jet& operator+=(const Jet& g) {
    a += g.a;
    for (std::size_t i = 0; i < N; ++i) v[i] += g.v[i];
    return *this;
  }
  Jet& operator-=(const Jet& g) { return *this = *this - g; }
  Jet& operator*=(const Jet& g) { return *this = *this * g; }
  Jet& operator/=(const Jet& g) { return *this = *this / g; }
  Jet& operator+=(double s) { return a += s, *this; }
  Jet& operator*=(double s) { return *this = *this * s; }
  friend bool operator<(const Jet& f, const Jet& g) { return f.a < g.a; }
  friend bool operator>(const Jet& f, const Jet& g) { return f.a > g.a; }

  friend Jet pow(const Jet& f, const Jet& g) {
    const double by_base = g.a * std::pow(f.a, g.a - 1.0);
    Jet result(std::pow(f.a, g.a));
    const double by_exponent = result.a * std::log(f.a);
    for (std::size_t i = 0; i < N; ++i) result.v[i] = by_base * f.v[i] + by_exponent * g.v[i];
    return result;
  }

 private:
  struct Unset {};
  explicit Jet(Unset) {}
  template <class Slope>
  static Jet made(double value, const Slope& slope) {
    Jet result{Unset{}};
    result.a = value;
    for (std::size_t i = 0; i < N; ++i) result.v[i] = slope(i);
    return result;
  }
};

}  // namespace hwsim::cost_models
