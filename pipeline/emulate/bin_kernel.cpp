// The hot loop: one screen bin's triangles through raster, depth, shading and color, on every vector target.
#include "pipeline/emulate/pass_context.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "pipeline/depth/stencil.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/emulate/bin_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/depth/depth_tile-inl.h"
#include "pipeline/emulate/color_write-inl.h"
#include "pipeline/emulate/fragment_setup-inl.h"
#include "pipeline/raster/coverage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

inline constexpr SamplePosition kPixelCenter{};
/// From this many quads of one triangle on, a tile is shaded in place; fewer are gathered with those of other tiles.
inline constexpr int kTileQuads = 5;

class BinRunner {
 public:
  BinRunner(const PassContext& context, int bin, BinWorker& worker)
      : c_(context), w_(worker), samples_(context.samples), bin_x_(bin % context.bins_x * kBinPx),
        bin_y_(bin / context.bins_x * kBinPx) {
    w_.texture_tracker.reset();
    w_.batch.quad_count = 0;
    w_.draw = nullptr;
  }

  void run(const Segment& segment, int bin) {
    for (const GeometryItem& item : segment.items) {
      const std::uint32_t first = item.bin_start[static_cast<std::size_t>(bin)];
      const std::uint32_t last = item.bin_start[static_cast<std::size_t>(bin) + 1];
      if (first == last) continue;
      start_draw(c_.draws[item.draw]);
      for (std::uint32_t i = first; i < last; ++i) rasterize(item.triangles[item.binned[i]], segment, item);
    }
    flush();
  }

  void run_full_screen() {
    w_.state = &c_.pass->state;
    w_.program = c_.pass->fragment;
    w_.uniforms = c_.pass->uniforms.get();
    w_.late_z = w_.program->can_discard && w_.state->stencil.test;
    w_.batch.material = nullptr;
    start_batch();
    for (int y = bin_y_; y < std::min(bin_y_ + kBinPx, c_.height); y += kBlockPx)
      for (int x = bin_x_; x < std::min(bin_x_ + kBinPx, c_.width); x += kBlockPx) full_screen_tile(x, y);
    flush();
  }

 private:
  void start_draw(const DrawInfo& draw) {
    if (w_.draw == &draw) return;
    const bool same_batch = w_.draw != nullptr && w_.draw->batch == draw.batch && w_.draw->material == draw.material;
    if (!same_batch) {
      flush();
      w_.state = &draw.batch->state;
      w_.program = draw.batch->fragment;
      w_.uniforms = draw.batch->fragment_uniforms.get();
      w_.late_z = tests_late(*w_.state, w_.program);
      w_.batch.material = draw.material;
      start_batch();
    }
    w_.draw = &draw;
  }

  void start_batch() {
    w_.batch.resources = &c_.resources;
    w_.batch.texture_tracker = &w_.texture_tracker;
    w_.batch.quad_count = 0;
    w_.batch.sample_index = -1;
    ordered_ = w_.late_z;
    for (const BlendState& b : w_.state->blend) ordered_ = ordered_ || b.enabled || b.write_mask != 0xf;
  }

  void rasterize(const RasterTriangle& t, const Segment& segment, const GeometryItem& item) {
    w_.current_chunk = t.chunk;
    PassCounters& n = w_.counters();
    const bool conservative = w_.state->raster.conservative;
    TileCoverage coverage(t, conservative ? std::span(&kPixelCenter, 1) : c_.positions, c_.sample_min_x, c_.sample_min_y, c_.sample_max_x, c_.sample_max_y);
    const int left = std::max<int>(t.min_x, bin_x_) & ~7, right = std::min<int>(t.max_x, bin_x_ + kBinPx - 1);
    const int top = std::max<int>(t.min_y, bin_y_) & ~7, bottom = std::min<int>(t.max_y, bin_y_ + kBinPx - 1);
    SampleMasks masks;
    for (int y = top; y <= bottom; y += kBlockPx) {
      for (int x = left; x <= right; x += kBlockPx) {
        if (!coverage.reaches(x, y)) continue;
        n.raster.visited_tiles += 1;
        const CoarseResult coarse = test_coarse(t, x, y, n);
        if (coarse == CoarseResult::killed) continue;
        if (!cover(coverage, x, y, masks, n)) continue;
        if (!w_.late_z && !test_early(t, x, y, coarse, masks, n)) continue;
        if (w_.program != nullptr) append_tile(&t, &segment, &item, x, y, masks, n);
      }
    }
  }

  CoarseResult test_coarse(const RasterTriangle& t, int x, int y, PassCounters& n) const {
    if (c_.depth == nullptr || !w_.state->depth.test) return CoarseResult::ambiguous;
    const auto block = static_cast<std::size_t>(c_.depth->block_index(x, y));
    n.hiz.tested_tiles += 1;
    CoarseResult result = coarse_test(t, x, y, c_.depth_scale, w_.state->depth.compare, c_.depth->depth_min[block],
                                      c_.depth->depth_max[block]);
    // A sample that fails may still change the stencil.
    if (result == CoarseResult::killed && w_.state->stencil.test && w_.state->stencil.on_depth_fail != StencilOp::keep)
      result = CoarseResult::ambiguous;
    n.hiz.killed_tiles += result == CoarseResult::killed ? 1 : 0;
    n.hiz.accepted_tiles += result == CoarseResult::accepted ? 1 : 0;
    n.hiz.ambiguous_tiles += result == CoarseResult::ambiguous ? 1 : 0;
    return result;
  }

  bool cover(TileCoverage& coverage, int x, int y, SampleMasks& masks, PassCounters& n) {
    if (coverage.covers_whole_tile()) {
      masks.start();
      for (int s = 0; s < samples_; ++s) masks.set(static_cast<std::size_t>(s), ~std::uint64_t{0});
    } else {
      coverage.masks(masks);
      if (w_.state->raster.conservative) {  // a touched pixel counts as covered at all of its samples
        masks.start();
        for (int s = 0; s < samples_; ++s) masks.set(static_cast<std::size_t>(s), masks.lanes[0]);
      }
    }
    if (x + kBlockPx > c_.width || y + kBlockPx > c_.height) masks.keep(lanes_inside(x, y), 0, samples_, samples_);
    n.raster.covered_samples += masks.count;
    return masks.count != 0;
  }

  std::uint64_t lanes_inside(int x, int y) const {
    std::uint64_t inside = 0;
    for (int lane = 0; lane < kBlockLanes; ++lane)
      if (x + lane_x(lane) < c_.width && y + lane_y(lane) < c_.height) inside |= std::uint64_t{1} << lane;
    return inside;
  }

  /// Stencil and depth before shading; false when no sample is left.
  bool test_early(const RasterTriangle& t, int x, int y, CoarseResult coarse, SampleMasks& masks, PassCounters& n) {
    const PipelineState& state = *w_.state;
    if (c_.depth == nullptr || !(state.depth.test || state.stencil.test || state.depth.write)) {
      n.stats.samples_passed += masks.count;
      return true;
    }
    const std::uint64_t tested = masks.count;
    test_tile(&t, x, y, coarse, masks, n);
    n.zrop.early_z_tested_samples += tested;
    n.zrop.early_z_killed_samples += tested - masks.count;
    count_depth_traffic(tested, masks.count, n);
    return masks.count != 0;
  }

  void count_depth_traffic(std::uint64_t tested, std::uint64_t passed, PassCounters& n) const {
    const PipelineState& state = *w_.state;
    n.stats.samples_passed += passed;
    const auto bytes = static_cast<std::uint64_t>(c_.depth_bytes);
    n.mem.depth_read_bytes += tested * bytes;
    const bool stencil_writes = state.stencil.test && (state.stencil.on_pass != StencilOp::keep);
    if (state.depth.write || stencil_writes) {
      n.zrop.written_samples += passed;
      n.mem.depth_write_bytes += passed * bytes;
    }
  }

  void test_tile(const RasterTriangle* t, int x, int y, CoarseResult coarse, SampleMasks& masks, PassCounters& n) {
    const PipelineState& state = *w_.state;
    const int block = c_.depth->block_index(x, y);
    c_.depth->use(block);
    touch_tile(*c_.depth, block, w_.current_chunk, n.zrop);
    std::uint64_t before_depth[kMaxSamples];
    if (state.stencil.test) {
      test_stencil(state.stencil, samples_, c_.depth->stencil_block(block), masks.lanes);
      masks.keep(~std::uint64_t{0}, 0, samples_, samples_);
      std::memcpy(before_depth, masks.lanes, sizeof(std::uint64_t) * static_cast<std::size_t>(samples_));
    }
    const Compare compare = state.depth.test ? state.depth.compare : Compare::always;
    const bool write = state.depth.write;
    const bool known = coarse == CoarseResult::accepted && state.depth.test && c_.skip.accepted_tiles;
    if (known && !write) {
      w_.accepted_tiles_skipped += 1;
    } else if (t != nullptr && (state.depth.test || write)) {  // full-screen passes test stencil alone
      const TileDepth tile{c_.depth->block(block), &c_.depth->depth_min[static_cast<std::size_t>(block)],
                           &c_.depth->depth_max[static_cast<std::size_t>(block)], c_.depth_scale};
      fine_test(compare, write, *t, x, y, c_.positions, tile, masks);
    }
    if (state.stencil.test)
      update_stencil(state.stencil, samples_, c_.depth->stencil_block(block), before_depth, masks.lanes);
  }

  static std::uint64_t popcount(std::uint64_t bits) { return static_cast<std::uint64_t>(__builtin_popcountll(bits)); }

  void full_screen_tile(int x, int y) {
    SampleMasks masks;
    masks.start();
    const std::uint64_t inside = lanes_inside(x, y);
    for (int s = 0; s < samples_; ++s) masks.set(static_cast<std::size_t>(s), inside);
    PassCounters& n = w_.counters();
    n.raster.visited_tiles += 1;
    n.raster.covered_samples += masks.count;
    if (c_.depth != nullptr && w_.state->stencil.test && !w_.late_z) {
      const std::uint64_t tested = masks.count;
      test_tile(nullptr, x, y, CoarseResult::ambiguous, masks, n);
      n.zrop.early_z_tested_samples += tested;
      n.zrop.early_z_killed_samples += tested - masks.count;
      count_depth_traffic(tested, masks.count, n);
    } else if (!w_.late_z) {
      n.stats.samples_passed += masks.count;
    }
    append_tile(nullptr, nullptr, nullptr, x, y, masks, n);
  }

  void append_tile(const RasterTriangle* t, const Segment* segment, const GeometryItem* item, int x, int y,
                   const SampleMasks& masks, PassCounters& n) {
    const std::uint64_t any_sample = masks.any_lane;
    n.raster.fragments += popcount(any_sample);
    const int block = tile_number(x, y);
    if (quads_of(any_sample) >= kTileQuads) {
      if (holds_tile(block)) flush();
      shade_tile(t, segment, item, x, y, block, masks, n);
      return;
    }
    for (int quad = 0; quad < kQuadsPerBlock; ++quad) {
      const auto lanes = static_cast<std::uint32_t>(any_sample >> (4 * quad)) & 15u;
      if (lanes == 0) continue;
      n.raster.quads += 1;
      n.raster.partial_quads += lanes != 15 ? 1 : 0;
      if (ordered_ && holds(block, quad)) flush();
      append_quad(t, segment, item, x, y, block, quad, masks.lanes);
      if (w_.batch.quad_count == kBatchQuads) flush();
    }
  }

  static std::uint64_t quad_lanes(std::uint64_t lanes) {  // every lane of a quad that has one
    const std::uint64_t low = (lanes | lanes >> 1 | lanes >> 2 | lanes >> 3) & 0x1111111111111111ull;
    return low * 15;
  }
  static int quads_of(std::uint64_t lanes) { return __builtin_popcountll(quad_lanes(lanes)) / 4; }

  /// Shades and writes one triangle's part of a tile at once: every register holds neighboring quads of one triangle,
  /// and texels are stored a register at a time.
  void shade_tile(const RasterTriangle* t, const Segment* segment, const GeometryItem* item, int x, int y, int block,
                  const SampleMasks& masks, PassCounters& n) {
    const std::uint64_t quads = quad_lanes(masks.any_lane);
    n.raster.quads += static_cast<std::uint64_t>(quads_of(quads));
    n.raster.partial_quads += static_cast<std::uint64_t>(quads_of(quads & ~masks.any_lane));
    FragmentBatch& batch = w_.sample_batch;
    start_tile(batch, t, segment, item, x, y);
    set_lane_coverage(batch, masks.lanes);
    SampleMasks kept = masks;
    if (w_.state->raster.sample_rate && samples_ > 1) {
      for (int s = 0; s < samples_; ++s) {
        kept = masks;
        if (masks.lanes[s] != 0) shade_tile_sample(batch, block, x, y, s, kept);
      }
      return;
    }
    batch.sample_index = -1;
    batch.active_lanes = masks.any_lane;
    batch.valid_lanes = quads;
    set_up_tile(batch, x, y, w_.state->raster.centroid ? AttributeLocation::centroid : AttributeLocation::center,
                c_.positions, 0);
    shade(batch, false);
    add_tile_heat(batch, x, y);
    if (batch.discarded_lanes != 0) kept.keep(~batch.discarded_lanes, 0, samples_, samples_);
    if (w_.late_z) test_tile_late(t, x, y, kept);
    write_tile(batch, block, kept.lanes, 0, samples_);
  }

  void shade_tile_sample(FragmentBatch& batch, int block, int x, int y, int s, SampleMasks& kept) {
    batch.sample_index = s;
    batch.active_lanes = kept.lanes[s];
    batch.valid_lanes = quad_lanes(kept.lanes[s]);
    set_up_tile(batch, x, y, AttributeLocation::sample, c_.positions, s);
    shade(batch, true);
    add_tile_heat(batch, x, y);
    kept.keep(~batch.discarded_lanes, s, s + 1, samples_);
    if (w_.late_z) test_tile_late(batch.triangle[0], x, y, kept);
    write_tile(batch, block, kept.lanes, s, s + 1);
  }

  void start_tile(FragmentBatch& batch, const RasterTriangle* t, const Segment* segment, const GeometryItem* item, int x,
                  int y) {
    batch.material = w_.batch.material;
    batch.resources = w_.batch.resources;
    batch.texture_tracker = w_.batch.texture_tracker;
    batch.quad_count = kBatchQuads;
    batch.triangle.fill(t);
    for (int quad = 0; quad < kQuadsPerBlock; ++quad) {
      batch.quad_x[static_cast<std::size_t>(quad)] = x + lane_x(4 * quad);
      batch.quad_y[static_cast<std::size_t>(quad)] = y + lane_y(4 * quad);
    }
    if (t == nullptr) return;
    batch.primitive.fill(t->primitive);
    batch.front_facing.fill(t->front_facing != w_.draw->mirrored);
    const auto stride = static_cast<std::uint32_t>(w_.draw->batch->vertex->varying_scalars);
    for (std::size_t v = 0; v < 3; ++v) batch.varyings[v].fill(varyings_of(t->vertex[v], stride, *segment, *item));
  }

  void set_lane_coverage(FragmentBatch& batch, const std::uint64_t* masks) const {
    for (int first = 0; first < kBlockLanes; first += kVectorLanes) {
      LaneI bits(0);
      for (int s = 0; s < samples_; ++s)
        bits = bits | select(mask_from_bits(masks[s], first), LaneI(static_cast<std::int32_t>(1u << s)), LaneI(0));
      store(bits, reinterpret_cast<std::int32_t*>(batch.coverage.data()) + first);
    }
  }

  void test_tile_late(const RasterTriangle* t, int x, int y, SampleMasks& masks) {
    const std::uint64_t tested = masks.count;
    if (tested == 0) return;
    PassCounters& n = w_.counters();
    test_tile(t, x, y, CoarseResult::ambiguous, masks, n);
    n.zrop.late_z_tested_samples += tested;
    n.zrop.late_z_killed_samples += tested - masks.count;
    count_depth_traffic(tested, masks.count, n);
  }

  void write_tile(const FragmentBatch& batch, int block, const std::uint64_t* masks, int first_sample, int last_sample) {
    for (std::size_t target = 0; target < c_.color.size(); ++target) {
      const BlendState state = target < w_.state->blend.size() ? w_.state->blend[target] : BlendState{};
      if (state.write_mask == 0) continue;
      GpuImage& image = *c_.color[target];
      image.use(block);
      EncodedBatch texels;
      const bool reads = state.enabled || state.write_mask != 0xf;
      if (!reads) encode_batch(image.format, batch.color[target], image.words, kBatchLanes, texels);
      std::uint64_t written = 0, any_lane = 0, every_sample = ~std::uint64_t{0};
      for (int s = first_sample; s < last_sample; ++s) {
        any_lane |= masks[s];
        every_sample &= masks[s];
        written += popcount(masks[s]);
        if (masks[s] == 0) continue;
        if (reads) blend_tile(image, state, batch.color[target], block, s, texels);
        store_tile(image, block, s, masks[s], texels);
      }
      if (any_lane == 0) continue;
      const bool all_samples = last_sample - first_sample == samples_;
      count_color(image, block, popcount(any_lane), all_samples ? popcount(every_sample) : 0, written, reads);
    }
  }

  void count_color(GpuImage& image, int block, std::uint64_t fragments, std::uint64_t single_color, std::uint64_t written,
                   bool reads) {
    PassCounters& n = w_.counters();
    touch_tile(image, block, w_.current_chunk, n.crop);
    const auto bytes = static_cast<std::uint64_t>(info(image.format).bytes);
    n.crop.exported_fragments += fragments;
    n.crop.single_color_fragments += single_color;
    n.crop.written_samples += written;
    n.mem.color_write_bytes += written * bytes;
    if (reads) {
      n.crop.blended_samples += written;
      n.mem.color_read_bytes += written * bytes;
    }
  }

  bool holds_tile(int block) const {
    for (std::size_t q = 0; q < static_cast<std::size_t>(w_.batch.quad_count); ++q)
      if (w_.block[q] == block) return true;
    return false;
  }

  /// The number of the tile in targets of the pass's size.
  int tile_number(int x, int y) const { return (y / kBlockPx) * ((c_.width + kBlockPx - 1) / kBlockPx) + x / kBlockPx; }

  bool holds(int block, int quad) const {
    for (std::size_t q = 0; q < static_cast<std::size_t>(w_.batch.quad_count); ++q)
      if (w_.block[q] == block && w_.quad_in_block[q] == quad) return true;
    return false;
  }

  void append_quad(const RasterTriangle* t, const Segment* segment, const GeometryItem* item, int x, int y, int block,
                   int quad, const std::uint64_t* masks) {
    FragmentBatch& batch = w_.batch;
    const auto q = static_cast<std::size_t>(batch.quad_count++);
    batch.quad_x[q] = x + lane_x(4 * quad);
    batch.quad_y[q] = y + lane_y(4 * quad);
    batch.triangle[q] = t;
    w_.block[q] = block;
    w_.quad_in_block[q] = quad;
    for (int s = 0; s < samples_; ++s) w_.samples[q].masks[s] = static_cast<std::uint8_t>(masks[s] >> (4 * quad) & 15);
    if (t == nullptr) return;
    batch.primitive[q] = t->primitive;
    batch.front_facing[q] = t->front_facing != w_.draw->mirrored;
    const auto stride = static_cast<std::uint32_t>(w_.draw->batch->vertex->varying_scalars);
    for (std::size_t v = 0; v < 3; ++v) batch.varyings[v][q] = varyings_of(t->vertex[v], stride, *segment, *item);
  }

  static const float* varyings_of(std::uint32_t vertex, std::uint32_t stride, const Segment& segment,
                                  const GeometryItem& item) {
    if ((vertex & kClippedVertexBit) != 0) return item.clipped_varyings.data() + (vertex & ~kClippedVertexBit) * stride;
    return segment.varyings.data() + segment.varying_base[item.draw - segment.first_draw] + std::size_t{vertex} * stride;
  }

  void flush() {
    if (w_.batch.quad_count == 0) return;
    FragmentBatch& batch = w_.batch;
    const int quads = batch.quad_count;
    std::uint64_t active = 0;
    for (int q = 0; q < quads; ++q) {
      lane_coverage(w_.samples[static_cast<std::size_t>(q)], samples_, batch.coverage.data() + 4 * q);
      for (int lane = 4 * q; lane < 4 * q + 4; ++lane)
        active |= static_cast<std::uint64_t>(batch.coverage[static_cast<std::size_t>(lane)] != 0) << lane;
    }
    batch.active_lanes = active;
    batch.valid_lanes = quads == kBatchQuads ? ~std::uint64_t{0} : (std::uint64_t{1} << (4 * quads)) - 1;
    if (w_.state->raster.sample_rate && samples_ > 1) {
      for (int s = 0; s < samples_; ++s) shade_sample(s);
      if (w_.late_z) refresh_bounds();
    } else {
      shade_pixels();
    }
    batch.quad_count = 0;
  }

  void shade_pixels() {
    FragmentBatch& batch = w_.batch;
    const AttributeLocation location =
        w_.state->raster.centroid ? AttributeLocation::centroid : AttributeLocation::center;
    for (int q = 0; q < batch.quad_count; ++q) set_up_quad(batch, q, location, c_.positions, 0);
    shade(batch, false);
    add_heat(batch);
    if (batch.discarded_lanes != 0) drop_discarded(batch.discarded_lanes);
    if (w_.late_z) test_late();
    write_color(batch, w_.block.data(), w_.quad_in_block.data(), 0, samples_);
  }

  // One invocation for each sample index that is covered in a pixel of the quad (techniques 0.3.5).
  void shade_sample(int s) {
    FragmentBatch& batch = w_.batch;
    FragmentBatch& part = w_.sample_batch;
    std::int32_t block[kBatchQuads], quad_in_block[kBatchQuads];
    part.quad_count = 0;
    part.active_lanes = 0;
    for (int q = 0; q < batch.quad_count; ++q) {
      const auto from = static_cast<std::size_t>(q);
      const std::uint8_t mask = w_.samples[from].masks[s];
      if (mask == 0) continue;
      const auto to = static_cast<std::size_t>(part.quad_count);
      copy_quad(batch, from, part, to);
      part.active_lanes |= static_cast<std::uint64_t>(mask) << (4 * to);
      block[to] = w_.block[from];
      quad_in_block[to] = w_.quad_in_block[from];
      w_.sample_quad[to] = q;
      part.quad_count++;
    }
    if (part.quad_count == 0) return;
    part.valid_lanes =
        part.quad_count == kBatchQuads ? ~std::uint64_t{0} : (std::uint64_t{1} << (4 * part.quad_count)) - 1;
    part.material = batch.material;
    part.resources = batch.resources;
    part.texture_tracker = batch.texture_tracker;
    part.sample_index = s;
    for (int q = 0; q < part.quad_count; ++q) set_up_quad(part, q, AttributeLocation::sample, c_.positions, s);
    shade(part, true);
    add_heat(part);
    drop_discarded_sample(part, s);
    write_color(part, block, quad_in_block, s, s + 1);
  }

  static void copy_quad(const FragmentBatch& from_batch, std::size_t from, FragmentBatch& to_batch, std::size_t to) {
    to_batch.quad_x[to] = from_batch.quad_x[from];
    to_batch.quad_y[to] = from_batch.quad_y[from];
    to_batch.triangle[to] = from_batch.triangle[from];
    to_batch.primitive[to] = from_batch.primitive[from];
    to_batch.front_facing[to] = from_batch.front_facing[from];
    for (auto* v = &from_batch.varyings[0]; v != &from_batch.varyings[3]; ++v)
      to_batch.varyings[v - &from_batch.varyings[0]][to] = (*v)[from];
    for (std::size_t lane = 0; lane < 4; ++lane)
      to_batch.coverage[4 * to + lane] = from_batch.coverage[4 * from + lane];
  }

  void shade(FragmentBatch& batch, bool sample_rate) {
    batch.discarded_lanes = 0;
    batch.blocks.used = 0;
    batch.tex_bilinear_probes = 0;
    batch.image_texels = 0;
    batch.image_read_bytes = 0;
    const std::uint64_t lines_before = w_.texture_tracker.missed_lines;
    w_.program->run(batch, w_.uniforms);
    PassCounters& n = w_.counters();
    account_shading(batch, *w_.program, sample_rate, n);
    n.tex.touched_lines += w_.texture_tracker.missed_lines - lines_before;
  }

  /// add_heat for a tile in place: lanes of the tile are lanes of the heat image.
  void add_tile_heat(const FragmentBatch& batch, int x, int y) const {
    if (c_.heat == nullptr || c_.heat_shift != 0) return add_heat(batch);
    const std::uint64_t active = batch.active_lanes;
    auto* heat = reinterpret_cast<std::int32_t*>(c_.heat) + ((y >> 3) * c_.heat_blocks_x + (x >> 3)) * kBlockLanes;
    for (int first = 0; first < kBlockLanes; first += kVectorLanes)
      store(load(heat + first) + select(mask_from_bits(active, first), LaneI(1), LaneI(0)), heat + first);
  }

  void add_heat(const FragmentBatch& batch) const {
    if (c_.heat == nullptr) return;
    for (std::uint64_t lanes = batch.active_lanes; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctzll(lanes));
      const int x = batch.pixel_x[lane] >> c_.heat_shift, y = batch.pixel_y[lane] >> c_.heat_shift;
      const int block = (y >> 3) * c_.heat_blocks_x + (x >> 3);
      c_.heat[block * kBlockLanes + lane_of(x & 7, y & 7)] += 1;
    }
  }

  void drop_discarded(std::uint64_t discarded) {
    for (std::size_t q = 0; q < static_cast<std::size_t>(w_.batch.quad_count); ++q) {
      const auto kept = static_cast<std::uint8_t>(~(discarded >> (4 * q)) & 15);
      for (int s = 0; s < samples_; ++s) w_.samples[q].masks[s] &= kept;
    }
  }

  void drop_discarded_sample(const FragmentBatch& part, int s) {
    for (std::size_t q = 0; q < static_cast<std::size_t>(part.quad_count); ++q) {
      const auto original = static_cast<std::size_t>(w_.sample_quad[q]);
      w_.samples[original].masks[s] &= static_cast<std::uint8_t>(~(part.discarded_lanes >> (4 * q)) & 15);
    }
    if (w_.late_z) test_late_sample(s);
  }

  void test_late() {
    for (int s = 0; s < samples_; ++s) test_late_sample(s);
    refresh_bounds();
  }

  // In submission order, a quad at a time: two quads of a batch never lie on the same pixels (see append_tile).
  void test_late_sample(int s) {
    const D4 d;
    const PipelineState& state = *w_.state;
    const SamplePosition p = c_.positions[static_cast<std::size_t>(s)];
    PassCounters& n = w_.counters();
    std::uint64_t tested = 0, passed = 0;
    for (std::size_t q = 0; q < static_cast<std::size_t>(w_.batch.quad_count); ++q) {
      std::uint8_t& mask = w_.samples[q].masks[s];
      if (mask == 0) continue;
      tested += popcount(mask);
      HWY_ALIGN float values[4] = {};
      if (const RasterTriangle* t = w_.batch.triangle[q]; t != nullptr) {  // null in full-screen passes: stencil only
        const float x0 = static_cast<float>(w_.batch.quad_x[q] - t->reference_x) + 0.5f + static_cast<float>(p.x) * 0.0625f;
        const float y0 = static_cast<float>(w_.batch.quad_y[q] - t->reference_y) + 0.5f + static_cast<float>(p.y) * 0.0625f;
        const auto x = hn::Add(hn::Load(d, kQuadX), hn::Set(d, x0)), y = hn::Add(hn::Load(d, kQuadY), hn::Set(d, y0));
        hn::Store(plane_at(t->z, x, y), d, values);
      }
      c_.depth->use(w_.block[q]);
      touch_tile(*c_.depth, w_.block[q], w_.current_chunk, n.zrop);
      mask = test_quad(state, q, s, values, mask);
      passed += popcount(mask);
    }
    n.zrop.late_z_tested_samples += tested;
    n.zrop.late_z_killed_samples += tested - passed;
    count_depth_traffic(tested, passed, n);
  }

  std::uint8_t test_quad(const PipelineState& state, std::size_t q, int s, const float* values, std::uint8_t mask) {
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
      case Compare::never: return false;
      case Compare::less: return z < stored;
      case Compare::equal: return z == stored;
      case Compare::less_equal: return z <= stored;
      case Compare::greater: return z > stored;
      case Compare::not_equal: return z != stored;
      case Compare::greater_equal: return z >= stored;
      case Compare::always: return true;
    }
    return true;
  }

  // Late writes went past the tiles' bounds: read them anew.
  void refresh_bounds() {
    if (!w_.state->depth.write) return;
    int last = -1;
    for (std::size_t q = 0; q < static_cast<std::size_t>(w_.batch.quad_count); ++q) {
      const int block = w_.block[q];
      if (block == last) continue;
      last = block;
      const auto* stored = reinterpret_cast<const std::int32_t*>(c_.depth->block(block));
      LaneI lowest = load(stored), highest = lowest;
      for (int i = kVectorLanes; i < samples_ * kBlockLanes; i += kVectorLanes) {
        lowest = min(lowest, load(stored + i));
        highest = max(highest, load(stored + i));
      }
      const auto index = static_cast<std::size_t>(block);
      c_.depth->depth_min[index] = static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(DI(), lowest.v)));
      c_.depth->depth_max[index] = static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(DI(), highest.v)));
    }
  }

  void write_color(const FragmentBatch& batch, const std::int32_t* block, const std::int32_t* quad_in_block,
                   int first_sample, int last_sample) {
    const WriteTargets to{block, quad_in_block, batch.quad_count};
    for (std::size_t target = 0; target < c_.color.size(); ++target) {
      const BlendState state = target < w_.state->blend.size() ? w_.state->blend[target] : BlendState{};
      if (state.write_mask == 0) continue;
      GpuImage& image = *c_.color[target];
      for (int q = 0; q < to.count; ++q) image.use(block[q]);
      EncodedBatch texels;
      const bool reads = state.enabled || state.write_mask != 0xf;
      if (!reads) encode_batch(image.format, batch.color[target], image.words, 4 * batch.quad_count, texels);
      for (int s = first_sample; s < last_sample; ++s) {
        if (reads) blend_batch(image, state, batch.color[target], to, s, texels);
        write_sample(image, to, batch.sample_index >= 0, s, texels);
      }
      count_quads(image, to, batch.sample_index >= 0, first_sample, last_sample, reads);
    }
  }

  std::uint8_t sample_mask(int quad, bool of_sample_batch, int s) const {
    const auto q = static_cast<std::size_t>(quad);
    return w_.samples[of_sample_batch ? static_cast<std::size_t>(w_.sample_quad[q]) : q].masks[s];
  }

  void write_sample(GpuImage& image, const WriteTargets& to, bool of_sample_batch, int s, const EncodedBatch& texels) {
    for (int q = 0; q < to.count; ++q) {
      const std::uint8_t mask = sample_mask(q, of_sample_batch, s);
      if (mask == 0) continue;
      for (int word = 0; word < image.words; ++word)
        store_quad(texels.words[word] + 4 * q, mask, quad_texels(image, to.block[q], to.quad_in_block[q], s, word));
    }
  }

  void count_quads(GpuImage& image, const WriteTargets& to, bool of_sample_batch, int first_sample, int last_sample,
                   bool reads) {
    for (int q = 0; q < to.count; ++q) {
      std::uint64_t written = 0;
      std::uint8_t lanes = 0, all = 15;
      for (int s = first_sample; s < last_sample; ++s) {
        const std::uint8_t mask = sample_mask(q, of_sample_batch, s);
        written += popcount(mask);
        lanes |= mask;
        all &= mask;
      }
      if (lanes == 0) continue;
      const bool all_samples = last_sample - first_sample == samples_;
      count_color(image, to.block[q], popcount(lanes), all_samples ? popcount(all) : 0, written, reads);
    }
  }

  const PassContext& c_;
  BinWorker& w_;
  const int samples_;
  const int bin_x_, bin_y_;
  bool ordered_ = false;  ///< quads on the same pixels must not share a batch: blending and late tests read what they write
};

void run_bin_target(const PassContext& context, const Segment& segment, int bin, BinWorker& worker) {
  BinRunner(context, bin, worker).run(segment, bin);
}
void run_full_screen_bin_target(const PassContext& context, int bin, BinWorker& worker) {
  BinRunner(context, bin, worker).run_full_screen();
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::pipeline {
HWY_EXPORT(run_bin_target);
HWY_EXPORT(run_full_screen_bin_target);

void run_bin(const PassContext& context, const Segment& segment, int bin, BinWorker& worker) {
  HWY_DYNAMIC_DISPATCH(run_bin_target)(context, segment, bin, worker);
}
void run_full_screen_bin(const PassContext& context, int bin, BinWorker& worker) {
  HWY_DYNAMIC_DISPATCH(run_full_screen_bin_target)(context, bin, worker);
}
}  // namespace hwsim::pipeline
#endif
