// Coverage of 8x8 tiles, exact: integer edge functions on vector registers. Per-target include guard.
#include <algorithm>

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

/// Lanes of a tile left of, and above, each of its columns and rows.
struct LanesBefore {
  std::uint64_t column[kBlockPx + 1], row[kBlockPx + 1];
};
inline constexpr LanesBefore make_lanes_before() {
  LanesBefore lanes{};
  for (int i = 0; i <= kBlockPx; ++i)
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      if (lane_x(lane) < i) lanes.column[i] |= std::uint64_t{1} << lane;
      if (lane_y(lane) < i) lanes.row[i] |= std::uint64_t{1} << lane;
    }
  return lanes;
}
inline constexpr LanesBefore kLanesBefore = make_lanes_before();

/// Lanes of a tile in a rectangle of pixels from its corner, both ends included.
HWY_INLINE std::uint64_t lanes_within(int left, int top, int right, int bottom) {
  const auto at = [](int i) HWY_ATTR { return std::clamp(i, 0, kBlockPx); };
  return kLanesBefore.column[at(right + 1)] & ~kLanesBefore.column[at(left)] &
         kLanesBefore.row[at(bottom + 1)] & ~kLanesBefore.row[at(top)];
}

/// Sample positions on registers: 1/16 px from the pixel's corner.
struct SampleGrid {
  SampleGrid(std::span<const SamplePosition> positions, int left, int top, int right, int bottom)
      : count(static_cast<int>(positions.size())), min_x(left), min_y(top), max_x(right), max_y(bottom) {
    for (int s = 0; s < count; ++s) {
      x[s] = 8 + positions[static_cast<std::size_t>(s)].x;
      y[s] = 8 + positions[static_cast<std::size_t>(s)].y;
    }
  }
  int count;
  int min_x, min_y, max_x, max_y;  ///< bounds of the positions, from the pixel's center
  HWY_ALIGN std::int32_t x[kMaxSamples] = {};
  HWY_ALIGN std::int32_t y[kMaxSamples] = {};
};

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
  TileCoverage(const RasterTriangle& t, const SampleGrid& grid) : t_(t), grid_(grid) {
    // Samples of a tile lie between 8 + min and 8 + 112 + max sixteenths of a pixel from its corner.
    for (int i = 0; i < 3; ++i) {
      const std::int64_t a = t.a[i], b = t.b[i];
      const std::int64_t left = a * (8 + grid.min_x), right = a * (120 + grid.max_x);
      const std::int64_t top = b * (8 + grid.min_y), bottom = b * (120 + grid.max_y);
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
      corner_[edge_count_] = e;
      edge_[edge_count_++] = i;
    }
    x_ = x;
    y_ = y;
    return true;
  }
  bool covers_whole_tile() const { return edge_count_ == 0; }

  /// For a tile that edges cut. Registers of pixels beyond the triangle's bounds are left out: most of them,
  /// for small triangles.
  void masks(SampleMasks& masks) {
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
  /// An edge's values at the pixels of a tile's first register, from its corner.
  LaneI first_offsets(int edge) const {
    const LaneI x = load(kLaneOffsets.x), y = load(kLaneOffsets.y);
    return shift_left<4>(LaneI(t_.a[edge]) * x + LaneI(t_.b[edge]) * y);
  }
  /// Those of the register that begins at `lane` are moved by as much.
  LaneI move_to(int edge, int lane) const {
    return LaneI(16 * (t_.a[edge] * lane_x(lane) + t_.b[edge] * lane_y(lane)));
  }
  void prepare_offsets() {
    if (offsets_ready_) return;
    offsets_ready_ = true;
    for (int i = 0; i < 3; ++i) {
      const LaneI first = first_offsets(i);
      for (int v = 0; v < kBlockVectors; ++v)
        store(first + move_to(i, v * kVectorLanes), offsets_[i] + v * kVectorLanes);
    }
  }

  /// What an edge's value at a pixel's corner must exceed for a sample to be inside. Both fit 32 bits where
  /// the edge cuts the tile (raster/triangle.h), so that sums may wrap on the way.
  void find_thresholds(int edge, std::int64_t corner, std::int32_t* threshold) const {
    const LaneI base(static_cast<std::int32_t>(-1 - corner)), a(t_.a[edge]), b(t_.b[edge]);
    for (int s = 0; s < grid_.count; s += kVectorLanes)
      store(base - (a * load(grid_.x + s) + b * load(grid_.y + s)), threshold + s);
  }

  template <int kEdges>
  using Thresholds = std::int32_t[kEdges][kMaxSamples];

  template <int kEdges>
  void masks_of(SampleMasks& masks) {
    HWY_ALIGN Thresholds<kEdges> threshold;
    for (int e = 0; e < kEdges; ++e) find_thresholds(edge_[e], corner_[e], threshold[e]);
    const std::uint64_t bounds = lanes_within(t_.min_x - x_, t_.min_y - y_, t_.max_x - x_, t_.max_y - y_);
    int first_lane[kBlockVectors], registers = 0;
    for (int lane = 0; lane < kBlockLanes; lane += kVectorLanes) {
      first_lane[registers] = lane;
      registers += (bounds >> lane & kRegisterBits) != 0 ? 1 : 0;
    }
    masks.start();
    if (registers == 1) return masks_of_one<kEdges>(threshold, first_lane[0], masks);
    prepare_offsets();
    if (registers == kBlockVectors) return masks_of_all<kEdges>(threshold, masks);
    for (int s = 0; s < grid_.count; ++s) {
      std::uint64_t word = 0;
      for (int r = 0; r < registers; ++r) put_inside<kEdges>(threshold, s, first_lane[r], word);
      masks.set(static_cast<std::size_t>(s), word);
    }
  }
  template <int kEdges>
  void masks_of_all(const Thresholds<kEdges>& threshold, SampleMasks& masks) const {
    for (int s = 0; s < grid_.count; ++s) {
      std::uint64_t word = 0;
      for (int v = 0; v < kBlockVectors; ++v) put_inside<kEdges>(threshold, s, v * kVectorLanes, word);
      masks.set(static_cast<std::size_t>(s), word);
    }
  }
  template <int kEdges>
  HWY_INLINE void put_inside(const Thresholds<kEdges>& threshold, int s, int lane,
                             std::uint64_t& word) const {
    LaneM inside = load(offsets_[edge_[0]] + lane) > LaneI(threshold[0][s]);
    for (int e = 1; e < kEdges; ++e)
      inside = inside & (load(offsets_[edge_[e]] + lane) > LaneI(threshold[e][s]));
    word |= static_cast<std::uint64_t>(mask_bits(inside)) << lane;
  }
  template <int kEdges>
  void masks_of_one(const Thresholds<kEdges>& threshold, int lane, SampleMasks& masks) const {
    LaneI offset[kEdges];
    for (int e = 0; e < kEdges; ++e) offset[e] = first_offsets(edge_[e]) + move_to(edge_[e], lane);
    for (int s = 0; s < grid_.count; ++s) {
      LaneM inside = offset[0] > LaneI(threshold[0][s]);
      for (int e = 1; e < kEdges; ++e) inside = inside & (offset[e] > LaneI(threshold[e][s]));
      masks.set(static_cast<std::size_t>(s), static_cast<std::uint64_t>(mask_bits(inside)) << lane);
    }
  }

  const RasterTriangle& t_;
  const SampleGrid& grid_;
  std::int64_t highest_[3], lowest_[3], corner_[3];
  int edge_[3];
  int edge_count_ = 0;
  int x_ = 0, y_ = 0;  ///< the tile that was asked for last
  bool offsets_ready_ = false;
  HWY_ALIGN std::int32_t offsets_[3][kBlockLanes];
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
