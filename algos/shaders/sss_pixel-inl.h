// Which places of a pixel a triangle covers (techniques 5.4). Per-target include guard, see
// shade/lanes-inl.h.
#include <hwy/highway.h>
#include "pipeline/shade/vec-inl.h"
#if defined(HWSIM_ALGOS_SHADERS_SSS_PIXEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_SHADERS_SSS_PIXEL_INL_H_
#undef HWSIM_ALGOS_SHADERS_SSS_PIXEL_INL_H_
#else
#define HWSIM_ALGOS_SHADERS_SSS_PIXEL_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// The triangle of a fragment, and which places of its pixel it covers. Coordinates: 1/256 px from the
/// pixel's corner, whole numbers.
template <class F>
struct PixelTriangle {
  F x[3], y[3], z[3], inv_w[3];
  F area2;

  /// The top-left rule, by the same operations for both triangles of an edge: a place is in exactly one.
  auto covers(F px, F py) const {
    auto inside = F(0.0f) < F(1.0f);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      // The edge's own direction is the one that a clockwise triangle has it on top or left in.
      const auto up = (y[i] > y[j]) | ((!(y[i] < y[j])) & (x[j] > x[i]));
      const F ax = select(up, x[i], x[j]), ay = select(up, y[i], y[j]);
      const F bx = select(up, x[j], x[i]), by = select(up, y[j], y[i]);
      const F side = (bx - ax) * (py - ay) - (by - ay) * (px - ax);
      const F turn = select(up, area2, F(0.0f) - area2);
      inside = inside & (((!(side < F(0.0f))) & (turn > F(0.0f))) | ((side < F(0.0f)) & (turn < F(0.0f))));
    }
    return inside;
  }

  pipeline::HWY_NAMESPACE::Vec3<F> barycentric(F px, F py) const {
    const F inv = F(1.0f) / ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]));
    const F b1 = ((px - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (py - y[0])) * inv;
    const F b2 = ((x[1] - x[0]) * (py - y[0]) - (px - x[0]) * (y[1] - y[0])) * inv;
    return {F(1.0f) - b1 - b2, b1, b2};
  }
};

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
