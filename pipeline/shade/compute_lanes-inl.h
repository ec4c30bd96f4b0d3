// What a compute shader sees: a wave of up to 64 invocations of a group, a vector register at a time.
// Per-target include guard, see simd/lanes-inl.h.
#include "pipeline/batch/accounting.h"
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
    return load_texel(image, group_.resources->formats[static_cast<std::size_t>(slot)], x, y, sample);
  }

  /// As FragmentLanes'.
  TexelQuad<F> gather_image(int slot, int channel, I x, I y, int dx = 0, int dy = 0) {
    return read_quad(slot, channel, x + I(dx), y + I(dy));
  }
  F compare_image(int slot, F x, F y, F reference) {
    return compare_bilinear<F, I>(x, y, reference,
                                  [&](I left, I top) HWY_ATTR { return read_quad(slot, 0, left, top); });
  }

  /// As FragmentLanes'.
  template <int kChannels>
  void load_image_int(int slot, I x, I y, I sample, I (&channels)[kChannels]) {
    const GpuImage& image = *group_.resources->images[static_cast<std::size_t>(slot)];
    const auto lanes = static_cast<std::uint64_t>(__builtin_popcount(mask_bits(live_)));
    TexelCounts texels;
    texels.add(lanes, info(image.format).bytes);
    charge_texels(texels, *group_.counters);
    group_.counters->mem.texture_read_bytes += lanes * info(image.format).bytes;
    track_texels(*group_.resources, slot, x, y, sample, mask_bits(live_), first_);
    for (int c = 0; c < kChannels; ++c) channels[c] = load_texel_int(image, c, x, y, sample);
  }
  void count(TechniqueCounter counter, M mask) {
    group_.counters->technique[counter] +=
        static_cast<std::uint64_t>(__builtin_popcount(mask_bits(mask & live_)));
  }

  /// Number of the invocation within its wave.
  I lane_index() const {
    HWY_ALIGN std::int32_t index[kVectorLanes];
    for (int lane = 0; lane < kVectorLanes; ++lane) index[lane] = first_ + lane;
    return load(index);
  }
  /// Byte `address` of the group's memory, lanes of `mask` only (others 0).
  I load_group_byte(I address, M mask) const {
    const std::uint8_t* bytes = group_bytes();
    HWY_ALIGN std::int32_t at[kVectorLanes], out[kVectorLanes] = {};
    store(address, at);
    for (std::uint32_t bits = mask_bits(mask & live_); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      out[lane] = bytes[at[lane]];
    }
    return load(out);
  }
  void store_group_byte(I address, I value, M mask) {
    for_each_group_byte(address, value, mask, [](std::uint8_t& byte, std::int32_t v) HWY_ATTR {
      byte = static_cast<std::uint8_t>(v);
    });
  }
  /// An addition by the group memory itself, without a result.
  void add_group_byte(I address, I value, M mask) {
    for_each_group_byte(address, value, mask, [](std::uint8_t& byte, std::int32_t v) HWY_ATTR {
      byte = static_cast<std::uint8_t>(byte + v);
    });
  }

  /// Word `index` of the pass's storage buffer, lanes of `mask` in the current branch only (others 0): what a
  /// register has beside them touches nothing, so that counts do not depend on its width.
  I load_buffer(int slot, I index, M mask) {
    group_.counters->mem.storage_read_bytes += word_bytes(mask & live_);
    return BufferAccess(*group_.resources, slot, first_).load_words(index, mask & live_);
  }
  void store_buffer(int slot, I index, I value, M mask) {
    group_.counters->mem.storage_write_bytes += word_bytes(mask & live_);
    BufferAccess(*group_.resources, slot, first_).store_words(index, value, mask & live_);
  }
  /// Atomic integer add; the words before it.
  I atomic_add(int slot, I index, I value, M mask) {
    group_.counters->mem.storage_read_bytes += word_bytes(mask & live_);
    group_.counters->mem.storage_write_bytes += word_bytes(mask & live_);
    return BufferAccess(*group_.resources, slot, first_).add_words(index, value, mask & live_);
  }

  /// Atomic addition of floats, whose order shows: it takes effect when the wave ends, lane by lane, in the
  /// order of the calls. A pass whose program uses it runs its groups one after another.
  void atomic_add_float(int slot, I index, F value, M mask) {
    group_.counters->mem.storage_read_bytes += word_bytes(mask & live_);
    group_.counters->mem.storage_write_bytes += word_bytes(mask & live_);
    HWY_ALIGN std::int32_t at[kVectorLanes];
    HWY_ALIGN float by[kVectorLanes];
    store(index, at);
    store(value, by);
    for (std::uint32_t bits = mask_bits(mask & live_); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      group_.float_adds.push_back({first_ + lane, slot, at[lane], by[lane]});
    }
  }

  /// A layer's tile of the wave's pixels, 8x8, as compressed (Pass::depth_planes). Charged once a wave: the
  /// planes, and the number of its plane for each sample, in pieces of 32 bytes (docs/compression.md#depth).
  /// Planes are numbered through the layers, kMaxDepthPlanes each.
  int tile_plane_count(int layer = 0) {
    const DepthPlaneView& view = *group_.resources->depth_planes;
    const int count = view.plane_count[static_cast<std::size_t>(tile(layer))];
    if (first_ != 0) return count;
    const int bits = count <= 1 ? 0 : count == 2 ? 1 : 2;
    const int bytes = 12 * (1 << bits) + 8 * view.image->samples * bits;
    const auto pieces = static_cast<std::uint64_t>((bytes + 31) / 32);
    TexelCounts texels;
    for (std::uint64_t i = 0; i < 2 * pieces; ++i) texels.add(1, 16);
    charge_texels(texels, *group_.counters);
    group_.counters->mem.texture_read_bytes += 32 * pieces;
    track_tile(layer, pieces);
    return count;
  }
  /// Depth of a plane at (x, y), pixels from the image's corner.
  F tile_plane_depth(int plane, F x, F y) const {
    const DepthPlane& p = tile_plane(plane);
    const F z = (F(p.z.base) + F(p.z.ddy) * (y - F(p.reference_y))) + F(p.z.ddx) * (x - F(p.reference_x));
    return min(max(z, F(0.0f)), F(1.0f));
  }
  /// The plane of a clear depth of 1.
  bool tile_plane_is_far(int plane) const {
    const DepthPlane& p = tile_plane(plane);
    return p.z.base >= 1.0f && p.z.ddx == 0.0f && p.z.ddy == 0.0f;
  }
  /// Whether `b` is `a` moved by so many pixels: one triangle's in two viewports, whose planes are set up
  /// once (raster/triangle.h).
  bool is_moved_tile_plane(int a, int b, glm::vec2 by_px) const {
    DepthPlane moved = tile_plane(a);
    moved.reference_x += by_px.x;
    moved.reference_y += by_px.y;
    return moved.same_plane(tile_plane(b));
  }
  /// Pixels whose sample, of the plane's layer, lies on the plane.
  M in_tile_plane(int plane, int sample) const {
    GpuImage& image = const_cast<GpuImage&>(*group_.resources->depth_planes->image);
    const std::uint64_t* lanes = image.tile_plane_lanes(tile(plane / kMaxDepthPlanes));
    return mask_from_bits(lanes[plane % kMaxDepthPlanes * image.samples + sample], first_);
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
      note_store(*group_.resources, target, first_ + lane, {px[lane], py[lane], ps[lane]});
    }
    const auto texels = static_cast<std::uint64_t>(__builtin_popcount(bits));
    const auto bytes = static_cast<std::uint64_t>(info(image.format).bytes);
    group_.counters->mem.storage_write_bytes += texels * bytes;
    if (bytes < kWordBytes) group_.counters->shader.narrow_store_lane_ops += texels;
  }

 private:
  TexelQuad<F> read_quad(int slot, int channel, I x, I y) {
    const GpuImage& image = *group_.resources->images[static_cast<std::size_t>(slot)];
    const auto lanes = static_cast<std::uint64_t>(__builtin_popcount(mask_bits(live_)));
    group_.counters->mem.texture_read_bytes += 4 * lanes * info(image.format).bytes;
    return load_texel_quad(*group_.resources, {slot, channel, mask_bits(live_), first_}, x, y);
  }
  int tile(int layer) const {
    HWY_ALIGN std::int32_t x[kVectorLanes], y[kVectorLanes];
    store(x_, x);
    store(y_, y);
    return group_.resources->depth_planes->image->block_index(x[0], y[0], layer);
  }
  const DepthPlane& tile_plane(int plane) const {
    const GpuImage& image = *group_.resources->depth_planes->image;
    const int in_tile = plane % kMaxDepthPlanes, layer = plane / kMaxDepthPlanes;
    return image.planes[static_cast<std::size_t>(tile(layer) * kMaxDepthPlanes + in_tile)];
  }
  /// Where the tile's samples would lie: compression moves fewer bytes and leaves them at their address.
  void track_tile(int layer, std::uint64_t pieces) {
    for (std::size_t slot = 0; slot < group_.resources->images.size(); ++slot) {
      if (group_.resources->images[slot] != group_.resources->depth_planes->image) continue;
      const GpuImage& image = *group_.resources->images[slot];
      const auto first = group_.resources->image_first_line[slot] +
                         static_cast<std::uint32_t>(tile(layer) * image.samples * info(image.format).bytes);
      for (std::uint32_t i = 0; 2 * i < pieces; ++i)
        group_.resources->tracker->use_if_sampled(0, ReuseStream::texture, first + i, 64, 0);
    }
  }
  std::uint8_t* group_bytes() const { return reinterpret_cast<std::uint8_t*>(group_.group_memory); }
  template <class Body>
  HWY_INLINE void for_each_group_byte(I address, I value, M mask, Body&& body) {
    HWY_ALIGN std::int32_t at[kVectorLanes], from[kVectorLanes];
    store(address, at);
    store(value, from);
    for (std::uint32_t bits = mask_bits(mask & live_); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      body(group_bytes()[at[lane]], from[lane]);
    }
  }

  GroupBatch& group_;
  I x_, y_, sample_;
};

/// The additions of a wave, lane by lane: no register's width shows.
inline void add_floats(GroupBatch& group) {
  std::stable_sort(group.float_adds.begin(), group.float_adds.end(),
                   [](const FloatAdd& a, const FloatAdd& b) { return a.lane < b.lane; });
  for (const FloatAdd& add : group.float_adds)
    BufferAccess(*group.resources, add.slot, add.lane).add_float(add.index, add.value);
  group.float_adds.clear();
}

/// Charges the blocks that a wave of `lanes` invocations went through, and starts the next wave.
inline void end_wave(GroupBatch& group, int lanes) {
  const std::uint64_t valid = lanes == kBatchLanes ? ~std::uint64_t{0} : (std::uint64_t{1} << lanes) - 1;
  account_blocks(group.blocks, group.program->ops, group.program->block_count, valid, *group.counters);
  group.blocks.used = 0;
  if (!group.float_adds.empty()) add_floats(group);
  group.resources->tracker->end_batch();
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
