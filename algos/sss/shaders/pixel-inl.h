// Which places of a pixel a triangle covers (docs/techniques/sss.md#lists). Per-target include guard, see
// simd/lanes-inl.h.
#include <hwy/highway.h>
#include "algos/sss/shaders/view-inl.h"
#include "pipeline/simd/vec-inl.h"
#if defined(HWSIM_ALGOS_SSS_SHADERS_PIXEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_SSS_SHADERS_PIXEL_INL_H_
#undef HWSIM_ALGOS_SSS_SHADERS_PIXEL_INL_H_
#else
#define HWSIM_ALGOS_SSS_SHADERS_PIXEL_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// The triangle of a fragment, and which places of its pixel it covers. Coordinates: 1/256 px from the
/// pixel's corner, whole numbers.
template <class F>
struct PixelTriangle {
  F x[3], y[3], z[3], inv_w[3];
  F area2;
  F slope_x, slope_y;  ///< change of depth for 1/256 px

  F depth(F px, F py) const { return z[0] + slope_x * (px - x[0]) + slope_y * (py - y[0]); }

  pipeline::HWY_NAMESPACE::Vec3<F> barycentric(F px, F py) const {
    const F inv = F(1.0f) / ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]));
    const F b1 = ((px - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (py - y[0])) * inv;
    const F b2 = ((x[1] - x[0]) * (py - y[0]) - (px - x[0]) * (y[1] - y[0])) * inv;
    return {F(1.0f) - b1 - b2, b1, b2};
  }
};

/// The triangle's edges, ready for many places: what does not change from place to place is computed once.
template <class F>
class PixelEdges {
 public:
  explicit PixelEdges(const PixelTriangle<F>& t) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      // The edge's own direction is the one that a clockwise triangle has it on top or left in.
      const auto up = (t.y[i] > t.y[j]) | ((!(t.y[i] < t.y[j])) & (t.x[j] > t.x[i]));
      x_[i] = select(up, t.x[i], t.x[j]);
      y_[i] = select(up, t.y[i], t.y[j]);
      const F turn = select(up, t.area2, F(0.0f) - t.area2);
      const F sign = select(turn < F(0.0f), F(-1.0f), F(1.0f));
      dx_[i] = (select(up, t.x[j], t.x[i]) - x_[i]) * sign;
      dy_[i] = (select(up, t.y[j], t.y[i]) - y_[i]) * sign;
      // Products of whole numbers are whole, rounded or not: 0 belongs to the side that turns clockwise.
      least_[i] = select(turn > F(0.0f), F(-0.5f), select(turn < F(0.0f), F(0.5f), F(3e38f)));
    }
  }

  /// The top-left rule, by the same operations for both triangles of an edge: a place is in exactly one.
  auto cover(F px, F py) const {
    auto inside = dx_[0] * (py - y_[0]) - dy_[0] * (px - x_[0]) > least_[0];
    for (int i = 1; i < 3; ++i) inside = inside & (dx_[i] * (py - y_[i]) - dy_[i] * (px - x_[i]) > least_[i]);
    return inside;
  }

 private:
  F x_[3], y_[3], dx_[3], dy_[3];
  F least_[3];  ///< what lies inside is beyond it; where the triangle has no area, nothing is
};

/// Centers of a regular grid over the pixel, row by row: 1/256 px from its corner.
template <class F>
class PixelPlaces {
 public:
  explicit PixelPlaces(F grid) : step_(F(256.0f) / grid), x_(step_ * F(0.5f)), y_(x_) {}
  F x() const { return x_; }
  F y() const { return y_; }
  void next() {
    x_ = x_ + step_;
    const auto row_ends = x_ > F(256.0f);
    y_ = select(row_ends, y_ + step_, y_);
    x_ = select(row_ends, step_ * F(0.5f), x_);
  }

 private:
  F step_, x_, y_;
};

/// Nodes: color and covered 64ths of the pixel, depth, the next node. 12 bytes: 8 bits of the color's square
/// root each; 16 bytes: 16 bits linear; 32 bytes: and a bit for each of the pixel's 8x8 places, and the
/// change of depth for a place to the right and down (as in Jouppi and Chang's Z3, 1999).
template <class S>
struct NodeData {
  static constexpr int kColor = 0, kMask = 2, kSlope = 4, kWords = 6;
  typename S::I words[kWords];
};

/// Adds place i of a grid of 2, 4 or 8 to the lanes `inside`; on coarser grids than 8x8 it stands for
/// several.
template <class F, class M, class I>
void add_place(int i, F grid, M inside, I (&mask)[2]) {
  const auto bits = [&](int side, int w) {
    const int wide = 8 / side, x = i % side * wide, y = i / side * wide - 4 * w;
    std::uint32_t word = 0;
    for (int row = std::max(y, 0); row < std::min(y + wide, 4); ++row)
      word |= ((1u << wide) - 1u) << (8 * row + x);
    return I(static_cast<std::int32_t>(word));
  };
  for (int w = 0; w < 2; ++w) {
    const I coarse = select(grid < F(3.0f), bits(2, w), bits(4, w));
    mask[w] = mask[w] | select(inside, select(grid > F(6.0f), bits(8, w), coarse), I(0));
  }
}

template <class S>
NodeData<S> pack_color(const SssUniforms& u, const Vec3<typename S::F>& c, typename S::F covered) {
  using F = typename S::F;
  using I = typename S::I;
  const F range(1.0f / u.radiance_max);
  const auto code = [&](F v, float most) HWY_ATTR { return to_int(floor(v * F(most) + F(0.5f))); };
  if (u.node_words == 3) {
    const auto root = [&](F v) HWY_ATTR { return code(sqrt(v * range), 255.0f); };
    const I word =
        root(c.x) | shift_left<8>(root(c.y)) | shift_left<16>(root(c.z)) | shift_left<24>(to_int(covered));
    return {{word, I(0), I(0), I(0), I(0), I(0)}};
  }
  const auto linear = [&](F v) HWY_ATTR { return code(v * range, 65535.0f); };
  return {{linear(c.x) | shift_left<16>(linear(c.y)), linear(c.z) | shift_left<16>(to_int(covered)), I(0),
           I(0), I(0), I(0)}};
}

/// Color, and the pixel's covered part.
template <class S>
Vec4<typename S::F> unpack_color(const SssUniforms& u, const NodeData<S>& node) {
  using F = typename S::F;
  using I = typename S::I;
  const F range(u.radiance_max), part(1.0f / 64.0f);
  const auto low = [&](I w) HWY_ATTR { return to_float(w & I(0xffff)) * F(1.0f / 65535.0f) * range; };
  if (u.node_words == 3) {
    const I w = node.words[0];
    const auto square = [&](I code) HWY_ATTR {
      const F root = to_float(code & I(255)) * F(1.0f / 255.0f);
      return root * root * range;
    };
    return {square(w), square(shift_right<8>(w)), square(shift_right<16>(w)),
            to_float(shift_right<24>(w) & I(255)) * part};
  }
  return {low(node.words[0]), low(shift_right<16>(node.words[0])), low(node.words[1]),
          to_float(shift_right<16>(node.words[1]) & I(0xffff)) * part};
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
