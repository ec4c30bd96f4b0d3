// Color writes of a screen bin. Per-target include guard.
#include "pipeline/emulate/bin_coverage-inl.h"
#include "pipeline/emulate/color_traffic.h"
#include "pipeline/emulate/color_write-inl.h"

#if defined(HWSIM_EMULATE_BIN_COLOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_EMULATE_BIN_COLOR_INL_H_
#undef HWSIM_EMULATE_BIN_COLOR_INL_H_
#else
#define HWSIM_EMULATE_BIN_COLOR_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// Color of one bin.
class BinColor : protected BinCoverage {
 protected:
  using BinCoverage::BinCoverage;

  void write_tile(const FragmentBatch& batch, int block, const std::uint64_t* masks, int first_sample,
                  int last_sample) {
    for (std::size_t target = 0; target < c_.color.size(); ++target) {
      const BlendState state = target < w_.state->blend.size() ? w_.state->blend[target] : BlendState{};
      if (state.write_mask == 0) continue;
      GpuImage& image = *c_.color[target];
      const bool reads = state.enabled || state.write_mask != 0xf;
      const ColorSamples samples(samples_ / image.samples, first_sample, last_sample);
      std::uint64_t combined[kMaxSamples] = {};
      for (int s = samples.begin; s < samples.end; ++s)
        combined[s] = samples.combine(s, [&](int i) HWY_ATTR { return masks[i]; });
      const TileWrite write = describe(image, combined, samples, reads);
      if (write.any == 0) continue;
      const std::uint64_t lazy = begin_write(target, block, combined, write);
      EncodedBatch texels;
      if (!reads) encode_batch(image.format, batch.color[target], image.words, batch.valid_lanes, texels);
      for (int s = samples.begin; s < samples.end; ++s) {
        const std::uint64_t mask = s == 0 ? combined[0] : combined[s] & ~lazy;
        if (mask == 0) continue;
        if (reads) blend_tile(image, state, batch.color[target], block, s, texels);
        store_tile(image, block, s, mask, texels);
      }
    }
  }

  static TileWrite describe(const GpuImage& image, const std::uint64_t* combined, const ColorSamples& samples,
                            bool reads) {
    TileWrite write;
    write.blends = reads;
    std::uint64_t every = ~std::uint64_t{0};
    for (int s = samples.begin; s < samples.end; ++s) {
      write.any |= combined[s];
      every &= combined[s];
      write.count += popcount(combined[s]);
    }
    if (samples.end - samples.begin == image.samples) write.whole = every;
    return write;
  }

  /// Before texels of the tile are written: counts, and says which lanes need only sample 0.
  std::uint64_t begin_write(std::size_t target, int block, const std::uint64_t* combined,
                            const TileWrite& write) {
    GpuImage& image = *c_.color[target];
    count_color(target, block, write);
    if (!image.tracks_colors()) {
      image.use(block);
      return 0;
    }
    if (c_.skip.single_color_pixels)
      image.use_first_sample(block);
    else
      image.use(block);
    return follow_colors(image, block, combined, write, c_.skip.single_color_pixels);
  }

  void count_color(std::size_t target, int block, const TileWrite& write) {
    GpuImage& image = *c_.color[target];
    PassCounters& n = w_.counters();
    const auto i = static_cast<std::size_t>(block);
    if (image.touched_chunk[i] != w_.current_chunk + 1) {
      save_color_tile(image, block, w_.chunks);
      if (write.blends && image.tracks_colors()) count_pixel_colors(kReadPixels, image, block, n.crop);
    }
    touch_tile(image, block, w_.current_chunk, n.crop);
    image.unsaved[i] = 1;
    const auto bytes = static_cast<std::uint64_t>(info(image.format).bytes);
    n.crop.exported_fragments += popcount(write.any);
    n.crop.single_color_fragments += popcount(write.whole);
    n.crop.written_samples += write.count;
    n.mem.color_write_bytes += write.count * bytes;
    if (write.blends) {
      n.crop.blended_samples += write.count;
      n.mem.color_read_bytes += write.count * bytes;
    }
    const auto tile =
        static_cast<std::uint32_t>(target * image.touched_chunk.size()) + static_cast<std::uint32_t>(block);
    w_.tracker.touch_if_sampled(ReuseStream::color, tile, write.blends ? write.count * bytes : 0,
                                write.count * bytes);
  }

  void write_color(const FragmentBatch& batch, const std::int32_t* block, const std::int32_t* quad_in_block,
                   int first_sample, int last_sample) {
    const WriteTargets to{block, quad_in_block, batch.quad_count};
    for (std::size_t target = 0; target < c_.color.size(); ++target) {
      const BlendState state = target < w_.state->blend.size() ? w_.state->blend[target] : BlendState{};
      if (state.write_mask == 0) continue;
      GpuImage& image = *c_.color[target];
      const ColorSamples samples(samples_ / image.samples, first_sample, last_sample);
      if (state.enabled || state.write_mask != 0xf)
        blend_quads(batch, state, target, to, samples);
      else
        store_quads(batch, target, to, samples);
    }
  }

  /// Two quads of an opaque batch may lie on the same pixels: one after the other.
  void store_quads(const FragmentBatch& batch, std::size_t target, const WriteTargets& to,
                   const ColorSamples& samples) {
    GpuImage& image = *c_.color[target];
    EncodedBatch texels;
    encode_batch(image.format, batch.color[target], image.words, batch.valid_lanes, texels);
    const bool of_sample_batch = batch.sample_index >= 0;
    for (QuadRun run{}; run.end < to.count;) {
      const int first = run.end;
      run = begin_run(target, to, first, of_sample_batch, samples, false);
      for (int q = first; q < run.end; ++q)
        for (int s = samples.begin; s < samples.end; ++s)
          store_sample(image, to, q, s, sample_mask(q, of_sample_batch, samples, s), run.lazy_of(to, q),
                       texels);
    }
  }

  /// The quads of a blending batch lie on different pixels: all of them, a sample at a time.
  void blend_quads(const FragmentBatch& batch, const BlendState& state, std::size_t target,
                   const WriteTargets& to, const ColorSamples& samples) {
    GpuImage& image = *c_.color[target];
    std::uint8_t lazy[kBatchQuads];
    for (QuadRun run{}; run.end < to.count;) {
      const int first = run.end;
      run = begin_run(target, to, first, batch.sample_index >= 0, samples, true);
      for (int q = first; q < run.end; ++q) lazy[q] = run.lazy_of(to, q);
    }
    EncodedBatch texels;
    for (int s = samples.begin; s < samples.end; ++s) {
      blend_batch(image, state, batch.color[target], to, s, texels);
      for (int q = 0; q < to.count; ++q)
        store_sample(image, to, q, s, sample_mask(q, batch.sample_index >= 0, samples, s), lazy[q], texels);
    }
  }

  /// Quads up to `end` that follow each other in one tile, on different pixels.
  struct QuadRun {
    int end = 0;
    std::uint64_t lazy = 0;  ///< lanes of the tile that need only sample 0

    std::uint8_t lazy_of(const WriteTargets& to, int q) const {
      return static_cast<std::uint8_t>(lazy >> (4 * to.quad_in_block[q]) & 15);
    }
  };

  /// begin_write for the quads that follow `first` in its tile: once for all, as triangles leave several.
  QuadRun begin_run(std::size_t target, const WriteTargets& to, int first, bool of_sample_batch,
                    const ColorSamples& samples, bool reads) {
    std::uint64_t combined[kMaxSamples] = {};
    std::uint32_t taken = 0;
    QuadRun run{first, 0};
    for (; run.end < to.count && to.block[run.end] == to.block[first]; ++run.end) {
      const int quad = to.quad_in_block[run.end];
      if ((taken >> quad & 1) != 0) break;
      taken |= 1u << quad;
      for (int s = samples.begin; s < samples.end; ++s)
        combined[s] |= std::uint64_t{sample_mask(run.end, of_sample_batch, samples, s)} << (4 * quad);
    }
    const TileWrite write = describe(*c_.color[target], combined, samples, reads);
    if (write.any != 0) run.lazy = begin_write(target, to.block[first], combined, write);
    return run;
  }

  static void store_sample(GpuImage& image, const WriteTargets& to, int q, int s, std::uint8_t mask,
                           std::uint8_t lazy, const EncodedBatch& texels) {
    if (s != 0) mask = static_cast<std::uint8_t>(mask & ~lazy);
    if (mask == 0) return;
    for (int word = 0; word < image.words; ++word)
      store_quad(texels.words[word] + 4 * q, mask,
                 quad_texels(image, to.block[q], to.quad_in_block[q], s, word));
  }

  std::uint8_t sample_mask(int quad, bool of_sample_batch, const ColorSamples& samples, int s) const {
    const auto q = static_cast<std::size_t>(quad);
    const QuadSamples& quad_samples =
        w_.samples[of_sample_batch ? static_cast<std::size_t>(w_.sample_quad[q]) : q];
    return static_cast<std::uint8_t>(
        samples.combine(s, [&](int i) HWY_ATTR { return quad_samples.masks[i]; }));
  }
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
