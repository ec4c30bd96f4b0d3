// Depth and stencil tests of a screen bin: coarse, early, late. Per-target include guard.
#include <hwy/cache_control.h>

#include <cstring>

#include "pipeline/emulate/depth_traffic.h"
#include "pipeline/emulate/fragment_setup-inl.h"
#include "pipeline/emulate/pass_context.h"
#include "pipeline/memory/depth_planes-inl.h"
#include "pipeline/memory/depth_tile-inl.h"
#include "pipeline/memory/stencil.h"

#if defined(HWSIM_EMULATE_BIN_DEPTH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_EMULATE_BIN_DEPTH_INL_H_
#undef HWSIM_EMULATE_BIN_DEPTH_INL_H_
#else
#define HWSIM_EMULATE_BIN_DEPTH_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// Depth and stencil of one bin. BinDepth, BinCoverage, BinColor, BinShading and BinRunner are the stages of
/// one loop over a bin's triangles: each adds its stage to what the one before it offers.
class BinDepth {
 protected:
  BinDepth(const PassContext& context, int layer, BinWorker& worker)
      : c_(context), w_(worker), samples_(context.samples), layer_(layer) {}

  /// `plane` becomes the triangle's plane over the tile.
  CoarseResult test_coarse(const RasterTriangle& t, int x, int y, DepthPlane& plane, PassCounters& n) const {
    if (c_.depth == nullptr) return CoarseResult::ambiguous;
    plane = plane_over_tile(t, x, y, c_.depth_scale);
    if (!w_.state->depth.test || !c_.hierarchical_z) return CoarseResult::ambiguous;
    const auto block = static_cast<std::size_t>(c_.depth->block_index(x, y, layer_));
    prefetch_planes(static_cast<int>(block));
    n.hiz.tested_tiles += 1;
    CoarseResult result = compare_bounds(w_.state->depth.compare, plane.nearest, plane.farthest,
                                         c_.depth->depth_min[block], c_.depth->depth_max[block]);
    if (result == CoarseResult::killed && failing_samples_matter()) result = CoarseResult::ambiguous;
    n.hiz.killed_tiles += result == CoarseResult::killed ? 1 : 0;
    n.hiz.accepted_tiles += result == CoarseResult::accepted ? 1 : 0;
    n.hiz.ambiguous_tiles += result == CoarseResult::ambiguous ? 1 : 0;
    return result;
  }

  /// The fine test waited for them for a quarter of its time; coverage is found out meanwhile.
  void prefetch_planes(int block) const {
    hwy::Prefetch(c_.depth->tile_planes(block));
    hwy::Prefetch(c_.depth->tile_plane_lanes(block));
    hwy::Prefetch(c_.depth->tile_plane_lanes(block) + 8);
  }

  /// Samples that fail may still change the stencil, by either test; and a shader that writes storage runs
  /// before the test unless early tests are forced.
  bool failing_samples_matter() const {
    const StencilState& stencil = w_.state->stencil;
    const bool changes_stencil =
        stencil.test && (stencil.on_depth_fail != StencilOp::keep || stencil.on_fail != StencilOp::keep);
    return changes_stencil || (w_.late_z && w_.program->writes_storage);
  }

  void count_depth_traffic(std::uint64_t tested, std::uint64_t passed, PassCounters& n) const {
    n.stats.samples_passed += passed;
    const auto bytes = static_cast<std::uint64_t>(c_.depth_bytes);
    n.mem.depth_read_bytes += tested * bytes;
    if (writes_depth()) {
      n.zrop.written_samples += passed;
      n.mem.depth_write_bytes += passed * bytes;
    }
  }

  bool writes_depth() const {
    const PipelineState& state = *w_.state;
    return state.depth.write || (state.stencil.test && state.stencil.on_pass != StencilOp::keep);
  }

  void track_depth(int block, std::uint64_t tested, std::uint64_t passed) const {
    const auto bytes = static_cast<std::uint64_t>(c_.depth_bytes);
    w_.tracker.touch_if_sampled(ReuseStream::depth, static_cast<std::uint32_t>(block), tested * bytes,
                                writes_depth() ? passed * bytes : 0);
  }

  /// A null `plane` tests stencil alone (full-screen passes).
  void test_tile(const RasterTriangle* t, const DepthPlane* plane, int x, int y, CoarseResult coarse,
                 SampleMasks& masks) {
    const PipelineState& state = *w_.state;
    const int block = c_.depth->block_index(x, y, layer_);
    c_.depth->use_planes(block);
    touch_depth_tile(block);
    std::uint64_t before_depth[kMaxSamples];
    if (state.stencil.test) {
      test_stencil(state.stencil, samples_, c_.depth->stencil_block(block), masks.lanes);
      masks.keep(~std::uint64_t{0}, 0, samples_, samples_);
      std::memcpy(before_depth, masks.lanes, sizeof(std::uint64_t) * static_cast<std::size_t>(samples_));
    }
    if (plane != nullptr && (state.depth.test || state.depth.write))
      test_depth(*t, *plane, x, y, coarse, state.depth.write, masks);
    if (state.stencil.test)
      update_stencil(state.stencil, samples_, c_.depth->stencil_block(block), before_depth, masks.lanes);
    if (writes_depth_image() && (masks.count != 0 || failing_samples_matter()))
      c_.depth->unsaved[static_cast<std::size_t>(block)] = 1;
  }

  bool writes_depth_image() const {
    return w_.state->depth.write ||
           (w_.state->stencil.test &&
            (w_.state->stencil.on_pass != StencilOp::keep || failing_samples_matter()));
  }

  void test_depth(const RasterTriangle& t, const DepthPlane& plane, int x, int y, CoarseResult coarse,
                  bool write, SampleMasks& masks) {
    const PipelineState& state = *w_.state;
    const int block = c_.depth->block_index(x, y, layer_);
    const auto index = static_cast<std::size_t>(block);
    const Compare compare = state.depth.test ? state.depth.compare : Compare::always;
    const bool accepted = coarse == CoarseResult::accepted && state.depth.test && c_.skip.accepted_tiles;
    if (c_.depth->plane_count[index] == 0) {
      w_.accepted_tiles_skipped += accepted && !write ? 1 : 0;
      if (accepted && !write) return;
      const TileDepth tile{c_.depth->block(block), &c_.depth->depth_min[index], &c_.depth->depth_max[index],
                           c_.depth_scale};
      fine_test(compare, write, t, x, y, c_.positions, tile, masks);
      if (write && masks.count == static_cast<std::uint64_t>(samples_ * kBlockLanes))
        hold_plane({*c_.depth, block, x, y, c_.depth_scale}, plane);
      return;
    }
    const PlaneTile tile{*c_.depth, block, x, y, c_.depth_scale};
    if (!accepted) test_planes(compare, tile, plane, !c_.skip.plane_tiles, masks);
    w_.accepted_tiles_skipped += accepted ? 1 : 0;
    w_.plane_tiles_skipped += !accepted && c_.skip.plane_tiles ? 1 : 0;
    if (write && masks.count != 0) write_plane(tile, plane, masks);
  }

  /// Depth alone, sample by sample, whatever bounds say; nothing is written or counted.
  void test_samples(const RasterTriangle& t, const DepthPlane& plane, int x, int y, SampleMasks& masks) {
    const int block = c_.depth->block_index(x, y, layer_);
    const auto index = static_cast<std::size_t>(block);
    c_.depth->use_planes(block);
    const Compare compare = w_.state->depth.compare;
    if (c_.depth->plane_count[index] != 0)
      return test_planes(compare, {*c_.depth, block, x, y, c_.depth_scale}, plane, true, masks);
    const TileDepth tile{c_.depth->block(block), &c_.depth->depth_min[index], &c_.depth->depth_max[index],
                         c_.depth_scale};
    fine_test(compare, false, t, x, y, c_.positions, tile, masks);
  }

  /// Once for each chunk that uses the tile: what memory gave, and what went back to it since.
  void touch_depth_tile(int block) {
    const auto i = static_cast<std::size_t>(block);
    if (c_.depth->touched_chunk[i] == w_.current_chunk + 1) return;
    save_depth_tile(*c_.depth, block, w_.chunks);
    PassCounters& n = w_.counters();
    count_tile_form(kReadTiles, c_.depth->stored_form[i], n.zrop);
    touch_tile(*c_.depth, block, w_.current_chunk, n.zrop);
  }

  /// The depth test of a draw without stencil, nothing written.
  void test_tile_read_only(const RasterTriangle& t, const DepthPlane& plane, int x, int y,
                           CoarseResult coarse, SampleMasks& masks) {
    const int block = c_.depth->block_index(x, y, layer_);
    c_.depth->use_planes(block);
    touch_depth_tile(block);
    test_depth(t, plane, x, y, coarse, false, masks);
  }

  static std::uint64_t popcount(std::uint64_t bits) {
    return static_cast<std::uint64_t>(__builtin_popcountll(bits));
  }

  void test_tile_late(const RasterTriangle* t, int x, int y, SampleMasks& masks) {
    const std::uint64_t tested = masks.count;
    if (tested == 0) return;
    PassCounters& n = w_.counters();
    if (t != nullptr) {
      const DepthPlane plane = plane_over_tile(*t, x, y, c_.depth_scale);
      test_tile(t, &plane, x, y, CoarseResult::ambiguous, masks);
    } else {
      test_tile(t, nullptr, x, y, CoarseResult::ambiguous, masks);
    }
    track_depth(c_.depth->block_index(x, y, layer_), tested, masks.count);
    n.zrop.late_z_tested_samples += tested;
    n.zrop.late_z_killed_samples += tested - masks.count;
    count_depth_traffic(tested, masks.count, n);
  }

  void test_late() {
    for (int s = 0; s < samples_; ++s) test_late_sample(s);
    refresh_bounds();
  }

  // In submission order, a quad at a time: two quads of a batch never lie on the same pixels (see
  // append_tile).
  void test_late_sample(int s) {
    const D4 d;
    const PipelineState& state = *w_.state;
    const SamplePosition p = c_.positions[static_cast<std::size_t>(s)];
    PassCounters& n = w_.counters();
    std::uint64_t tested = 0, passed = 0;
    for (std::size_t q = 0; q < static_cast<std::size_t>(w_.batch.quad_count); ++q) {
      std::uint8_t& mask = w_.samples[q].masks[s];
      if (mask == 0) continue;
      const std::uint8_t before = mask;
      tested += popcount(mask);
      HWY_ALIGN float values[4] = {};
      if (const RasterTriangle* t = w_.batch.triangle[q];
          t != nullptr) {  // null in full-screen passes: stencil only
        const float x0 = (static_cast<float>(w_.batch.quad_x[q]) - t->reference_x) + 0.5f +
                         static_cast<float>(p.x) * 0.0625f;
        const float y0 = (static_cast<float>(w_.batch.quad_y[q]) - t->reference_y) + 0.5f +
                         static_cast<float>(p.y) * 0.0625f;
        const auto x = hn::Add(hn::Load(d, kQuadX), hn::Set(d, x0)),
                   y = hn::Add(hn::Load(d, kQuadY), hn::Set(d, y0));
        hn::Store(plane_at(t->z, x, y), d, values);
      }
      c_.depth->use(w_.block[q]);
      touch_depth_tile(w_.block[q]);
      mask = test_quad(state, q, s, values, mask);
      track_depth(w_.block[q], popcount(before), popcount(mask));
      if (mask != 0 && writes_depth_image()) c_.depth->unsaved[static_cast<std::size_t>(w_.block[q])] = 1;
      passed += popcount(mask);
    }
    n.zrop.late_z_tested_samples += tested;
    n.zrop.late_z_killed_samples += tested - passed;
    count_depth_traffic(tested, passed, n);
  }

  std::uint8_t test_quad(const PipelineState& state, std::size_t q, int s, const float* values,
                         std::uint8_t mask) {
    const int first = s * kBlockLanes + 4 * w_.quad_in_block[q];
    std::uint32_t* stored = c_.depth->block(w_.block[q]) + first;
    std::uint8_t* stencil = state.stencil.test ? c_.depth->stencil_block(w_.block[q]) + first : nullptr;
    std::uint8_t passed = 0;
    for (int lane = 0; lane < 4; ++lane) {
      if ((mask >> lane & 1) == 0) continue;
      if (stencil != nullptr && !stencil_passes(state.stencil, stencil[lane])) {
        stencil[lane] = stencil_result(state.stencil, state.stencil.on_fail, stencil[lane]);
        continue;
      }
      const float clamped = values[lane] > 0.0f ? (values[lane] < 1.0f ? values[lane] : 1.0f) : 0.0f;
      const std::uint32_t z = depth_bits(clamped, c_.depth_scale);
      const bool pass = !state.depth.test || depth_passes(state.depth.compare, z, stored[lane]);
      if (pass && state.depth.write) stored[lane] = z;
      if (stencil != nullptr) {
        const StencilOp op = pass ? state.stencil.on_pass : state.stencil.on_depth_fail;
        stencil[lane] = stencil_result(state.stencil, op, stencil[lane]);
      }
      if (pass) passed = static_cast<std::uint8_t>(passed | 1 << lane);
    }
    return passed;
  }

  static bool depth_passes(Compare compare, std::uint32_t z, std::uint32_t stored) {
    switch (compare) {
      case Compare::never:
        return false;
      case Compare::less:
        return z < stored;
      case Compare::equal:
        return z == stored;
      case Compare::less_equal:
        return z <= stored;
      case Compare::greater:
        return z > stored;
      case Compare::not_equal:
        return z != stored;
      case Compare::greater_equal:
        return z >= stored;
      case Compare::always:
        return true;
    }
    return true;
  }

  /// A full-screen triangle lies in one depth, which is tested before its program runs, unless the program
  /// gives each fragment a depth of its own. One sample a pixel.
  bool test_full_screen_depth(int x, int y, SampleMasks& masks, PassCounters& n) {
    const int block = c_.depth->block_index(x, y, layer_);
    const auto index = static_cast<std::size_t>(block);
    const Compare compare = w_.state->depth.compare;
    const std::uint32_t z = depth_bits(c_.pass->full_screen_depth, c_.depth_scale);
    const CoarseResult coarse =
        compare_bounds(compare, z, z, c_.depth->depth_min[index], c_.depth->depth_max[index]);
    n.hiz.tested_tiles += 1;
    n.hiz.killed_tiles += coarse == CoarseResult::killed ? 1 : 0;
    n.hiz.accepted_tiles += coarse == CoarseResult::accepted ? 1 : 0;
    n.hiz.ambiguous_tiles += coarse == CoarseResult::ambiguous ? 1 : 0;
    if (coarse == CoarseResult::killed) return false;
    c_.depth->use(block);
    touch_depth_tile(block);
    const std::uint64_t tested = masks.count;
    std::uint64_t passed = 0;
    for (std::uint64_t lanes = masks.lanes[0]; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctzll(lanes);
      if (depth_passes(compare, z, c_.depth->block(block)[lane])) passed |= std::uint64_t{1} << lane;
    }
    masks.keep(passed, 0, samples_, samples_);
    track_depth(block, tested, masks.count);
    n.zrop.early_z_tested_samples += tested;
    n.zrop.early_z_killed_samples += tested - masks.count;
    count_depth_traffic(tested, masks.count, n);
    return masks.count != 0;
  }

  /// Full-screen programs' own depth is tested when it is known; early tests cannot be forced then.
  bool gives_depth() const {
    const DepthState& depth = w_.state->depth;
    return w_.program->writes_depth && c_.depth != nullptr && (depth.test || depth.write);
  }

  /// The depth that the program gave each lane, tested and written after it.
  void test_given_depth(const FragmentBatch& batch, int x, int y, SampleMasks& masks) {
    const std::uint64_t tested = masks.count;
    if (tested == 0) return;
    const int block = c_.depth->block_index(x, y);
    c_.depth->use(block);
    touch_depth_tile(block);
    const Compare compare = w_.state->depth.test ? w_.state->depth.compare : Compare::always;
    std::uint64_t passed = 0;
    for (std::uint64_t lanes = masks.lanes[0]; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctzll(lanes);
      const std::uint32_t z = depth_bits(batch.depth[lane], c_.depth_scale);
      std::uint32_t& stored = c_.depth->block(block)[lane];
      if (!depth_passes(compare, z, stored)) continue;
      passed |= std::uint64_t{1} << lane;
      if (w_.state->depth.write) stored = z;
    }
    masks.keep(passed, 0, samples_, samples_);
    PassCounters& n = w_.counters();
    track_depth(block, tested, masks.count);
    n.zrop.late_z_tested_samples += tested;
    n.zrop.late_z_killed_samples += tested - masks.count;
    count_depth_traffic(tested, masks.count, n);
    if (!w_.state->depth.write || passed == 0) return;
    read_bounds(*c_.depth, block);
    c_.depth->unsaved[static_cast<std::size_t>(block)] = 1;
  }

  // Late writes went past the tiles' bounds: read them anew.
  void refresh_bounds() {
    if (!w_.state->depth.write) return;
    int last = -1;
    for (std::size_t q = 0; q < static_cast<std::size_t>(w_.batch.quad_count); ++q) {
      const int block = w_.block[q];
      // A tile whose fragments were all discarded may still wait for its clear, or be held as planes: its
      // texels are not its depth then, and its bounds are right.
      const auto i = static_cast<std::size_t>(block);
      if (block == last || c_.depth->cleared[i] != 0 || c_.depth->plane_count[i] != 0) continue;
      last = block;
      read_bounds(*c_.depth, block);
    }
  }

  const PassContext& c_;
  BinWorker& w_;
  const int samples_;
  const int layer_;  ///< the layer of the attachments
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
