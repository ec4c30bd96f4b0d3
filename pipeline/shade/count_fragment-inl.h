// The counting context: a fragment shader run once on it yields the operations of each of its blocks.
// Every branch is taken and every loop body runs once; how often lanes go through is counted during
// emulation. Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include <algorithm>
#include <string>
#include "pipeline/batch/fragment_batch.h"
#include "pipeline/shade/count_lane.h"
#include "pipeline/shade/texel_quad-inl.h"
#include "pipeline/simd/vec-inl.h"
#include "pipeline/texture/texture_sampler-inl.h"
#if defined(HWSIM_SHADE_COUNT_FRAGMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_COUNT_FRAGMENT_INL_H_
#undef HWSIM_SHADE_COUNT_FRAGMENT_INL_H_
#else
#define HWSIM_SHADE_COUNT_FRAGMENT_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

class CountFragment {
 public:
  using F = CountF;
  using I = CountI;
  using M = CountM;

  CountFragment() = default;
  CountFragment(const CountFragment&) = delete;
  CountFragment& operator=(const CountFragment&) = delete;

  M valid() const { return {}; }
  M active() const { return {}; }
  const MaterialView& material() const { return material_; }
  I pixel_x() { return integer(); }
  I pixel_y() { return integer(); }
  int sample_index() const { return -1; }
  int layer() const { return 0; }
  I coverage() {
    reads_coverage_ = true;
    return integer();
  }
  I primitive_id() {  // the draw's base is added: an API's numbers restart with each draw
    return I(made(OpKind::alu, made(OpKind::value)));
  }
  F facing() { return F(made(OpKind::value)); }
  F attr(int) { return F(made(OpKind::interp)); }
  Vec3<F> attr3(int k) { return {attr(k), attr(k + 1), attr(k + 2)}; }
  Vec4<F> sample_texture(const TextureView*, int k) {
    const F u = attr(k), v = attr(k + 1);
    return four(made(OpKind::texture, u, v));
  }
  F sample_texture_alpha(const TextureView* texture, int k) { return sample_texture(texture, k).w; }
  Vec4<F> sample_texture_at(const TextureView*, const TextureSite<F>& at) {
    made(OpKind::output, at.du_dx, at.dv_dx);
    return four(made(OpKind::texture, at.u, at.v, at.du_dy));
  }
  F flat_attr(int k) { return attr(k); }
  Vec4<F> load_image(int, I x, I y, I sample) { return four(made(OpKind::fetch, x, y, sample)); }
  template <int kChannels>
  void load_image_int(int, I x, I y, I sample, I (&channels)[kChannels]) {
    const CountValue request = made(OpKind::fetch, x, y, sample);
    for (I& c : channels) c = I(made(OpKind::value, request));
  }
  void count(TechniqueCounter, M) {}
  M buffer_nonzero(int, I, M) const { return {}; }
  I lane_index() { return integer(); }
  I load_group_byte(I address, M mask) { return I(made(OpKind::group_memory, address, mask)); }
  void store_group_byte(I address, I value, M mask) { made(OpKind::group_memory, address, value, mask); }
  void add_group_byte(I address, I value, M mask) { made(OpKind::group_memory, address, value, mask); }
  Vec4<F> sample_image(int, F x, F y) { return four(made(OpKind::texture, x, y)); }
  TexelQuad<F> gather_image(int, int, I x, I y, int = 0, int = 0) {
    const Vec4<F> texels = four(made(OpKind::gather, x, y));
    return {texels.x, texels.y, texels.z, texels.w};
  }
  F compare_image(int, F x, F y, F reference) { return F(made(OpKind::comparison, x, y, reference)); }
  int target_width(int) const { return 1; }
  int target_height(int) const { return 1; }
  int image_width(int) const { return 1; }
  int image_height(int) const { return 1; }

  template <class Body>
  void branch(int block, M mask, Body&& body) {
    made(OpKind::output, mask);
    enter(block, body);
  }
  template <class Body>
  void uniform_branch(int block, bool, Body&& body) {
    enter(block, body);
  }
  template <class Body>
  void loop(int block, int, M mask, Body&& body) {
    made(OpKind::output, mask);
    enter(block, [&]() HWY_ATTR {
      recorder_.ops().alu += 2;  // the counter and its comparison
      body(0);
    });
  }
  I load_buffer(int, I index, M mask) { return I(made(OpKind::load, index, mask)); }
  void store_buffer(int, I index, I value, M mask) {
    made(OpKind::store, index, value, mask);
    writes_storage_ = true;
  }
  I atomic_add(int, I index, I value, M mask) {
    writes_storage_ = true;
    return I(made(OpKind::atomic, index, value, mask));
  }
  I atomic_exchange(int slot, I index, I value, M mask) {
    ordered_storage_ = true;
    return atomic_add(slot, index, value, mask);
  }
  void atomic_add_float(int slot, I index, F value, M mask) {
    ordered_storage_ = true;
    atomic_add(slot, index, I(CountValue(value)), mask);
  }
  int tile_plane_count() {
    made(OpKind::fetch);
    return 1;
  }
  bool tile_plane_is_far(int) const { return false; }
  F tile_plane_depth(int, F x, F y) { return F(made(OpKind::alu, made(OpKind::alu, x), y)); }
  M in_tile_plane(int, int) { return M(made(OpKind::alu)); }
  template <class Body>
  void loop_each(int block, I count, M mask, Body&& body) {
    made(OpKind::output, count, mask);
    enter(block, [&]() HWY_ATTR {
      recorder_.ops().alu += 2;
      body(0, M{});
    });
  }
  std::size_t loop_count(int) const { return 1; }
  void store_image(int, I x, I y, I sample, const Vec4<F>& color, M mask) {
    made(OpKind::output, color.x, color.y, color.z);
    made(OpKind::output, color.w, sample, mask);
    made(OpKind::store, x, y);
  }
  void output_depth(F depth) {
    made(OpKind::output, depth);
    writes_depth_ = true;
  }
  void discard(M mask) {
    made(OpKind::alu, mask);
    can_discard_ = true;
  }
  void output_mask(I mask) {
    made(OpKind::output, mask);
    writes_mask_ = true;
  }
  void output(int target, const Vec4<F>& color) {
    made(OpKind::output, color.x, color.y, color.z);
    made(OpKind::output, color.w);
    color_outputs_ = std::max(color_outputs_, target + 1);
  }

  BlockOps blocks() const { return recorder_.finish(); }
  int block_count() const { return recorder_.block_count(); }
  int color_outputs() const { return color_outputs_; }
  bool writes_storage() const { return writes_storage_; }
  bool ordered_storage() const { return ordered_storage_; }
  bool writes_depth() const { return writes_depth_; }
  bool can_discard() const { return can_discard_; }
  bool reads_coverage() const { return reads_coverage_; }
  bool writes_mask() const { return writes_mask_; }

 protected:
  CountValue made(OpKind kind, CountValue a = {}, CountValue b = {}, CountValue c = {}) {
    return {&recorder_, recorder_.add(kind, {a.op, b.op, c.op})};
  }
  I integer() { return I(made(OpKind::value)); }
  Vec4<F> four(CountValue request) {
    return {F(request), F(made(OpKind::value, request)), F(made(OpKind::value, request)),
            F(made(OpKind::value, request))};
  }
  OpRecorder& recorder() { return recorder_; }

 private:
  template <class Body>
  void enter(int block, Body&& body) {
    const OpRecorder::Site outer = recorder_.open(block);
    recorder_.ops().alu += 1;  // the branch itself
    body();
    recorder_.close(outer);
  }

  MaterialView material_;
  OpRecorder recorder_;
  int color_outputs_ = 0;
  bool can_discard_ = false;
  bool writes_depth_ = false;
  bool reads_coverage_ = false;
  bool writes_storage_ = false;
  bool writes_mask_ = false;
  bool ordered_storage_ = false;
};

/// Counts a shader and fills a program's costs. Uniforms count where the host itself branches on them.
template <class Shader>
FragmentProgram describe_fragment_shader(std::string name, void (*run)(FragmentBatch&, const void*),
                                         const typename Shader::Uniforms& uniforms = {}) {
  CountFragment counter;
  Shader::run(counter, uniforms);
  FragmentProgram program;
  program.name = std::move(name);
  program.run = run;
  program.ops = counter.blocks();
  program.block_count = counter.block_count();
  program.color_outputs = counter.color_outputs();
  program.can_discard = counter.can_discard();
  program.writes_depth = counter.writes_depth();
  program.reads_coverage = counter.reads_coverage();
  program.writes_storage = counter.writes_storage();
  program.writes_mask = counter.writes_mask();
  program.ordered_storage = counter.ordered_storage();
  return program;
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
