// What a compute shader sees: a wave of up to 64 invocations of a group, a vector register at a time.
// Per-target include guard, see shade/lanes-inl.h.
#include "pipeline/emulate/pass_context.h"
#include "pipeline/shade/fragment_lanes-inl.h"

#if defined(HWSIM_SHADE_COMPUTE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_COMPUTE_LANES_INL_H_
#undef HWSIM_SHADE_COMPUTE_LANES_INL_H_
#else
#define HWSIM_SHADE_COMPUTE_LANES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

class ComputeLanes : public LaneFlow {
 public:
  /// Pixels and samples that the invocations of this register work on; `valid`: those that work at all.
  ComputeLanes(GroupBatch& group, int first_lane, I x, I y, I sample, M valid)
      : LaneFlow(group.blocks, first_lane, valid), group_(group), x_(x), y_(y), sample_(sample) {}

  I pixel_x() const { return x_; }
  I pixel_y() const { return y_; }
  I sample() const { return sample_; }

  const MaterialView& material() const { return *group_.material; }
  /// As FragmentLanes' (shade/fragment_lanes-inl.h).
  Vec4<F> sample_texture_at(const TextureView* texture, const TextureSite<F>& at) {
    const TextureSampler<F, I, M> sampler(*texture, group_.resources->tracker, live_, first_);
    return sampler.sample(at.u, at.v, at.du_dx, at.dv_dx, at.du_dy, at.dv_dy,
                          group_.counters->tex.bilinear_probes);
  }

  Vec4<F> load_image(int slot, I x, I y, I sample) {
    const GpuImage& image = *group_.resources->images[static_cast<std::size_t>(slot)];
    const auto lanes = static_cast<std::uint64_t>(__builtin_popcount(mask_bits(live_)));
    TexelCounts texels;
    texels.add(lanes, info(image.format).bytes);
    charge_texels(texels, *group_.counters);
    group_.counters->mem.texture_read_bytes += lanes * info(image.format).bytes;
    track_texels(*group_.resources, slot, x, y, sample, mask_bits(live_), first_);
    return load_texel(image, x, y, sample);
  }

  /// Word `index` of the pass's storage buffer, lanes of `mask` only (others 0).
  I load_buffer(int slot, I index, M mask) {
    group_.counters->mem.storage_read_bytes += word_bytes(mask & valid_);
    return BufferAccess(*group_.resources, slot, first_).load_words(index, mask & valid_);
  }
  void store_buffer(int slot, I index, I value, M mask) {
    group_.counters->mem.storage_write_bytes += word_bytes(mask & valid_);
    BufferAccess(*group_.resources, slot, first_).store_words(index, value, mask & valid_);
  }
  /// Atomic integer add; the words before it.
  I atomic_add(int slot, I index, I value, M mask) {
    group_.counters->mem.storage_read_bytes += word_bytes(mask & valid_);
    group_.counters->mem.storage_write_bytes += word_bytes(mask & valid_);
    return BufferAccess(*group_.resources, slot, first_).add_words(index, value, mask & valid_);
  }
  void tally(std::uint64_t TechniqueCounters::*counter, M mask) {
    group_.counters->technique.*counter +=
        static_cast<std::uint64_t>(__builtin_popcount(mask_bits(mask & live_)));
  }

  /// Writes texel (x, y) of the pass's target, lanes of `mask` only; coordinates are inside the image.
  void store_image(int target, I x, I y, I sample, const Vec4<F>& color, M mask) {
    GpuImage& image = *group_.resources->targets[static_cast<std::size_t>(target)];
    HWY_ALIGN std::int32_t words[4][kVectorLanes], px[kVectorLanes], py[kVectorLanes], ps[kVectorLanes];
    I encoded[4] = {I(0), I(0), I(0), I(0)};
    encode_texel<F, I>(image.format, color, encoded);
    for (int w = 0; w < image.words; ++w) hn::Store(encoded[w].v, DI(), words[w]);
    store(x, px);
    store(y, py);
    store(sample, ps);
    const std::uint32_t bits = mask_bits(mask & live_);
    for (std::uint32_t rest = bits; rest != 0; rest &= rest - 1) {
      const int lane = __builtin_ctz(rest);
      for (int w = 0; w < image.words; ++w)
        image.texels[image.word_index(px[lane], py[lane], ps[lane], w)] =
            static_cast<std::uint32_t>(words[w][lane]);
      note_store(image, target, lane, image.word_index(px[lane], py[lane], ps[lane], 0));
    }
    group_.counters->mem.storage_write_bytes +=
        static_cast<std::uint64_t>(__builtin_popcount(bits)) * info(image.format).bytes;
  }

 private:
  /// Images that are stored to are numbered behind the buffers; a sample's tile is as many lines as a texel
  /// has bytes.
  void note_store(const GpuImage& image, int target, int lane, std::size_t first_word) const {
    const auto bytes = static_cast<std::uint32_t>(info(image.format).bytes);
    const auto texel = static_cast<std::uint32_t>(first_word % kBlockLanes);
    const auto tile =
        static_cast<std::uint32_t>(first_word / kBlockLanes / static_cast<std::size_t>(image.words));
    group_.resources->tracker->use_if_sampled(
        (first_ + lane) / 4, ReuseStream::storage,
        buffer_line(kMaxBufferSlots + target, 0) + tile * bytes + texel * bytes / kLineBytes, 0, bytes);
  }

  GroupBatch& group_;
  I x_, y_, sample_;
};

/// Charges the blocks that a wave of `lanes` invocations went through, and starts the next wave.
inline void end_wave(GroupBatch& group, int lanes) {
  const std::uint64_t valid = lanes == kBatchLanes ? ~std::uint64_t{0} : (std::uint64_t{1} << lanes) - 1;
  account_blocks(group.blocks, group.program->ops, group.program->block_count, valid, *group.counters);
  group.blocks.used = 0;
  group.resources->tracker->end_batch();
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
