// Each operation of our Jet against that of ceres::Jet, bit for bit.
#include "cost_models/jet.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace hwsim::cost_models::test {
namespace {

constexpr std::size_t kWidth = 8;
using Ours = Jet<kWidth>;
using Theirs = ceres::Jet<double, static_cast<int>(kWidth)>;

struct Operand {
  double value = 0.0;
  std::array<double, kWidth> slopes{};

  explicit Operand(std::mt19937_64& random) {
    const auto next = [&random] {
      const double mantissa = 1.0 + static_cast<double>(random() >> 12) * 0x1p-52;
      return std::ldexp(mantissa, static_cast<int>(random() % 40) - 20);
    };
    value = next();
    for (double& slope : slopes) slope = random() % 8 == 0 ? 0.0 : (random() % 2 == 0 ? next() : -next());
  }
  Ours ours() const {
    Ours jet(value);
    for (std::size_t i = 0; i < kWidth; ++i) jet.v[i] = slopes[i];
    return jet;
  }
  Theirs theirs() const {
    Theirs jet(value);
    for (std::size_t i = 0; i < kWidth; ++i) jet.v[static_cast<Eigen::Index>(i)] = slopes[i];
    return jet;
  }
};

void expect_same_bits(const Ours& ours, const Theirs& theirs, const std::string& operation) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  EXPECT_EQ(bits(ours.a), bits(theirs.a)) << operation;
  for (std::size_t i = 0; i < kWidth; ++i)
    EXPECT_EQ(bits(ours.v[i]), bits(theirs.v[static_cast<Eigen::Index>(i)])) << operation << ", slope " << i;
}

/// Calls `operation` with two Jets and a number, of ours and of theirs.
template <class Operation>
void compare(const std::string& name, const Operation& operation) {
  std::mt19937_64 random(17);
  for (int n = 0; n < 500 && !testing::Test::HasFailure(); ++n) {
    const Operand f(random), g(random), s(random);
    expect_same_bits(operation(f.ours(), g.ours(), s.value), operation(f.theirs(), g.theirs(), s.value),
                     name);
  }
}

TEST(Jet, ItsArithmeticIsThatOfCeres) {
  compare("f + g", [](auto f, auto g, double) { return f + g; });
  compare("f - g", [](auto f, auto g, double) { return f - g; });
  compare("f * g", [](auto f, auto g, double) { return f * g; });
  compare("f / g", [](auto f, auto g, double) { return f / g; });
  compare("f + s", [](auto f, auto, double s) { return f + s; });
  compare("f - s", [](auto f, auto, double s) { return f - s; });
  compare("f * s", [](auto f, auto, double s) { return f * s; });
  compare("f / s", [](auto f, auto, double s) { return f / s; });
  compare("s + f", [](auto f, auto, double s) { return s + f; });
  compare("s - f", [](auto f, auto, double s) { return s - f; });
  compare("s * f", [](auto f, auto, double s) { return s * f; });
  compare("s / f", [](auto f, auto, double s) { return s / f; });
}

TEST(Jet, ItsAssignmentsAreThoseOfCeres) {
  compare("f += g", [](auto f, auto g, double) { return f += g; });
  compare("f -= g", [](auto f, auto g, double) { return f -= g; });
  compare("f *= g", [](auto f, auto g, double) { return f *= g; });
  compare("f /= g", [](auto f, auto g, double) { return f /= g; });
  compare("f += s", [](auto f, auto, double s) { return f += s; });
  compare("f *= s", [](auto f, auto, double s) { return f *= s; });
}

TEST(Jet, ItsPowerAndItsOrderAreThoseOfCeres) {
  compare("pow", [](auto f, auto g, double) {
    using std::pow;
    return pow(f, g);
  });
  compare("f < g", [](auto f, auto g, double) { return f < g ? f : g; });
  compare("f > g", [](auto f, auto g, double) { return f > g ? f : g; });
}

}  // namespace
}  // namespace hwsim::cost_models::test
