#include "algos/filters/shaders/tone_map.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/filters/shaders/tone_map.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

enum ReduceBlock : int { kReduceBlock = 1 };

template <class F>
F luminance_of(const lanes::Vec4<F>& c) {
  return c.x * F(0.2126f) + c.y * F(0.7152f) + c.z * F(0.0722f);
}

/// body(texel) for each pixel of the source that the target's pixel stands for; returns how many they are.
template <class S, class Body>
typename S::F for_each_source(S& s, const ReduceUniforms& u, Body&& body) {
  using I = typename S::I;
  const I x = s.pixel_x() * I(u.factor), y = s.pixel_y() * I(u.factor);
  s.loop(kReduceBlock, u.factor * u.factor, s.valid(), [&](int i) HWY_ATTR {
    const I at_x = x + I(i % u.factor), at_y = y + I(i / u.factor);
    const auto inside = (at_x < I(u.width)) & (at_y < I(u.height));
    const auto texel = s.load_image(0, min(at_x, I(u.width - 1)), min(at_y, I(u.height - 1)), I(0));
    body(texel, inside);
  });
  const I columns = min(I(u.width) - x, I(u.factor)), rows = min(I(u.height) - y, I(u.factor));
  return to_float(columns) * to_float(rows);
}

struct LuminanceShader {
  using Uniforms = ReduceUniforms;
  template <class S>
  static void run(S& s, const ReduceUniforms& u) {
    using F = typename S::F;
    F sum(0.0f);
    const F count = for_each_source(s, u, [&](const lanes::Vec4<F>& c, typename S::M inside) HWY_ATTR {
      sum = sum + select(inside, luminance_of(c), F(0.0f));
    });
    s.output(0, {sum / count, F(0.0f), F(0.0f), F(0.0f)});
  }
};

struct MeanShader {
  using Uniforms = ReduceUniforms;
  template <class S>
  static void run(S& s, const ReduceUniforms& u) {
    using F = typename S::F;
    F sum(0.0f);
    const F count = for_each_source(s, u, [&](const lanes::Vec4<F>& c, typename S::M inside) HWY_ATTR {
      sum = sum + select(inside, c.x, F(0.0f));
    });
    s.output(0, {sum / count, F(0.0f), F(0.0f), F(0.0f)});
  }
};

struct BrightShader {
  using Uniforms = ReduceUniforms;
  template <class S>
  static void run(S& s, const ReduceUniforms& u) {
    using F = typename S::F;
    const F zero(0.0f);
    lanes::Vec4<F> sum = {zero, zero, zero, zero};
    const F count = for_each_source(s, u, [&](const lanes::Vec4<F>& c, typename S::M inside) HWY_ATTR {
      const F scale = select(inside & (luminance_of(c) > F(u.threshold)), F(1.0f), F(0.0f));
      sum = sum + c * scale;
    });
    s.output(0, sum * (F(1.0f) / count));
  }
};

struct BlurShader {
  using Uniforms = BlurUniforms;
  template <class S>
  static void run(S& s, const BlurUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    constexpr float kWeights[] = {0.2270f, 0.1946f, 0.1216f, 0.0540f, 0.0163f};
    const F zero(0.0f);
    lanes::Vec4<F> sum = {zero, zero, zero, zero};
    s.loop(kReduceBlock, kBlurTaps, s.valid(), [&](int i) HWY_ATTR {
      const int step = i - kBlurTaps / 2;
      const I x = max(min(s.pixel_x() + I(step * u.dx), I(u.width - 1)), I(0));
      const I y = max(min(s.pixel_y() + I(step * u.dy), I(u.height - 1)), I(0));
      sum = sum + s.load_image(0, x, y, I(0)) * F(kWeights[step < 0 ? -step : step]);
    });
    s.output(0, sum);
  }
};

struct ToneMapShader {
  using Uniforms = ToneMapUniforms;
  template <class S>
  static void run(S& s, const ToneMapUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    const auto light = s.load_image(0, s.pixel_x(), s.pixel_y(), I(0));
    const F mean = s.load_image(2, I(0), I(0), I(0)).x;
    const F to_bloom(1.0f / static_cast<float>(u.factor));
    const I bloom_x = min(to_int(to_float(s.pixel_x()) * to_bloom), I(u.bloom_width - 1));
    const I bloom_y = min(to_int(to_float(s.pixel_y()) * to_bloom), I(u.bloom_height - 1));
    const auto bloom = s.load_image(1, bloom_x, bloom_y, I(0));
    const auto color = (light + bloom * F(u.bloom)) * (F(u.key) / max(mean, F(1e-4f)));
    const auto mapped = [](F c) HWY_ATTR { return c / (F(1.0f) + c); };
    s.output(0, {mapped(color.x), mapped(color.y), mapped(color.z), F(1.0f)});
  }
};

void run_luminance(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<LuminanceShader>(b, u);
}
void run_mean(pipeline::FragmentBatch& b, const void* u) { lanes::run_fragment_shader<MeanShader>(b, u); }
void run_bright(pipeline::FragmentBatch& b, const void* u) { lanes::run_fragment_shader<BrightShader>(b, u); }
void run_blur(pipeline::FragmentBatch& b, const void* u) { lanes::run_fragment_shader<BlurShader>(b, u); }
void run_tone_map(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<ToneMapShader>(b, u);
}
}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_luminance);
HWY_EXPORT(run_mean);
HWY_EXPORT(run_bright);
HWY_EXPORT(run_blur);
HWY_EXPORT(run_tone_map);

namespace {
template <class Shader>
pipeline::FragmentProgram described(const char* name, void (*run)(pipeline::FragmentBatch&, const void*)) {
  return pipeline::HWY_NAMESPACE::describe_fragment_shader<Shader>(name, run);
}
}  // namespace

const pipeline::FragmentProgram& luminance_program() {
  static const pipeline::FragmentProgram program = described<HWY_NAMESPACE::LuminanceShader>(
      "tone_map_luminance", [](pipeline::FragmentBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_luminance)(b, u);
      });
  return program;
}

const pipeline::FragmentProgram& mean_program() {
  static const pipeline::FragmentProgram program =
      described<HWY_NAMESPACE::MeanShader>("tone_map_mean", [](pipeline::FragmentBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_mean)(b, u);
      });
  return program;
}

const pipeline::FragmentProgram& bright_program() {
  static const pipeline::FragmentProgram program = described<HWY_NAMESPACE::BrightShader>(
      "tone_map_bright", [](pipeline::FragmentBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_bright)(b, u);
      });
  return program;
}

const pipeline::FragmentProgram& blur_program() {
  static const pipeline::FragmentProgram program =
      described<HWY_NAMESPACE::BlurShader>("tone_map_blur", [](pipeline::FragmentBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_blur)(b, u);
      });
  return program;
}

const pipeline::FragmentProgram& tone_map_program() {
  static const pipeline::FragmentProgram program =
      described<HWY_NAMESPACE::ToneMapShader>("tone_map", [](pipeline::FragmentBatch& b, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_tone_map)(b, u);
      });
  return program;
}

}  // namespace hwsim::algos
#endif
