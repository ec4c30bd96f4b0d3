// Over the frame of selective supersampling: which of its samples' triangles were sampled (marks), and what
// is shown of both.
#include <array>

#include "algos/sss/shaders/programs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/sss/shaders/composite.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/sss/shaders/composite-inl.h"
#include "algos/sss/shaders/geometry-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// The triangles that are sampled in this view, as they are.
template <SssVertex kVertex>
struct MarksShader : SssGeometryShader<kVertex, pipeline::GeometryOutput::triangle_strip, 3> {
  template <class S>
  static void run(S& s, const SssUniforms& u) {
    using F = typename S::F;
    MarksShader::for_chosen(
        s, u, [&](const SssCorner<F>(&c)[3], const SssTriangle<F>&, typename S::M chosen) HWY_ATTR {
          for (int v = 0; v < 3; ++v) s.emit(chosen, c[v].clip, std::span<const F>());
        });
  }
};

struct MarkShader {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    using F = typename S::F;
    s.output(0, {F(1.0f), F(1.0f), F(1.0f), F(1.0f)});
  }
};

struct CompositeShader {
  using Uniforms = SssUniforms;
  template <class S>
  static void run(S& s, const SssUniforms& u) {
    blend_over_frame(s, u, s.load_image(kSssSumSlot, s.pixel_x(), s.pixel_y(), typename S::I(0)));
  }
};

/// The sums of the compute variant: four words a pixel in buffer slot 0, fixed-point or floats.
template <bool kFloat>
struct SumCompositeShader {
  using Uniforms = SssUniforms;
  template <class S>
  static void run(S& s, const SssUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    const I first = (s.pixel_y() * I(u.width_px) + s.pixel_x()) * I(4);
    const F scale(1.0f / u.fixed_point_scale);
    const auto word = [&](int i) HWY_ATTR {
      const I value = s.load_buffer(0, first + I(i), s.active());
      if constexpr (kFloat) return bits_to_float(value);
      // Unsigned words: the high half apart, so that no value is taken for a negative one.
      return (to_float(shift_right<16>(value) & I(0xffff)) * F(65536.0f) + to_float(value & I(0xffff))) *
             scale;
    };
    const F r = word(0), g = word(1), b = word(2), w = word(3);
    blend_over_frame(s, u, Vec4<F>{r, g, b, w});
  }
};

void run_marks(SssVertex vertex, pipeline::GeometryBatch& b, const void* u) {
  with_vertex(vertex, [&](auto v) HWY_ATTR { lanes::run_geometry_shader<MarksShader<v()>>(b, u); });
}
void run_mark(pipeline::FragmentBatch& b, const void* u) { lanes::run_fragment_shader<MarkShader>(b, u); }
void run_composite(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<CompositeShader>(b, u);
}
void run_fixed_composite(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<SumCompositeShader<false>>(b, u);
}
void run_float_composite(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<SumCompositeShader<true>>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_marks);
HWY_EXPORT(run_mark);
HWY_EXPORT(run_composite);
HWY_EXPORT(run_fixed_composite);
HWY_EXPORT(run_float_composite);

const pipeline::GeometryProgram& sss_marks_program(SssVertex vertex) {
  static const auto programs = for_each_vertex([](auto v) {
    return pipeline::HWY_NAMESPACE::describe_geometry_shader<HWY_NAMESPACE::MarksShader<v()>>(
        "sss_marks", [](pipeline::GeometryBatch& b, const void* u) {
          HWY_DYNAMIC_DISPATCH(run_marks)(decltype(v)::value, b, u);
        });
  });
  return programs[static_cast<std::size_t>(vertex)];
}

const pipeline::FragmentProgram& sss_mark_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::MarkShader>(
          "sss_mark", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_mark)
            (b, u);
          });
  return program;
}

const pipeline::FragmentProgram& sss_composite_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::CompositeShader>(
          "sss_composite", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_composite)
            (b, u);
          });
  return program;
}

const pipeline::FragmentProgram& sss_sum_composite_program(bool floats) {
  static const pipeline::FragmentProgram programs[] = {
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::SumCompositeShader<false>>(
          "sss_fixed_composite",
          [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_fixed_composite)
            (b, u);
          }),
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::SumCompositeShader<true>>(
          "sss_float_composite", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_float_composite)(b, u);
          })};
  return programs[floats ? 1 : 0];
}

}  // namespace hwsim::algos
#endif
