// The counting context: a fragment shader run once on it yields the operations of each of its blocks.
// Every branch is taken and every loop body runs once; how often lanes go through is counted during
// emulation. Per-target include guard, see shade/lanes-inl.h.
#include <hwy/highway.h>
#include <algorithm>
#include <string>
#include "pipeline/emulate/fragment_batch.h"
#include "pipeline/shade/count_lane.h"
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

  CountFragment() : current_(&blocks_[0]) {}
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
  F facing() { return value(); }
  F attr(int) {
    current_->interp += 1;
    return value();
  }
  Vec3<F> attr3(int k) { return {attr(k), attr(k + 1), attr(k + 2)}; }
  Vec4<F> sample_texture(const TextureView*, int k) {
    attr(k);
    attr(k + 1);
    current_->tex += 1;
    return {value(), value(), value(), value()};
  }
  Vec4<F> load_image(int, I, I, I) {
    current_->load += 1;
    return {value(), value(), value(), value()};
  }
  int image_width(int) const { return 1; }
  int image_height(int) const { return 1; }

  template <class Body>
  void branch(int block, M, Body&& body) {
    enter(block, body);
  }
  template <class Body>
  void uniform_branch(int block, bool, Body&& body) {
    enter(block, body);
  }
  template <class Body>
  void loop(int block, int, M, Body&& body) {
    enter(block, [&]() HWY_ATTR { body(0); });
    blocks_[static_cast<std::size_t>(block)].alu += 2;  // the counter and its comparison
  }
  I load_buffer(int, I, M) {
    current_->load += 1;
    return integer();
  }
  void store_buffer(int, I, I, M) {
    current_->store += 1;
    writes_storage_ = true;
  }
  I atomic_add(int, I, I, M) {
    current_->atomic += 1;
    writes_storage_ = true;
    return integer();
  }
  std::size_t loop_count(int) const { return 1; }
  void store_image(int, I, I, I, const Vec4<F>&, M) { current_->store += 1; }
  void discard(M) { current_->alu += 1; }
  void output(int target, const Vec4<F>&) { color_outputs_ = std::max(color_outputs_, target + 1); }

  const BlockOps& blocks() const { return blocks_; }
  int block_count() const { return block_count_; }
  int color_outputs() const { return color_outputs_; }
  bool writes_storage() const { return writes_storage_; }
  bool reads_coverage() const { return reads_coverage_; }

 private:
  F value() { return F(&current_); }
  I integer() { return I(&current_); }
  template <class Body>
  void enter(int block, Body&& body) {
    ShaderOps* outer = current_;
    current_ = &blocks_.at(static_cast<std::size_t>(block));
    block_count_ = std::max(block_count_, block + 1);
    current_->alu += 1;  // the branch itself
    body();
    current_ = outer;
  }

  MaterialView material_;
  BlockOps blocks_{};
  ShaderOps* current_;
  int block_count_ = 1;
  int color_outputs_ = 0;
  bool reads_coverage_ = false;
  bool writes_storage_ = false;
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
  return program;
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
