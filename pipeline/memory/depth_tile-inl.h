// Coarse and fine depth tests of 8x8 tiles. Per-target include guard.
#include "pipeline/memory/depth_format.h"
#include "pipeline/memory/depth_planes.h"
#include "pipeline/memory/gpu_image.h"
#include "pipeline/raster/coverage-inl.h"
#include "pipeline/raster/triangle.h"
#include "pipeline/simd/codec-inl.h"
#include "pipeline/state/pipeline_state.h"

#if defined(HWSIM_MEMORY_DEPTH_TILE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_MEMORY_DEPTH_TILE_INL_H_
#undef HWSIM_MEMORY_DEPTH_TILE_INL_H_
#else
#define HWSIM_MEMORY_DEPTH_TILE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// Depth of a triangle at (x, y) pixels from its reference pixel's corner, as stored. The only place where
/// depth is evaluated, so that EQUAL passes meet the bits of the pre-pass.
HWY_INLINE LaneI depth_at(const PlaneEquation& z, LaneF x, LaneF y, float scale) {
  const LaneF plane = (LaneF(z.base) + LaneF(z.ddy) * y) + LaneF(z.ddx) * x;
  // Never NaN, so the plain instructions agree on all targets but for the sign of zero, which the sum below
  // removes.
  const LaneF value(hn::Min(hn::Max(plane.v, hn::Zero(DF())), hn::Set(DF(), 1.0f)));
  if (scale == 0.0f) return float_to_bits(value + LaneF(0.0f));
  return round_to_int(value * LaneF(scale));
}

HWY_INLINE LaneM compare_depth(Compare compare, LaneI a, LaneI b) {
  switch (compare) {
    case Compare::never:
      return a != a;
    case Compare::less:
      return a < b;
    case Compare::equal:
      return a == b;
    case Compare::less_equal:
      return !(a > b);
    case Compare::greater:
      return a > b;
    case Compare::not_equal:
      return a != b;
    case Compare::greater_equal:
      return !(a < b);
    case Compare::always:
      return a == a;
  }
  return a == a;
}

enum class CoarseResult { killed, accepted, ambiguous };

/// What the bounds of new and stored values say about every pair of them.
inline CoarseResult compare_bounds(Compare compare, std::uint32_t nearest, std::uint32_t farthest,
                                   std::uint32_t stored_min, std::uint32_t stored_max) {
  const auto result = [](bool killed, bool accepted) HWY_ATTR {
    return killed ? CoarseResult::killed : accepted ? CoarseResult::accepted : CoarseResult::ambiguous;
  };
  switch (compare) {
    case Compare::never:
      return CoarseResult::killed;
    case Compare::less:
      return result(nearest >= stored_max, farthest < stored_min);
    case Compare::less_equal:
      return result(nearest > stored_max, farthest <= stored_min);
    case Compare::greater:
      return result(farthest <= stored_min, nearest > stored_max);
    case Compare::greater_equal:
      return result(farthest < stored_min, nearest >= stored_max);
    case Compare::equal:
      return result(nearest > stored_max || farthest < stored_min, false);
    case Compare::not_equal:
      return CoarseResult::ambiguous;
    case Compare::always:
      return CoarseResult::accepted;
  }
  return CoarseResult::ambiguous;
}

/// A triangle's plane over its part of the tile at (x, y). Evaluation at samples rounds each of its five
/// operations, so bounds are widened by 2^-20 of the largest term.
inline DepthPlane plane_over_tile(const RasterTriangle& t, int x, int y, float scale) {
  const float left = (static_cast<float>(std::max<int>(x, t.min_x)) - t.reference_x),
              right = (static_cast<float>(std::min<int>(x + kBlockPx, t.max_x + 1)) - t.reference_x),
              top = (static_cast<float>(std::max<int>(y, t.min_y)) - t.reference_y),
              bottom = (static_cast<float>(std::min<int>(y + kBlockPx, t.max_y + 1)) - t.reference_y);
  const float x0 = t.z.ddx * left, x1 = t.z.ddx * right, y0 = t.z.ddy * top, y1 = t.z.ddy * bottom;
  const float slack = (std::fabs(t.z.base) + std::max(std::fabs(x0), std::fabs(x1)) +
                       std::max(std::fabs(y0), std::fabs(y1))) *
                      0x1p-20f;
  const float low = t.z.base + std::min(x0, x1) + std::min(y0, y1) - slack;
  const float high = t.z.base + std::max(x0, x1) + std::max(y0, y1) + slack;
  const auto clamp01 = [](float v) HWY_ATTR { return v > 0.0f ? (v < 1.0f ? v : 1.0f) : 0.0f; };
  return {t.z, t.reference_x, t.reference_y, depth_bits(clamp01(low), scale),
          depth_bits(clamp01(high), scale)};
}

struct TileDepth {
  std::uint32_t* stored;  ///< samples * 64 values
  std::uint32_t* tile_min;
  std::uint32_t* tile_max;
  float scale;
};

/// Exact bounds of a tile while some of its samples are replaced. The others are read only where a replaced
/// one was a bound, and that only until another one of the bound's value is found.
class BoundsUpdate {
 public:
  BoundsUpdate(const TileDepth& tile, std::size_t samples)
      : tile_(tile),
        count_(static_cast<int>(samples) * kBlockLanes),
        low_(static_cast<std::int32_t>(*tile.tile_min)),
        high_(static_cast<std::int32_t>(*tile.tile_max)),
        lowest_(low_),
        highest_(high_),
        lost_low_(low_ < low_),
        lost_high_(lost_low_) {}

  HWY_INLINE void replace(LaneM written, LaneI old, LaneI now) {
    lowest_ = min(lowest_, select(written, now, low_));
    highest_ = max(highest_, select(written, now, high_));
    lost_low_ = lost_low_ | (written & (old == low_));
    lost_high_ = lost_high_ | (written & (old == high_));
  }

  /// After all writes.
  void finish() const {
    const bool lower = any(lowest_ < low_), higher = any(highest_ > high_);
    if ((any(lost_low_) && !lower && !holds(low_)) || (any(lost_high_) && !higher && !holds(high_)))
      return read_all();
    if (lower) *tile_.tile_min = least(lowest_);
    if (higher) *tile_.tile_max = most(highest_);
  }

 private:
  static std::uint32_t least(LaneI z) {
    return static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(DI(), z.v)));
  }
  static std::uint32_t most(LaneI z) {
    return static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(DI(), z.v)));
  }
  LaneI stored(int first) const { return load(reinterpret_cast<const std::int32_t*>(tile_.stored) + first); }
  bool holds(LaneI value) const {
    for (int first = 0; first < count_; first += kVectorLanes)
      if (any(stored(first) == value)) return true;
    return false;
  }
  void read_all() const {
    LaneI lowest = stored(0), highest = lowest;
    for (int first = kVectorLanes; first < count_; first += kVectorLanes) {
      lowest = min(lowest, stored(first));
      highest = max(highest, stored(first));
    }
    *tile_.tile_min = least(lowest);
    *tile_.tile_max = most(highest);
  }

  const TileDepth& tile_;
  const int count_;
  const LaneI low_, high_;
  LaneI lowest_, highest_;
  LaneM lost_low_, lost_high_;  ///< lanes that replaced a value equal to the bound
};

template <Compare kCompare, bool kWrite>
void fine_test_of(const RasterTriangle& t, int x, int y, std::span<const SamplePosition> positions,
                  const TileDepth& tile, SampleMasks& masks) {
  const float left = static_cast<float>(x) - t.reference_x, top = static_cast<float>(y) - t.reference_y;
  masks.start();
  BoundsUpdate bounds(tile, positions.size());
  for (std::size_t s = 0; s < positions.size(); ++s) {
    // Sums of multiples of 1/16 below 2^15: exact.
    const LaneF sample_x(left + 0.5f + static_cast<float>(positions[s].x) * 0.0625f);
    const LaneF sample_y(top + 0.5f + static_cast<float>(positions[s].y) * 0.0625f);
    auto* stored = reinterpret_cast<std::int32_t*>(tile.stored) + s * kBlockLanes;
    const std::uint64_t covered = masks.lanes[s];
    std::uint64_t passed = 0;
    for (int v = 0; v < kBlockVectors; ++v) {
      const int first = v * kVectorLanes;
      if ((covered >> first & kRegisterBits) == 0) continue;
      const LaneI old = load(stored + first);
      const LaneI z = depth_at(t.z, load(kLaneOffsets.fx + first) + sample_x,
                               load(kLaneOffsets.fy + first) + sample_y, tile.scale);
      const LaneM pass = mask_from_bits(covered, first) & compare_depth(kCompare, z, old);
      put_mask(pass, v, passed);
      if constexpr (kWrite) {
        store(select(pass, z, old), stored + first);
        bounds.replace(pass, old, z);
      }
    }
    masks.set(s, passed);
  }
  if constexpr (kWrite) bounds.finish();
}

template <bool kWrite>
void fine_test_dispatch(Compare compare, const RasterTriangle& t, int x, int y,
                        std::span<const SamplePosition> positions, const TileDepth& tile,
                        SampleMasks& masks) {
  switch (compare) {
    case Compare::less:
      return fine_test_of<Compare::less, kWrite>(t, x, y, positions, tile, masks);
    case Compare::equal:
      return fine_test_of<Compare::equal, kWrite>(t, x, y, positions, tile, masks);
    case Compare::less_equal:
      return fine_test_of<Compare::less_equal, kWrite>(t, x, y, positions, tile, masks);
    case Compare::greater:
      return fine_test_of<Compare::greater, kWrite>(t, x, y, positions, tile, masks);
    case Compare::greater_equal:
      return fine_test_of<Compare::greater_equal, kWrite>(t, x, y, positions, tile, masks);
    case Compare::not_equal:
      return fine_test_of<Compare::not_equal, kWrite>(t, x, y, positions, tile, masks);
    case Compare::always:
      return fine_test_of<Compare::always, kWrite>(t, x, y, positions, tile, masks);
    case Compare::never:
      return fine_test_of<Compare::never, kWrite>(t, x, y, positions, tile, masks);
  }
}

/// The fine test of all covered samples: clears the bits of samples that fail, writes the others' depth if
/// asked to.
inline void fine_test(Compare compare, bool write, const RasterTriangle& t, int x, int y,
                      std::span<const SamplePosition> positions, const TileDepth& tile, SampleMasks& masks) {
  if (write) return fine_test_dispatch<true>(compare, t, x, y, positions, tile, masks);
  fine_test_dispatch<false>(compare, t, x, y, positions, tile, masks);
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
