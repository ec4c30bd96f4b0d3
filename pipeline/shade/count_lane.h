#pragma once
// The counting lane type: shaders instantiated on it charge their operations to the current block instead of
// running. A multiplication whose result goes straight into an addition is one fused operation, as every GPU
// issues it.
#include <cstdint>

#include "pipeline/shade/program.h"

namespace hwsim::pipeline {

struct CountM {
  ShaderOps** ops = nullptr;
};
struct CountI;

/// A value of the counted program. `ops` points to the counter's current block; null for constants.
struct CountF {
  ShaderOps** ops = nullptr;
  bool product = false;  ///< an addition can absorb it

  CountF() = default;
  CountF(float) {}  // NOLINT: constants convert, as in the other lane types
  explicit CountF(ShaderOps** o, bool is_product = false) : ops(o), product(is_product) {}
};

struct CountI {
  ShaderOps** ops = nullptr;
  CountI() = default;
  CountI(std::int32_t) {}  // NOLINT
  explicit CountI(ShaderOps** o) : ops(o) {}
};

namespace count_detail {
inline ShaderOps** either(ShaderOps** a, ShaderOps** b) { return a ? a : b; }
inline void alu(ShaderOps** ops, std::uint32_t n = 1) {
  if (ops) (*ops)->alu += n;
}
inline void sfu(ShaderOps** ops, std::uint32_t n = 1) {
  if (ops) (*ops)->sfu += n;
}
inline CountF sum(CountF a, CountF b) {
  ShaderOps** ops = either(a.ops, b.ops);
  const bool fused = (a.product && a.ops) || (b.product && b.ops);
  alu(ops, fused ? 0 : 1);  // the multiplication was charged already
  return CountF(ops);
}
inline CountF one_alu(CountF a, CountF b) {
  ShaderOps** ops = either(a.ops, b.ops);
  alu(ops);
  return CountF(ops);
}
inline CountM compare(ShaderOps** ops) {
  alu(ops);
  return {ops};
}
inline CountI int_alu(CountI a, CountI b) {
  ShaderOps** ops = either(a.ops, b.ops);
  alu(ops);
  return CountI(ops);
}
}  // namespace count_detail

inline CountF operator+(CountF a, CountF b) { return count_detail::sum(a, b); }
inline CountF operator-(CountF a, CountF b) { return count_detail::sum(a, b); }
inline CountF operator*(CountF a, CountF b) {
  ShaderOps** ops = count_detail::either(a.ops, b.ops);
  count_detail::alu(ops);
  return CountF(ops, true);
}
inline CountF operator/(CountF a, CountF b) {
  ShaderOps** ops = count_detail::either(a.ops, b.ops);
  count_detail::sfu(ops);
  count_detail::alu(ops);
  return CountF(ops, true);
}
inline CountF operator-(CountF a) { return a; }  // a source modifier
inline CountF abs(CountF a) { return a; }        // likewise
inline CountF min(CountF a, CountF b) { return count_detail::one_alu(a, b); }
inline CountF max(CountF a, CountF b) { return count_detail::one_alu(a, b); }
inline CountF floor(CountF a) { return count_detail::one_alu(a, a); }
inline CountF sqrt(CountF a) {
  count_detail::sfu(a.ops);
  count_detail::alu(a.ops);
  return CountF(a.ops);
}
inline CountF rsqrt(CountF a) {
  count_detail::sfu(a.ops);
  return CountF(a.ops);
}
inline CountF exp2(CountF a) { return rsqrt(a); }
inline CountF log2(CountF a) { return rsqrt(a); }
inline CountM operator<(CountF a, CountF b) {
  return count_detail::compare(count_detail::either(a.ops, b.ops));
}
inline CountM operator<=(CountF a, CountF b) { return a < b; }
inline CountM operator>(CountF a, CountF b) { return a < b; }
inline CountM operator>=(CountF a, CountF b) { return a < b; }
inline CountM operator&(CountM a, CountM b) {
  ShaderOps** ops = count_detail::either(a.ops, b.ops);
  count_detail::alu(ops);
  return {ops};
}
inline CountM operator|(CountM a, CountM b) { return a & b; }
inline CountM operator!(CountM a) { return a; }
inline CountF select(CountM m, CountF a, CountF b) {
  ShaderOps** ops = count_detail::either(m.ops, count_detail::either(a.ops, b.ops));
  count_detail::alu(ops);
  return CountF(ops);
}
inline CountI select(CountM m, CountI a, CountI b) {
  ShaderOps** ops = count_detail::either(m.ops, count_detail::either(a.ops, b.ops));
  count_detail::alu(ops);
  return CountI(ops);
}
inline CountI operator+(CountI a, CountI b) { return count_detail::int_alu(a, b); }
inline CountI operator-(CountI a, CountI b) { return count_detail::int_alu(a, b); }
inline CountI operator*(CountI a, CountI b) { return count_detail::int_alu(a, b); }
inline CountI operator&(CountI a, CountI b) { return count_detail::int_alu(a, b); }
inline CountI operator|(CountI a, CountI b) { return count_detail::int_alu(a, b); }
inline CountI operator^(CountI a, CountI b) { return count_detail::int_alu(a, b); }
template <int kBits>
CountI shift_left(CountI a) {
  return count_detail::int_alu(a, a);
}
template <int kBits>
CountI shift_right(CountI a) {
  return count_detail::int_alu(a, a);
}
inline CountI min(CountI a, CountI b) { return count_detail::int_alu(a, b); }
inline CountI max(CountI a, CountI b) { return count_detail::int_alu(a, b); }
inline CountM operator<(CountI a, CountI b) {
  return count_detail::compare(count_detail::either(a.ops, b.ops));
}
inline CountM operator>(CountI a, CountI b) { return a < b; }
inline CountM operator==(CountI a, CountI b) { return a < b; }
inline CountM operator!=(CountI a, CountI b) { return a < b; }
inline CountI to_int(CountF a) {
  count_detail::alu(a.ops);
  return CountI(a.ops);
}
inline CountF to_float(CountI a) {
  count_detail::alu(a.ops);
  return CountF(a.ops);
}
inline CountF bits_to_float(CountI a) { return CountF(a.ops); }
inline CountI float_to_bits(CountF a) { return CountI(a.ops); }
inline bool any(CountM) { return true; }

}  // namespace hwsim::pipeline
