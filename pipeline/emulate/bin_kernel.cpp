// The hot loop: one screen bin's triangles through raster, depth, shading and color, on every vector target.
#include "pipeline/emulate/pass_context.h"
#include "pipeline/emulate/primitive_setup.h"
#include "pipeline/raster/triangle_setup.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/emulate/bin_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/emulate/bin_shading-inl.h"
#include "pipeline/raster/coverage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

inline constexpr SamplePosition kPixelCenter{};

class BinRunner : private BinShading {
 public:
  BinRunner(const PassContext& context, int bin, int layer, BinWorker& worker)
      : BinShading(context, layer, worker),
        bin_x_(bin % context.bins_x * kBinPx),
        bin_y_(bin / context.bins_x * kBinPx),
        grid_(context.coverage_positions, context.sample_min_x, context.sample_min_y, context.sample_max_x,
              context.sample_max_y),
        center_(std::span(&kPixelCenter, 1), 0, 0, 0, 0) {
    w_.tracker.start_bin(static_cast<std::uint32_t>(bin));
    w_.batch.quad_count = 0;
    w_.draw = nullptr;
  }

  void run(const Segment& segment, int bin) {
    const auto slot = static_cast<std::size_t>(layer_ * c_.bins_x * c_.bins_y + bin);
    for (const BinRun& run : segment.runs[slot]) {
      const GeometryItem& item = segment.items[run.item];
      start_draw(c_.draws[item.draw]);
      if (item.points != nullptr)
        rasterize_points(item, segment, run.first, run.last);
      else
        rasterize_triangles(item, segment, run.first, run.last);
    }
    flush();
  }

  void run_full_screen() {
    w_.state = &c_.pass->state;
    w_.program = c_.pass->fragment;
    w_.uniforms = c_.pass->uniforms.get();
    w_.late_z = (w_.program->can_discard || w_.program->writes_mask) && w_.state->stencil.test;
    w_.early_reject = false;
    w_.batch.stores = w_.sample_batch.stores = &w_.stores;
    w_.batch.store_order = static_cast<std::uint64_t>(bin_y_ / kBinPx * c_.bins_x + bin_x_ / kBinPx) << 32;
    w_.batch.material = nullptr;
    start_batch();
    for (int y = bin_y_; y < std::min(bin_y_ + kBinPx, c_.height); y += kBlockPx)
      for (int x = bin_x_; x < std::min(bin_x_ + kBinPx, c_.width); x += kBlockPx) full_screen_tile(x, y);
    flush();
  }

 private:
  void rasterize_triangles(const GeometryItem& item, const Segment& segment, std::uint32_t first,
                           std::uint32_t last) {
    for (std::uint32_t i = first; i < last; ++i) {
      const BinTriangle& from = item.triangles[i];
      RasterTriangle& t = w_.triangles[w_.next_triangle];
      const TriangleSlopes slopes =
          set_up_depth(from.screen, from.place, c_.viewports[static_cast<std::size_t>(layer_)],
                       w_.state->raster.conservative, t);
      std::copy_n(from.vertex, 3, t.vertex);
      t.draw = item.draw;
      t.chunk = from.primitive / c_.chunk_primitives;
      t.primitive = from.primitive;
      t.layer = from.layer;
      attributes_ = {&from.screen, &slopes};
      rasterize(t, segment, item);
      keep(t);
    }
  }

  /// What a triangle's fragments need beyond its depth; most small triangles have none.
  void complete(RasterTriangle& t) {
    if (attributes_.slopes == nullptr) return;
    set_up_attributes(*attributes_.vertices, *attributes_.slopes, t);
    attributes_.slopes = nullptr;
  }

  void start_draw(const DrawInfo& draw) {
    if (w_.draw == &draw) return;
    const bool same_batch =
        w_.draw != nullptr && w_.draw->batch == draw.batch && w_.draw->material == draw.material;
    if (!same_batch) {
      flush();
      w_.state = &draw.batch->state;
      w_.program = draw.batch->fragment;
      w_.uniforms = draw.batch->fragment_uniforms.get();
      w_.late_z = tests_late(*w_.state, w_.program);
      w_.early_reject = rejects_early(*w_.state, w_.program);
      w_.batch.material = draw.material;
      start_batch();
    }
    w_.draw = &draw;
  }

  void start_batch() {
    w_.batch.resources = &w_.resources;
    w_.batch.quad_count = 0;
    w_.batch.sample_index = -1;
    w_.batch.layer = layer_;
    start_coverage();
    ordered_ = w_.late_z || (w_.program != nullptr && w_.program->writes_storage);
    for (const BlendState& b : w_.state->blend) ordered_ = ordered_ || b.enabled || b.write_mask != 0xf;
  }

  void rasterize_points(const GeometryItem& item, const Segment& segment, std::uint32_t first,
                        std::uint32_t last) {
    const DrawInfo& draw = c_.draws[item.draw];
    const SetupRules rules = setup_rules(c_, draw);
    const std::int32_t half = point_half(*w_.state);
    const bool one_pixel = half == kSubpixelUnits / 2 && positions_ == 1 && !rules.conservative;
    const bool direct = one_pixel && c_.depth == nullptr && !w_.late_z && !keeps_primitive_masks_ &&
                        w_.program != nullptr && !w_.program->writes_depth;
    for (std::uint32_t i = first; i < last; ++i) {
      const RasterPoint& p = item.points[i];
      const PointPixel pixel(p, rules);
      if (direct && pixel.one_tile) {
        append_point(p, pixel, segment, item);
        continue;
      }
      for (const bool upper : {true, false}) {
        RasterTriangle& t = w_.triangles[w_.next_triangle];
        set_up_point(p, half, upper, rules, t);
        t.draw = item.draw;
        attributes_.slopes = nullptr;
        rasterize(t, segment, item);
        keep(t);
      }
    }
  }

  /// The point's fragment, without edges and tests: what `rasterize` makes of both halves.
  void append_point(const RasterPoint& p, const PointPixel& pixel, const Segment& segment,
                    const GeometryItem& item) {
    w_.current_chunk = p.chunk;
    w_.tracker.start_primitive(p.primitive);
    PassCounters& n = w_.counters();
    n.raster.visited_tiles += pixel.visits();
    n.raster.covered_samples += 1;
    n.stats.samples_passed += 1;
    n.raster.fragments += 1;
    n.raster.quads += 1;
    n.raster.partial_quads += 1;
    const int x = pixel.x & ~7, y = pixel.y & ~7, lane = lane_of(pixel.x & 7, pixel.y & 7);
    const int block = tile_number(x, y), quad = lane / 4;
    if (ordered_ && holds(block, quad)) flush();
    RasterTriangle& t = w_.triangles[w_.next_triangle];
    set_point_planes(p, pixel, t);
    const std::size_t q = place_quad(&t, &segment, &item, x, y, block, quad);
    w_.samples[q].masks[0] = static_cast<std::uint8_t>(1 << lane % 4);
    keep(t);
    if (w_.batch.quad_count == kBatchQuads) flush();
  }

  /// A triangle that the batch has quads of stays until they are shaded: no more than one for each of its
  /// quads.
  void keep(const RasterTriangle& t) {
    const auto quads = static_cast<std::size_t>(w_.batch.quad_count);
    if (quads != 0 && w_.batch.triangle[quads - 1] == &t)
      w_.next_triangle = (w_.next_triangle + 1) % (kBatchQuads + 1);
  }

  void rasterize(RasterTriangle& t, const Segment& segment, const GeometryItem& item) {
    w_.current_chunk = t.chunk;
    w_.tracker.start_primitive(t.primitive);
    PassCounters& n = w_.counters();
    TileCoverage coverage(t, w_.state->raster.conservative ? center_ : grid_);
    const int left = std::max<int>(t.min_x, bin_x_) & ~7, right = std::min<int>(t.max_x, bin_x_ + kBinPx - 1);
    const int top = std::max<int>(t.min_y, bin_y_) & ~7, bottom = std::min<int>(t.max_y, bin_y_ + kBinPx - 1);
    SampleMasks masks;
    for (int y = top; y <= bottom; y += kBlockPx) {
      for (int x = left; x <= right; x += kBlockPx) {
        if (!coverage.reaches(x, y)) continue;
        n.raster.visited_tiles += 1;
        DepthPlane plane;
        const CoarseResult coarse = test_coarse(t, x, y, plane, n);
        if (coarse == CoarseResult::killed) {
          if (c_.skip.hidden_tiles)
            w_.hidden_tiles_skipped += 1;
          else if (cover(t, coverage, x, y, masks))
            test_hidden(t, plane, x, y, masks);
          continue;
        }
        if (!cover(t, coverage, x, y, masks)) continue;
        n.raster.covered_samples += masks.count;
        if (keeps_primitive_masks_) primitive_masks_ = masks;
        if (follows_map_ && !w_.late_z) hide_tile(t, x, y, masks.lanes);
        if (positions_ != samples_) masks.keep(~std::uint64_t{0}, 0, samples_, positions_);
        if (masks.count == 0) continue;  // covers further positions alone: nothing to name
        if (!w_.late_z && !test_early(t, plane, x, y, coarse, masks, n)) continue;
        if (follows_map_ && !w_.late_z) insert_tile(t, x, y, masks.lanes, primitive_masks_.lanes);
        if (w_.early_reject && !reject_early(t, plane, x, y, coarse, masks, n)) continue;
        if (w_.program == nullptr) continue;
        complete(t);
        append_tile(&t, &segment, &item, x, y, masks, n);
      }
    }
  }

  bool cover(const RasterTriangle& t, TileCoverage& coverage, int x, int y, SampleMasks& masks) {
    if (coverage.covers_whole_tile()) {
      masks.start();
      for (int s = 0; s < positions_; ++s) masks.set(static_cast<std::size_t>(s), ~std::uint64_t{0});
    } else {
      coverage.masks(masks);
      if (w_.state->raster.conservative) {  // a touched pixel counts as covered at all of its samples
        masks.start();
        for (int s = 0; s < positions_; ++s) masks.set(static_cast<std::size_t>(s), masks.lanes[0]);
      }
    }
    // Grown edges meet far beyond a sharp corner: the bounds end it.
    if (w_.state->raster.conservative)
      masks.keep(lanes_within(t.min_x - x, t.min_y - y, t.max_x - x, t.max_y - y), 0, positions_, positions_);
    if (x + kBlockPx > c_.width || y + kBlockPx > c_.height)
      masks.keep(lanes_inside(x, y), 0, positions_, positions_);
    return masks.count != 0;
  }

  /// What the coarse test spares; samples that pass show that it was wrong.
  void test_hidden(const RasterTriangle& t, const DepthPlane& plane, int x, int y, SampleMasks& masks) {
    if (positions_ != samples_) masks.keep(~std::uint64_t{0}, 0, samples_, positions_);
    test_samples(t, plane, x, y, masks);
    w_.hidden_samples_passed += masks.count;
  }

  std::uint64_t lanes_inside(int x, int y) const {
    return lanes_within(0, 0, c_.width - 1 - x, c_.height - 1 - y);
  }

  /// Stencil and depth before shading; false when no sample is left.
  bool test_early(const RasterTriangle& t, const DepthPlane& plane, int x, int y, CoarseResult coarse,
                  SampleMasks& masks, PassCounters& n) {
    const PipelineState& state = *w_.state;
    if (c_.depth == nullptr || !(state.depth.test || state.stencil.test || state.depth.write)) {
      n.stats.samples_passed += masks.count;
      return true;
    }
    const std::uint64_t tested = masks.count;
    test_tile(&t, &plane, x, y, coarse, masks);
    track_depth(c_.depth->block_index(x, y, layer_), tested, masks.count);
    n.zrop.early_z_tested_samples += tested;
    n.zrop.early_z_killed_samples += tested - masks.count;
    count_depth_traffic(tested, masks.count, n);
    return masks.count != 0;
  }

  /// The depth test alone, without writes; the shader's samples are tested again and written after it.
  bool reject_early(const RasterTriangle& t, const DepthPlane& plane, int x, int y, CoarseResult coarse,
                    SampleMasks& masks, PassCounters& n) {
    const std::uint64_t tested = masks.count;
    test_tile_read_only(t, plane, x, y, coarse, masks);
    track_depth(c_.depth->block_index(x, y, layer_), tested, 0);
    n.zrop.early_z_tested_samples += tested;
    n.zrop.early_z_killed_samples += tested - masks.count;
    n.mem.depth_read_bytes += tested * static_cast<std::uint64_t>(c_.depth_bytes);
    return masks.count != 0;
  }

  void full_screen_tile(int x, int y) {
    SampleMasks masks;
    masks.start();
    const std::uint64_t inside = lanes_inside(x, y);
    for (int s = 0; s < samples_; ++s) masks.set(static_cast<std::size_t>(s), inside);
    if (keeps_primitive_masks_) primitive_masks_ = masks;
    PassCounters& n = w_.counters();
    n.raster.visited_tiles += 1;
    n.raster.covered_samples += masks.count;
    if (gives_depth()) return append_tile(nullptr, nullptr, nullptr, x, y, masks, n);
    if (w_.state->depth.test) {
      if (!test_full_screen_depth(x, y, masks, n)) return;
    } else if (c_.depth != nullptr && w_.state->stencil.test && !w_.late_z) {
      const std::uint64_t tested = masks.count;
      test_tile(nullptr, nullptr, x, y, CoarseResult::ambiguous, masks);
      track_depth(c_.depth->block_index(x, y, layer_), tested, masks.count);
      n.zrop.early_z_tested_samples += tested;
      n.zrop.early_z_killed_samples += tested - masks.count;
      count_depth_traffic(tested, masks.count, n);
    } else if (!w_.late_z) {
      n.stats.samples_passed += masks.count;
    }
    append_tile(nullptr, nullptr, nullptr, x, y, masks, n);
  }

  const int bin_x_, bin_y_;
  const SampleGrid grid_;    ///< where coverage is found
  const SampleGrid center_;  ///< the same for conservative rasterization
  /// The vertices and slopes of the triangle at hand, until complete() has used them.
  struct Attributes {
    const ScreenVertex (*vertices)[3] = nullptr;
    const TriangleSlopes* slopes = nullptr;
  } attributes_;
};

void run_bin_target(const PassContext& context, const Segment& segment, int bin, BinWorker& worker) {
  for (int layer = 0; layer < static_cast<int>(context.viewports.size()); ++layer)
    BinRunner(context, bin, layer, worker).run(segment, bin);
}
void run_full_screen_bin_target(const PassContext& context, int bin, BinWorker& worker) {
  for (int layer = 0; layer < static_cast<int>(context.viewports.size()); ++layer)
    BinRunner(context, bin, layer, worker).run_full_screen();
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
