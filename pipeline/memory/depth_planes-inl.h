// Tests and writes of tiles held as planes: on masks where bounds decide, on samples where they don't.
// Per-target include guard.
#include "pipeline/memory/depth_planes.h"
#include "pipeline/memory/depth_tile-inl.h"

#if defined(HWSIM_MEMORY_DEPTH_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_MEMORY_DEPTH_PLANES_INL_H_
#undef HWSIM_MEMORY_DEPTH_PLANES_INL_H_
#else
#define HWSIM_MEMORY_DEPTH_PLANES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// A plane at the samples of one index of a tile.
class PlaneSamples {
 public:
  PlaneSamples(const DepthPlane& plane, int x, int y, SamplePosition position, float scale)
      : z_(plane.z),
        // Sums of multiples of 1/256 below 2^15: exact.
        x_((static_cast<float>(x) - plane.reference_x) + 0.5f + static_cast<float>(position.x) * 0.0625f),
        y_((static_cast<float>(y) - plane.reference_y) + 0.5f + static_cast<float>(position.y) * 0.0625f),
        scale_(scale) {}
  HWY_INLINE LaneI at(int first) const {
    return depth_at(z_, load(kLaneOffsets.fx + first) + LaneF(x_), load(kLaneOffsets.fy + first) + LaneF(y_),
                    scale_);
  }

 private:
  const PlaneEquation& z_;
  float x_, y_, scale_;
};

/// Lanes of `lanes` whose new depth passes against the old one.
inline std::uint64_t passing_lanes(Compare compare, const PlaneSamples& now, const PlaneSamples& old,
                                   std::uint64_t lanes) {
  std::uint64_t passed = 0;
  for (int v = 0; v < kBlockVectors; ++v) {
    const int first = v * kVectorLanes;
    if ((lanes >> first & kRegisterBits) == 0) continue;
    put_mask(compare_depth(compare, now.at(first), old.at(first)), v, passed);
  }
  return passed & lanes;
}

/// A tile of a depth image while it is held as planes.
struct PlaneTile {
  GpuImage& image;
  int block;
  int x, y;  ///< pixel of the tile's corner
  float scale;

  DepthPlane* planes() const { return image.tile_planes(block); }
  std::uint64_t* lanes(int plane) const { return image.tile_plane_lanes(block) + plane * image.samples; }
  std::uint8_t& count() const { return image.plane_count[static_cast<std::size_t>(block)]; }
};

/// What bounds say about a triangle against one of a tile's planes.
inline CoarseResult test_plane(Compare compare, const DepthPlane& now, const DepthPlane& old) {
  if (now.same_plane(old)) {  // a later pass over the same triangle: equal at every sample
    const bool passes = compare == Compare::equal || compare == Compare::less_equal ||
                        compare == Compare::greater_equal || compare == Compare::always;
    return passes ? CoarseResult::accepted : CoarseResult::killed;
  }
  return compare_bounds(compare, now.nearest, now.farthest, old.nearest, old.farthest);
}

/// Clears the bits of samples that fail. `by_samples`: every sample is compared, whatever the bounds say.
inline void test_planes(Compare compare, const PlaneTile& tile, const DepthPlane& now, bool by_samples,
                        SampleMasks& masks) {
  const int samples = tile.image.samples;
  std::uint64_t failed[kMaxSamples] = {};
  bool any_failed = false;
  for (int p = 0; p < tile.count(); ++p) {
    const DepthPlane& old = tile.planes()[p];
    const CoarseResult result = by_samples ? CoarseResult::ambiguous : test_plane(compare, now, old);
    if (result == CoarseResult::accepted) continue;
    any_failed = true;
    const std::uint64_t* held = tile.lanes(p);
    for (int s = 0; s < samples; ++s) {
      const std::uint64_t overlap = masks.lanes[s] & held[s];
      if (overlap == 0) continue;
      if (result == CoarseResult::killed) {
        failed[s] |= overlap;
        continue;
      }
      const SamplePosition position = tile.image.plane_positions[static_cast<std::size_t>(s)];
      failed[s] |= overlap & ~passing_lanes(compare, PlaneSamples(now, tile.x, tile.y, position, tile.scale),
                                            PlaneSamples(old, tile.x, tile.y, position, tile.scale), overlap);
    }
  }
  if (!any_failed) return;
  masks.start();
  for (int s = 0; s < samples; ++s) masks.set(static_cast<std::size_t>(s), masks.lanes[s] & ~failed[s]);
}

inline void store_plane(const PlaneTile& tile, const DepthPlane& plane, const std::uint64_t* lanes) {
  auto* stored = reinterpret_cast<std::int32_t*>(tile.image.block(tile.block));
  for (int s = 0; s < tile.image.samples; ++s) {
    const PlaneSamples samples(plane, tile.x, tile.y, tile.image.plane_positions[static_cast<std::size_t>(s)],
                               tile.scale);
    for (int first = 0; first < kBlockLanes; first += kVectorLanes) {
      if ((lanes[s] >> first & kRegisterBits) == 0) continue;
      std::int32_t* to = stored + s * kBlockLanes + first;
      store(select(mask_from_bits(lanes[s], first), samples.at(first), load(to)), to);
    }
  }
}

inline void read_bounds(GpuImage& image, int block) {
  const auto* stored = reinterpret_cast<const std::int32_t*>(image.block(block));
  LaneI lowest = load(stored), highest = lowest;
  for (int i = kVectorLanes; i < image.samples * kBlockLanes; i += kVectorLanes) {
    lowest = min(lowest, load(stored + i));
    highest = max(highest, load(stored + i));
  }
  const auto index = static_cast<std::size_t>(block);
  image.depth_min[index] = static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(DI(), lowest.v)));
  image.depth_max[index] = static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(DI(), highest.v)));
}

/// Texels in place of planes.
inline void expand_planes(const PlaneTile& tile) {
  auto* stored = tile.image.block(tile.block);
  if (tile.image.lanes_inside(tile.block) != ~std::uint64_t{0})  // no plane reaches beyond the image
    std::fill_n(stored, tile.image.samples * kBlockLanes, tile.image.clear_words[0]);
  for (int p = 0; p < tile.count(); ++p) store_plane(tile, tile.planes()[p], tile.lanes(p));
  tile.count() = 0;
  read_bounds(tile.image, tile.block);
}

/// Gives `now` the samples of `masks`. Without a free slot the tile is expanded.
inline void write_plane(const PlaneTile& tile, const DepthPlane& now, const SampleMasks& masks) {
  const int samples = tile.image.samples;
  int kept = 0;
  std::uint32_t nearest = now.nearest, farthest = now.farthest;
  for (int p = 0; p < tile.count(); ++p) {
    const std::uint64_t* from = tile.lanes(p);
    std::uint64_t* to = tile.lanes(kept);
    std::uint64_t left = 0;
    for (int s = 0; s < samples; ++s) {
      to[s] = from[s] & ~masks.lanes[s];
      left |= to[s];
    }
    if (left == 0) continue;
    if (kept != p) tile.planes()[kept] = tile.planes()[p];
    nearest = std::min(nearest, tile.planes()[kept].nearest);
    farthest = std::max(farthest, tile.planes()[kept].farthest);
    ++kept;
  }
  tile.count() = static_cast<std::uint8_t>(kept);
  if (kept == kMaxDepthPlanes) {
    expand_planes(tile);
    store_plane(tile, now, masks.lanes);
    return read_bounds(tile.image, tile.block);
  }
  tile.planes()[kept] = now;
  std::copy_n(masks.lanes, samples, tile.lanes(kept));
  tile.count() = static_cast<std::uint8_t>(kept + 1);
  tile.image.depth_min[static_cast<std::size_t>(tile.block)] = nearest;
  tile.image.depth_max[static_cast<std::size_t>(tile.block)] = farthest;
}

/// A plane that passed at every sample of an expanded tile.
inline void hold_plane(const PlaneTile& tile, const DepthPlane& plane) {
  tile.planes()[0] = plane;
  std::fill_n(tile.lanes(0), tile.image.samples, ~std::uint64_t{0});
  tile.count() = 1;
}

/// The smallest form that holds the tile without loss.
inline DepthTileForm form_of(const GpuImage& image, int block) {
  const auto i = static_cast<std::size_t>(block);
  switch (image.plane_count[i]) {
    case 0:
      break;
    case 1:
      return DepthTileForm::one_plane;
    case 2:
      return DepthTileForm::two_planes;
    default:
      return DepthTileForm::four_planes;
  }
  const auto* stored = reinterpret_cast<const std::int32_t*>(image.block(block));
  const LaneI lowest(static_cast<std::int32_t>(image.depth_min[i])),
      highest(static_cast<std::int32_t>(image.depth_max[i]));
  LaneI farthest(0);
  for (int k = 0; k < image.samples * kBlockLanes; k += kVectorLanes) {
    const LaneI z = load(stored + k);
    farthest = max(farthest, min(z - lowest, highest - z));
  }
  const std::int32_t distance = hn::GetLane(hn::MaxOfLanes(DI(), farthest.v));
  if (distance < 1 << 6) return DepthTileForm::offset_6;
  return distance < 1 << 14 ? DepthTileForm::offset_14 : DepthTileForm::raw;
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
