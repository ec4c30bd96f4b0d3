// Color writes of a screen bin. Per-target include guard.
#include "pipeline/emulate/bin_depth-inl.h"
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
class BinColor : protected BinDepth {
 protected:
  using BinDepth::BinDepth;

  void write_tile(const FragmentBatch& batch, int block, const std::uint64_t* masks, int first_sample,
                  int last_sample) {
    for (std::size_t target = 0; target < c_.color.size(); ++target) {
      const BlendState state = target < w_.state->blend.size() ? w_.state->blend[target] : BlendState{};
      if (state.write_mask == 0) continue;
      GpuImage& image = *c_.color[target];
      image.use(block);
      EncodedBatch texels;
      const bool reads = state.enabled || state.write_mask != 0xf;
      if (!reads) encode_batch(image.format, batch.color[target], image.words, batch.valid_lanes, texels);
      std::uint64_t written = 0, any_lane = 0, every_sample = ~std::uint64_t{0};
      const ColorSamples samples(samples_ / image.samples, first_sample, last_sample);
      for (int s = samples.begin; s < samples.end; ++s) {
        const std::uint64_t mask = samples.combine(s, [&](int i) HWY_ATTR { return masks[i]; });
        any_lane |= mask;
        every_sample &= mask;
        written += popcount(mask);
        if (mask == 0) continue;
        if (reads) blend_tile(image, state, batch.color[target], block, s, texels);
        store_tile(image, block, s, mask, texels);
      }
      if (any_lane == 0) continue;
      const bool all_samples = samples.end - samples.begin == image.samples;
      count_color(target, block, popcount(any_lane), all_samples ? popcount(every_sample) : 0, written,
                  reads);
    }
  }

  void count_color(std::size_t target, int block, std::uint64_t fragments, std::uint64_t single_color,
                   std::uint64_t written, bool reads) {
    GpuImage& image = *c_.color[target];
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
    const auto tile =
        static_cast<std::uint32_t>(target * image.touched_chunk.size()) + static_cast<std::uint32_t>(block);
    w_.tracker.touch_if_sampled(ReuseStream::color, tile, reads ? written * bytes : 0, written * bytes);
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
      if (!reads) encode_batch(image.format, batch.color[target], image.words, batch.valid_lanes, texels);
      const ColorSamples samples(samples_ / image.samples, first_sample, last_sample);
      for (int s = samples.begin; s < samples.end; ++s) {
        if (reads) blend_batch(image, state, batch.color[target], to, s, texels);
        write_sample(image, to, batch.sample_index >= 0, samples, s, texels);
      }
      count_quads(target, to, batch.sample_index >= 0, samples, reads);
    }
  }

  std::uint8_t sample_mask(int quad, bool of_sample_batch, const ColorSamples& samples, int s) const {
    const auto q = static_cast<std::size_t>(quad);
    const QuadSamples& quad_samples =
        w_.samples[of_sample_batch ? static_cast<std::size_t>(w_.sample_quad[q]) : q];
    return static_cast<std::uint8_t>(
        samples.combine(s, [&](int i) HWY_ATTR { return quad_samples.masks[i]; }));
  }

  void write_sample(GpuImage& image, const WriteTargets& to, bool of_sample_batch,
                    const ColorSamples& samples, int s, const EncodedBatch& texels) {
    for (int q = 0; q < to.count; ++q) {
      const std::uint8_t mask = sample_mask(q, of_sample_batch, samples, s);
      if (mask == 0) continue;
      for (int word = 0; word < image.words; ++word)
        store_quad(texels.words[word] + 4 * q, mask,
                   quad_texels(image, to.block[q], to.quad_in_block[q], s, word));
    }
  }

  void count_quads(std::size_t target, const WriteTargets& to, bool of_sample_batch,
                   const ColorSamples& samples, bool reads) {
    for (int q = 0; q < to.count; ++q) {
      std::uint64_t written = 0;
      std::uint8_t lanes = 0, all = 15;
      for (int s = samples.begin; s < samples.end; ++s) {
        const std::uint8_t mask = sample_mask(q, of_sample_batch, samples, s);
        written += popcount(mask);
        lanes |= mask;
        all &= mask;
      }
      if (lanes == 0) continue;
      const bool all_samples = samples.end - samples.begin == c_.color[target]->samples;
      count_color(target, to.block[q], popcount(lanes), all_samples ? popcount(all) : 0, written, reads);
    }
  }
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
