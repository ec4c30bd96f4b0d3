// Coverage of 8x8 tiles, exact: integer edge functions on vector registers. Per-target include guard.
#include "pipeline/raster/tile.h"
#include "pipeline/raster/triangle.h"
#include "pipeline/simd/lanes-inl.h"
#include "pipeline/state/pipeline_state.h"
#include "pipeline/state/sample_pattern.h"

#if defined(HWSIM_RASTER_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_RASTER_COVERAGE_INL_H_
#undef HWSIM_RASTER_COVERAGE_INL_H_
#else
#define HWSIM_RASTER_COVERAGE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

inline constexpr int kBlockVectors = kBlockLanes / kVectorLanes;

/// Pixel offsets of the 64 lanes of a tile.
struct LaneOffsets {
  HWY_ALIGN std::int32_t x[kBlockLanes];
  HWY_ALIGN std::int32_t y[kBlockLanes];
  HWY_ALIGN float fx[kBlockLanes];
  HWY_ALIGN float fy[kBlockLanes];
};
inline constexpr LaneOffsets make_lane_offsets() {
  LaneOffsets offsets{};
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    offsets.x[lane] = lane_x(lane);
    offsets.y[lane] = lane_y(lane);
    offsets.fx[lane] = static_cast<float>(lane_x(lane));
    offsets.fy[lane] = static_cast<float>(lane_y(lane));
  }
  return offsets;
}
inline constexpr LaneOffsets kLaneOffsets = make_lane_offsets();

/// Writes the mask's bits as bits [lanes * v, ...) of a 64-bit word; the word starts out zero.
HWY_INLINE void put_mask(LaneM m, int v, std::uint64_t& word) {
  word |= static_cast<std::uint64_t>(mask_bits(m)) << (v * kVectorLanes);
}

/// The covered samples of a tile: lanes[s] at sample s. Sums are taken while the masks are in registers:
/// reading them back at once, eight bytes stored by thirty-two loaded, stalls on store forwarding.
struct SampleMasks {
  std::uint64_t lanes[kMaxSamples];
  std::uint64_t any_lane = 0;  ///< union over the samples
  std::uint64_t count = 0;     ///< bits set

  HWY_INLINE void start() { any_lane = count = 0; }
  HWY_INLINE void set(std::size_t s, std::uint64_t mask) {
    lanes[s] = mask;
    any_lane |= mask;
    count += static_cast<std::uint64_t>(__builtin_popcountll(mask));
  }
  /// Keeps the lanes of `kept` at samples [first, last), nothing elsewhere.
  void keep(std::uint64_t kept, int first, int last, int samples) {
    start();
    for (int s = 0; s < samples; ++s)
      set(static_cast<std::size_t>(s), s >= first && s < last ? lanes[s] & kept : 0);
  }
};

/// One triangle against the tiles of a bin.
class TileCoverage {
 public:
  TileCoverage(const RasterTriangle& t, std::span<const SamplePosition> positions, int min_x, int min_y,
               int max_x, int max_y)
      : t_(t), positions_(positions) {
    // Samples of a tile lie between 8 + min and 8 + 112 + max sixteenths of a pixel from its corner.
    for (int i = 0; i < 3; ++i) {
      const std::int64_t a = t.a[i], b = t.b[i];
      const std::int64_t left = a * (8 + min_x), right = a * (120 + max_x);
      const std::int64_t top = b * (8 + min_y), bottom = b * (120 + max_y);
      highest_[i] = std::max(left, right) + std::max(top, bottom);
      lowest_[i] = std::min(left, right) + std::min(top, bottom);
    }
  }

  /// Whether the tile with corner pixel (x, y) can hold a covered sample; sets which edges cut it.
  bool reaches(int x, int y) {
    edge_count_ = 0;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t e = std::int64_t{t_.a[i]} * (16 * x) + std::int64_t{t_.b[i]} * (16 * y) + t_.c[i];
      if (e + highest_[i] < 0) return false;
      if (e + lowest_[i] >= 0) continue;
      corner_[edge_count_] = e;  // cuts the tile, so that it fits 32 bits (raster/triangle.h)
      edge_[edge_count_++] = i;
    }
    return true;
  }
  bool covers_whole_tile() const { return edge_count_ == 0; }

  /// For a tile that edges cut.
  void masks(SampleMasks& masks) {
    prepare_offsets();
    switch (edge_count_) {
      case 1:
        return masks_of<1>(masks);
      case 2:
        return masks_of<2>(masks);
      default:
        return masks_of<3>(masks);
    }
  }

 private:
  void prepare_offsets() {
    if (offsets_ready_) return;
    offsets_ready_ = true;
    for (int i = 0; i < 3; ++i) {
      // A register's lanes are those of the first one, moved.
      const LaneI x = load(kLaneOffsets.x), y = load(kLaneOffsets.y);
      const LaneI first = shift_left<4>(LaneI(t_.a[i]) * x + LaneI(t_.b[i]) * y);
      for (int v = 0; v < kBlockVectors; ++v) {
        const std::int32_t moved =
            16 * (t_.a[i] * lane_x(v * kVectorLanes) + t_.b[i] * lane_y(v * kVectorLanes));
        store(first + LaneI(moved), offsets_[i] + v * kVectorLanes);
      }
    }
  }

  template <int kEdges>
  void masks_of(SampleMasks& masks) {
    masks.start();
    for (std::size_t s = 0; s < positions_.size(); ++s) {
      LaneI threshold[kEdges];
      for (int e = 0; e < kEdges; ++e) {
        const int i = edge_[e];
        const std::int64_t at_sample = corner_[e] + std::int64_t{t_.a[i]} * (8 + positions_[s].x) +
                                       std::int64_t{t_.b[i]} * (8 + positions_[s].y);
        threshold[e] = LaneI(static_cast<std::int32_t>(-1 - at_sample));
      }
      std::uint64_t word = 0;
      for (int v = 0; v < kBlockVectors; ++v) {
        LaneM inside = load(offsets_[edge_[0]] + v * kVectorLanes) > threshold[0];
        for (int e = 1; e < kEdges; ++e)
          inside = inside & (load(offsets_[edge_[e]] + v * kVectorLanes) > threshold[e]);
        put_mask(inside, v, word);
      }
      masks.set(s, word);
    }
  }

  const RasterTriangle& t_;
  std::span<const SamplePosition> positions_;
  std::int64_t highest_[3], lowest_[3], corner_[3];
  int edge_[3];
  int edge_count_ = 0;
  bool offsets_ready_ = false;
  HWY_ALIGN std::int32_t offsets_[3][kBlockLanes];
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
