// Points on a triangle: where they lie, what they stand for, and what depth is tested there
// (docs/techniques/sss.md#points). Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include "algos/sss/shaders/view-inl.h"
#if defined(HWSIM_ALGOS_SSS_SHADERS_PATTERN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_SSS_SHADERS_PATTERN_INL_H_
#undef HWSIM_ALGOS_SSS_SHADERS_PATTERN_INL_H_
#else
#define HWSIM_ALGOS_SSS_SHADERS_PATTERN_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// Weights of the three vertices at a place given by its barycentric coordinates on the screen.
template <class F>
Vec3<F> perspective_weights(const SssCorner<F> (&c)[3], const Vec3<F>& b) {
  const Vec3<F> w = {b.x * c[0].inv_w, b.y * c[1].inv_w, b.z * c[2].inv_w};
  return w * (F(1.0f) / (w.x + w.y + w.z));
}

template <class F>
F ceiling(F x) {
  return F(0.0f) - floor(F(0.0f) - x);
}

/// The pixel whose center a point of 1 px covers, after snapping as the rasterizer does.
template <class I, class F>
I point_pixel(F x) {
  const F snapped = floor(x * F(256.0f) + F(0.5f)) * F(1.0f / 256.0f);
  return to_int(ceiling(snapped) - F(1.0f));
}

/// Two numbers of [0, 1) for a triangle, from its number.
template <class F, class I>
Vec2<F> triangle_noise(I number) {
  I h = number * I(-1640531527);
  h = h ^ (shift_right<16>(h) & I(0xffff));
  h = h * I(0x7feb352d);
  h = h ^ (shift_right<15>(h) & I(0x1ffff));
  const I high = shift_right<8>(h) & I(0xffff), low = h & I(0xffff);
  return {to_float(high) * F(1.0f / 65536.0f), to_float(low) * F(1.0f / 65536.0f)};
}

/// The sample places of a triangle: `count` points, the first `border` of them along its edges.
template <class F>
struct SssPattern {
  F count, border;
  F weight;  ///< px^2 that a point stands for
  F noise_x, noise_y;
  F edge[3], perimeter;
};

template <class F>
F fraction(F x) {
  return x - floor(x);
}

template <class F, class I>
SssPattern<F> make_pattern(const SssUniforms& u, const SssTriangle<F>& t, const SssCorner<F> (&c)[3],
                           I number) {
  SssPattern<F> p;
  // No closer than in 64x supersampling, which the paper's budget aims at.
  const float most = std::max(u.samples_per_px, 64.0f);
  const F wanted = ceiling(min(F(u.samples_per_px) * t.finer, F(most)) * t.area);
  p.count = min(max(wanted, F(u.samples_min)), F(u.samples_max));
  p.border = ceiling(F(u.border_share) * p.count);
  p.weight = min(F(1.0f), t.area / p.count);
  const Vec2<F> noise = triangle_noise<F, I>(number);
  p.noise_x = noise.x;
  p.noise_y = noise.y;
  for (int e = 0; e < 3; ++e) p.edge[e] = edge_px(c[e], c[(e + 1) % 3]);
  p.perimeter = p.edge[0] + p.edge[1] + p.edge[2];
  return p;
}

/// Barycentric coordinates on the screen of point i: evenly spaced along the perimeter, or the R2 sequence.
template <class F>
Vec3<F> pattern_place(const SssPattern<F>& p, int i) {
  const F index(static_cast<float>(i));
  const F along = (index + p.noise_x) / max(p.border, F(1.0f)) * p.perimeter;
  const F second = along - p.edge[0], third = second - p.edge[1];
  const auto on_first = second < F(0.0f), on_second = third < F(0.0f);
  const F position = select(on_first, along, select(on_second, second, third));
  const F length = select(on_first, p.edge[0], select(on_second, p.edge[1], p.edge[2]));
  const F f = min(position / max(length, F(1e-6f)), F(1.0f)), rest = F(1.0f) - f;
  const F zero(0.0f);
  const Vec3<F> border = {select(on_first, rest, select(on_second, zero, f)),
                          select(on_first, f, select(on_second, rest, zero)),
                          select(on_first, zero, select(on_second, f, rest))};
  const F step = index - p.border + F(1.0f);
  F a = fraction(p.noise_x + step * F(0.7548776662f)), b = fraction(p.noise_y + step * F(0.5698402910f));
  const auto outside = (a + b) > F(1.0f);
  a = select(outside, F(1.0f) - a, a);
  b = select(outside, F(1.0f) - b, b);
  const Vec3<F> inside = {F(1.0f) - a - b, a, b};
  return select(index < p.border, border, inside);
}

/// What of a place is compared with the frame's depth.
template <class F, class I>
struct DepthTest {
  I sample;
  F depth;
};

/// At (x, y), px from the pixel's corner, with depth `z` there: the triangle's plane at the sample near to
/// it.
template <class F, class I>
DepthTest<F, I> depth_test(const SssUniforms& u, const SssTriangle<F>& t, F x, F y, F z) {
  const DepthSample<F, I> near = near_sample<F, I>(u, x, y);
  const F there = z + t.depth_slope.x * (near.x - x) + t.depth_slope.y * (near.y - y);
  return {near.number, there - t.depth_bias};
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
