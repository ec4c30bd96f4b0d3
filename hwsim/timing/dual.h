#pragma once
// A value with its derivatives by N parameters: forward automatic differentiation, the least that the
// engines' templates ask of a scalar. The fit has its own (cost_models/jet.h), with Ceres' rounding.
#include <array>
#include <cmath>
#include <cstddef>

namespace hwsim {

template <std::size_t N>
struct Dual {
  double v = 0.0;
  std::array<double, N> d{};

  Dual() = default;
  explicit Dual(double value) : v(value) {}
  /// The parameter number `index` itself.
  Dual(double value, std::size_t index) : v(value) { d[index] = 1.0; }

  Dual& operator+=(const Dual& b) { return combine(b, v + b.v, 1.0, 1.0); }
  Dual& operator-=(const Dual& b) { return combine(b, v - b.v, 1.0, -1.0); }
  Dual& operator*=(const Dual& b) { return combine(b, v * b.v, b.v, v); }
  Dual& operator/=(const Dual& b) { return combine(b, v / b.v, 1.0 / b.v, -v / (b.v * b.v)); }
  Dual& operator+=(double b) { return v += b, *this; }

  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator*(Dual a, const Dual& b) { return a *= b; }
  friend Dual operator/(Dual a, const Dual& b) { return a /= b; }
  friend Dual operator+(double a, const Dual& b) { return Dual(a) + b; }
  friend Dual operator+(const Dual& a, double b) { return a + Dual(b); }
  friend Dual operator-(double a, const Dual& b) { return Dual(a) - b; }
  friend Dual operator-(const Dual& a, double b) { return a - Dual(b); }
  friend Dual operator*(double a, const Dual& b) { return b.scaled(a); }
  friend Dual operator*(const Dual& a, double b) { return a.scaled(b); }
  friend Dual operator/(double a, const Dual& b) { return Dual(a) / b; }
  friend Dual operator/(const Dual& a, double b) { return a / Dual(b); }
  friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }

  friend Dual sqrt(const Dual& a) { return a.chained(std::sqrt(a.v), 0.5 / std::sqrt(a.v)); }
  friend Dual pow(const Dual& a, const Dual& b) {
    const double p = std::pow(a.v, b.v);
    Dual result = a.chained(p, p * b.v / a.v);
    for (std::size_t i = 0; i < N; ++i) result.d[i] += p * std::log(a.v) * b.d[i];
    return result;
  }

 private:
  /// `value`, with the derivatives weighted: the chain rule of a function of two.
  Dual& combine(const Dual& b, double value, double weight_a, double weight_b) {
    for (std::size_t i = 0; i < N; ++i) d[i] = weight_a * d[i] + weight_b * b.d[i];
    v = value;
    return *this;
  }
  Dual chained(double value, double slope) const {
    Dual result(value);
    for (std::size_t i = 0; i < N; ++i) result.d[i] = slope * d[i];
    return result;
  }
  Dual scaled(double factor) const { return chained(v * factor, factor); }
};

}  // namespace hwsim
