// Quads on their way into a fragment batch: pixel coordinates and barycentrics. Per-target include guard.
#include "pipeline/emulate/pass_context.h"
#include "pipeline/raster/coverage-inl.h"
#include "pipeline/simd/lanes-inl.h"

#if defined(HWSIM_EMULATE_FRAGMENT_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_EMULATE_FRAGMENT_SETUP_INL_H_
#undef HWSIM_EMULATE_FRAGMENT_SETUP_INL_H_
#else
#define HWSIM_EMULATE_FRAGMENT_SETUP_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

using D4 = hn::FixedTag<float, 4>;
using D4I = hn::FixedTag<std::int32_t, 4>;

HWY_INLINE hn::Vec<D4> plane_at(const PlaneEquation& p, hn::Vec<D4> x, hn::Vec<D4> y) {
  const D4 d;
  return hn::Add(hn::Add(hn::Set(d, p.base), hn::Mul(hn::Set(d, p.ddy), y)), hn::Mul(hn::Set(d, p.ddx), x));
}

/// Perspective-correct barycentrics of a quad's four lanes at (x, y) from the triangle's reference pixel.
HWY_INLINE void barycentrics(const RasterTriangle& t, hn::Vec<D4> x, hn::Vec<D4> y, float* b1, float* b2) {
  const D4 d;
  const auto w = hn::Div(hn::Set(d, 1.0f), plane_at(t.inv_w, x, y));
  hn::StoreU(hn::Mul(plane_at(t.l1_w, x, y), w), d, b1);
  hn::StoreU(hn::Mul(plane_at(t.l2_w, x, y), w), d, b2);
}

HWY_ALIGN inline constexpr float kQuadX[4] = {0, 1, 0, 1};
HWY_ALIGN inline constexpr float kQuadY[4] = {0, 0, 1, 1};
HWY_ALIGN inline constexpr std::int32_t kQuadXi[4] = {0, 1, 0, 1};
HWY_ALIGN inline constexpr std::int32_t kQuadYi[4] = {0, 0, 1, 1};

HWY_INLINE void set_pixels(FragmentBatch& batch, int quad) {
  const D4I d;
  const auto q = static_cast<std::size_t>(quad);
  hn::StoreU(hn::Add(hn::Load(d, kQuadXi), hn::Set(d, batch.quad_x[q])), d, batch.pixel_x.data() + 4 * quad);
  hn::StoreU(hn::Add(hn::Load(d, kQuadYi), hn::Set(d, batch.quad_y[q])), d, batch.pixel_y.data() + 4 * quad);
}

/// Bits of all samples for each of a quad's lanes.
HWY_INLINE void lane_coverage(const QuadSamples& samples, int count, std::uint32_t* coverage) {
  for (int lane = 0; lane < 4; ++lane) coverage[lane] = 0;
  for (int s = 0; s < count; ++s) {
    const std::uint32_t mask = samples.masks[s];
    for (std::uint32_t lane = 0; lane < 4; ++lane) coverage[lane] |= (mask >> lane & 1u) << s;
  }
}

inline std::size_t first_covered(std::uint32_t bits, const CentroidRule& rule) {
  for (const std::uint8_t s : rule.order)
    if ((bits >> s & 1u) != 0) return s;
  return static_cast<std::size_t>(__builtin_ctz(bits));
}

/// Attribute location of the centroid rule (docs/techniques/conventions.md#rasterization): the center where
/// all samples are covered or none is, else the rule's first covered sample. Depth tests don't move it.
inline void centroid_offsets(const std::uint32_t* coverage, const CentroidRule& rule, float* dx, float* dy) {
  const std::size_t count = rule.positions.size();
  const std::uint32_t all = count == 32 ? 0xffffffffu : (1u << count) - 1;
  for (int lane = 0; lane < 4; ++lane) {
    const std::uint32_t bits = coverage[lane];
    const bool center = bits == 0 || bits == all;
    const std::size_t s = center ? 0 : first_covered(bits, rule);
    dx[lane] = center ? 0.0f : static_cast<float>(rule.positions[s].x) * 0.0625f;
    dy[lane] = center ? 0.0f : static_cast<float>(rule.positions[s].y) * 0.0625f;
  }
}

enum class AttributeLocation { center, centroid, sample };

HWY_INLINE LaneF plane_at(const PlaneEquation& p, LaneF x, LaneF y) {
  return (LaneF(p.base) + LaneF(p.ddy) * y) + LaneF(p.ddx) * x;
}

/// The same operations as `barycentrics` for a quad.
HWY_INLINE void barycentrics(const RasterTriangle& t, LaneF x, LaneF y, float* b1, float* b2) {
  const LaneF w = LaneF(1.0f) / plane_at(t.inv_w, x, y);
  store(plane_at(t.l1_w, x, y) * w, b1);
  store(plane_at(t.l2_w, x, y) * w, b2);
}

/// Offsets of the attribute location from the pixel centers for lanes [first, ...).
HWY_INLINE void location_offsets(const FragmentBatch& batch, int first, AttributeLocation location,
                                 const CentroidRule& rule, int sample, LaneF& dx, LaneF& dy) {
  if (location == AttributeLocation::sample) {
    const SamplePosition p = rule.positions[static_cast<std::size_t>(sample)];
    dx = LaneF(static_cast<float>(p.x) * 0.0625f);
    dy = LaneF(static_cast<float>(p.y) * 0.0625f);
    return;
  }
  HWY_ALIGN float x[kVectorLanes], y[kVectorLanes];
  for (int lane = 0; lane < kVectorLanes; lane += 4)
    centroid_offsets(batch.primitive_coverage.data() + first + lane, rule, x + lane, y + lane);
  dx = load(x);
  dy = load(y);
}

/// As set_up_quad, for the whole tile with corner (x, y) and one triangle.
inline void set_up_tile(FragmentBatch& batch, int x, int y, AttributeLocation location,
                        const CentroidRule& rule, int sample) {
  const RasterTriangle* t = batch.triangle[0];
  for (int first = 0; first < kBlockLanes; first += kVectorLanes) {
    if ((batch.valid_lanes >> first & kRegisterBits) == 0) continue;
    store(load(kLaneOffsets.x + first) + LaneI(x), batch.pixel_x.data() + first);
    store(load(kLaneOffsets.y + first) + LaneI(y), batch.pixel_y.data() + first);
    if (t == nullptr) continue;
    // Quad corner, then lane, then half a pixel: multiples of 1/256, exact in any order.
    const LaneF px = load(kLaneOffsets.fx + first) + LaneF((static_cast<float>(x) - t->reference_x) + 0.5f);
    const LaneF py = load(kLaneOffsets.fy + first) + LaneF((static_cast<float>(y) - t->reference_y) + 0.5f);
    barycentrics(*t, px, py, batch.b1_center.data() + first, batch.b2_center.data() + first);
    if (location == AttributeLocation::center) {
      store(load(batch.b1_center.data() + first), batch.b1.data() + first);
      store(load(batch.b2_center.data() + first), batch.b2.data() + first);
      continue;
    }
    LaneF dx(0.0f), dy(0.0f);
    location_offsets(batch, first, location, rule, sample, dx, dy);
    barycentrics(*t, px + dx, py + dy, batch.b1.data() + first, batch.b2.data() + first);
  }
}

/// Everything of quad `quad` of `batch` that a shader can ask for; its triangle and position are set already.
HWY_INLINE void set_up_quad(FragmentBatch& batch, int quad, AttributeLocation location,
                            const CentroidRule& rule, int sample) {
  set_pixels(batch, quad);
  const RasterTriangle* t = batch.triangle[static_cast<std::size_t>(quad)];
  if (t == nullptr) return;
  const D4 d;
  const auto q = static_cast<std::size_t>(quad);
  const auto x =
      hn::Add(hn::Load(d, kQuadX), hn::Set(d, (static_cast<float>(batch.quad_x[q]) - t->reference_x) + 0.5f));
  const auto y =
      hn::Add(hn::Load(d, kQuadY), hn::Set(d, (static_cast<float>(batch.quad_y[q]) - t->reference_y) + 0.5f));
  const int lane = 4 * quad;
  barycentrics(*t, x, y, batch.b1_center.data() + lane, batch.b2_center.data() + lane);
  if (location == AttributeLocation::center) {
    hn::StoreU(hn::LoadU(d, batch.b1_center.data() + lane), d, batch.b1.data() + lane);
    hn::StoreU(hn::LoadU(d, batch.b2_center.data() + lane), d, batch.b2.data() + lane);
    return;
  }
  HWY_ALIGN float dx[4], dy[4];
  if (location == AttributeLocation::centroid) {
    centroid_offsets(batch.primitive_coverage.data() + lane, rule, dx, dy);
  } else {
    const SamplePosition p = rule.positions[static_cast<std::size_t>(sample)];
    for (int i = 0; i < 4; ++i) {
      dx[i] = static_cast<float>(p.x) * 0.0625f;
      dy[i] = static_cast<float>(p.y) * 0.0625f;
    }
  }
  barycentrics(*t, hn::Add(x, hn::Load(d, dx)), hn::Add(y, hn::Load(d, dy)), batch.b1.data() + lane,
               batch.b2.data() + lane);
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
