// What a fragment shader sees, on the host's vector registers. A shader is a struct with
//   template <class S> static void run(S& s, const Uniforms& uniforms)
// written once against this class and CountFragment (shade/count_fragment-inl.h). Per-target include guard.
#include "pipeline/batch/fragment_batch.h"
#include "pipeline/shade/buffer_access-inl.h"
#include "pipeline/shade/image_access-inl.h"
#include "pipeline/shade/lane_flow-inl.h"
#include "pipeline/simd/lanes-inl.h"

#if defined(HWSIM_SHADE_FRAGMENT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_FRAGMENT_LANES_INL_H_
#undef HWSIM_SHADE_FRAGMENT_LANES_INL_H_
#else
#define HWSIM_SHADE_FRAGMENT_LANES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

class FragmentLanes : public LaneFlow {
 public:
  FragmentLanes(FragmentBatch& batch, int first_lane)
      : LaneFlow(batch.blocks, first_lane, mask_from_bits(batch.valid_lanes, first_lane)),
        batch_(batch),
        active_(mask_from_bits(batch.active_lanes, first_lane)) {
    const int quads = batch.quad_count;
    const int first_quad = first_lane / 4;
    for (int q = 1; q < kVectorLanes / 4; ++q) {
      const int quad = first_quad + q;
      if (quad < quads && batch.triangle[static_cast<std::size_t>(quad)] !=
                              batch.triangle[static_cast<std::size_t>(first_quad)])
        one_triangle_ = false;
    }
  }

  M active() const { return active_; }  ///< fragments
  const MaterialView& material() const { return *batch_.material; }
  I pixel_x() const { return load(batch_.pixel_x.data() + first_); }
  I pixel_y() const { return load(batch_.pixel_y.data() + first_); }
  int sample_index() const { return batch_.sample_index; }
  int layer() const { return batch_.layer; }  ///< the layer that a multicast pass draws
  I coverage() const { return load(reinterpret_cast<const std::int32_t*>(batch_.coverage.data()) + first_); }
  int first_lane() const { return first_; }
  FragmentBatch& batch() { return batch_; }

  /// Attribute scalar k at the shading point.
  F attr(int k) const { return interpolate(k, batch_.b1.data(), batch_.b2.data()); }
  Vec3<F> attr3(int k) const { return {attr(k), attr(k + 1), attr(k + 2)}; }
  /// +1 on front faces, -1 on back faces.
  F facing() const {
    HWY_ALIGN float sign[kVectorLanes];
    for (int lane = 0; lane < kVectorLanes; ++lane)
      sign[lane] = batch_.front_facing[static_cast<std::size_t>((first_ + lane) / 4)] ? 1.0f : -1.0f;
    return load(sign);
  }

  /// Number of the primitive in the pass, over all of its draws, in submission order.
  I primitive_id() const {
    HWY_ALIGN std::int32_t id[kVectorLanes];
    for (int lane = 0; lane < kVectorLanes; ++lane)
      id[lane] = static_cast<std::int32_t>(batch_.primitive[static_cast<std::size_t>((first_ + lane) / 4)]);
    return load(id);
  }

  /// Filtered texture at attribute scalars (k, k + 1); level of detail from the derivatives at pixel centers.
  Vec4<F> sample_texture(const TextureView* texture, int k) { return sample_texture_of<Vec4<F>>(texture, k); }
  F sample_texture_alpha(const TextureView* texture, int k) { return sample_texture_of<F>(texture, k); }

  /// Filtered texture at coordinates of the shader's own, with their derivatives.
  Vec4<F> sample_texture_at(const TextureView* texture, const TextureSite<F>& at) {
    const TextureSampler<F, I, M> sampler(*texture, batch_.resources->tracker, live_, first_);
    return sampler.sample(at.u, at.v, at.du_dx, at.dv_dx, at.du_dy, at.dv_dy, batch_.tex_bilinear_probes);
  }
  /// Attribute scalar k of the triangle's first vertex.
  F flat_attr(int k) const {
    HWY_ALIGN float values[kVectorLanes];
    for (int lane = 0; lane < kVectorLanes; ++lane) {
      const auto quad = static_cast<std::size_t>(std::min((first_ + lane) / 4, batch_.quad_count - 1));
      values[lane] = batch_.varyings[0][quad][k];
    }
    return load(values);
  }

  /// Texel (x, y) of the pass's image slot, unfiltered; coordinates are clamped to the image.
  Vec4<F> load_image(int slot, I x, I y, I sample) {
    batch_.image_texels.add(live_count(), image_bytes(slot));
    return read_texel(slot, x, y, sample);
  }
  /// Bilinear, clamped to the edge; coordinates in texels, centers at one half.
  Vec4<F> sample_image(int slot, F x, F y) {
    batch_.image_probes += live_count();
    const F left = floor(x - F(0.5f)), top = floor(y - F(0.5f));
    const F fx = x - F(0.5f) - left, fy = y - F(0.5f) - top;
    const I x0 = to_int(left), y0 = to_int(top), x1 = x0 + I(1), y1 = y0 + I(1);
    const Vec4<F> c00 = read_texel(slot, x0, y0, I(0)), c10 = read_texel(slot, x1, y0, I(0));
    const Vec4<F> c01 = read_texel(slot, x0, y1, I(0)), c11 = read_texel(slot, x1, y1, I(0));
    const Vec4<F> upper = c00 + (c10 - c00) * fx, lower = c01 + (c11 - c01) * fx;
    return upper + (lower - upper) * fy;
  }
  /// One channel of the 2x2 texels from (x + dx, y + dy) on. An instruction has room for dx and dy.
  TexelQuad<F> gather_image(int slot, int channel, I x, I y, int dx = 0, int dy = 0) {
    return read_quad(slot, channel, x + I(dx), y + I(dy));
  }
  /// A depth compared with the image's first channel (compare_bilinear).
  F compare_image(int slot, F x, F y, F reference) {
    return compare_bilinear<F, I>(x, y, reference,
                                  [&](I left, I top) HWY_ATTR { return read_quad(slot, 0, left, top); });
  }
  /// As load_image, all channels of an integer format by one load.
  template <int kChannels>
  void load_image_int(int slot, I x, I y, I sample, I (&channels)[kChannels]) {
    const GpuImage& image = *batch_.resources->images[static_cast<std::size_t>(slot)];
    const auto lanes = static_cast<std::uint64_t>(__builtin_popcount(mask_bits(live_)));
    batch_.image_texels.add(lanes, info(image.format).bytes);
    batch_.image_read_bytes += lanes * info(image.format).bytes;
    track_texels(*batch_.resources, slot, x, y, sample, mask_bits(live_), first_);
    for (int c = 0; c < kChannels; ++c) channels[c] = load_texel_int(image, c, x, y, sample);
  }
  /// Word `index` of the pass's storage buffer, lanes of `mask` in the current branch only (others 0): what a
  /// register has beside them touches nothing, so that counts do not depend on its width.
  I load_buffer(int slot, I index, M mask) {
    batch_.storage_read_bytes += word_bytes(mask & live_);
    return BufferAccess(*batch_.resources, slot, first_).load_words(index, mask & live_);
  }
  void store_buffer(int slot, I index, I value, M mask) {
    batch_.storage_write_bytes += word_bytes(mask & active_ & live_);
    BufferAccess(*batch_.resources, slot, first_).store_words(index, value, mask & active_ & live_);
  }
  /// Atomic integer add; the words before it.
  I atomic_add(int slot, I index, I value, M mask) {
    batch_.storage_read_bytes += word_bytes(mask & active_ & live_);
    batch_.storage_write_bytes += word_bytes(mask & active_ & live_);
    return BufferAccess(*batch_.resources, slot, first_).add_words(index, value, mask & active_ & live_);
  }
  /// Atomic exchange; the words before it. A pass whose programs use it runs its bins one after another.
  I atomic_exchange(int slot, I index, I value, M mask) {
    batch_.storage_read_bytes += word_bytes(mask & active_ & live_);
    batch_.storage_write_bytes += word_bytes(mask & active_ & live_);
    return BufferAccess(*batch_.resources, slot, first_).exchange_words(index, value, mask & active_ & live_);
  }
  /// Adds the lanes of `mask` to a counter: no operation of the program.
  void count(TechniqueCounter counter, M mask) {
    batch_.counters->technique[counter] +=
        static_cast<std::uint64_t>(__builtin_popcount(mask_bits(mask & active_ & live_)));
  }
  /// Lanes of `mask` whose word of a buffer is not 0, for counters alone.
  M buffer_nonzero(int slot, I index, M mask) const {
    return BufferAccess(*batch_.resources, slot, first_).holds_nonzero(index, mask & active_ & live_);
  }

  /// To the pass's target, which holds it when the pass has ended; coordinates are inside the image.
  void store_image(int target, I x, I y, I sample, const Vec4<F>& color, M mask) {
    const auto at = static_cast<std::size_t>(target);
    const GpuImage& image = *batch_.resources->targets[at];
    I encoded[4] = {I(0), I(0), I(0), I(0)};
    encode_texel<F, I>(batch_.resources->target_formats[at], color, encoded);
    HWY_ALIGN std::int32_t word[kVectorLanes], px[kVectorLanes], py[kVectorLanes], ps[kVectorLanes];
    store(encoded[0], word);
    store(x, px);
    store(y, py);
    store(sample, ps);
    const std::uint32_t bits = mask_bits(mask & live_ & active_);
    for (std::uint32_t rest = bits; rest != 0; rest &= rest - 1) {
      const int lane = __builtin_ctz(rest);
      note_store(*batch_.resources, target, first_ + lane, {px[lane], py[lane], ps[lane]});
      batch_.stores->push_back({batch_.store_order + static_cast<std::uint64_t>(first_ + lane),
                                static_cast<std::uint32_t>(target),
                                static_cast<std::uint32_t>(image.word_index(px[lane], py[lane], ps[lane], 0)),
                                static_cast<std::uint32_t>(word[lane])});
    }
    const auto texels = static_cast<std::uint64_t>(__builtin_popcount(bits));
    const auto bytes = static_cast<std::uint64_t>(info(image.format).bytes);
    batch_.storage_write_bytes += texels * bytes;
    if (bytes < kWordBytes) batch_.narrow_stores += texels;
  }
  void output_depth(F depth) { store(depth, batch_.depth + first_); }

  int target_width(int target) const {
    return batch_.resources->targets[static_cast<std::size_t>(target)]->width;
  }
  int target_height(int target) const {
    return batch_.resources->targets[static_cast<std::size_t>(target)]->height;
  }
  int image_width(int slot) const { return batch_.resources->images[static_cast<std::size_t>(slot)]->width; }
  int image_height(int slot) const {
    return batch_.resources->images[static_cast<std::size_t>(slot)]->height;
  }

  void discard(M mask) {
    batch_.discarded_lanes |= static_cast<std::uint64_t>(mask_bits(mask & active_ & live_)) << first_;
  }
  /// Samples to keep, or to write (CoverageState).
  void output_mask(I mask) {
    store(mask, reinterpret_cast<std::int32_t*>(batch_.output_mask.data()) + first_);
  }
  void output(int target, const Vec4<F>& color) {
    store(color.x, batch_.color[target][0] + first_);
    store(color.y, batch_.color[target][1] + first_);
    store(color.z, batch_.color[target][2] + first_);
    store(color.w, batch_.color[target][3] + first_);
  }

 private:
  template <class Value>
  Value sample_texture_of(const TextureView* texture, int k) {
    const TextureSampler<F, I, M, Value> sampler(*texture, batch_.resources->tracker, live_, first_);
    const F uc = interpolate(k, batch_.b1_center.data(), batch_.b2_center.data());
    const F vc = interpolate(k + 1, batch_.b1_center.data(), batch_.b2_center.data());
    const F part(batch_.texture_footprint);
    return sampler.sample(attr(k), attr(k + 1), ddx(uc) * part, ddx(vc) * part, ddy(uc) * part,
                          ddy(vc) * part, batch_.tex_bilinear_probes);
  }

  std::uint64_t live_count() const {
    return static_cast<std::uint64_t>(__builtin_popcount(mask_bits(live_)));
  }

  int image_bytes(int slot) const {
    return info(batch_.resources->images[static_cast<std::size_t>(slot)]->format).bytes;
  }

  Vec4<F> read_texel(int slot, I x, I y, I sample) {
    const auto at = static_cast<std::size_t>(slot);
    const GpuImage& image = *batch_.resources->images[at];
    batch_.image_read_bytes += live_count() * static_cast<std::uint64_t>(image_bytes(slot));
    track_texels(*batch_.resources, slot, x, y, sample, mask_bits(live_), first_);
    return load_texel(image, batch_.resources->formats[at], x, y, sample);
  }

  TexelQuad<F> read_quad(int slot, int channel, I x, I y) {
    batch_.image_read_bytes += 4 * live_count() * static_cast<std::uint64_t>(image_bytes(slot));
    return load_texel_quad(*batch_.resources, {slot, channel, mask_bits(live_), first_}, x, y);
  }

  F interpolate(int k, const float* b1, const float* b2) const {
    const auto first_quad = static_cast<std::size_t>(first_ / 4);
    if (one_triangle_) {
      const float v0 = batch_.varyings[0][first_quad][k];
      const F d1(batch_.varyings[1][first_quad][k] - v0), d2(batch_.varyings[2][first_quad][k] - v0);
      return (F(v0) + load(b1 + first_) * d1) + load(b2 + first_) * d2;
    }
    return interpolate_quads(k, b1, b2);
  }

  // The same operations in the same order, a quad at a time.
  F interpolate_quads(int k, const float* b1, const float* b2) const {
    const hn::FixedTag<float, 4> d4;
    HWY_ALIGN float values[kVectorLanes];
    for (int q = 0; q < kVectorLanes / 4; ++q) {
      const int quad = std::min(first_ / 4 + q, batch_.quad_count - 1);
      const auto index = static_cast<std::size_t>(quad);
      const float v0 = batch_.varyings[0][index][k];
      const auto d1 = hn::Set(d4, batch_.varyings[1][index][k] - v0);
      const auto d2 = hn::Set(d4, batch_.varyings[2][index][k] - v0);
      const int lane = first_ + 4 * q;
      const auto sum = hn::Add(hn::Set(d4, v0), hn::Mul(hn::LoadU(d4, b1 + lane), d1));
      hn::Store(hn::Add(sum, hn::Mul(hn::LoadU(d4, b2 + lane), d2)), d4, values + 4 * q);
    }
    return load(values);
  }

  FragmentBatch& batch_;
  M active_;
  bool one_triangle_ = true;
};

/// The function of a FragmentProgram: the batch, a vector register at a time.
template <class Shader>
void run_fragment_shader(FragmentBatch& batch, const void* uniforms) {
  const auto& typed = *static_cast<const typename Shader::Uniforms*>(uniforms);
  for (int first = 0; first < kBatchLanes; first += kVectorLanes) {
    if ((batch.valid_lanes >> first & kRegisterBits) == 0) continue;
    FragmentLanes s(batch, first);
    Shader::run(s, typed);
  }
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
