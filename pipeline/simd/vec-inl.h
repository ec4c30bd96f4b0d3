// Vectors over a lane type F (simd/lanes-inl.h, simd/scalar_lane-inl.h, shade/count_lane.h).
// Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>

#if defined(HWSIM_SIMD_VEC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SIMD_VEC_INL_H_
#undef HWSIM_SIMD_VEC_INL_H_
#else
#define HWSIM_SIMD_VEC_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

template <class F>
struct Vec2 {
  F x, y;
};
template <class F>
struct Vec3 {
  F x, y, z;
};
template <class F>
struct Vec4 {
  F x, y, z, w;
};

template <class F>
Vec2<F> operator+(const Vec2<F>& a, const Vec2<F>& b) {
  return {a.x + b.x, a.y + b.y};
}
template <class F>
Vec2<F> operator*(const Vec2<F>& a, F s) {
  return {a.x * s, a.y * s};
}

template <class F>
Vec3<F> operator+(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
Vec3<F> operator-(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
Vec3<F> operator-(const Vec3<F>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class F>
Vec3<F> operator*(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class F>
Vec3<F> operator*(const Vec3<F>& a, F s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class F>
F dot(const Vec3<F>& a, const Vec3<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
Vec3<F> cross(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F, class M>
Vec3<F> select(M mask, const Vec3<F>& a, const Vec3<F>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}
/// A zero vector stays zero: the guard costs one max.
template <class F>
Vec3<F> normalize(const Vec3<F>& a) {
  return a * rsqrt(max(dot(a, a), F(1e-30f)));
}
template <class F>
Vec3<F> lerp(const Vec3<F>& a, const Vec3<F>& b, F t) {
  return a + (b - a) * t;
}

template <class F>
Vec4<F> operator+(const Vec4<F>& a, const Vec4<F>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
template <class F>
Vec4<F> operator-(const Vec4<F>& a, const Vec4<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
}
template <class F>
Vec4<F> operator*(const Vec4<F>& a, F s) {
  return {a.x * s, a.y * s, a.z * s, a.w * s};
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
