// What the variants of selective supersampling share: a triangle in this view, whether it is critical, and
// the lighting of a point on it. Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include "algos/sss/shaders/programs.h"
#include "pipeline/shade/bit_ops-inl.h"
#include "pipeline/shade/surface-inl.h"
#include "pipeline/texture/texture_sampler-inl.h"
#if defined(HWSIM_ALGOS_SSS_SHADERS_VIEW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_SSS_SHADERS_VIEW_INL_H_
#undef HWSIM_ALGOS_SSS_SHADERS_VIEW_INL_H_
#else
#define HWSIM_ALGOS_SSS_SHADERS_VIEW_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

namespace lanes = pipeline::HWY_NAMESPACE;
using lanes::Vec2;
using lanes::Vec3;
using lanes::Vec4;

/// Blocks beyond those of materials and lighting.
enum SssBlock : int {
  kCriticalBlock = 10,
  kHighlightPointBlock = 12,
  kSampleBlock = 13,
  kShadeBlock = 14,
  kStoreBlock = 15,
  kHighlightSunBlock = 16
};

/// Attribute scalars of a vertex beside its position on the screen, in the order of SurfaceVaryings but
/// without what a material does not use.
constexpr int attribute_count(SssVertex vertex) {
  using V = pipeline::SurfaceVaryings;
  return vertex == SssVertex::plain ? 6 : vertex == SssVertex::textured ? V::kBasic : V::kFull;
}
/// Place in SurfaceVaryings of attribute i.
constexpr int attribute_place(SssVertex vertex, int i) {
  using V = pipeline::SurfaceVaryings;
  return vertex == SssVertex::plain && i >= 3 ? V::kPosition + i - 3 : i;
}

template <class F>
struct SssCorner {
  Vec4<F> clip;
  F x, y, z;  ///< in the view: pixels, and depth
  F inv_w;
  Vec3<F> normal, position;  ///< unit normal
};

template <class F>
void place_corner(const SssUniforms& u, SssCorner<F>& c) {
  c.inv_w = F(1.0f) / c.clip.w;
  c.x = (c.clip.x * c.inv_w * F(0.5f) + F(0.5f)) * F(static_cast<float>(u.width_px));
  c.y = (F(0.5f) - c.clip.y * c.inv_w * F(0.5f)) * F(static_cast<float>(u.height_px));
  c.z = c.clip.z * c.inv_w;
}

/// A triangle as the per-frame test sees it.
template <class F>
struct SssTriangle {
  F area2;   ///< twice the area in px^2, positive where it turns clockwise on the screen
  F area;    ///< px^2
  F facing;  ///< -1: the back of a double-sided material
  F theta;   ///< largest angle between two normals
  F cos_theta;
  F highlight_px;       ///< width of a highlight on it, where it is thinnest
  F finer;              ///< samples for each one that a pixel-wide highlight needs
  F exponent;           ///< Phong's
  Vec2<F> depth_slope;  ///< change of depth for a pixel
  F depth_bias;         ///< by which samples come forward
};

/// asin for [0, 0.71] by its series: relative error below 0.3 %; beyond it underrates. Sizes of highlights
/// need no more.
template <class F>
F small_asin(F x) {
  const F x2 = x * x;
  F p = F(0.0303819f);
  p = p * x2 + F(0.0446429f);
  p = p * x2 + F(0.075f);
  p = p * x2 + F(0.1666667f);
  p = p * x2 + F(1.0f);
  return p * x;
}

template <class F>
F largest_chord2(const SssCorner<F> (&c)[3]) {
  const auto chord2 = [&](int i, int j) HWY_ATTR {
    const Vec3<F> d = c[i].normal - c[j].normal;
    return dot(d, d);
  };
  return max(max(chord2(0, 1), chord2(1, 2)), chord2(2, 0));
}

template <class F>
F edge_px(const SssCorner<F>& a, const SssCorner<F>& b) {
  const F dx = b.x - a.x, dy = b.y - a.y;
  return sqrt(dx * dx + dy * dy);
}

/// Change of a value that is linear on the screen, for one pixel to the right and down.
template <class F>
Vec2<F> gradient(const SssCorner<F> (&c)[3], F area2, F v0, F v1, F v2) {
  const F inv = F(1.0f) / area2;
  return {((v1 - v0) * (c[2].y - c[0].y) - (v2 - v0) * (c[1].y - c[0].y)) * inv,
          ((v2 - v0) * (c[1].x - c[0].x) - (v1 - v0) * (c[2].x - c[0].x)) * inv};
}

/// Exponent of the material's lobe, before the scale (docs/techniques/conventions.md#shading-models).
inline float material_exponent(const pipeline::MaterialView& m) {
  const float alpha = std::max(m.roughness * m.roughness, 0.03f);
  return std::max(2.0f / (alpha * alpha) - 2.0f, 0.0f);
}
inline float material_reflectance(const pipeline::MaterialView& m) {
  const float base = std::max({m.base_color[0], m.base_color[1], m.base_color[2]});
  return base * m.metallic + 0.04f * (1.0f - m.metallic);
}

/// Full width of the Phong lobe at half its height, in the reflection's angle: 2 acos(0.5^(1/s)). acos(c)
/// from its series at 1: sqrt(2 (1 - c)) (1 + (1 - c) / 12), within 3 % down to c = 0.
template <class F>
F lobe_width(F exponent) {
  const F away = F(1.0f) - exp2(F(-1.0f) / max(exponent, F(1e-3f)));
  return F(2.0f) * sqrt(F(2.0f) * away) * (F(1.0f) + away * F(0.0833333f));
}

/// Radians for a pixel by which the normal turns, in the direction on the screen in which it turns most, and
/// across it: the singular values of its derivatives. (docs/techniques/sss.md#classification divides the
/// longest edge by the angle between normals, which is this for triangles about as long as wide. On a bar's
/// long ones the normal turns across them, and their length says nothing of how thin the highlight is.)
template <class F>
Vec2<F> normal_turns(const SssCorner<F> (&c)[3], F area2) {
  const Vec2<F> x = gradient(c, area2, c[0].normal.x, c[1].normal.x, c[2].normal.x);
  const Vec2<F> y = gradient(c, area2, c[0].normal.y, c[1].normal.y, c[2].normal.y);
  const Vec2<F> z = gradient(c, area2, c[0].normal.z, c[1].normal.z, c[2].normal.z);
  const F across = x.x * x.x + y.x * y.x + z.x * z.x, down = x.y * x.y + y.y * y.y + z.y * z.y;
  const F both = x.x * x.y + y.x * y.y + z.x * z.y;
  const F half = (across - down) * F(0.5f);
  const F middle = (across + down) * F(0.5f), apart = sqrt(half * half + both * both);
  return {sqrt(middle + apart), sqrt(max(middle - apart, F(0.0f)))};
}

template <class S, class F>
SssTriangle<F> measure_triangle(S& s, const SssUniforms& u, float winding, SssCorner<F> (&c)[3]) {
  for (SssCorner<F>& corner : c) place_corner(u, corner);
  SssTriangle<F> t;
  t.area2 = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
  t.area = abs(t.area2) * F(0.5f);
  t.facing = select(t.area2 * F(winding) < F(0.0f), F(1.0f), F(-1.0f));
  const F chord2 = largest_chord2(c);
  t.theta = F(2.0f) * small_asin(min(sqrt(chord2) * F(0.5f), F(1.0f)));
  t.cos_theta = F(1.0f) - chord2 * F(0.5f);
  t.exponent = F(material_exponent(s.material()) * u.exponent_scale);
  // A reflection turns twice as fast as the normal.
  const Vec2<F> turns = normal_turns(c, t.area2);
  const F lobe = F(2.0f) / lobe_width(t.exponent);
  t.highlight_px = F(1.0f) / max(turns.x * lobe, F(1e-6f));
  // On a bar the highlight is thin across, and long along it: samples are closer in one direction only.
  t.finer = min(max(turns.x * lobe, F(1.0f)), F(1e3f)) * min(max(turns.y * lobe, F(1.0f)), F(1e3f));
  t.depth_slope = gradient(c, t.area2, c[0].z, c[1].z, c[2].z);
  t.depth_bias = F(u.depth_bias) + F(u.depth_slope) * max(abs(t.depth_slope.x), abs(t.depth_slope.y));
  return t;
}

/// In view, facing, and small in the sense of the mode.
template <class S, class F>
typename S::M is_critical(S& s, const SssUniforms& u, const SssTriangle<F>& t, const SssCorner<F> (&c)[3]) {
  auto in_front = c[0].clip.w > F(1e-6f), left = c[0].clip.x<-c[0].clip.w, right = c[0].clip.x> c[0].clip.w,
       below = c[0].clip.y<-c[0].clip.w, above = c[0].clip.y> c[0].clip.w, far = c[0].clip.z > c[0].clip.w;
  for (int i = 1; i < 3; ++i) {
    in_front = in_front & (c[i].clip.w > F(1e-6f));
    left = left & (c[i].clip.x < -c[i].clip.w);
    right = right & (c[i].clip.x > c[i].clip.w);
    below = below & (c[i].clip.y < -c[i].clip.w);
    above = above & (c[i].clip.y > c[i].clip.w);
    far = far & (c[i].clip.z > c[i].clip.w);
  }
  const auto seen =
      in_front & !(left | right | below | above | far) & (t.area > F(0.0f)) & !(t.area > F(u.largest_px2));
  const auto small_triangle = sqrt(t.area) < F(u.triangle_px),
             small_highlight = t.highlight_px < F(u.highlight_px);
  const auto small =
      u.mode == SssMode::both ? small_triangle & small_highlight : small_triangle | small_highlight;
  const F double_sided(s.material().double_sided ? 1.0f : 0.0f);
  return s.valid() & seen & small & ((t.facing + double_sided) > F(0.0f));
}

/// Bound of the highlight of one light on the triangle: its reflection comes no closer to the eye than at
/// the best vertex less twice the spread of the normals.
template <class F>
F highlight_bound(const SssTriangle<F>& t, F best_cos, F strength) {
  const F cos2 = F(2.0f) * t.cos_theta * t.cos_theta - F(1.0f);
  const F sin_theta = sqrt(max(F(1.0f) - t.cos_theta * t.cos_theta, F(0.0f)));
  const F sin2 = F(2.0f) * t.cos_theta * sin_theta;
  const F best = max(min(best_cos, F(1.0f)), F(-1.0f));
  const F nearest = best * cos2 + sqrt(F(1.0f) - best * best) * sin2;
  const auto reached = (best > cos2) | (t.cos_theta < F(0.0f));  // within the spread, or it is half a turn
  const F cosine = select(reached, F(1.0f), max(nearest, F(0.0f)));
  return lanes::pow(cosine, t.exponent) * strength;
}

template <class F>
F reflection_cos(const SssCorner<F>& c, const Vec3<F>& to_eye, const Vec3<F>& to_light, F facing) {
  const Vec3<F> n = c.normal * facing;
  const Vec3<F> r = n * (F(2.0f) * dot(n, to_light)) - to_light;
  return dot(r, to_eye);
}

/// Whether a highlight of any light may show on the triangle.
template <class S, class F>
typename S::M near_highlight(S& s, const SssUniforms& u, const SssTriangle<F>& t, const SssCorner<F> (&c)[3],
                             typename S::M mask) {
  const pipeline::MaterialView& m = s.material();
  const float exponent = material_exponent(m);
  const float lobe = u.normalized ? (exponent + 8.0f) * 0.0397887358f : 1.0f;
  const float reflectance = material_reflectance(m) * lobe;
  Vec3<F> to_eye[3];
  for (int v = 0; v < 3; ++v) to_eye[v] = normalize(lanes::broadcast<F>(u.lighting.eye) - c[v].position);
  F strongest(0.0f);
  s.loop(kHighlightSunBlock, u.lighting.directional_count, mask, [&](int i) HWY_ATTR {
    const pipeline::DirectionalLight& light = u.lighting.directional[static_cast<std::size_t>(i)];
    const Vec3<F> l = lanes::broadcast<F>(light.to_light);
    F best(-1.0f);
    for (int v = 0; v < 3; ++v) best = max(best, reflection_cos(c[v], to_eye[v], l, t.facing));
    const float strength = std::max({light.color.x, light.color.y, light.color.z}) * reflectance;
    strongest = max(strongest, highlight_bound(t, best, F(strength)));
  });
  const std::span points(u.lighting.points.data(), s.loop_count(u.lighting.point_count));
  s.loop(kHighlightPointBlock, static_cast<int>(points.size()), mask, [&](int i) HWY_ATTR {
    const pipeline::PointLight& light = points[static_cast<std::size_t>(i)];
    F best(-1.0f), reaches(0.0f);
    for (int v = 0; v < 3; ++v) {
      Vec3<F> l;
      reaches = max(reaches, lanes::point_attenuation(light, c[v].position, l));
      best = max(best, reflection_cos(c[v], to_eye[v], l, t.facing));
    }
    const float strength = std::max({light.color.x, light.color.y, light.color.z}) * reflectance;
    strongest = max(strongest, highlight_bound(t, best, F(strength) * reaches));
  });
  return mask & !(strongest < F(u.threshold));
}

/// The test of a frame, counted. `mask`: triangles that exist.
template <class S, class F>
typename S::M select_triangles(S& s, const SssUniforms& u, const SssTriangle<F>& t,
                               const SssCorner<F> (&c)[3], typename S::M mask) {
  using T = SssCounters;
  const auto critical = mask & is_critical(s, u, t, c);
  auto chosen = critical;
  s.branch(kCriticalBlock, critical, [&]() HWY_ATTR {
    if (u.early_exit) chosen = near_highlight(s, u, t, c, critical);
  });
  if (u.counted) {
    s.count(T::sss_tested_primitives, mask);
    s.count(T::sss_uncritical_primitives, mask & !critical);
    s.count(T::sss_early_exit_primitives, critical & !chosen);
    s.count(T::sss_processed_primitives, chosen);
  }
  return chosen;
}

/// One of the multisampled frame's samples in its pixel.
template <class F, class I>
struct DepthSample {
  I number;
  F x, y;  ///< px from the pixel's corner
};

/// The sample near to a place, px from its pixel's corner. (In cells of a quarter: 4 of 16 cells hold places
/// that lie nearer to another one, by 0.1 px at most.)
template <class F, class I>
DepthSample<F, I> near_sample(const SssUniforms& u, F x, F y) {
  const auto cell = [](F v) HWY_ATTR { return max(min(to_int(v * F(4.0f)), I(3)), I(0)); };
  const I row = cell(y);
  const I word = select(row < I(2), I(u.nearest_samples[0]), I(u.nearest_samples[1]));
  const I place = shift_left<4>(row & I(1)) | shift_left<2>(cell(x));
  DepthSample<F, I> s;
  s.number = lanes::shift_right_by(word, place) & I(7);
  const I digit = shift_left<2>(s.number);
  s.x = to_float(lanes::shift_right_by(I(u.samples_x), digit) & I(15)) * F(1.0f / 16.0f);
  s.y = to_float(lanes::shift_right_by(I(u.samples_y), digit) & I(15)) * F(1.0f / 16.0f);
  return s;
}

/// Stands for a fragment at attributes of its own: materials and lighting take it as their context.
template <class S>
class SurfacePoint {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;

  explicit SurfacePoint(S& s) : s_(s) {}

  std::array<F, pipeline::SurfaceVaryings::kFull> values;
  lanes::TextureSite<F> site{F(0.0f), F(0.0f), F(0.0f), F(0.0f), F(0.0f), F(0.0f)};  ///< u and v: of `values`

  const pipeline::MaterialView& material() const { return s_.material(); }
  F attr(int k) const { return values[static_cast<std::size_t>(k)]; }
  Vec3<F> attr3(int k) const { return {attr(k), attr(k + 1), attr(k + 2)}; }
  F facing() const { return F(1.0f); }  // normals were turned already
  /// The level of detail is that of UV set 0 for both sets.
  Vec4<F> sample_texture(const pipeline::TextureView* texture, int k) {
    site.u = attr(k);
    site.v = attr(k + 1);
    return s_.sample_texture_at(texture, site);
  }
  F compare_image(int slot, F x, F y, F reference) { return s_.compare_image(slot, x, y, reference); }
  template <class Body>
  void branch(int block, M mask, Body&& body) {
    s_.branch(block, mask, body);
  }
  template <class Body>
  void uniform_branch(int block, bool condition, Body&& body) {
    s_.uniform_branch(block, condition, body);
  }
  template <class Body>
  void loop(int block, int count, M mask, Body&& body) {
    s_.loop(block, count, mask, body);
  }
  std::size_t loop_count(int count) const { return s_.loop_count(count); }

 private:
  S& s_;
};

/// Light that leaves the point for the eye, clamped.
template <class S>
Vec3<typename S::F> light_point(S& s, const SssUniforms& u, SurfacePoint<S>& point, SssVertex vertex,
                                typename S::M mask) {
  using F = typename S::F;
  const auto material = lanes::sample_material(point, vertex == SssVertex::full);
  const auto surface =
      lanes::make_surface(material, point.attr3(pipeline::SurfaceVaryings::kPosition), u.lighting.eye);
  const Vec3<F> c = lanes::occlude_ambient(
      point, u.lighting, surface,
      lanes::light_surface(point, u.lighting, surface, lanes::lights_reach(point, mask)));
  s.count(SssCounters::sss_shaded_samples, mask);
  const F most(u.radiance_max);
  const auto limited = [&](F x) HWY_ATTR { return min(max(x, F(0.0f)), most); };
  return {limited(c.x), limited(c.y), limited(c.z)};
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
