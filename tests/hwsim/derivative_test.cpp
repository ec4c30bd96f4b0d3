// The engines over a scalar that carries a derivative, as the fit uses them: checked against finite
// differences.
#include <gtest/gtest.h>

#include <cmath>

#include "hwsim/config/gpu_keys.h"
#include "hwsim/sample_gpu.h"
#include "hwsim/timing/time_pass.h"

namespace hwsim::test {
namespace {

/// A value and its derivative: the least that an automatic-differentiation type offers.
struct Dual {
  double v = 0.0, d = 0.0;
  Dual() = default;
  explicit Dual(double value, double derivative = 0.0) : v(value), d(derivative) {}
  Dual& operator+=(const Dual& b) { return *this = Dual(v + b.v, d + b.d); }
  Dual& operator-=(const Dual& b) { return *this = Dual(v - b.v, d - b.d); }
  Dual& operator*=(const Dual& b) { return *this = Dual(v * b.v, d * b.v + v * b.d); }
  Dual& operator+=(double b) { return *this = Dual(v + b, d); }
  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator*(Dual a, const Dual& b) { return a *= b; }
  friend Dual operator/(const Dual& a, const Dual& b) {
    return Dual(a.v / b.v, (a.d * b.v - a.v * b.d) / (b.v * b.v));
  }
  friend Dual operator+(double a, const Dual& b) { return Dual(a) + b; }
  friend Dual operator+(const Dual& a, double b) { return a + Dual(b); }
  friend Dual operator-(double a, const Dual& b) { return Dual(a) - b; }
  friend Dual operator-(const Dual& a, double b) { return a - Dual(b); }
  friend Dual operator*(double a, const Dual& b) { return Dual(a) * b; }
  friend Dual operator*(const Dual& a, double b) { return a * Dual(b); }
  friend Dual operator/(double a, const Dual& b) { return Dual(a) / b; }
  friend Dual operator/(const Dual& a, double b) { return a / Dual(b); }
  friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend Dual sqrt(const Dual& a) { return Dual(std::sqrt(a.v), a.d / (2.0 * std::sqrt(a.v))); }
  friend Dual pow(const Dual& a, const Dual& b) {
    const double p = std::pow(a.v, b.v);
    return Dual(p, p * (b.d * std::log(a.v) + b.v * a.d / a.v));
  }
};

/// Copies the numbers of a config to duals; the key `seeded` gets derivative one.
struct ToDual {
  std::vector<Key> keys;
  std::string_view seeded;
  std::size_t next = 0;
  void key(const KeyInfo& info, Dual& value) {
    value = Dual(*std::get<double*>(keys[next++].slot), info.name == seeded ? 1.0 : 0.0);
  }
  void key(const KeyInfo&, int& value) { value = *std::get<int*>(keys[next++].slot); }
  void key(const KeyInfo&, bool& value) { value = *std::get<bool*>(keys[next++].slot); }
};

TEST(Derivative, OfEveryFittedKeyEqualsTheFiniteDifference) {
  GpuValues<double> base = sample_gpu();
  base.dram_bandwidth_gb_s = 60.0;
  base.pass_overhead_us = 2.0;
  const PassWork pass = busy_pass(70);
  int nonzero = 0;
  for (const Engine engine : {Engine::roofline, Engine::queue})
    for (const Key& key : keys_of(base)) {
      auto* const* slot = std::get_if<double*>(&key.slot);
      if (!slot || !key.info.has(kFit)) continue;
      GpuValues<Dual> duals;
      ToDual to_dual{keys_of(base), key.info.name};
      describe(to_dual, duals);
      const Dual exact = time_pass(pass, derive_rates<Dual>(duals), engine, true).time_ns;
      const double value = **slot, step = std::max(1e-6, 1e-6 * value);
      const auto time_at = [&](double x) {
        **slot = x;
        return time_pass(pass, derive_rates<double>(base), engine, true).time_ns;
      };
      const double slope = (time_at(value + step) - time_at(value - step)) / (2.0 * step);
      **slot = value;
      EXPECT_DOUBLE_EQ(exact.v, time_at(value));
      EXPECT_NEAR(exact.d, slope, 1e-3 * std::abs(slope) + 1e-2)
          << key.info.name << " in " << engine_name(engine);
      nonzero += exact.d != 0.0 ? 1 : 0;
    }
  EXPECT_GT(nonzero, 10);
}

}  // namespace
}  // namespace hwsim::test
