// Coverage maps of a screen bin (memory/coverage_map.h). Per-target include guard.
#include <bit>

#include "pipeline/emulate/bin_depth-inl.h"
#include "pipeline/graph/frame_graph.h"
#include "pipeline/memory/coverage_map.h"
#include "pipeline/memory/depth_expand.h"

#if defined(HWSIM_EMULATE_BIN_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_EMULATE_BIN_COVERAGE_INL_H_
#undef HWSIM_EMULATE_BIN_COVERAGE_INL_H_
#else
#define HWSIM_EMULATE_BIN_COVERAGE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// Positions of coverage beyond the samples, of one bin. A map is updated with the depth test, in whose order
/// fragments compete.
class BinCoverage : protected BinDepth {
 protected:
  BinCoverage(const PassContext& context, int layer, BinWorker& worker)
      : BinDepth(context, layer, worker),
        positions_(static_cast<int>(context.coverage_positions.size())),
        layout_(context.coverage_map == nullptr ? nullptr : &coverage_layout(samples_, positions_)) {}

  /// Blended fragments color what is there: positions keep their samples. So do draws without color.
  void start_coverage_map() {
    const std::vector<BlendState>& blend = w_.state->blend;
    follows_map_ = c_.coverage_map != nullptr && w_.program != nullptr &&
                   (blend.empty() || (!blend[0].enabled && blend[0].write_mask == 0xf));
  }

  /// `passed`: samples after the depth test; `covered`: positions of the triangle.
  void insert_tile(const RasterTriangle& t, int x, int y, const std::uint64_t* passed,
                   const std::uint64_t* covered) {
    const int block = c_.depth->block_index(x, y, layer_);
    std::uint64_t any = 0, every = ~std::uint64_t{0};
    for (int s = 0; s < samples_; ++s) {
      any |= passed[s];
      every &= passed[s];
    }
    for (int q = 0; q < positions_; ++q) every &= covered[q];
    std::uint64_t& whole = c_.coverage_map->coverage_whole[static_cast<std::size_t>(block)];
    count_map_bytes(0, popcount(every & ~whole));
    whole |= every;
    for (std::uint64_t lanes = any & ~every; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctzll(lanes);
      insert(t, block, lane, bits_of(passed, samples_, lane), bits_of(covered, positions_, lane));
    }
  }

  /// Pixels of which the triangle covers further positions alone.
  void hide_tile(const RasterTriangle& t, int x, int y, const std::uint64_t* covered) {
    const int block = c_.depth->block_index(x, y, layer_);
    std::uint64_t hides = 0, has_sample = 0;
    for (int q = 0; q < positions_; ++q) (q < samples_ ? has_sample : hides) |= covered[q];
    for (std::uint64_t lanes = hides & ~has_sample; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctzll(lanes);
      insert(t, block, lane, 0, bits_of(covered, positions_, lane));
    }
  }

  /// The same for a quad of the batch.
  void insert_quad(std::size_t q) {
    const QuadSamples &passed = w_.samples[q], &covered = w_.primitive_samples[q];
    for (int lane = 0; lane < 4; ++lane) {
      const std::uint32_t bits = bits_of(passed.masks, samples_, lane);
      if (bits == 0) continue;
      insert(*w_.batch.triangle[q], w_.block[q], 4 * w_.quad_in_block[q] + lane, bits,
             bits_of(covered.masks, positions_, lane));
    }
  }

  const int positions_;  ///< at which coverage is found; the first of them are the samples'
  bool follows_map_ = false;

 private:
  template <class Mask>
  static std::uint32_t bits_of(const Mask* masks, int count, int lane) {
    std::uint32_t bits = 0;
    for (int i = 0; i < count; ++i) bits |= static_cast<std::uint32_t>(masks[i] >> lane & 1) << i;
    return bits;
  }

  void insert(const RasterTriangle& t, int block, int lane, std::uint32_t passed, std::uint32_t covered) {
    GpuImage& image = *c_.coverage_map;
    const auto tile = static_cast<std::size_t>(block);
    const std::uint64_t bit = std::uint64_t{1} << lane;
    const bool was_whole = (image.coverage_whole[tile] & bit) != 0;
    const std::size_t words = coverage_words(positions_);
    std::uint64_t* stored =
        image.coverage_map.data() + (tile * kBlockLanes + static_cast<std::size_t>(lane)) * words;
    const CoverageWord before = was_whole ? CoverageWord() : CoverageWord(stored, words);
    const int x = c_.depth->block_x(block) + lane_x(lane), y = c_.depth->block_y(block) + lane_y(lane);
    const auto wins = [&](int position, int sample) HWY_ATTR {
      const std::uint32_t z =
          plane_depth_at(t.z, t.reference_x, t.reference_y, x, y,
                         c_.coverage_positions[static_cast<std::size_t>(position)], c_.depth_scale);
      return depth_passes(w_.state->depth.compare, z, stored_depth(*c_.depth, block, sample, lane));
    };
    const bool everywhere = std::popcount(passed) == samples_ && std::popcount(covered) == positions_;
    if (everywhere) {
      image.coverage_whole[tile] |= bit;
      count_map_bytes(0, was_whole ? 0 : 1);
      return;
    }
    const CoverageWord after =
        passed == 0 ? hide_positions(before, *layout_, covered, wins)
                    : insert_fragment(before, *layout_, passed, covered, c_.pass->drop_orphans, wins);
    count_map_bytes(1, after == before ? 0 : 1);
    image.coverage_whole[tile] &= ~bit;
    after.store(stored, words);
  }

  const CoverageLayout* layout_;  ///< null without a map

  void count_map_bytes(std::uint64_t read_pixels, std::uint64_t written_pixels) {
    const std::uint64_t bytes = coverage_map_bytes(samples_, positions_);
    w_.counters().mem.other_read_bytes += read_pixels * bytes;
    w_.counters().mem.other_write_bytes += written_pixels * bytes;
  }
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
