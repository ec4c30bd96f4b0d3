// Gathers of four texels and comparisons with a depth: what they return beside a scalar reading, and what
// they cost beside the loads that they replace.
#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/shade/compute_lanes-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "support/frames.h"

namespace hwsim::pipeline {
namespace {
namespace lanes = HWY_NAMESPACE;

constexpr int kWidth = 37, kHeight = 21;  // no whole tiles: borders on two sides

/// A value of its own for each texel, in each channel.
float value_of(int x, int y, int channel) {
  return static_cast<float>((x * 7 + y * 13 + channel * 29) % 64) / 64.0f;
}

RawImage texels() {
  RawImage image;
  image.width = kWidth;
  image.height = kHeight;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      std::uint32_t code = 0;
      for (int channel = 0; channel < 4; ++channel)
        code |= static_cast<std::uint32_t>(value_of(x, y, channel) * 64.0f) << (8 * channel);
      image.texels.push_back(code);
    }
  return image;
}
/// As a unorm texel decodes it.
float texel(int x, int y, int channel) {
  x = std::clamp(x, 0, kWidth - 1);
  y = std::clamp(y, 0, kHeight - 1);
  return value_of(x, y, channel) * 64.0f * (1.0f / 255.0f);
}

constexpr int kDx = -1, kDy = -1;

template <int kChannel>
struct GatherShader {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    const auto quad = s.gather_image(0, kChannel, s.pixel_x(), s.pixel_y(), kDx, kDy);
    s.output(0, {quad.t00, quad.t10, quad.t01, quad.t11});
  }
};

/// The same texels by four loads.
struct LoadShader {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    using I = typename S::I;
    const I x = s.pixel_x() + I(kDx), y = s.pixel_y() + I(kDy);
    const auto t00 = s.load_image(0, x, y, I(0));
    const auto t10 = s.load_image(0, x + I(1), y, I(0));
    const auto t01 = s.load_image(0, x, y + I(1), I(0));
    const auto t11 = s.load_image(0, x + I(1), y + I(1), I(0));
    s.output(0, {t00.w, t10.w, t01.w, t11.w});
  }
};

/// Places and depths that go beyond every border, and far out.
template <class F, class I>
void comparison_site(I px, I py, F& x, F& y, F& reference) {
  x = to_float(px) * F(1.37f) - F(5.21f);
  y = to_float(py) * F(1.21f) - F(3.83f);
  x = select(px == I(3), F(3.0e9f), x);
  reference = to_float((px * I(5) + py * I(3)) & I(63)) * F(1.0f / 255.0f);
}

struct CompareShader {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    typename S::F x, y, reference;
    comparison_site(s.pixel_x(), s.pixel_y(), x, y, reference);
    const typename S::F lit = s.compare_image(0, x, y, reference);
    s.output(0, {lit, lit, lit, lit});
  }
};

template <class Shader>
const FragmentProgram& program() {
  static const FragmentProgram p = lanes::describe_fragment_shader<Shader>(
      "request", [](FragmentBatch& b, const void* u) { lanes::run_fragment_shader<Shader>(b, u); });
  return p;
}

Emulation run(const FragmentProgram& program, int jobs) {
  FrameGraph graph(test::share(test::clip_space_scene({}, {})), kWidth, kHeight);
  const ImageId source = graph.add_image({"source", Format::rgba8_unorm, kWidth, kHeight, 1},
                                         std::make_shared<RawImage>(texels()));
  const ImageId output = graph.add_image({"output", Format::rgba32_float, kWidth, kHeight, 1});
  Pass& pass = graph.add_pass("request", PassKind::full_screen);
  pass.color = {output};
  pass.sampled = {source};
  pass.fragment = &program;
  pass.uniforms = std::make_shared<int>(0);
  graph.set_output(output);
  EmulationOptions options;
  options.jobs = jobs;
  return emulate(graph, GpuFeatures{}, FunctionalConfig{}, options);
}

template <int kChannel>
void expect_gathered() {
  const Emulation e = run(program<GatherShader<kChannel>>(), 2);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int i = 0; i < 4; ++i)
        ASSERT_EQ(e.color.at(x, y)[i], texel(x + kDx + (i & 1), y + kDy + (i >> 1), kChannel))
            << x << ", " << y << " texel " << i << " of channel " << kChannel;
}

TEST(Gather, ReturnsFourTexelsOfOneChannelClampedAtTheBorder) {
  expect_gathered<0>();
  expect_gathered<1>();
  expect_gathered<2>();
  expect_gathered<3>();
}

TEST(Comparison, WeighsTheAnswersOfFourTexels) {
  const Emulation e = run(program<CompareShader>(), 1);
  int partly = 0;
  for (int py = 0; py < kHeight; ++py)
    for (int px = 0; px < kWidth; ++px) {
      float x, y, reference;
      x = static_cast<float>(px) * 1.37f - 5.21f;
      y = static_cast<float>(py) * 1.21f - 3.83f;
      if (px == 3) x = 3.0e9f;
      reference = static_cast<float>((px * 5 + py * 3) & 63) / 255.0f;
      const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
      const float fx = x - 0.5f - left, fy = y - 0.5f - top;
      const int x0 = static_cast<int>(std::min(left, 1.0e6f)), y0 = static_cast<int>(top);
      const auto lit = [&](int dx, int dy) { return reference <= texel(x0 + dx, y0 + dy, 0) ? 1.0f : 0.0f; };
      const float expected =
          (lit(0, 0) * (1 - fx) + lit(1, 0) * fx) * (1 - fy) + (lit(0, 1) * (1 - fx) + lit(1, 1) * fx) * fy;
      partly += expected > 0.0f && expected < 1.0f ? 1 : 0;
      ASSERT_NEAR(e.color.at(px, py).x, expected, 1e-6f) << px << ", " << py;
    }
  EXPECT_GT(partly, kWidth * kHeight / 4);
}

TEST(TextureRequests, CostOneSlotAndFourTexelsWhateverTheThreads) {
  constexpr std::uint64_t kPixels = kWidth * kHeight;
  for (const int jobs : {1, 3}) {
    const PassCounters gather = total(run(program<GatherShader<3>>(), jobs).trace.passes[0]);
    const PassCounters compare = total(run(program<CompareShader>(), jobs).trace.passes[0]);
    const std::uint64_t lanes = gather.ps.invocations + gather.ps.helper_invocations;
    EXPECT_GE(lanes, kPixels);
    EXPECT_EQ(gather.tex.gathers, lanes);
    EXPECT_EQ(gather.tex.comparisons, 0u);
    EXPECT_EQ(compare.tex.comparisons, lanes);
    for (const PassCounters& n : {gather, compare}) {
      EXPECT_EQ(n.tex.requests, lanes);
      EXPECT_EQ(n.tex.bilinear_probes, 0u);
      EXPECT_EQ(n.tex.fetched_32bit_texels, 0u);
      EXPECT_EQ(n.tex.texels, 4 * lanes);
      EXPECT_EQ(n.mem.texture_read_bytes, 16 * lanes);
      EXPECT_EQ(n.shader.memory_chain_lane_ops, lanes);
      EXPECT_TRUE(violations(n, unit_laws()).empty());
    }
  }
}

TEST(TextureRequests, NoteTheLinesThatLoadsWouldRead) {
  const Emulation loads = run(program<LoadShader>(), 1), gather = run(program<GatherShader<3>>(), 1);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) ASSERT_EQ(loads.color.at(x, y), gather.color.at(x, y)) << x << ", " << y;
  const PassWork &by_load = loads.trace.passes[0], &by_gather = gather.trace.passes[0];
  EXPECT_EQ(total(by_load).mem.texture_read_bytes, total(by_gather).mem.texture_read_bytes);
  EXPECT_EQ(total(by_load).tex.texels, total(by_gather).tex.texels);
  EXPECT_EQ(by_load.reuse.texture_l1.read_bytes, by_gather.reuse.texture_l1.read_bytes);
  EXPECT_GT(total(by_load).shader.alu_lane_ops, total(by_gather).shader.alu_lane_ops);
}

}  // namespace
}  // namespace hwsim::pipeline
