// Texels of a pass's image slots: shared by fragment and compute contexts. Coordinates are clamped.
// Per-target include guard, see simd/lanes-inl.h.
#include "pipeline/batch/fragment_batch.h"
#include "pipeline/image/image.h"
#include "pipeline/shade/texel_quad-inl.h"
#include "pipeline/simd/codec-inl.h"
#include "pipeline/simd/lanes-inl.h"
#include "pipeline/texture/texture_sampler-inl.h"

#if defined(HWSIM_SHADE_IMAGE_ACCESS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_IMAGE_ACCESS_INL_H_
#undef HWSIM_SHADE_IMAGE_ACCESS_INL_H_
#else
#define HWSIM_SHADE_IMAGE_ACCESS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// The tile of a pixel, and its lane there.
struct TilePlace {
  LaneI block, lane;
};
HWY_INLINE TilePlace place_in_tile(const GpuImage& image, LaneI x, LaneI y) {
  const LaneI cx = min(max(x, LaneI(0)), LaneI(image.width - 1)),
              cy = min(max(y, LaneI(0)), LaneI(image.height - 1));
  const LaneI block = shift_right<3>(cy) * LaneI(image.blocks_x) + shift_right<3>(cx);
  const LaneI lane = (cx & LaneI(1)) | shift_left<1>(cy & LaneI(1)) | shift_left<1>(cx & LaneI(2)) |
                     shift_left<2>(cy & LaneI(2)) | shift_left<2>(cx & LaneI(4)) |
                     shift_left<3>(cy & LaneI(4));
  return {block, lane};
}

/// The sample (of all layers) within the image, as coordinates are clamped.
HWY_INLINE LaneI place_in_samples(const GpuImage& image, LaneI sample) {
  return min(max(sample, LaneI(0)), LaneI(image.samples * image.layers - 1));
}

/// Where the words of texels lie: in GpuImage::texels, those of `in_packed` in GpuImage::packed.
struct TexelWords {
  LaneI first, packed;
  LaneM in_packed;
  bool any_packed;

  HWY_INLINE LaneI load(const GpuImage& image, int word) const {
    const LaneI from_texels =
        gather(reinterpret_cast<const std::int32_t*>(image.texels.data()), first + LaneI(word * kBlockLanes));
    if (!any_packed) return from_texels;
    const LaneI from_packed =
        gather(reinterpret_cast<const std::int32_t*>(image.packed.words.data()), packed + LaneI(word * 4));
    return select(in_packed, from_packed, from_texels);
  }
};

/// The place of a texel in its image.
HWY_INLINE TexelWords texel_words(const GpuImage& image, LaneI x, LaneI y, LaneI any_sample) {
  const LaneI sample = place_in_samples(image, any_sample);
  const auto [block, lane] = place_in_tile(image, x, y);
  const LaneM none = LaneI(0) > LaneI(0);
  const LaneI words(image.words * kBlockLanes);
  if (!image.first_samples_apart) {
    const LaneI tile(static_cast<std::int32_t>(image.further_stride) * image.layers);
    return {block * tile + sample * words + lane, LaneI(0), none, false};
  }
  const LaneI first = block * words + lane;
  const LaneM is_first = sample == LaneI(0);
  if (image.packed.quad_start.empty()) {
    const LaneI further = LaneI(static_cast<std::int32_t>(image.further_begin)) +
                          block * LaneI(static_cast<std::int32_t>(image.further_stride)) +
                          (sample - LaneI(1)) * words + lane;
    return {select(is_first, first, further), LaneI(0), none, false};
  }
  const LaneI start = gather(image.packed.quad_start.data(), shift_left<4>(block) + shift_right<2>(lane));
  const LaneM in_packed = (sample > LaneI(0)) & (start > LaneI(PackedSamples::kOneColor));
  const LaneI place = start + (sample - LaneI(1)) * LaneI(4 * image.words) + (lane & LaneI(3));
  return {first, select(in_packed, place, LaneI(0)), in_packed, mask_bits(in_packed) != 0};
}

HWY_INLINE Vec4<LaneF> load_texel(const GpuImage& image, Format format, LaneI x, LaneI y, LaneI sample) {
  const TexelWords at = texel_words(image, x, y, sample);
  LaneI words[4] = {LaneI(0), LaneI(0), LaneI(0), LaneI(0)};
  for (int word = 0; word < image.words; ++word) words[word] = at.load(image, word);
  return decode_texel<LaneF, LaneI>(format, words, srgb_decode_table().data());
}

/// Notes the lines of texels of the pass's image slot, as load_texel reads them: a line is a rectangle of a
/// tile's pixels at one sample.
HWY_INLINE void track_texels(const ResourceView& resources, int slot, LaneI x, LaneI y, LaneI sample,
                             std::uint32_t lanes, int first_lane) {
  if (resources.tracker == nullptr || lanes == 0) return;
  const GpuImage& image = *resources.images[static_cast<std::size_t>(slot)];
  const auto [block, lane] = place_in_tile(image, x, y);
  const std::int32_t bytes = info(image.format).bytes;  // 64 texels of it are as many lines
  const LaneI line =
      LaneI(static_cast<std::int32_t>(resources.image_first_line[static_cast<std::size_t>(slot)])) +
      (block * LaneI(image.samples * image.layers) + place_in_samples(image, sample)) * LaneI(bytes) +
      shift_right<6>(lane * LaneI(bytes));
  track_lines(*resources.tracker, line, lanes, first_lane, static_cast<std::uint32_t>(bytes));
}

/// Channel `channel` of an integer format.
HWY_INLINE LaneI load_texel_int(const GpuImage& image, int channel, LaneI x, LaneI y, LaneI sample) {
  return texel_words(image, x, y, sample).load(image, channel);
}

struct TexelPlace {
  int x, y;    ///< pixel
  int sample;  ///< layer * samples + sample, for an image with layers
};

/// Notes a texel stored to the pass's target: those images are numbered behind the buffers; a sample's tile
/// is as many lines as a texel has bytes.
inline void note_store(const ResourceView& resources, int target, int lane, const TexelPlace& at) {
  const GpuImage& image = *resources.targets[static_cast<std::size_t>(target)];
  const auto bytes = static_cast<std::uint32_t>(info(image.format).bytes);
  const auto texel = static_cast<std::uint32_t>(lane_of(at.x & 7, at.y & 7));
  const auto tile = static_cast<std::uint32_t>(image.block_index(at.x, at.y) * image.samples + at.sample);
  resources.tracker->use_if_sampled(
      lane / 4, ReuseStream::storage,
      buffer_line(kMaxBufferSlots + target, 0) + tile * bytes + texel * bytes / kLineBytes, 0, bytes);
}

/// The image slot and the channel of a gather, and who asks: lanes of a register that begins at `first_lane`.
struct GatherSource {
  int slot, channel;
  std::uint32_t lanes;
  int first_lane;
};

/// One channel of 2x2 texels; each is noted.
HWY_INLINE TexelQuad<LaneF> load_texel_quad(const ResourceView& resources, const GatherSource& from, LaneI x,
                                            LaneI y) {
  const auto at = static_cast<std::size_t>(from.slot);
  const auto texel = [&](LaneI texel_x, LaneI texel_y) HWY_ATTR {
    track_texels(resources, from.slot, texel_x, texel_y, LaneI(0), from.lanes, from.first_lane);
    const Vec4<LaneF> c =
        load_texel(*resources.images[at], resources.formats[at], texel_x, texel_y, LaneI(0));
    return from.channel == 0 ? c.x : from.channel == 1 ? c.y : from.channel == 2 ? c.z : c.w;
  };
  const LaneI right = x + LaneI(1), below = y + LaneI(1);
  const LaneF t00 = texel(x, y), t10 = texel(right, y), t01 = texel(x, below), t11 = texel(right, below);
  return {t00, t10, t01, t11};
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
