#include "pipeline/memory/stencil.h"

namespace hwsim::pipeline {
namespace {

void apply(const StencilState& state, StencilOp op, std::uint8_t* stencil, std::uint64_t lanes) {
  if (op == StencilOp::keep) return;
  for (; lanes != 0; lanes &= lanes - 1) {
    std::uint8_t& value = stencil[__builtin_ctzll(lanes)];
    value = stencil_result(state, op, value);
  }
}

}  // namespace

bool stencil_passes(const StencilState& state, std::uint8_t stored) {
  const int reference = state.reference & state.read_mask;
  const int value = stored & state.read_mask;
  switch (state.compare) {
    case Compare::never:
      return false;
    case Compare::less:
      return reference < value;
    case Compare::equal:
      return reference == value;
    case Compare::less_equal:
      return reference <= value;
    case Compare::greater:
      return reference > value;
    case Compare::not_equal:
      return reference != value;
    case Compare::greater_equal:
      return reference >= value;
    case Compare::always:
      return true;
  }
  return true;
}

std::uint8_t stencil_result(const StencilState& state, StencilOp op, std::uint8_t stored) {
  int value = stored;
  switch (op) {
    case StencilOp::keep:
      break;
    case StencilOp::zero:
      value = 0;
      break;
    case StencilOp::replace:
      value = state.reference;
      break;
    case StencilOp::increment_saturate:
      value = value < 255 ? value + 1 : 255;
      break;
    case StencilOp::decrement_saturate:
      value = value > 0 ? value - 1 : 0;
      break;
    case StencilOp::invert:
      value = ~value & 255;
      break;
    case StencilOp::increment_wrap:
      value = (value + 1) & 255;
      break;
    case StencilOp::decrement_wrap:
      value = (value - 1) & 255;
      break;
  }
  return static_cast<std::uint8_t>((stored & ~state.write_mask) | (value & state.write_mask));
}

void test_stencil(const StencilState& state, int samples, std::uint8_t* stencil, std::uint64_t* masks) {
  for (int s = 0; s < samples; ++s, stencil += 64) {
    std::uint64_t passed = 0;
    for (std::uint64_t lanes = masks[s]; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctzll(lanes);
      if (stencil_passes(state, stencil[lane])) passed |= std::uint64_t{1} << lane;
    }
    apply(state, state.on_fail, stencil, masks[s] & ~passed);
    masks[s] = passed;
  }
}

void update_stencil(const StencilState& state, int samples, std::uint8_t* stencil,
                    const std::uint64_t* tested, const std::uint64_t* passed) {
  for (int s = 0; s < samples; ++s, stencil += 64) {
    apply(state, state.on_depth_fail, stencil, tested[s] & ~passed[s]);
    apply(state, state.on_pass, stencil, passed[s]);
  }
}

}  // namespace hwsim::pipeline
