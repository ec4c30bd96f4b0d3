#include "algos/forward/shaders/light_lists.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/forward/shaders/listed_forward.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"
#include "pipeline/shade/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

enum ListedBlock : int { kConeBlock = 12 };  // 1 to 11 are the material's and the lights'

/// A pixel's list. Lanes of one register may belong to several tiles.
template <class S>
class ListedLights {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;
  using Surface = lanes::Surface<F>;
  using Vec3 = lanes::Vec3<F>;

  ListedLights(S& s, const ListedForwardUniforms& u) : s_(s), u_(u) {}

  /// Adds what the surface reflects, light by light in the order of the list.
  void add(const Surface& surface, M lit, Vec3& sum) {
    const I tile = shift_right<4>(s_.pixel_y()) * I(u_.grid.columns()) + shift_right<4>(s_.pixel_x());
    const I list = tile * I(u_.grid.list_words());
    const I count = s_.load_buffer(kListsBuffer, list, lit);
    s_.loop_each(lanes::kPointBlock, count, lit, [&](int i, M listed) HWY_ATTR {
      const I number = s_.load_buffer(kListsBuffer, list + I(1 + i), listed);
      add_light(surface, number * I(kLightWords), listed, sum);
    });
  }

 private:
  F word(I light, int offset, M mask) {
    return bits_to_float(s_.load_buffer(kLightsBuffer, light + I(offset), mask));
  }
  Vec3 words(I light, int offset, M mask) {
    const F x = word(light, offset, mask), y = word(light, offset + 1, mask),
            z = word(light, offset + 2, mask);
    return {x, y, z};
  }

  void add_light(const Surface& surface, I light, M listed, Vec3& sum) {
    const Vec3 position = words(light, 0, listed);
    const F inv_range2 = word(light, 3, listed);
    Vec3 l;
    F attenuation = lanes::distance_attenuation(position - surface.position, inv_range2, l);
    s_.uniform_branch(kConeBlock, u_.spots, [&]() HWY_ATTR {
      const F cos_outer = word(light, 7, listed);
      const Vec3 axis = words(light, 8, listed);
      const F inv_cos_span = word(light, 11, listed);
      attenuation =
          select(cos_outer > F(-1.5f), lanes::cone_attenuated(attenuation, l, axis, cos_outer, inv_cos_span),
                 attenuation);
    });
    const M reached = listed & (attenuation > F(0.0f));
    s_.branch(lanes::kPointInRangeBlock, reached, [&]() HWY_ATTR {
      const Vec3 color = words(light, 4, reached);
      const Vec3 more =
          sum + lanes::reflect_light(surface, l, u_.forward.lighting.model) * (color * attenuation);
      sum = lanes::select(reached, more, sum);
    });
  }

  S& s_;
  const ListedForwardUniforms& u_;
};

struct ListedForwardShader {
  using Uniforms = ListedForwardUniforms;
  template <class S>
  static void run(S& s, const ListedForwardUniforms& u) {
    const pipeline::LightingUniforms& lighting = u.forward.lighting;
    auto material = lanes::sample_material(s, u.forward.full_varyings);
    s.count(BaseCounters::lit_samples, s.valid() & s.active());
    const auto position = s.attr3(pipeline::SurfaceVaryings::kPosition);
    const auto surface = lanes::make_surface(material, position, lighting.eye);
    const auto lit = lanes::lights_reach(s, s.valid());
    auto sum = surface.emissive + lanes::ambient_light(lighting, surface);
    lanes::for_each_directional(s, lighting, surface, lit, [&](const auto& l, const auto& light) HWY_ATTR {
      sum = sum + lanes::reflect_light(surface, l, lighting.model) * light;
    });
    ListedLights<S>(s, u).add(surface, lit, sum);
    const auto color = lanes::occlude_ambient(s, lighting, surface, sum);
    s.output(0, {color.x, color.y, color.z, material.base.w});
  }
};

void run_listed(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<ListedForwardShader>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_listed);

namespace {
pipeline::FragmentProgram describe_listed(bool full, bool extended) {
  ListedForwardUniforms uniforms;
  uniforms.forward.lighting.extended = extended;
  pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::ListedForwardShader>(
          "listed_forward",
          [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_listed)
            (b, u);
          },
          uniforms);
  program.varying_scalars = full ? pipeline::SurfaceVaryings::kFull : pipeline::SurfaceVaryings::kBasic;
  return program;
}
}  // namespace

const pipeline::FragmentProgram& listed_forward_program(bool full_varyings, bool extended) {
  static const pipeline::FragmentProgram programs[] = {
      describe_listed(false, false), describe_listed(true, false), describe_listed(false, true),
      describe_listed(true, true)};
  return programs[(extended ? 2 : 0) + (full_varyings ? 1 : 0)];
}

}  // namespace hwsim::algos
#endif
