#pragma once
// A value with its derivatives by N parameters, for the fit. The arithmetic is that of ceres::Jet, operation
// by operation, so that fits end at the same bits (jet_test compares each). It is not ceres::Jet itself
// because that takes 18 ns where this takes 3 (a step of the queue's recurrence, N = 8, AVX-512): Eigen's own
// vector code is off in this library, as its sums differ between processors, and the compiler does not find
// it by itself.
#include <cmath>
#include <cstddef>

#include "hwsim/timing/dual.h"

namespace hwsim::cost_models {

template <std::size_t N>
struct Jet {
  using Slopes = typename DoublesOf<N>::Type;

  double a;  ///< the value
  Slopes v;  ///< its derivatives

  Jet() : Jet(0.0) {}
  explicit Jet(double value) : Jet(value, Slopes{}) {}

  friend Jet operator+(const Jet& f, const Jet& g) { return {f.a + g.a, f.v + g.v}; }
  friend Jet operator-(const Jet& f, const Jet& g) { return {f.a - g.a, f.v - g.v}; }
  friend Jet operator*(const Jet& f, const Jet& g) { return {f.a * g.a, f.a * g.v + f.v * g.a}; }
  friend Jet operator/(const Jet& f, const Jet& g) {
    const double inverse = 1.0 / g.a, ratio = f.a * inverse;
    return {ratio, (f.v - ratio * g.v) * inverse};
  }
  friend Jet operator+(const Jet& f, double s) { return {f.a + s, f.v}; }
  friend Jet operator-(const Jet& f, double s) { return {f.a - s, f.v}; }
  friend Jet operator*(const Jet& f, double s) { return {f.a * s, f.v * s}; }
  friend Jet operator/(const Jet& f, double s) { return f * (1.0 / s); }
  friend Jet operator+(double s, const Jet& f) { return f + s; }
  friend Jet operator*(double s, const Jet& f) { return f * s; }
  friend Jet operator-(double s, const Jet& f) { return {s - f.a, -f.v}; }
  friend Jet operator/(double s, const Jet& g) { return {s / g.a, g.v * (-s / (g.a * g.a))}; }
  Jet& operator+=(const Jet& g) { return *this = *this + g; }
  Jet& operator-=(const Jet& g) { return *this = *this - g; }
  Jet& operator*=(const Jet& g) { return *this = *this * g; }
  Jet& operator/=(const Jet& g) { return *this = *this / g; }
  Jet& operator+=(double s) { return a += s, *this; }
  Jet& operator*=(double s) { return *this = *this * s; }
  friend bool operator<(const Jet& f, const Jet& g) { return f.a < g.a; }
  friend bool operator>(const Jet& f, const Jet& g) { return f.a > g.a; }

  friend Jet pow(const Jet& f, const Jet& g) {
    const double by_base = g.a * std::pow(f.a, g.a - 1.0), power = std::pow(f.a, g.a);
    return {power, by_base * f.v + power * std::log(f.a) * g.v};
  }

 private:
  Jet(double value, const Slopes& slopes) : a(value), v(slopes) {}
};

}  // namespace hwsim::cost_models
