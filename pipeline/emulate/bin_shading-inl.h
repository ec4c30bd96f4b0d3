// Fragment shading of a screen bin. Per-target include guard.
#include "pipeline/batch/accounting.h"
#include "pipeline/emulate/bin_color-inl.h"
#include "pipeline/emulate/coverage_output-inl.h"

#if defined(HWSIM_EMULATE_BIN_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_EMULATE_BIN_SHADING_INL_H_
#undef HWSIM_EMULATE_BIN_SHADING_INL_H_
#else
#define HWSIM_EMULATE_BIN_SHADING_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// From this many quads of one triangle on, a tile is shaded in place; fewer are gathered with those of other
/// tiles.
inline constexpr int kTileQuads = 3;

/// Fragments of one bin: tiles shaded in place, and quads gathered into batches.
class BinShading : protected BinColor {
 protected:
  using BinColor::BinColor;

  static std::uint64_t quad_lanes(std::uint64_t lanes) {  // every lane of a quad that has one
    const std::uint64_t low = (lanes | lanes >> 1 | lanes >> 2 | lanes >> 3) & 0x1111111111111111ull;
    return low * 15;
  }

  static int quads_of(std::uint64_t lanes) { return __builtin_popcountll(quad_lanes(lanes)) / 4; }

  /// Shades and writes one triangle's part of a tile at once: every register holds neighboring quads of one
  /// triangle, and texels are stored a register at a time.
  void shade_tile(const RasterTriangle* t, const Segment* segment, const GeometryItem* item, int x, int y,
                  int block, const SampleMasks& masks, PassCounters& n) {
    const std::uint64_t quads = quad_lanes(masks.any_lane);
    n.raster.quads += static_cast<std::uint64_t>(quads_of(quads));
    n.raster.partial_quads += static_cast<std::uint64_t>(quads_of(quads & ~masks.any_lane));
    FragmentBatch& batch = w_.sample_batch;
    start_tile(batch, t, segment, item, x, y);
    const bool centroid = w_.state->raster.centroid;
    if (centroid) set_lane_coverage(primitive_masks_.lanes, positions_, batch.primitive_coverage);
    if (w_.program->reads_coverage)
      set_lane_coverage(w_.state->coverage.post_depth ? masks.lanes : primitive_masks_.lanes, samples_,
                        batch.coverage);
    if (w_.state->raster.sample_rate && samples_ > 1) {
      for (int s = 0; s < samples_; ++s) {
        SampleMasks kept = masks;
        if (masks.lanes[s] != 0) shade_tile_sample(batch, block, x, y, s, kept);
      }
      return;
    }
    batch.sample_index = -1;
    batch.active_lanes = masks.any_lane;
    batch.valid_lanes = quads;
    set_up_tile(batch, x, y, centroid ? AttributeLocation::centroid : AttributeLocation::center, c_.centroid,
                0);
    shade(batch, false);
    add_tile_heat(batch, x, y);
    if (batch.discarded_lanes == 0 && !w_.late_z && !masks_output_ && !gives_depth())
      return write_tile(batch, block, masks.lanes, 0, samples_);
    SampleMasks kept = masks;
    apply_output_mask(batch, 0, samples_, kept);
    kept.keep(~batch.discarded_lanes, 0, samples_, samples_);
    if (gives_depth()) test_given_depth(batch, x, y, kept);
    if (w_.late_z) test_tile_late(t, x, y, kept);
    if (follows_map_ && w_.late_z) insert_tile(*t, x, y, kept.lanes, primitive_masks_.lanes);
    write_tile(batch, block, kept.lanes, 0, samples_);
  }

  void shade_tile_sample(FragmentBatch& batch, int block, int x, int y, int s, SampleMasks& kept) {
    batch.sample_index = s;
    batch.active_lanes = kept.lanes[s];
    batch.valid_lanes = quad_lanes(kept.lanes[s]);
    set_up_tile(batch, x, y, AttributeLocation::sample, {c_.positions, {}}, s);
    shade(batch, true);
    add_tile_heat(batch, x, y);
    apply_output_mask(batch, s, s + 1, kept);
    kept.keep(~batch.discarded_lanes, s, s + 1, samples_);
    if (w_.late_z) test_tile_late(batch.triangle[0], x, y, kept);
    write_tile(batch, block, kept.lanes, s, s + 1);
  }

  void start_tile(FragmentBatch& batch, const RasterTriangle* t, const Segment* segment,
                  const GeometryItem* item, int x, int y) {
    batch.material = w_.batch.material;
    batch.resources = w_.batch.resources;
    batch.layer = layer_;
    batch.stores = w_.batch.stores;
    batch.quad_count = kBatchQuads;
    batch.triangle.fill(t);
    for (int quad = 0; quad < kQuadsPerBlock; ++quad) {
      batch.quad_x[static_cast<std::size_t>(quad)] = x + lane_x(4 * quad);
      batch.quad_y[static_cast<std::size_t>(quad)] = y + lane_y(4 * quad);
    }
    if (t == nullptr) return;
    batch.primitive.fill(t->primitive);
    batch.front_facing.fill(t->front_facing != w_.draw->mirrored);
    const auto stride = static_cast<std::uint32_t>(w_.draw->batch->raster_scalars());
    for (std::size_t v = 0; v < 3; ++v)
      batch.varyings[v].fill(segment->varyings_of(*item, t->vertex[v], stride));
  }

  void apply_output_mask(FragmentBatch& batch, int first_sample, int last_sample, SampleMasks& kept) {
    if (!masks_output_) return;
    if (!w_.program->writes_mask) alpha_to_output_mask(alpha_, batch);
    const bool replaces = w_.state->coverage.override_output;
    for (int s = first_sample; s < last_sample; ++s) {
      const std::uint64_t lanes = lanes_with_sample(batch, s);
      kept.lanes[s] = replaces ? lanes : kept.lanes[s] & lanes;
    }
  }

  static void set_lane_coverage(const std::uint64_t* masks, int count,
                                std::array<std::uint32_t, kBatchLanes>& coverage) {
    for (int first = 0; first < kBlockLanes; first += kVectorLanes) {
      LaneI bits(0);
      for (int s = 0; s < count; ++s)
        bits = bits |
               select(mask_from_bits(masks[s], first), LaneI(static_cast<std::int32_t>(1u << s)), LaneI(0));
      store(bits, reinterpret_cast<std::int32_t*>(coverage.data()) + first);
    }
  }

  bool holds_tile(int block) const {
    for (std::size_t q = 0; q < static_cast<std::size_t>(w_.batch.quad_count); ++q)
      if (w_.block[q] == block) return true;
    return false;
  }

  static std::int32_t place_of(int block, int quad) { return block * kQuadsPerBlock + quad; }

  bool holds(int block, int quad) const {
    std::uint32_t equal = 0;
    for (int q = 0; q < kBatchQuads; q += kVectorLanes)
      equal |= mask_bits(load(w_.place.data() + q) == LaneI(place_of(block, quad))) << q;
    return (equal & ((1u << w_.batch.quad_count) - 1)) != 0;
  }

  /// The number of the tile's block in targets of the pass's size.
  int tile_number(int x, int y) const {
    const int tile = (y / kBlockPx) * ((c_.width + kBlockPx - 1) / kBlockPx) + x / kBlockPx;
    return tile * static_cast<int>(c_.viewports.size()) + layer_;
  }

  void append_tile(const RasterTriangle* t, const Segment* segment, const GeometryItem* item, int x, int y,
                   const SampleMasks& masks, PassCounters& n) {
    const std::uint64_t any_sample = masks.any_lane;
    n.raster.fragments += popcount(any_sample);
    const int block = tile_number(x, y);
    if (quads_of(any_sample) >= kTileQuads || w_.program->writes_depth) {
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

  void append_quad(const RasterTriangle* t, const Segment* segment, const GeometryItem* item, int x, int y,
                   int block, int quad, const std::uint64_t* masks) {
    const std::size_t q = place_quad(t, segment, item, x, y, block, quad);
    for (int s = 0; s < samples_; ++s)
      w_.samples[q].masks[s] = static_cast<std::uint8_t>(masks[s] >> (4 * quad) & 15);
    if (keeps_primitive_masks_)
      for (int s = 0; s < positions_; ++s)
        w_.primitive_samples[q].masks[s] =
            static_cast<std::uint8_t>(primitive_masks_.lanes[s] >> (4 * quad) & 15);
  }

  /// Takes the batch's next quad, whose samples the caller sets.
  std::size_t place_quad(const RasterTriangle* t, const Segment* segment, const GeometryItem* item, int x,
                         int y, int block, int quad) {
    FragmentBatch& batch = w_.batch;
    const auto q = static_cast<std::size_t>(batch.quad_count++);
    batch.quad_x[q] = x + lane_x(4 * quad);
    batch.quad_y[q] = y + lane_y(4 * quad);
    batch.triangle[q] = t;
    w_.block[q] = block;
    w_.quad_in_block[q] = quad;
    w_.place[q] = place_of(block, quad);
    if (t == nullptr) return q;
    batch.primitive[q] = t->primitive;
    batch.front_facing[q] = t->front_facing != w_.draw->mirrored;
    const auto stride = static_cast<std::uint32_t>(w_.draw->batch->raster_scalars());
    for (std::size_t v = 0; v < 3; ++v)
      batch.varyings[v][q] = segment->varyings_of(*item, t->vertex[v], stride);
    return q;
  }

  void flush() {
    if (w_.batch.quad_count == 0) return;
    FragmentBatch& batch = w_.batch;
    const int quads = batch.quad_count;
    std::uint64_t active = 0;
    for (int q = 0; q < quads; ++q) {
      std::uint32_t lanes = 0;
      for (int s = 0; s < samples_; ++s) lanes |= w_.samples[static_cast<std::size_t>(q)].masks[s];
      active |= static_cast<std::uint64_t>(lanes) << (4 * q);
    }
    gather_coverage();
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

  void gather_coverage() {
    FragmentBatch& batch = w_.batch;
    for (std::size_t q = 0; q < static_cast<std::size_t>(batch.quad_count); ++q) {
      if (w_.state->raster.centroid)
        lane_coverage(w_.primitive_samples[q], positions_, batch.primitive_coverage.data() + 4 * q);
      if (w_.program->reads_coverage)
        lane_coverage(w_.state->coverage.post_depth ? w_.samples[q] : w_.primitive_samples[q], samples_,
                      batch.coverage.data() + 4 * q);
    }
  }

  void shade_pixels() {
    FragmentBatch& batch = w_.batch;
    const AttributeLocation location =
        w_.state->raster.centroid ? AttributeLocation::centroid : AttributeLocation::center;
    for (int q = 0; q < batch.quad_count; ++q) set_up_quad(batch, q, location, c_.centroid, 0);
    shade(batch, false);
    add_heat(batch);
    if (masks_output_) mask_quads();
    if (batch.discarded_lanes != 0) drop_discarded(batch.discarded_lanes);
    if (w_.late_z) test_late();
    if (follows_map_ && w_.late_z)
      for (std::size_t q = 0; q < static_cast<std::size_t>(batch.quad_count); ++q) insert_quad(q);
    write_color(batch, w_.block.data(), w_.quad_in_block.data(), 0, samples_);
  }

  // One invocation for each sample index that is covered in a pixel of the quad
  // (docs/techniques/conventions.md#rasterization).
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
    part.layer = layer_;
    part.sample_index = s;
    for (int q = 0; q < part.quad_count; ++q)
      set_up_quad(part, q, AttributeLocation::sample, {c_.positions, {}}, s);
    shade(part, true);
    add_heat(part);
    if (masks_output_) mask_quads_of_sample(part, s);
    drop_discarded_sample(part, s);
    write_color(part, block, quad_in_block, s, s + 1);
  }

  static void copy_quad(const FragmentBatch& from_batch, std::size_t from, FragmentBatch& to_batch,
                        std::size_t to) {
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
    w_.batch.store_order += kBatchLanes;  // lanes within
    batch.store_order = w_.batch.store_order;
    batch.blocks.used = 0;
    batch.texture_footprint = w_.state->raster.texture_footprint;
    batch.tex_bilinear_probes = 0;
    batch.image_probes = 0;
    batch.image_texels = {};
    batch.image_read_bytes = 0;
    batch.storage_read_bytes = batch.storage_write_bytes = batch.narrow_stores = 0;
    batch.counters = &w_.counters();
    w_.program->run(batch, w_.uniforms);
    w_.tracker.end_batch();
    PassCounters& n = w_.counters();
    account_shading(batch, *w_.program, sample_rate, n);
  }

  /// add_heat for a tile in place: lanes of the tile are lanes of the heat image.
  void add_tile_heat(const FragmentBatch& batch, int x, int y) const {
    if (c_.heat == nullptr || c_.heat_shift != 0) return add_heat(batch);
    const std::uint64_t active = batch.active_lanes;
    auto* heat =
        reinterpret_cast<std::int32_t*>(c_.heat) + ((y >> 3) * c_.heat_blocks_x + (x >> 3)) * kBlockLanes;
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

  void mask_quads() {
    FragmentBatch& batch = w_.batch;
    if (!w_.program->writes_mask) alpha_to_output_mask(alpha_, batch);
    const bool replaces = w_.state->coverage.override_output;
    for (int s = 0; s < samples_; ++s) {
      const std::uint64_t lanes = lanes_with_sample(batch, s);
      for (std::size_t q = 0; q < static_cast<std::size_t>(batch.quad_count); ++q) {
        std::uint8_t& mask = w_.samples[q].masks[s];
        const auto output = static_cast<std::uint8_t>(lanes >> (4 * q) & 15);
        mask = replaces ? output : static_cast<std::uint8_t>(mask & output);
      }
    }
  }

  void mask_quads_of_sample(FragmentBatch& part, int s) {
    if (!w_.program->writes_mask) alpha_to_output_mask(alpha_, part);
    const std::uint64_t lanes = lanes_with_sample(part, s);
    for (std::size_t q = 0; q < static_cast<std::size_t>(part.quad_count); ++q)
      w_.samples[static_cast<std::size_t>(w_.sample_quad[q])].masks[s] &=
          static_cast<std::uint8_t>(lanes >> (4 * q) & 15);
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

  /// What the current draws' state and program ask of coverage.
  void start_coverage() {
    const CoverageState& state = w_.state->coverage;
    const bool reads_primitive = w_.program != nullptr && w_.program->reads_coverage && !state.post_depth;
    const bool writes_mask = w_.program != nullptr && w_.program->writes_mask;
    start_coverage_map();
    keeps_primitive_masks_ = w_.state->raster.centroid || reads_primitive || follows_map_;
    masks_output_ = writes_mask || (w_.program != nullptr && state.alpha_to_coverage);
    if (masks_output_ && !writes_mask)
      alpha_ = AlphaCoverage(samples_, layer_, static_cast<int>(c_.viewports.size()), state.alpha_dither);
  }

  SampleMasks primitive_masks_;  ///< the tile at hand, before depth and stencil
  bool keeps_primitive_masks_ = false;
  bool masks_output_ = false;  ///< a mask or alpha changes the coverage after the shader
  AlphaCoverage alpha_;
  bool ordered_ = false;  ///< quads on the same pixels must not share a batch: blending, late tests and
                          ///< storage see what they write, in submission order
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
