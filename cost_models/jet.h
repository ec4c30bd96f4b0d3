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
  explicit Jet(double value) : a(value), v{} {}

  // Results are stored member by member: clang 14 takes a temporary of Slopes behind a reference for one that
  // is aligned to its size, which it is not where the address sanitizer lays out the stack.
  friend Jet operator+(const Jet& f, const Jet& g) {
    Jet h(f.a + g.a);
    h.v = f.v + g.v;
    return h;
  }
  friend Jet operator-(const Jet& f, const Jet& g) {
    Jet h(f.a - g.a);
    h.v = f.v - g.v;
    return h;
  }
  friend Jet operator*(const Jet& f, const Jet& g) {
    Jet h(f.a * g.a);
    h.v = f.a * g.v + f.v * g.a;
    return h;
  }
  friend Jet operator/(const Jet& f, const Jet& g) {
    const double inverse = 1.0 / g.a, ratio = f.a * inverse;
    Jet h(ratio);
    h.v = (f.v - ratio * g.v) * inverse;
    return h;
  }
  friend Jet operator+(const Jet& f, double s) {
    Jet h(f);
    h.a = f.a + s;
    return h;
  }
  friend Jet operator-(const Jet& f, double s) {
    Jet h(f);
    h.a = f.a - s;
    return h;
  }
  friend Jet operator*(const Jet& f, double s) {
    Jet h(f.a * s);
    h.v = f.v * s;
    return h;
  }
  friend Jet operator/(const Jet& f, double s) { return f * (1.0 / s); }
  friend Jet operator+(double s, const Jet& f) { return f + s; }
  friend Jet operator*(double s, const Jet& f) { return f * s; }
  friend Jet operator-(double s, const Jet& f) {
    Jet h(s - f.a);
    h.v = -f.v;
    return h;
  }
  friend Jet operator/(double s, const Jet& g) {
    Jet h(s / g.a);
    h.v = g.v * (-s / (g.a * g.a));
    return h;
  }
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
    Jet h(power);
    h.v = by_base * f.v + power * std::log(f.a) * g.v;
    return h;
  }
};

}  // namespace hwsim::cost_models
