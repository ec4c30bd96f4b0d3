#pragma once
// The counting lane type: shaders instantiated on it charge their operations to the current block instead of
// running, and leave a record of which result each operation waits for. A multiplication whose result goes
// straight into an addition is one fused operation, as every GPU issues it.
#include <cstdint>

#include "pipeline/shade/op_recorder.h"

namespace hwsim::pipeline {

/// A result of the counted program; without a recorder, a constant.
struct CountValue {
  OpRecorder* ops = nullptr;
  int op = -1;  ///< the operation that made it
};

struct CountM : CountValue {
  CountM() = default;
  explicit CountM(CountValue v) : CountValue(v) {}
};

struct CountF : CountValue {
  bool product = false;  ///< an addition can absorb it

  CountF() = default;
  CountF(float) {}  // NOLINT: constants convert, as in the other lane types
  explicit CountF(CountValue v, bool is_product = false) : CountValue(v), product(is_product) {}
};

struct CountI : CountValue {
  CountI() = default;
  CountI(std::int32_t) {}  // NOLINT
  explicit CountI(CountValue v) : CountValue(v) {}
};

namespace count_detail {
inline CountValue record(OpKind kind, CountValue a, CountValue b = {}, CountValue c = {}) {
  OpRecorder* ops = a.ops ? a.ops : b.ops ? b.ops : c.ops;
  if (ops == nullptr) return {};
  return {ops, ops->add(kind, {a.op, b.op, c.op})};
}
inline CountValue alu(CountValue a, CountValue b = {}, CountValue c = {}) {
  return record(OpKind::alu, a, b, c);
}
inline CountF sum(CountF a, CountF b) {
  const bool first = a.product && a.ops, second = b.product && b.ops;
  if (first) return CountF(record(OpKind::fused, a, b));  // the multiplication was charged already
  if (second) return CountF(record(OpKind::fused, b, a));
  return CountF(alu(a, b));
}
inline CountF sfu(CountF a) { return CountF(record(OpKind::sfu, a)); }
}  // namespace count_detail

inline CountF operator+(CountF a, CountF b) { return count_detail::sum(a, b); }
inline CountF operator-(CountF a, CountF b) { return count_detail::sum(a, b); }
inline CountF operator*(CountF a, CountF b) { return CountF(count_detail::alu(a, b), true); }
inline CountF operator/(CountF a, CountF b) {
  const CountF reciprocal = count_detail::sfu(b.ops ? b : a);
  return CountF(count_detail::alu(a, reciprocal), true);
}
inline CountF operator-(CountF a) { return a; }  // a source modifier
inline CountF abs(CountF a) { return a; }        // likewise
inline CountF min(CountF a, CountF b) { return CountF(count_detail::alu(a, b)); }
inline CountF max(CountF a, CountF b) { return CountF(count_detail::alu(a, b)); }
inline CountF floor(CountF a) { return CountF(count_detail::alu(a)); }
inline CountF sqrt(CountF a) { return CountF(count_detail::alu(count_detail::sfu(a))); }
inline CountF rsqrt(CountF a) { return count_detail::sfu(a); }
inline CountF exp2(CountF a) { return count_detail::sfu(a); }
inline CountF log2(CountF a) { return count_detail::sfu(a); }
inline CountM operator<(CountF a, CountF b) { return CountM(count_detail::alu(a, b)); }
inline CountM operator<=(CountF a, CountF b) { return a < b; }
inline CountM operator>(CountF a, CountF b) { return a < b; }
inline CountM operator>=(CountF a, CountF b) { return a < b; }
inline CountM operator&(CountM a, CountM b) { return CountM(count_detail::alu(a, b)); }
inline CountM operator|(CountM a, CountM b) { return a & b; }
inline CountM operator!(CountM a) { return a; }
inline CountF select(CountM m, CountF a, CountF b) { return CountF(count_detail::alu(m, a, b)); }
inline CountI select(CountM m, CountI a, CountI b) { return CountI(count_detail::alu(m, a, b)); }
inline CountI operator+(CountI a, CountI b) { return CountI(count_detail::alu(a, b)); }
inline CountI operator-(CountI a, CountI b) { return CountI(count_detail::alu(a, b)); }
inline CountI operator*(CountI a, CountI b) { return CountI(count_detail::alu(a, b)); }
inline CountI operator&(CountI a, CountI b) { return CountI(count_detail::alu(a, b)); }
inline CountI operator|(CountI a, CountI b) { return CountI(count_detail::alu(a, b)); }
inline CountI operator^(CountI a, CountI b) { return CountI(count_detail::alu(a, b)); }
template <int kBits>
CountI shift_left(CountI a) {
  return CountI(count_detail::alu(a));
}
template <int kBits>
CountI shift_right(CountI a) {
  return CountI(count_detail::alu(a));
}
inline CountI min(CountI a, CountI b) { return CountI(count_detail::alu(a, b)); }
inline CountI max(CountI a, CountI b) { return CountI(count_detail::alu(a, b)); }
inline CountM operator<(CountI a, CountI b) { return CountM(count_detail::alu(a, b)); }
inline CountM operator>(CountI a, CountI b) { return a < b; }
inline CountM operator==(CountI a, CountI b) { return a < b; }
inline CountM operator!=(CountI a, CountI b) { return a < b; }
inline CountI to_int(CountF a) { return CountI(count_detail::alu(a)); }
inline CountF to_float(CountI a) { return CountF(count_detail::alu(a)); }
inline CountF bits_to_float(CountI a) { return CountF(CountValue(a)); }
inline CountI float_to_bits(CountF a) { return CountI(CountValue(a)); }
/// A shader that unpacks sRGB itself evaluates the curve: a power, and the line near zero.
inline CountF lookup(const float*, CountI code) {
  const CountF power = count_detail::sfu(count_detail::sfu(CountF(count_detail::alu(code))));
  return CountF(count_detail::alu(count_detail::alu(code), power));
}
inline bool any(CountM) { return true; }

}  // namespace hwsim::pipeline
