// Lobes of normals that an aggregate holds, and what they reflect (docs/techniques/agaa.md#shading): Toksvig
// (2005), LEAN (Olano and Baker 2010), SGGX (Heitz et al. 2015). Per-target include guard, see
// simd/lanes-inl.h.
#include <hwy/highway.h>
#include "algos/agaa/shaders/record-inl.h"
#include "pipeline/shade/lighting-inl.h"
#if defined(HWSIM_ALGOS_AGAA_SHADERS_LOBES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_AGAA_SHADERS_LOBES_INL_H_
#undef HWSIM_ALGOS_AGAA_SHADERS_LOBES_INL_H_
#else
#define HWSIM_ALGOS_AGAA_SHADERS_LOBES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

inline constexpr float kLargestExponent = 65534.0f;
inline constexpr float kPi = 3.14159265f;

template <class F>
struct SymmetricMatrix {
  F xx, yy, zz, xy, xz, yz;
};

template <class F>
void add_square(SymmetricMatrix<F>& sum, const Vec3<F>& d) {
  sum.xx = sum.xx + d.x * d.x;
  sum.yy = sum.yy + d.y * d.y;
  sum.zz = sum.zz + d.z * d.z;
  sum.xy = sum.xy + d.x * d.y;
  sum.xz = sum.xz + d.x * d.z;
  sum.yz = sum.yz + d.y * d.z;
}

template <class F>
SymmetricMatrix<F> covariance(const SymmetricMatrix<F>& squares, const Vec3<F>& mean, F share) {
  return {max(squares.xx * share - mean.x * mean.x, F(0.0f)),
          max(squares.yy * share - mean.y * mean.y, F(0.0f)),
          max(squares.zz * share - mean.z * mean.z, F(0.0f)),
          squares.xy * share - mean.x * mean.y,
          squares.xz * share - mean.x * mean.z,
          squares.yz * share - mean.y * mean.z};
}

template <class F>
Vec3<F> multiply(const SymmetricMatrix<F>& m, const Vec3<F>& v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

template <class F>
SymmetricMatrix<F> squared(const SymmetricMatrix<F>& m) {
  return {m.xx * m.xx + m.xy * m.xy + m.xz * m.xz, m.xy * m.xy + m.yy * m.yy + m.yz * m.yz,
          m.xz * m.xz + m.yz * m.yz + m.zz * m.zz, m.xx * m.xy + m.xy * m.yy + m.xz * m.yz,
          m.xx * m.xz + m.xy * m.yz + m.xz * m.zz, m.xy * m.xz + m.yy * m.yz + m.yz * m.zz};
}

/// The longest principal axis, as long as its standard deviation: a column of a power, 2^squarings.
template <int kSquarings = 4, class F>
Vec3<F> main_axis(const SymmetricMatrix<F>& m) {
  SymmetricMatrix<F> p = m;
  for (int i = 0; i < kSquarings; ++i) {
    const F scale = F(1.0f) / max(p.xx + p.yy + p.zz, F(1e-25f));
    p = squared(SymmetricMatrix<F>{p.xx * scale, p.yy * scale, p.zz * scale, p.xy * scale, p.xz * scale,
                                   p.yz * scale});
  }
  Vec3<F> column = {p.xx, p.xy, p.xz};
  column = select(p.yy > p.xx, Vec3<F>{p.xy, p.yy, p.yz}, column);
  column = select((p.zz > p.xx) & (p.zz > p.yy), Vec3<F>{p.xz, p.yz, p.zz}, column);
  const Vec3<F> axis = normalize(column);
  return axis * sqrt(max(dot(axis, multiply(m, axis)), F(0.0f)));
}

/// Variance across the unit direction l, both axes together.
template <class F>
F across_variance(const SymmetricMatrix<F>& m, const Vec3<F>& l) {
  return max(m.xx + m.yy + m.zz - dot(l, multiply(m, l)), F(0.0f));
}

/// The exponent that a Toksvig vector of this length holds; `reference` as in
/// docs/techniques/agaa.md#shading, 0: infinite.
template <class F>
F exponent_of(F length, float reference) {
  if (reference <= 0.0f) return length / (F(1.0f) - length);
  return length * F(reference) / (length + F(reference) * (F(1.0f) - length));
}

/// A von Mises-Fisher lobe of normals with mean length `r`, as its diffuse light needs it: what no light
/// changes. A series below kappa 2.5 (error 0.002), the fit of spherical Gaussians above (0.016);
/// docs/techniques/agaa.md#shading.
template <class F>
struct DiffuseLobe {
  F constant, linear, square;  ///< the series, in the cosine
  F scale, offset, root, inv_root;
  decltype(F{} < F{}) wide, flat;
};

template <class F>
DiffuseLobe<F> diffuse_lobe(F r) {
  const F r2 = r * r;
  const F kappa = r * (F(3.0f) - r2) / max(F(1.0f) - r2, F(1e-6f));
  const F inv = F(1.0f) / max(kappa, F(1e-3f));
  const F e1 = exp2(kappa * F(-1.442695041f)), e2 = e1 * e1;
  const F k2 = kappa * kappa;
  const auto series = kappa < F(0.3f);
  const F coth = (F(1.0f) + e2) / max(F(1.0f) - e2, F(1e-3f));
  const F a1 = select(series, kappa * (F(1.0f / 3.0f) - k2 * F(1.0f / 45.0f)), coth - inv);
  const F a2 = select(series, k2 * (F(1.0f / 15.0f) - k2 * F(2.0f / 315.0f)), F(1.0f) - F(3.0f) * a1 * inv);
  DiffuseLobe<F> lobe;
  lobe.constant = F(0.25f) - F(5.0f / 32.0f) * a2;
  lobe.linear = F(0.5f) * a1;
  lobe.square = F(15.0f / 32.0f) * a2;
  lobe.scale = F(1.0f) + F(2.0f) * e2 - inv;
  lobe.offset = (e1 - e2) * inv - e2;
  lobe.root = sqrt(max(F(1.0f) - lobe.scale, F(0.0f)));
  lobe.inv_root = F(1.0f) / max(lobe.root, F(1e-6f));
  lobe.wide = kappa < F(2.5f);
  lobe.flat = !(kappa < F(1e4f));
  return lobe;
}

/// Mean of max(0, n.l) over the lobe around a normal at cosine `mu`.
template <class F>
F diffuse_of(const DiffuseLobe<F>& lobe, F mu) {
  const F cosine = max(mu, F(0.0f));
  const F series = lobe.constant + mu * (lobe.linear + mu * lobe.square);
  const F x0 = F(0.36f) * mu, x1 = lobe.root * F(1.0f / 1.44f);
  const F n = x0 + x1;
  const F y = select(abs(x0) <= x1, n * n * lobe.inv_root, cosine);
  const F filtered = max(select(lobe.wide, series, lobe.scale * y + lobe.offset), F(0.0f));
  return select(lobe.flat, cosine, filtered);
}

/// What a lobe of normals with exponent a reflects of a material with exponent s: its density in h,
/// (a+1)/(2 pi) (n.h)^a, times the integral of the material's own lobe, (s+8)/(8 pi) 2 pi/(s+1). Toksvig's
/// factor (1+a)/(1+s) on the normalized lobe; a = s where nothing spreads. This is what does not depend on a,
/// for an energy of 1.
inline constexpr float kOwnLobeScale = 0.0397887358f;

template <class F>
Vec3<F> blinn_phong_specular(const lanes::Surface<F>& s, F own_scale, const Vec3<F>& l) {
  const Vec3<F> h = normalize(l + s.to_eye);
  const F lobe = (s.exponent + F(1.0f)) * own_scale * lanes::pow(max(dot(s.normal, h), F(0.0f)), s.exponent);
  return s.specular * select(dot(s.normal, l) > F(0.0f), lobe, F(0.0f));
}

template <class F>
Vec3<F> schlick(const lanes::Surface<F>& s, F v_dot_h) {
  const F m = F(1.0f) - max(v_dot_h, F(0.0f));
  const F m2 = m * m;
  return s.specular + (Vec3<F>{F(1.0f), F(1.0f), F(1.0f)} - s.specular) * (m2 * m2 * m);
}

/// Smith's masking of both directions over 4 n.l n.v, times n.l and the lights' pi (shade/lighting-inl.h).
template <class F>
F smith_visibility(const lanes::Surface<F>& s, F n_dot_l) {
  const F n_dot_v = max(dot(s.normal, s.to_eye), F(1e-4f)), cosine = max(n_dot_l, F(1e-4f));
  const F a2 = s.alpha * s.alpha;
  const auto g1 = [&](F c) HWY_ATTR { return F(2.0f) * c / (c + sqrt(a2 + (F(1.0f) - a2) * c * c)); };
  return g1(n_dot_v) * g1(cosine) / (F(4.0f) * n_dot_v * cosine) * max(n_dot_l, F(0.0f)) * F(kPi);
}

template <class F>
Vec3<F> ggx_specular(const lanes::Surface<F>& s, const Vec3<F>& l) {
  const Vec3<F> h = normalize(l + s.to_eye);
  const F n_dot_h = max(dot(s.normal, h), F(0.0f));
  const F a2 = s.alpha * s.alpha;
  const F d = n_dot_h * n_dot_h * (a2 - F(1.0f)) + F(1.0f);
  const F ndf = a2 * F(1.0f / kPi) / max(d * d, F(1e-12f));
  return schlick(s, dot(s.to_eye, h)) * (ndf * smith_visibility(s, dot(s.normal, l)));
}

/// Mean slope and its covariance, in the pixel's basis.
template <class F>
struct Lean {
  F bx, by;
  F xx, yy, xy;
  F det;
};

template <class F>
Lean<F> make_lean(const F (&shape)[6]) {
  Lean<F> lean;
  lean.bx = shape[0];
  lean.by = shape[1];
  // Half floats' rounding hides narrower lobes: what is left of the moments' difference is noise.
  const auto variance = [](F moment, F mean) HWY_ATTR {
    return max(moment - mean * mean, F(1e-5f) + mean * mean * F(1.0f / 512.0f));
  };
  lean.xx = variance(shape[2], lean.bx);
  lean.yy = variance(shape[3], lean.by);
  lean.xy = shape[4] - lean.bx * lean.by;
  lean.det = max(lean.xx * lean.yy - lean.xy * lean.xy, F(1e-8f));
  return lean;
}

template <class F>
Vec3<F> lean_specular(const lanes::Surface<F>& s, F own_scale, const Lean<F>& lean,
                      const PixelBasis<F>& basis, const Vec3<F>& l, bool ggx) {
  const Vec3<F> h = normalize(l + s.to_eye);
  const F hz = dot(h, basis.z);
  const F inv_z = F(1.0f) / max(hz, F(1e-3f));
  const F x = dot(h, basis.x) * inv_z - lean.bx, y = dot(h, basis.y) * inv_z - lean.by;
  const F e = (x * x * lean.yy - F(2.0f) * x * y * lean.xy + y * y * lean.xx) / lean.det;
  const F density = exp2(e * F(-0.7213475204f)) * F(0.5f / kPi) * rsqrt(lean.det);
  const auto lit = (dot(s.normal, l) > F(0.0f)) & (hz > F(0.0f));
  // The peak density of variance 1/s is s/(2 pi): so the peak is that of the normalized Blinn-Phong lobe.
  if (!ggx) return s.specular * select(lit, density * own_scale, F(0.0f));
  const F inv_z2 = inv_z * inv_z;
  const F lobe = density * inv_z2 * inv_z2 * smith_visibility(s, dot(s.normal, l));
  return schlick(s, dot(s.to_eye, h)) * select(lit, lobe, F(0.0f));
}

/// The matrix of the microflakes, its adjugate and determinant; world axes.
template <class F>
struct Sggx {
  SymmetricMatrix<F> s, adjugate;
  F det;
};

template <class F>
Sggx<F> make_sggx(const F (&shape)[6]) {
  const auto adjugate_of = [](const SymmetricMatrix<F>& m) HWY_ATTR {
    return SymmetricMatrix<F>{m.yy * m.zz - m.yz * m.yz, m.xx * m.zz - m.xz * m.xz,
                              m.xx * m.yy - m.xy * m.xy, m.xz * m.yz - m.xy * m.zz,
                              m.xy * m.yz - m.xz * m.yy, m.xy * m.xz - m.yz * m.xx};
  };
  Sggx<F> g;
  g.s = {shape[0], shape[1], shape[2], shape[3], shape[4], shape[5]};
  g.adjugate = adjugate_of(g.s);
  g.det = g.s.xx * g.adjugate.xx + g.s.xy * g.adjugate.xy + g.s.xz * g.adjugate.xz;
  // Rounding of the stored entries can leave a matrix that is not positive definite.
  const auto broken = !((g.det > F(1e-9f)) & (g.adjugate.xx > F(0.0f)) & (g.adjugate.yy > F(0.0f)) &
                        (g.adjugate.zz > F(0.0f)));
  const F added = select(broken, F(1e-4f), F(0.0f));
  g.s.xx = g.s.xx + added;
  g.s.yy = g.s.yy + added;
  g.s.zz = g.s.zz + added;
  g.adjugate = adjugate_of(g.s);
  g.det = max(g.s.xx * g.adjugate.xx + g.s.xy * g.adjugate.xy + g.s.xz * g.adjugate.xz, F(1e-12f));
  return g;
}

template <class F>
Vec3<F> sggx_specular(const lanes::Surface<F>& s, F own_scale, const Sggx<F>& g, const Vec3<F>& l, bool ggx) {
  const Vec3<F> h = normalize(l + s.to_eye);
  const F q = max(dot(h, multiply(g.adjugate, h)), F(1e-12f));
  const F ratio = g.det / q;  // D = 1 / (pi sqrt|S| (h S^-1 h)^2), S^-1 = adjugate / |S|
  const F density = ratio * ratio * F(1.0f / kPi) * rsqrt(g.det);
  const auto lit = dot(s.normal, l) > F(0.0f);
  // Blinn-Phong knows no masking, and no pi (shade/lighting-inl.h).
  if (!ggx) return s.specular * select(lit, density * own_scale, F(0.0f));
  const F sigma = sqrt(max(dot(s.to_eye, multiply(g.s, s.to_eye)), F(1e-6f)));
  return schlick(s, dot(s.to_eye, h)) * select(lit, density / (F(4.0f) * sigma) * F(kPi), F(0.0f));
}

/// What sampling the normals that a direction sees needs of an SGGX (Heitz et al. 2015, their supplement).
template <class F>
struct SggxFrame {
  Vec3<F> k, j, i;              ///< i: toward the viewer
  Vec3<F> k_row, j_row, i_row;  ///< a normal's components from a point (u, v, w) of the hemisphere
};

template <class F>
SggxFrame<F> sggx_frame(const Sggx<F>& g, const Vec3<F>& view) {
  SggxFrame<F> f;
  const auto steep = abs(view.y) > F(0.999f);
  const Vec3<F> up = {F(0.0f), select(steep, F(0.0f), F(1.0f)), select(steep, F(1.0f), F(0.0f))};
  f.i = view;
  f.k = normalize(cross(up, view));
  f.j = cross(view, f.k);
  const Vec3<F> sk = multiply(g.s, f.k), sj = multiply(g.s, f.j), si = multiply(g.s, f.i);
  const F kk = dot(f.k, sk), jj = dot(f.j, sj), ii = max(dot(f.i, si), F(1e-8f));
  const F kj = dot(f.k, sj), ki = dot(f.k, si), ji = dot(f.j, si);
  const F volume =
      sqrt(max(kk * jj * ii - kj * kj * ii - ki * ki * jj - ji * ji * kk + F(2.0f) * kj * ki * ji, F(0.0f)));
  const F inv_root = rsqrt(ii);
  const F area = sqrt(max(jj * ii - ji * ji, F(1e-12f)));
  const F inv_area = F(1.0f) / area;
  f.k_row = {volume * inv_area, F(0.0f) - inv_root * (ki * ji - kj * ii) * inv_area, inv_root * ki};
  f.j_row = {F(0.0f), inv_root * area, inv_root * ji};
  f.i_row = {F(0.0f), F(0.0f), inv_root * ii};
  return f;
}

/// `point`: on the unit hemisphere over the disk.
template <class F>
Vec3<F> visible_normal(const SggxFrame<F>& f, const Vec3<F>& point) {
  const F mk = point.x * f.k_row.x + point.y * f.k_row.y + point.z * f.k_row.z;
  const F mj = point.y * f.j_row.y + point.z * f.j_row.z;
  const F mi = point.z * f.i_row.z;
  return normalize(f.k * mk + f.j * mj + f.i * mi);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
