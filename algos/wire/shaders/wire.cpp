#include "algos/wire/shaders/wire.h"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/wire/shaders/wire.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"
#include "pipeline/shade/surface-inl.h"
#include "pipeline/shade/vertex_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;
using lanes::Vec3;

/// Eq. 6.1 and Listing 6.1; the displaced radius is the clamped one (docs/techniques/wire.md). Positions come
/// from the same operations whatever is handed on, so that depth is the same in all passes.
template <WireOutput kOutput>
struct WireVertexShader {
  template <class S>
  static void run(S& s, const WireVertexUniforms& u) {
    using F = typename S::F;
    using V = pipeline::SurfaceVaryings;
    const Vec3<F> local = s.attribute3(S::kPosition), n = s.attribute3(S::kNormal);
    const F radius = s.attribute(S::kRadius, 0);
    const Vec3<F> surface = {s.world(0, local), s.world(1, local), s.world(2, local)};
    // From the center line outward, as the instance scales it.
    const Vec3<F> out = {s.world_direction(0, n), s.world_direction(1, n), s.world_direction(2, n)};
    const F scale = sqrt(dot(out, out));
    const F r_true = radius * scale;
    const Vec3<F> center = surface - out * radius;
    const glm::mat4& m = u.clip_from_world;
    const auto row = [&](int r, const Vec3<F>& p) HWY_ATTR {
      return ((s.constant(m[0][r]) * p.x + s.constant(m[1][r]) * p.y) + s.constant(m[2][r]) * p.z) +
             s.constant(m[3][r]);
    };
    const F w = max(row(3, center), s.constant(0.0f));
    const F r_least = w * s.constant(u.pixel_scale * u.width_px);
    const auto thin = r_true < r_least;
    // Wide wires stay where plain rendering has them, to the bit.
    const Vec3<F> p = select(thin, center + out * (r_least / max(scale, s.constant(1e-30f))), surface);
    for (int r = 0; r < 4; ++r) s.clip(r, row(r, p));
    if constexpr (kOutput == WireOutput::geometry) hand_on_geometry(s, p);
    if constexpr (kOutput == WireOutput::normal || kOutput >= WireOutput::basic) {
      const Vec3<F> normal = {s.normal(0, n), s.normal(1, n), s.normal(2, n)};
      hand_on(s, V::kNormal, u.bend ? bent(s, u, p, normal, r_true, w) : normal);
    }
    if constexpr (kOutput >= WireOutput::basic) {
      hand_on_uv(s, V::kUv0, S::kUv);
      hand_on(s, V::kPosition, p);
    }
    if constexpr (kOutput >= WireOutput::full) {
      hand_on(s, V::kTangent, world_tangent(s));
      s.varying(V::kTangent + 3, s.attribute(S::kTangent, 3));
      for (int i = 0; i < 4; ++i) s.varying(V::kColor + i, s.attribute(S::kColor, i));
      hand_on_uv(s, V::kUv1, S::kUv1);
    }
    if constexpr (kOutput == WireOutput::wire) {
      s.varying(WireVaryings::kFade,
                select(thin, r_true / max(r_least, s.constant(1e-30f)), s.constant(1.0f)));
      s.varying(WireVaryings::kRadius, r_true);
      s.varying(WireVaryings::kW, w);
    }
  }

 private:
  template <class S, class F>
  static void hand_on(S& s, int first, const Vec3<F>& v) {
    s.varying(first, v.x);
    s.varying(first + 1, v.y);
    s.varying(first + 2, v.z);
  }
  template <class S, class F>
  static void hand_on_geometry(S& s, const Vec3<F>& p) {
    using G = pipeline::GeometryVaryings;
    hand_on(s, G::kPosition, p);
    hand_on_uv(s, G::kUv0, S::kAlphaUv);
  }
  template <class S>
  static void hand_on_uv(S& s, int first, int attribute) {
    s.varying(first, s.attribute(attribute, 0));
    s.varying(first + 1, s.attribute(attribute, 1));
  }
  template <class S>
  static Vec3<typename S::F> world_tangent(S& s) {
    const Vec3<typename S::F> t = s.attribute3(S::kTangent);
    return {s.world_direction(0, t), s.world_direction(1, t), s.world_direction(2, t)};
  }

  /// What WireShader::flattened does in each pixel: what it blends are the same for a cross-section.
  template <class S, class F>
  static Vec3<F> bent(S& s, const WireVertexUniforms& u, const Vec3<F>& p, const Vec3<F>& normal, F r_true,
                      F w) {
    const F true_px = r_true / max(w * s.constant(u.pixel_scale), s.constant(1e-30f));
    const F scale = s.constant(1.0f / (u.full_light_px - 1.0f));
    const F share = min(max((true_px - s.constant(1.0f)) * scale, s.constant(0.0f)), s.constant(1.0f));
    const Vec3<F> eye = {s.constant(u.eye.x), s.constant(u.eye.y), s.constant(u.eye.z)};
    const Vec3<F> n = normalize(normal), t = normalize(world_tangent(s)), v = normalize(eye - p);
    const Vec3<F> across = v - t * dot(v, t);
    const Vec3<F> flat = normalize(lerp(normalize(across), n, share));
    return select(dot(across, across) < s.constant(1e-6f), n, flat);
  }
};

/// The light of both models in one pass over the lights: `full`, and (n.l / 2 + 1/2)^power of the albedo.
template <class S, class F, class M>
Vec3<F> half_lambert(S& s, const WireUniforms& u, const lanes::Surface<F>& surface, F share, M mask) {
  Vec3<F> sum = surface.emissive + lanes::ambient_light(u.lighting, surface);
  const std::span points(u.lighting.points.data(), s.loop_count(u.lighting.point_count));
  lanes::for_each_light(s, u.lighting, points, surface, mask,
                        [&](const Vec3<F>& l, const Vec3<F>& light) HWY_ATTR {
                          const F wrapped = dot(surface.normal, l) * F(0.5f) + F(0.5f);
                          const F soft = u.look.half_lambert_power == 2 ? wrapped * wrapped : wrapped;
                          const Vec3<F> full = lanes::reflect_light(surface, l, u.lighting.model);
                          sum = sum + lerp(surface.albedo * soft, full, share) * light;
                        });
  return sum;
}

template <WirePart kPart>
struct WireShader {
  using Uniforms = WireUniforms;
  template <class S>
  static void run(S& s, const WireUniforms& u) {
    using F = typename S::F;
    using V = pipeline::SurfaceVaryings;
    const F true_px =
        s.attr(WireVaryings::kRadius) / max(s.attr(WireVaryings::kW) * F(u.pixel_scale), F(1e-30f));
    F fade = s.attr(WireVaryings::kFade);
    if (u.look.fade_per_pixel) fade = min(true_px / F(u.look.width_px), F(1.0f));
    auto lit = s.valid();
    if constexpr (kPart != WirePart::all) {
      const auto wide = !(fade < F(1.0f));
      const auto dropped = kPart == WirePart::wide ? !wide : wide;
      s.discard(dropped);
      lit = lit & !dropped;
    }
    auto material = lanes::sample_material(s, true);
    const Vec3<F> position = s.attr3(V::kPosition);
    const F share = lanes::saturate((true_px - F(1.0f)) * F(1.0f / (u.look.full_light_px - 1.0f)));
    if (u.look.flatten) material.normal = flattened(s, u, position, material.normal, share);
    const auto surface = lanes::make_surface(material, position, u.lighting.eye);
    const auto reached = lanes::lights_reach(s, lit);
    const Vec3<F> light = u.look.half_lambert ? half_lambert(s, u, surface, share, reached)
                                              : lanes::light_surface(s, u.lighting, surface, reached);
    const Vec3<F> c = lanes::occlude_ambient(s, u.lighting, surface, light);
    s.output(0, {c.x, c.y, c.z, material.base.w * fade});
  }

 private:
  /// Toward the normal of the wire's middle as the eye sees it; along the wire there is none.
  template <class S, class F>
  static Vec3<F> flattened(S& s, const WireUniforms& u, const Vec3<F>& position, const Vec3<F>& n, F share) {
    const Vec3<F> t = normalize(s.attr3(pipeline::SurfaceVaryings::kTangent));
    const Vec3<F> v = normalize(lanes::broadcast<F>(u.lighting.eye) - position);
    const Vec3<F> across = v - t * dot(v, t);
    const Vec3<F> flat = normalize(lerp(normalize(across), n, share));
    return select(dot(across, across) < F(1e-6f), n, flat);
  }
};

template <WireOutput kOutput>
void run_vertex(pipeline::VertexBatch& batch, const void* uniforms) {
  lanes::run_vertex_shader<WireVertexShader<kOutput>>(batch,
                                                      *static_cast<const WireVertexUniforms*>(uniforms));
}
void run_wire_vertex(WireOutput output, pipeline::VertexBatch& batch, const void* uniforms) {
  switch (output) {
    case WireOutput::position:
      return run_vertex<WireOutput::position>(batch, uniforms);
    case WireOutput::normal:
      return run_vertex<WireOutput::normal>(batch, uniforms);
    case WireOutput::geometry:
      return run_vertex<WireOutput::geometry>(batch, uniforms);
    case WireOutput::basic:
      return run_vertex<WireOutput::basic>(batch, uniforms);
    case WireOutput::full:
      return run_vertex<WireOutput::full>(batch, uniforms);
    case WireOutput::wire:
      return run_vertex<WireOutput::wire>(batch, uniforms);
  }
}
void run_wire_all(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<WireShader<WirePart::all>>(b, u);
}
void run_wire_wide(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<WireShader<WirePart::wide>>(b, u);
}
void run_wire_faded(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<WireShader<WirePart::faded>>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_wire_vertex);
HWY_EXPORT(run_wire_all);
HWY_EXPORT(run_wire_wide);
HWY_EXPORT(run_wire_faded);

namespace {
using pipeline::FragmentBatch;
using pipeline::FragmentProgram;

template <WirePart kPart>
FragmentProgram describe_wire(bool extended, void (*run)(FragmentBatch&, const void*)) {
  pipeline::HWY_NAMESPACE::CountFragment counter;
  WireUniforms uniforms;  // with all that the options can ask for
  uniforms.lighting.extended = extended;
  uniforms.look.half_lambert = uniforms.look.flatten = uniforms.look.fade_per_pixel = true;
  HWY_NAMESPACE::WireShader<kPart>::run(counter, uniforms);
  FragmentProgram program;
  program.name = "wire";
  program.run = run;
  program.ops = counter.blocks();
  program.block_count = counter.block_count();
  program.color_outputs = counter.color_outputs();
  program.varying_scalars = WireVaryings::kCount;
  program.can_discard = kPart != WirePart::all;
  return program;
}
}  // namespace

namespace {
template <WireOutput kOutput>
pipeline::VertexProgram describe_vertex() {
  WireVertexUniforms uniforms;
  uniforms.bend = true;  // where normals are handed on to others' programs
  if constexpr (kOutput == WireOutput::wire) uniforms.bend = false;
  return pipeline::HWY_NAMESPACE::describe_vertex_shader<HWY_NAMESPACE::WireVertexShader<kOutput>>(
      "wire",
      [](pipeline::VertexBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_wire_vertex)
        (kOutput, b, u);
      },
      uniforms);
}
}  // namespace

const pipeline::VertexProgram& wire_vertex_program(WireOutput output) {
  using enum WireOutput;
  static const pipeline::VertexProgram programs[] = {describe_vertex<position>(), describe_vertex<normal>(),
                                                     describe_vertex<geometry>(), describe_vertex<basic>(),
                                                     describe_vertex<full>(),     describe_vertex<wire>()};
  return programs[static_cast<std::size_t>(output)];
}

namespace {

std::array<FragmentProgram, 3> describe_parts(bool extended) {
  return {describe_wire<WirePart::all>(extended,
                                       [](FragmentBatch& b, const void* u) {
                                         HWY_DYNAMIC_DISPATCH(run_wire_all)
                                         (b, u);
                                       }),
          describe_wire<WirePart::wide>(extended,
                                        [](FragmentBatch& b, const void* u) {
                                          HWY_DYNAMIC_DISPATCH(run_wire_wide)
                                          (b, u);
                                        }),
          describe_wire<WirePart::faded>(extended, [](FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_wire_faded)(b, u);
          })};
}

}  // namespace

const FragmentProgram& wire_program(WirePart part, bool extended) {
  static const std::array programs = {describe_parts(false), describe_parts(true)};
  return programs[extended ? 1u : 0u][static_cast<std::size_t>(part)];
}

}  // namespace hwsim::algos
#endif
