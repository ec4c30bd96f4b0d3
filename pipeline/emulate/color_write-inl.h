// Encoding, blending and writing of shaded batches. Per-target include guard.
#include <cstring>
#include "pipeline/emulate/fragment_setup-inl.h"
#include "pipeline/emulate/pass_context.h"
#include "pipeline/image/image.h"
#include "pipeline/memory/stale_samples-inl.h"

#include "pipeline/simd/codec-inl.h"
#include "pipeline/simd/lanes-inl.h"

#if defined(HWSIM_EMULATE_COLOR_WRITE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_EMULATE_COLOR_WRITE_INL_H_
#undef HWSIM_EMULATE_COLOR_WRITE_INL_H_
#else
#define HWSIM_EMULATE_COLOR_WRITE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// A batch's texels for one target: words[w][lane].
struct EncodedBatch {
  HWY_ALIGN std::int32_t words[4][kBatchLanes];
};

HWY_INLINE Vec4<LaneF> batch_color(const float (&color)[4][kBatchLanes], int first) {
  return {load(color[0] + first), load(color[1] + first), load(color[2] + first), load(color[3] + first)};
}

HWY_INLINE void encode_lanes(Format format, const Vec4<LaneF>& color, int words, int first,
                             EncodedBatch& out) {
  LaneI encoded[4];
  encode_texel<LaneF, LaneI>(format, color, encoded);
  for (int w = 0; w < words; ++w) store(encoded[w], out.words[w] + first);
}

inline void encode_batch(Format format, const float (&color)[4][kBatchLanes], int words, std::uint64_t lanes,
                         EncodedBatch& out) {
  for (int first = 0; first < kBatchLanes; first += kVectorLanes)
    if ((lanes >> first & kRegisterBits) != 0)
      encode_lanes(format, batch_color(color, first), words, first, out);
}

HWY_INLINE Vec4<LaneF> blend_factor(BlendFactor factor, const Vec4<LaneF>& src, const Vec4<LaneF>& dst) {
  const LaneF zero(0.0f), one(1.0f);
  const auto all = [](LaneF x) HWY_ATTR { return Vec4<LaneF>{x, x, x, x}; };
  switch (factor) {
    case BlendFactor::zero:
      return all(zero);
    case BlendFactor::one:
      return all(one);
    case BlendFactor::src_alpha:
      return all(src.w);
    case BlendFactor::one_minus_src_alpha:
      return all(one - src.w);
    case BlendFactor::dst_alpha:
      return all(dst.w);
    case BlendFactor::one_minus_dst_alpha:
      return all(one - dst.w);
    case BlendFactor::src_color:
      return src;
    case BlendFactor::dst_color:
      return dst;
  }
  return all(one);
}

HWY_INLINE Vec4<LaneF> blend(const BlendState& state, const Vec4<LaneF>& src, const Vec4<LaneF>& dst) {
  const Vec4<LaneF> sf = blend_factor(state.src_color, src, dst),
                    df = blend_factor(state.dst_color, src, dst);
  const Vec4<LaneF> sa = blend_factor(state.src_alpha, src, dst),
                    da = blend_factor(state.dst_alpha, src, dst);
  return {src.x * sf.x + dst.x * df.x, src.y * sf.y + dst.y * df.y, src.z * sf.z + dst.z * df.z,
          src.w * sa.w + dst.w * da.w};
}

/// The color samples that raster samples [first, last) write: with fewer color than raster samples, color
/// sample j is written iff one of raster samples [j ratio, (j + 1) ratio) is set
/// (docs/techniques/conventions.md#coverage).
struct ColorSamples {
  int ratio, first, last;
  int begin, end;
  ColorSamples(int r, int f, int l) : ratio(r), first(f), last(l), begin(f / r), end((l + r - 1) / r) {}

  /// The union of mask_of(raster sample) over those of color sample j.
  template <class MaskOf>
  HWY_INLINE auto combine(int j, MaskOf&& mask_of) const {
    const int from = std::max(j * ratio, first), to = std::min((j + 1) * ratio, last);
    auto mask = mask_of(from);
    for (int i = from + 1; i < to; ++i) mask = static_cast<decltype(mask)>(mask | mask_of(i));
    return mask;
  }
};

/// Where a batch's quads go: the tile of each, the quad within it, and the samples to write (bit i: lane i).
struct WriteTargets {
  const std::int32_t* block;
  const std::int32_t* quad_in_block;
  int count;
};

HWY_INLINE std::uint32_t* quad_texels(GpuImage& image, int block, int quad_in_block, int sample, int word) {
  return image.sample_of_block(block, sample) + word * kBlockLanes + 4 * quad_in_block;
}

/// Writes four lanes' texels where `mask` says so.
HWY_INLINE void store_quad(const std::int32_t* from, std::uint32_t mask, std::uint32_t* to) {
  const D4I d;
  const auto texels = hn::LoadU(d, from);
  auto* target = reinterpret_cast<std::int32_t*>(to);
  if (mask == 15) {
    hn::StoreU(texels, d, target);
    return;
  }
  const std::uint8_t bits[8] = {static_cast<std::uint8_t>(mask)};
  hn::BlendedStore(texels, hn::LoadMaskBits(d, bits), d, target);
}

/// Writes a tile's texels of one sample where `mask` says so.
inline void store_tile(GpuImage& image, int block, int sample, std::uint64_t mask,
                       const EncodedBatch& texels) {
  auto* base = reinterpret_cast<std::int32_t*>(image.sample_of_block(block, sample));
  for (int w = 0; w < image.words; ++w) {
    std::int32_t* to = base + w * kBlockLanes;
    for (int first = 0; first < kBlockLanes; first += kVectorLanes)
      if ((mask >> first & kRegisterBits) != 0)
        hn::BlendedStore(load(texels.words[w] + first).v, hn::RebindMask(DI(), mask_from_bits(mask, first).v),
                         DI(), to + first);
  }
}

/// A write to a tile of a multisampled image, lane by lane.
struct TileWrite {
  std::uint64_t any = 0;    ///< lanes written at some sample
  std::uint64_t whole = 0;  ///< lanes written at all samples
  std::uint64_t count = 0;  ///< samples
  bool blends = false;      ///< the result depends on what the target holds
};

/// Follows which pixels of the tile hold one color or two, from the masks of each color sample. Returns the
/// lanes of which only sample 0 needs to be written.
inline std::uint64_t follow_colors(GpuImage& image, int block, const std::uint64_t* masks,
                                   const TileWrite& write, bool skip_single_colors) {
  const auto i = static_cast<std::size_t>(block);
  std::uint64_t &single = image.single_lanes[i], &twice = image.double_lanes[i],
                &stale = image.stale_lanes[i];
  const std::uint64_t partial = write.any & ~write.whole;
  if ((stale & partial) != 0) {
    spread_lanes(image, block, stale & partial);
    stale &= ~partial;
  }
  if (partial != 0) {
    std::uint64_t* second = image.tile_second_color(block);
    std::uint64_t covers_first = ~std::uint64_t{0}, covers_second = covers_first;
    for (int s = 0; s < image.samples; ++s) {
      covers_first &= second[s] | masks[s];
      covers_second &= ~second[s] | masks[s];
    }
    // A blended color is another one at each of the two.
    const std::uint64_t replaces = write.blends ? 0 : covers_first | covers_second;
    const std::uint64_t two = partial & (single | (twice & replaces));
    for (int s = 0; s < image.samples; ++s) second[s] = (second[s] & ~two) | (masks[s] & two);
    single &= ~partial;
    twice = (twice & ~partial) | two;
  }
  if (!write.blends) {
    single |= write.whole;
    twice &= ~write.whole;
  }
  if (!skip_single_colors) return 0;
  const std::uint64_t lazy = write.whole & single;
  stale |= lazy;
  return lazy;
}

/// The target's texels at sample s under the batch's quads.
inline void gather_target(GpuImage& image, const WriteTargets& to, int sample, EncodedBatch& out) {
  const D4I d;
  for (int q = 0; q < to.count; ++q) {
    for (int w = 0; w < image.words; ++w) {
      const auto* from = reinterpret_cast<const std::int32_t*>(
          quad_texels(image, to.block[q], to.quad_in_block[q], sample, w));
      hn::StoreU(hn::LoadU(d, from), d, out.words[w] + 4 * q);
    }
  }
}

/// Texels `out.words` hold the target's values: replaced by the blended ones.
inline void blend_lanes(const GpuImage& image, const BlendState& state, const float (&color)[4][kBatchLanes],
                        int lanes, EncodedBatch& out) {
  for (int first = 0; first < lanes; first += kVectorLanes) {
    LaneI words[4] = {LaneI(0), LaneI(0), LaneI(0), LaneI(0)};
    for (int w = 0; w < image.words; ++w) words[w] = load(out.words[w] + first);
    const Vec4<LaneF> dst = decode_texel<LaneF, LaneI>(image.format, words, srgb_decode_table().data());
    const Vec4<LaneF> src = batch_color(color, first);
    Vec4<LaneF> result = state.enabled ? blend(state, src, dst) : src;
    if ((state.write_mask & 1) == 0) result.x = dst.x;
    if ((state.write_mask & 2) == 0) result.y = dst.y;
    if ((state.write_mask & 4) == 0) result.z = dst.z;
    if ((state.write_mask & 8) == 0) result.w = dst.w;
    encode_lanes(image.format, result, image.words, first, out);
  }
}

/// The same for a tile in place.
inline void blend_tile(GpuImage& image, const BlendState& state, const float (&color)[4][kBatchLanes],
                       int block, int sample, EncodedBatch& out) {
  const auto* from = reinterpret_cast<const std::int32_t*>(image.sample_of_block(block, sample));
  for (int w = 0; w < image.words; ++w)
    std::memcpy(out.words[w], from + w * kBlockLanes, sizeof(out.words[w]));
  blend_lanes(image, state, color, kBatchLanes, out);
}

/// Blends (or masks channels of) a batch with the target's sample s and encodes the result.
inline void blend_batch(GpuImage& image, const BlendState& state, const float (&color)[4][kBatchLanes],
                        const WriteTargets& to, int sample, EncodedBatch& out) {
  gather_target(image, to, sample, out);
  blend_lanes(image, state, color, 4 * to.count, out);
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
