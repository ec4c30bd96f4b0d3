#pragma once
// Numbers that have the same bits on every machine: + - * / and sqrt are exact in IEEE 754 (the project is
// compiled without contraction); the C library's sin and the standard distributions are not.
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace hwsim::pipeline::generate {

constexpr double kPi = 3.14159265358979323846;

/// Taylor series to x^13 on [-pi/2, pi/2]: error below 6e-9.
inline double exact_sin(double x) {
  const double turns = x / (2.0 * kPi);
  x = (turns - std::floor(turns + 0.5)) * (2.0 * kPi);
  if (x > kPi / 2) x = kPi - x;
  if (x < -kPi / 2) x = -kPi - x;
  const double s = x * x;
  return x * (1.0 + s * (-1.0 / 6 +
                         s * (1.0 / 120 + s * (-1.0 / 5040 + s * (1.0 / 362880 + s * (-1.0 / 39916800 +
                                                                                      s / 6227020800.0))))));
}
inline double exact_cos(double x) { return exact_sin(x + kPi / 2); }

inline glm::dvec3 unit(const glm::dvec3& v) {
  const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return length > 0.0 ? v / length : glm::dvec3(0, 1, 0);
}

/// PCG-XSH-RR 64/32 (O'Neill 2014).
class Pcg {
 public:
  explicit Pcg(std::uint64_t seed) : state_(seed * 2 + 1) {
    next();
    state_ += 0x853c49e6748fea9bu;
    next();
  }
  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005u + 1442695040888963407u;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turn = static_cast<std::uint32_t>(old >> 59);
    return (shifted >> turn) | (shifted << ((32 - turn) & 31));
  }
  double uniform(double low, double high) { return low + (high - low) * (next() / 4294967296.0); }
  int below(int n) { return static_cast<int>((std::uint64_t{next()} * static_cast<std::uint64_t>(n)) >> 32); }

 private:
  std::uint64_t state_;
};

}  // namespace hwsim::pipeline::generate
