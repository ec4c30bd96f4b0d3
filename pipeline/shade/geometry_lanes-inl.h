// What a geometry shader sees: a triangle a lane, on the host's vector registers. A shader is a struct with
//   template <class S> static void run(S& s, const Uniforms& uniforms)
// written once against this class and CountGeometry (below). Per-target include guard.
#include "pipeline/batch/geometry_batch.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/lane_flow-inl.h"

#if defined(HWSIM_SHADE_GEOMETRY_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_GEOMETRY_LANES_INL_H_
#undef HWSIM_SHADE_GEOMETRY_LANES_INL_H_
#else
#define HWSIM_SHADE_GEOMETRY_LANES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

class GeometryLanes : public LaneFlow {
 public:
  GeometryLanes(GeometryBatch& batch, int first_lane)
      : LaneFlow(batch.blocks, first_lane, load(kLaneNumbers.data() + first_lane) < LaneI(batch.count)),
        batch_(batch) {}

  const MaterialView& material() const { return *batch_.material; }
  float width_px() const { return static_cast<float>(batch_.width_px); }
  float height_px() const { return static_cast<float>(batch_.height_px); }
  /// -1 where the draw's transform flips the winding.
  float winding() const { return batch_.mirrored ? -1.0f : 1.0f; }
  I primitive() const { return load(batch_.primitive.data() + first_); }

  Vec4<F> clip_position(int v) const {
    const auto& p = batch_.clip_position[v];
    return {load(p[0] + first_), load(p[1] + first_), load(p[2] + first_), load(p[3] + first_)};
  }
  /// Scalar k that the vertex program wrote for vertex v.
  F attr(int v, int k) const {
    HWY_ALIGN float values[kVectorLanes];
    for (int lane = 0; lane < kVectorLanes; ++lane) {
      const int safe = std::min(first_ + lane, batch_.count - 1);
      values[lane] = batch_.varyings[v][static_cast<std::size_t>(safe)][k];
    }
    return load(values);
  }
  Vec3<F> attr3(int v, int k) const { return {attr(v, k), attr(v, k + 1), attr(v, k + 2)}; }

  /// One vertex for each lane of `mask`, as far as the program's limit goes.
  void emit(M mask, const Vec4<F>& clip, std::span<const F> varyings) {
    HWY_ALIGN float values[kVectorLanes];
    const std::uint32_t lanes = mask_bits(mask & live_) & room();
    const auto put = [&](std::size_t k, F value) HWY_ATTR {
      store(value, values);
      for (std::uint32_t bits = lanes; bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        batch_.vertices[next(lane) * batch_.scalars_per_vertex() + k] = values[lane];
      }
    };
    put(0, clip.x);
    put(1, clip.y);
    put(2, clip.z);
    put(3, clip.w);
    for (std::size_t k = 0; k < varyings.size(); ++k) put(4 + k, varyings[k]);
    for (std::uint32_t bits = lanes; bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      const auto l = static_cast<std::size_t>(first_ + lane);
      batch_.starts_strip[next(lane)] = batch_.strip_ended[l] ? 1 : 0;
      batch_.strip_ended[l] = false;
      batch_.vertex_count[l] += 1;
    }
  }
  void end_strip(M mask) {
    for (std::uint32_t bits = mask_bits(mask & live_); bits != 0; bits &= bits - 1)
      batch_.strip_ended[static_cast<std::size_t>(first_ + __builtin_ctz(bits))] = true;
  }
  /// Adds the lanes of `mask` to a counter of the technique.
  void count(TechniqueCounter counter, M mask) {
    batch_.counters->technique[counter] +=
        static_cast<std::uint64_t>(__builtin_popcount(mask_bits(mask & live_)));
  }

 private:
  static constexpr std::array<std::int32_t, kBatchLanes> kLaneNumbers = [] {
    std::array<std::int32_t, kBatchLanes> numbers{};
    for (std::int32_t i = 0; i < kBatchLanes; ++i) numbers[static_cast<std::size_t>(i)] = i;
    return numbers;
  }();

  std::size_t next(int lane) const {
    const auto l = static_cast<std::size_t>(first_ + lane);
    return batch_.first_vertex(l) + static_cast<std::size_t>(batch_.vertex_count[l]);
  }
  std::uint32_t room() const {
    return mask_bits(load(batch_.vertex_count.data() + first_) < LaneI(batch_.program->max_vertices));
  }

  GeometryBatch& batch_;
};

/// The function of a GeometryProgram: the batch, a vector register at a time.
template <class Shader>
void run_geometry_shader(GeometryBatch& batch, const void* uniforms) {
  const auto& typed = *static_cast<const typename Shader::Uniforms*>(uniforms);
  for (int first = 0; first < batch.count; first += kVectorLanes) {
    GeometryLanes s(batch, first);
    Shader::run(s, typed);
  }
}

/// The counting context of geometry shaders. Inputs are read from on-chip memory; what is emitted is charged
/// by its bytes (gs.output_bytes), not here.
class CountGeometry : public CountFragment {
 public:
  float width_px() const { return 1.0f; }
  float height_px() const { return 1.0f; }
  float winding() const { return 1.0f; }
  I primitive() { return integer(); }
  Vec4<F> clip_position(int) {
    const F x = input(), y = input(), z = input(), w = input();
    return {x, y, z, w};
  }
  F attr(int, int) { return input(); }
  Vec3<F> attr3(int, int) {
    const F x = input(), y = input(), z = input();
    return {x, y, z};
  }
  void emit(M mask, const Vec4<F>& clip, std::span<const F> varyings) {
    made(OpKind::output, clip.x, clip.y, clip.z);
    made(OpKind::output, clip.w, mask);
    for (const F& v : varyings) made(OpKind::output, v);
    varying_scalars_ = std::max(varying_scalars_, static_cast<int>(varyings.size()));
  }
  void end_strip(M) {}
  void count(TechniqueCounter, M) {}
  int varying_scalars() const { return varying_scalars_; }

 private:
  F input() {
    recorder().ops().group_memory += 1;
    return F(made(OpKind::value));
  }
  int varying_scalars_ = 0;
};

/// Counts a shader and fills a program's costs. `Shader` says kOutput, kMaxVertices and kInputScalars.
template <class Shader>
GeometryProgram describe_geometry_shader(std::string name, void (*run)(GeometryBatch&, const void*)) {
  CountGeometry counter;
  const typename Shader::Uniforms uniforms{};
  Shader::run(counter, uniforms);
  GeometryProgram program;
  program.name = std::move(name);
  program.run = run;
  program.ops = counter.blocks();
  program.block_count = counter.block_count();
  program.output = Shader::kOutput;
  program.max_vertices = Shader::kMaxVertices;
  program.input_scalars = Shader::kInputScalars;
  program.varying_scalars = counter.varying_scalars();
  return program;
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
