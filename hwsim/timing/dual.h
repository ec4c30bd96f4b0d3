#pragma once
// A value with its derivatives by N parameters: forward automatic differentiation, the least that the
// engines' templates ask of a scalar. The fit has its own (cost_models/jet.h), with Ceres' rounding.
#include <cmath>
#include <cstddef>

namespace hwsim {

/// N doubles in vector registers, however wide these are. Each operation acts on each double alone, so that
/// its bits are those of single ones.
template <std::size_t N>
struct DoublesOf {
  using Type [[gnu::vector_size(N * sizeof(double)), gnu::aligned(alignof(double))]] = double;
};

template <std::size_t N>
struct Dual {
  double v = 0.0;
  typename DoublesOf<N>::Type d{};

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
    result.d += p * std::log(a.v) * b.d;
    return result;
  }

 private:
  /// `value`, with the derivatives weighted: the chain rule of a function of two.
  Dual& combine(const Dual& b, double value, double weight_a, double weight_b) {
    d = weight_a * d + weight_b * b.d;
    v = value;
    return *this;
  }
  Dual chained(double value, double slope) const {
    Dual result(value);
    result.d = slope * d;
    return result;
  }
  Dual scaled(double factor) const { return chained(v * factor, factor); }
};

}  // namespace hwsim
