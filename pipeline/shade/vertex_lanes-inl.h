// What a vertex shader sees: VertexLanes on the host's vector registers, CountVertex to count it. A shader is
// a struct with `template <class S> static void run(S& s, const Uniforms& uniforms)`. Per-target include
// guard.
#include <algorithm>
#include <string>
#include "pipeline/batch/fragment_batch.h"
#include "pipeline/shade/count_lane.h"
#include "pipeline/simd/lanes-inl.h"
#include "pipeline/simd/vec-inl.h"

#if defined(HWSIM_SHADE_VERTEX_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_VERTEX_LANES_INL_H_
#undef HWSIM_SHADE_VERTEX_LANES_INL_H_
#else
#define HWSIM_SHADE_VERTEX_LANES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// Attribute names, in the order of VertexBatch.
struct VertexAttributes {
  static constexpr int kPosition = 0, kNormal = 1, kTangent = 2, kUv = 3, kColor = 4, kRadius = 5, kUv1 = 6,
                       kAlphaUv = 7;
};

class CountVertex : public VertexAttributes {
 public:
  using F = CountF;
  F attribute(int, int) { return F(CountValue{&recorder_, recorder_.add(OpKind::value, {-1, -1, -1})}); }
  Vec3<F> attribute3(int a) { return {attribute(a, 0), attribute(a, 1), attribute(a, 2)}; }
  F constant(float c) { return F(c); }
  F world(int, const Vec3<F>& v) { return ((F(1.0f) * v.x + F(1.0f) * v.y) + F(1.0f) * v.z) + F(1.0f); }
  F world_direction(int, const Vec3<F>& v) { return (F(1.0f) * v.x + F(1.0f) * v.y) + F(1.0f) * v.z; }
  F normal(int row, const Vec3<F>& v) { return world_direction(row, v); }
  void clip(int, F value) { recorder_.add(OpKind::output, {value.op, -1, -1}); }
  void varying(int index, F value) {
    recorder_.add(OpKind::output, {value.op, -1, -1});
    varyings_ = std::max(varyings_, index + 1);
  }
  ShaderOps ops() const { return recorder_.finish()[0]; }
  int varyings() const { return varyings_; }

 private:
  OpRecorder recorder_;
  int varyings_ = 0;
};

class VertexLanes : public VertexAttributes {
 public:
  using F = LaneF;
  VertexLanes(VertexBatch& batch, int first) : b_(batch), first_(first) {}

  F attribute(int attribute, int component) const {
    switch (attribute) {
      case kPosition:
        return load(b_.position[component] + first_);
      case kNormal:
        return load(b_.normal[component] + first_);
      case kTangent:
        return load(b_.tangent[component] + first_);
      case kUv:
        return load(b_.uv0[component] + first_);
      case kUv1:
        return load(b_.uv1[component] + first_);
      case kAlphaUv:
        return load((b_.alpha_uv_set == 1 ? b_.uv1 : b_.uv0)[component] + first_);
      case kColor:
        return load(b_.color[component] + first_);
      default:
        return load(b_.radius + first_);
    }
  }
  Vec3<F> attribute3(int a) const { return {attribute(a, 0), attribute(a, 1), attribute(a, 2)}; }
  F constant(float c) const { return F(c); }
  F world(int row, const Vec3<F>& v) const {
    return world_direction(row, v) + F(b_.world_from_local[12 + row]);
  }
  F world_direction(int row, const Vec3<F>& v) const {
    const float* m = b_.world_from_local + row;
    return (F(m[0]) * v.x + F(m[4]) * v.y) + F(m[8]) * v.z;
  }
  F normal(int row, const Vec3<F>& v) const {
    const float* m = b_.normal_from_local + row;
    return (F(m[0]) * v.x + F(m[3]) * v.y) + F(m[6]) * v.z;
  }
  void clip(int row, F value) { store(value, b_.clip_position[row] + first_); }
  void varying(int index, F value) { store(value, b_.varyings[index] + first_); }

 private:
  VertexBatch& b_;
  int first_;
};

/// The function of a VertexProgram: the batch, a vector register at a time.
template <class Shader, class Uniforms>
void run_vertex_shader(VertexBatch& batch, const Uniforms& uniforms) {
  for (int first = 0; first < batch.count; first += kVectorLanes) {
    VertexLanes s(batch, first);
    Shader::run(s, uniforms);
  }
}

/// Counts a shader and fills a program's costs.
template <class Shader, class Uniforms>
VertexProgram describe_vertex_shader(std::string name, void (*run)(VertexBatch&, const void*),
                                     const Uniforms& uniforms) {
  CountVertex counter;
  Shader::run(counter, uniforms);
  VertexProgram program;
  program.name = std::move(name);
  program.run = run;
  program.ops = counter.ops();
  program.varying_scalars = counter.varyings();
  return program;
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
