#include "algos/sbaa/shaders/programs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/sbaa/shaders/programs.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/base/shaders/derivatives-inl.h"
#include "algos/sbaa/shaders/record-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

template <SbaaSample kSample, bool kAlphaTest>
struct IdShader {
  using Uniforms = SbaaIdUniforms;
  template <class S>
  static void run(S& s, const SbaaIdUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    using V = pipeline::SurfaceVaryings;
    if constexpr (kAlphaTest)
      s.discard(lanes::sample_alpha(s, kSample == SbaaSample::id ? 0 : V::kUv0) <
                F(s.material().alpha_cutoff));
    const F id = to_float((s.primitive_id() & I(u.id_mask)) | I(u.id_mask + 1));
    if constexpr (kSample == SbaaSample::id) {
      s.output(0, {id, F(0.0f), F(0.0f), F(0.0f)});
    } else {
      const auto n = normalize(s.attr3(V::kNormal)) * s.facing();
      if constexpr (kSample == SbaaSample::packed) {
        // The codes of an 8-bit normalized format, so that packing changes no result.
        const auto code = [](F x) HWY_ATTR { return lanes::round_even(x * F(127.0f)) + F(128.0f); };
        s.output(0, {id, code(n.x), code(n.y), code(n.z)});
      } else {
        s.output(0, {id, F(0.0f), F(0.0f), F(0.0f)});
        s.output(1, {n.x, n.y, n.z, F(0.0f)});
      }
    }
  }
};

// Blocks 1 to 5 are the material's, 6 to 9 those of lighting.
enum SbaaBlock : int {
  kLookupBlock = 10,    // a slot against the fragment's number
  kAcceptBlock = 11,    // a chosen fragment: attributes and record
  kSlotBlock = 12,      // a slot of a pixel
  kSurfaceBlock = 13,   // a used one: record and lighting
  kEmissionBlock = 14,  // the word of a compact record that holds emission
  kPaddingBlock = 15    // a word without use
};

template <bool kFull, bool kAlphaTest>
struct SbaaGBufferShader {
  using Uniforms = SbaaGBufferUniforms;
  template <class S>
  static void run(S& s, const SbaaGBufferUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    using M = typename S::M;
    const I id = s.primitive_id() & I(u.id_mask);
    I slot(-1);
    s.loop(kLookupBlock, u.surfaces.slots, s.active(), [&](int k) HWY_ATTR {
      I surface[2];
      load_surface(s, u.surfaces, 0, k, surface);
      const I count = k == 0 ? surface[1] & I(u.surfaces.background_unit - 1) : surface[1];
      slot = select((surface[0] == id) & (count > I(0)), I(k), slot);
    });
    const F z = view_depth(s, u);
    M accepted = s.active() & (slot > I(-1));
    s.branch(kAcceptBlock, accepted, [&]() HWY_ATTR {
      const auto m = lanes::sample_material(s, u.full_varyings);
      if constexpr (kAlphaTest) accepted = accepted & !(m.base.w < F(s.material().alpha_cutoff));
      store(s, u, m, z, slot, accepted);
    });
  }

  // Before the branch: derivatives need the whole quad.
  template <class S>
  static typename S::F view_depth(S& s, const SbaaGBufferUniforms& u) {
    using F = typename S::F;
    if constexpr (!kFull) return F(0.0f);
    const auto p = s.attr3(pipeline::SurfaceVaryings::kPosition);
    const glm::mat4& v = u.view_from_world;
    return F(v[0][2]) * p.x + F(v[1][2]) * p.y + F(v[2][2]) * p.z + F(v[3][2]);
  }

  static constexpr int kRecordWords = kFull ? 8 : 3;  // without emission and padding

  template <class S, class F, class I, class M>
  static void store(S& s, const SbaaGBufferUniforms& u, const lanes::MaterialSample<F>& m, F view_z, I slot,
                    M accepted) {
    const auto p = s.attr3(pipeline::SurfaceVaryings::kPosition);
    GBufferValues<F> values{p,          m.normal,    {m.base.x, m.base.y, m.base.z}, m.emissive,
                            m.metallic, m.roughness, depth_gradient(view_z)};
    mark_unlit(s, u.extended, values);
    const glm::mat4& c = u.clip_from_world;
    const auto row = [&](int r) HWY_ATTR {
      return F(c[0][r]) * p.x + F(c[1][r]) * p.y + F(c[2][r]) * p.z + F(c[3][r]);
    };
    F z(0.0f);
    if constexpr (!kFull) z = row(2) / row(3);
    I words[8];
    encode_record<kFull>(values, z, words);
    const I first = record_index(u.surfaces, s.pixel_x(), s.pixel_y(), slot);
    s.count(SbaaCounters::slot_conflicts_fragments, s.buffer_nonzero(0, first, accepted));
    for (int w = 0; w < kRecordWords; ++w) s.store_buffer(0, first + I(w), words[w], accepted);
    int used = kRecordWords;
    if constexpr (!kFull) {
      s.uniform_branch(kEmissionBlock, u.surfaces.record_words > used, [&]() HWY_ATTR {
        s.store_buffer(0, first + I(used), words[used], accepted);
        ++used;
      });
    }
    // Longer records: attributes of other renderers that this one has no use for.
    s.loop(kPaddingBlock, u.surfaces.record_words - used, accepted,
           [&](int w) HWY_ATTR { s.store_buffer(0, first + I(used + w), I(0), accepted); });
  }
};

template <bool kFull>
struct SbaaShadeShader {
  using Uniforms = SbaaShadeUniforms;
  template <class S>
  static void run(S& s, const SbaaShadeUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    using M = typename S::M;
    lanes::Vec3<F> sum = {F(0.0f), F(0.0f), F(0.0f)};
    F weight(0.0f), background(0.0f);
    M lit_any = F(1.0f) < F(0.0f);
    s.loop(kSlotBlock, u.surfaces.slots, s.valid(), [&](int k) HWY_ATTR {
      I surface[2];
      load_surface(s, u.surfaces, 0, k, surface);
      I count = surface[1];
      if (k == 0) {
        count = count & I(u.surfaces.background_unit - 1);
        background = to_float(surface[1] - count) * F(1.0f / static_cast<float>(u.surfaces.background_unit));
      }
      s.branch(kSurfaceBlock, count > I(0), [&]() HWY_ATTR {
        M found;
        const auto color = shade(s, u, k, count > I(0), found);
        const F share = select(found, to_float(count), F(0.0f));
        sum = sum + color * share;
        weight = weight + share;
        lit_any = lit_any | found;
        s.count(BaseCounters::lit_samples, found);
        s.count(SbaaCounters::slots_empty_surfaces, (count > I(0)) & !found);
      });
    });
    s.count(BaseCounters::lit_samples, !lit_any);
    // A pixel whose surfaces were all left empty shows the background, too.
    if (!u.weigh_background) background = select(lit_any, F(0.0f), F(1.0f));
    background = select(weight + background > F(0.0f), background, F(1.0f));
    const auto color =
        (sum + lanes::broadcast<F>(u.frame.background) * background) * (F(1.0f) / (weight + background));
    s.output(0, {color.x, color.y, color.z, F(1.0f)});
  }

  template <class S, class M>
  static lanes::Vec3<typename S::F> shade(S& s, const SbaaShadeUniforms& u, int slot, M used, M& found) {
    using F = typename S::F;
    using I = typename S::I;
    const I first = record_index(u.surfaces, s.pixel_x(), s.pixel_y(), I(slot));
    I words[8] = {I(0), I(0), I(0), I(0), I(0), I(0), I(0), I(0)};
    // Depth gradients, the last word of a full record, serve other techniques.
    constexpr int kRead = kFull ? 7 : 3;
    for (int w = 0; w < kRead; ++w) words[w] = s.load_buffer(0, first + I(w), used);
    if constexpr (!kFull) {
      s.uniform_branch(kEmissionBlock, u.surfaces.record_words > kRead,
                       [&]() HWY_ATTR { words[kRead] = s.load_buffer(0, first + I(kRead), used); });
    }
    found = used & (words[0] != I(0));
    const GBufferSample<F, M> sample{decode_record<kFull, S, F>(u.frame, s.pixel_x(), s.pixel_y(), words),
                                     found};
    const std::span points(u.frame.lighting.points.data(), s.loop_count(u.frame.lighting.point_count));
    const auto color = light_sample(s, u.frame, points, sample, found);
    return {color.x, color.y, color.z};
  }
};

// In the order of their descriptions below.
using Run = void (*)(pipeline::FragmentBatch&, const void*);
template <class Shader>
void run(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<Shader>(b, u);
}
using enum SbaaSample;
constexpr Run kRuns[] = {run<IdShader<id, false>>,
                         run<IdShader<id, true>>,
                         run<IdShader<id_and_normal, false>>,
                         run<IdShader<id_and_normal, true>>,
                         run<IdShader<packed, false>>,
                         run<IdShader<packed, true>>,
                         run<SbaaGBufferShader<false, false>>,
                         run<SbaaGBufferShader<false, true>>,
                         run<SbaaGBufferShader<true, false>>,
                         run<SbaaGBufferShader<true, true>>,
                         run<SbaaShadeShader<false>>,
                         run<SbaaShadeShader<true>>};
void run_sbaa(int which, pipeline::FragmentBatch& b, const void* u) { kRuns[which](b, u); }

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_sbaa);

namespace {
using pipeline::FragmentBatch;
using pipeline::FragmentProgram;
constexpr int kIdRuns = 0, kGBufferRuns = 6, kShadeRuns = 10;

template <int kWhich>
void call(FragmentBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_sbaa)(kWhich, b, u);
}

template <class Shader, int kWhich>
FragmentProgram describe(const char* name, int varyings, bool can_discard,
                         const typename Shader::Uniforms& uniforms = {}) {
  FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<Shader>(name, call<kWhich>, uniforms);
  program.varying_scalars = varyings;
  program.can_discard = can_discard;
  return program;
}

template <SbaaSample kSample, bool kAlphaTest>
FragmentProgram describe_id() {
  using V = pipeline::SurfaceVaryings;
  const int varyings =
      kSample == SbaaSample::id ? (kAlphaTest ? 2 : 0) : (kAlphaTest ? V::kNormalUv : V::kNormalOnly);
  constexpr int kWhich = kIdRuns + 2 * static_cast<int>(kSample) + (kAlphaTest ? 1 : 0);
  return describe<HWY_NAMESPACE::IdShader<kSample, kAlphaTest>, kWhich>("sbaa_id", varyings, kAlphaTest);
}

// Alpha-tested fragments that fail write no record; they need no discard, as nothing else is written.
template <bool kFull, bool kAlphaTest>
FragmentProgram describe_gbuffer(bool full_varyings, bool extended) {
  SbaaGBufferUniforms uniforms;
  uniforms.extended = extended;
  using V = pipeline::SurfaceVaryings;
  constexpr int kWhich = kGBufferRuns + (kFull ? 2 : 0) + (kAlphaTest ? 1 : 0);
  return describe<HWY_NAMESPACE::SbaaGBufferShader<kFull, kAlphaTest>, kWhich>(
      "sbaa_gbuffer", full_varyings ? V::kFull : V::kBasic, false, uniforms);
}

template <bool kFull>
FragmentProgram describe_shade(bool extended) {
  SbaaShadeUniforms uniforms;
  uniforms.frame.lighting.extended = extended;
  return describe<HWY_NAMESPACE::SbaaShadeShader<kFull>, kShadeRuns + (kFull ? 1 : 0)>("sbaa_shade", 0, false,
                                                                                       uniforms);
}
}  // namespace

const FragmentProgram& sbaa_id_program(SbaaSample sample, bool alpha_test) {
  using enum SbaaSample;
  static const FragmentProgram programs[] = {
      describe_id<id, false>(),           describe_id<id, true>(),      describe_id<id_and_normal, false>(),
      describe_id<id_and_normal, true>(), describe_id<packed, false>(), describe_id<packed, true>()};
  return programs[2 * static_cast<int>(sample) + (alpha_test ? 1 : 0)];
}

const FragmentProgram& sbaa_gbuffer_program(bool full_record, bool full_varyings, bool alpha_test,
                                            bool extended) {
  static const std::vector<FragmentProgram> programs = [] {
    std::vector<FragmentProgram> all;
    for (const bool ext : {false, true})
      for (const auto describe_one : {describe_gbuffer<false, false>, describe_gbuffer<false, true>,
                                      describe_gbuffer<true, false>, describe_gbuffer<true, true>})
        for (const bool full : {false, true}) all.push_back(describe_one(full, ext));
    return all;
  }();
  return programs[(extended ? 8u : 0u) + (full_record ? 4u : 0u) + (alpha_test ? 2u : 0u) +
                  (full_varyings ? 1u : 0u)];
}

const FragmentProgram& sbaa_shade_program(bool full_record, bool extended) {
  static const FragmentProgram programs[] = {describe_shade<false>(false), describe_shade<true>(false),
                                             describe_shade<false>(true), describe_shade<true>(true)};
  return programs[(extended ? 2 : 0) + (full_record ? 1 : 0)];
}

}  // namespace hwsim::algos
#endif
