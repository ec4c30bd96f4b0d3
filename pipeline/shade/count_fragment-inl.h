// The counting context: a fragment shader run once on it yields the operations of each of its blocks.
// Every branch is taken and every loop body runs once; how often lanes go through is counted during
// emulation. Per-target include guard, see shade/lanes-inl.h.
#include <hwy/highway.h>
#include <algorithm>
#include <string>
#include "pipeline/emulate/fragment_batch.h"
#include "pipeline/shade/count_lane.h"
#include "pipeline/shade/texture_sampler-inl.h"
#include "pipeline/shade/vec-inl.h"
#if defined(HWSIM_PIPELINE_SHADE_COUNT_FRAGMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_PIPELINE_SHADE_COUNT_FRAGMENT_INL_H_
#undef HWSIM_PIPELINE_SHADE_COUNT_FRAGMENT_INL_H_
#else
#define HWSIM_PIPELINE_SHADE_COUNT_FRAGMENT_INL_H_
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
  I coverage() {
    reads_coverage_ = true;
    return integer();
  }
  F facing() { return F(made(OpKind::value)); }
  F attr(int) { return F(made(OpKind::interp)); }
  Vec3<F> attr3(int k) { return {attr(k), attr(k + 1), attr(k + 2)}; }
  Vec4<F> sample_texture(const TextureView*, int k) {
    const F u = attr(k), v = attr(k + 1);
    return four(made(OpKind::texture, u, v));
  }
  Vec4<F> sample_texture_at(const TextureView*, const TextureSite<F>& at) {
    made(OpKind::output, at.du_dx, at.dv_dx);
    return four(made(OpKind::texture, at.u, at.v, at.du_dy));
  }
  F flat_attr(int k) { return attr(k); }
  Vec4<F> load_image(int, I x, I y, I sample) { return four(made(OpKind::fetch, x, y, sample)); }
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
    enter(block, [&]() HWY_ATTR { body(0); });
    recorder_.ops(block).alu += 2;  // the counter and its comparison
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
  void tally(std::uint64_t TechniqueCounters::*, M) {}
  template <class Body>
  void loop_each(int block, I count, M mask, Body&& body) {
    made(OpKind::output, count, mask);
    enter(block, [&]() HWY_ATTR { body(0, M{}); });
    recorder_.ops(block).alu += 2;
  }
  std::size_t loop_count(int) const { return 1; }
  void store_image(int, I x, I y, I sample, const Vec4<F>& color, M mask) {
    made(OpKind::output, color.x, color.y, color.z);
    made(OpKind::output, color.w, sample, mask);
    made(OpKind::store, x, y);
  }
  void discard(M mask) { made(OpKind::alu, mask); }
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
  bool reads_coverage() const { return reads_coverage_; }

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
    const int outer = recorder_.block();
    recorder_.enter(block);
    recorder_.ops().alu += 1;  // the branch itself
    body();
    recorder_.enter(outer);
  }

  MaterialView material_;
  OpRecorder recorder_;
  int color_outputs_ = 0;
  bool reads_coverage_ = false;
  bool writes_storage_ = false;
  bool ordered_storage_ = false;
};

/// Counts a shader and fills a program's costs.
template <class Shader>
FragmentProgram describe_fragment_shader(std::string name, void (*run)(FragmentBatch&, const void*)) {
  CountFragment counter;
  const typename Shader::Uniforms uniforms{};
  Shader::run(counter, uniforms);
  FragmentProgram program;
  program.name = std::move(name);
  program.run = run;
  program.ops = counter.blocks();
  program.block_count = counter.block_count();
  program.color_outputs = counter.color_outputs();
  program.reads_coverage = counter.reads_coverage();
  program.writes_storage = counter.writes_storage();
  program.ordered_storage = counter.ordered_storage();
  return program;
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
