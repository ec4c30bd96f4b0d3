// The geometry shader stage: what it emits is drawn, counted and bounded.
#include <gtest/gtest.h>

#include "hwsim/base/diagnostics.h"
#include "support/frames.h"

// One vector target is enough here: without foreach_target.
#include "pipeline/shade/fragment_lanes-inl.h"
#include "pipeline/shade/geometry_lanes-inl.h"

namespace hwsim::pipeline {
namespace {
namespace lanes = HWY_NAMESPACE;

constexpr int kSize = 64;

/// The triangle itself.
struct PassThrough {
  static constexpr GeometryOutput kOutput = GeometryOutput::triangle_strip;
  static constexpr int kMaxVertices = 3, kInputScalars = SurfaceVaryings::kBasic;
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    for (int v = 0; v < 3; ++v) {
      typename S::F out[SurfaceVaryings::kBasic];
      for (int k = 0; k < SurfaceVaryings::kBasic; ++k) out[k] = s.attr(v, k);
      s.emit(s.valid(), s.clip_position(v), std::span<const typename S::F>(out));
    }
  }
};

/// As many points as the triangle's number in the draw says, at most five, along a row of pixels.
struct Points {
  static constexpr GeometryOutput kOutput = GeometryOutput::points;
  static constexpr int kMaxVertices = 5, kInputScalars = 0;
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    using F = typename S::F;
    const F row = to_float(s.primitive());
    s.loop_each(1, s.primitive(), s.valid(), [&](int i, typename S::M lanes_left) HWY_ATTR {
      const F x((2.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(kSize)) - 1.0f);
      const F y = F(1.0f) - F(2.0f / static_cast<float>(kSize)) * (row + F(0.5f));
      const F tag[1] = {row * F(10.0f) + F(static_cast<float>(i))};
      s.emit(lanes_left, {x, y, F(0.5f), F(1.0f)}, std::span<const F>(tag));
    });
  }
};

struct ShowAttribute {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    using F = typename S::F;
    s.output(0, {s.flat_attr(0), F(0.0f), F(0.0f), F(1.0f)});
  }
};

struct ShowPosition {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    s.output(0, {s.attr(SurfaceVaryings::kPosition), s.attr(1), s.attr(2), s.attr(3)});
  }
};

template <class Shader>
const GeometryProgram& geometry(const char* name) {
  static const GeometryProgram p = lanes::describe_geometry_shader<Shader>(
      name, [](GeometryBatch& b, const void* u) { lanes::run_geometry_shader<Shader>(b, u); });
  return p;
}
template <class Shader>
FragmentProgram fragment(const char* name, int varyings) {
  FragmentProgram p = lanes::describe_fragment_shader<Shader>(
      name, [](FragmentBatch& b, const void* u) { lanes::run_fragment_shader<Shader>(b, u); });
  p.varying_scalars = varyings;
  return p;
}

/// Triangles with a common corner, `count` of them, some beyond the edges of the view.
std::shared_ptr<const Scene> fan(int count) {
  std::vector<glm::vec3> positions = {{0.1f, 0.05f, 0.5f}};
  std::vector<std::uint32_t> indices;
  for (int i = 0; i <= count; ++i) {
    const float a = 6.2f * static_cast<float>(i) / static_cast<float>(count);
    positions.push_back({1.3f * std::cos(a), 1.3f * std::sin(a), 0.2f + 0.5f * static_cast<float>(i % 3)});
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i)
    indices.insert(indices.end(), {0, i + 1, i + 2});
  return test::share(test::clip_space_scene(std::move(positions), std::move(indices)));
}

Emulation run_fan(int triangles, bool with_geometry, int jobs) {
  static const FragmentProgram show = fragment<ShowPosition>("show", SurfaceVaryings::kBasic);
  test::SampleFrame frame(fan(triangles), kSize, kSize, 4, Format::rgba32_float);
  DrawBatch batch = frame.all_draws(mesh_surface_program(), &show);
  batch.fragment_uniforms = std::make_shared<int>(0);
  batch.state.depth = {true, true, Compare::less};
  if (with_geometry) {
    batch.geometry = &geometry<PassThrough>("pass_through");
    batch.geometry_uniforms = std::make_shared<int>(0);
  }
  frame.draw("draw", {batch});
  EmulationOptions options;
  options.jobs = jobs;
  return frame.run(options);
}

TEST(GeometryShader, PassingTrianglesThroughGivesTheSameSamples) {
  const Emulation plain = run_fan(200, false, 1);
  for (const int jobs : {1, 3}) {
    const Emulation shaded = run_fan(200, true, jobs);
    for (std::size_t i = 0; i < plain.color.pixels.size(); ++i)
      ASSERT_EQ(plain.color.pixels[i], shaded.color.pixels[i]) << i;
    const PassCounters a = total(test::pass_named(plain.trace, "draw")),
                       b = total(test::pass_named(shaded.trace, "draw"));
    EXPECT_EQ(b.stats.geometry_shader_invocations, 200u);
    EXPECT_EQ(b.stats.geometry_shader_primitives, 200u);
    EXPECT_EQ(b.gs.output_vertices, 600u);
    EXPECT_EQ(b.gs.output_bytes, 600u * (4 + SurfaceVaryings::kBasic) * 4);
    EXPECT_EQ(b.gs.input_bytes, b.gs.output_bytes);
    EXPECT_EQ(a.stats.geometry_shader_invocations, 0u);
    EXPECT_EQ(a.setup.out_primitives, b.setup.out_primitives);
    EXPECT_EQ(a.raster.covered_samples, b.raster.covered_samples);
    EXPECT_EQ(a.stats.vertex_shader_invocations, b.stats.vertex_shader_invocations);
  }
}

TEST(GeometryShader, EmitsWhatEachTriangleAsksForUpToTheLimit) {
  static const FragmentProgram show = fragment<ShowAttribute>("show", 1);
  test::SampleFrame frame(fan(12), kSize, kSize, 1);
  DrawBatch batch = frame.all_draws(mesh_position_program(), &show);
  batch.fragment_uniforms = std::make_shared<int>(0);
  batch.geometry = &geometry<Points>("points");
  batch.geometry_uniforms = std::make_shared<int>(0);
  frame.draw("draw", {batch});
  const Emulation e = frame.run();
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const bool drawn = y < 12 && x < std::min(y, 5);
      ASSERT_EQ(e.color.at(x, y).x, drawn ? static_cast<float>(10 * y + x) : 0.0f) << x << " " << y;
    }
  const PassCounters n = total(test::pass_named(e.trace, "draw"));
  const std::uint64_t points = 0 + 1 + 2 + 3 + 4 + 5 * 7;
  EXPECT_EQ(n.stats.geometry_shader_primitives, points);
  EXPECT_EQ(n.gs.output_vertices, points);
  EXPECT_EQ(n.gs.output_bytes, points * 5 * 4);
  EXPECT_EQ(n.raster.fragments, points);
  EXPECT_EQ(n.ps.invocations, points);
}

// 20,000 triangles with 5 points each come in several runs of items; where they are cut changes nothing.
TEST(GeometryShader, ThreadsChangeNothingWhereItemsAreBuiltInRuns) {
  const auto run = [](int jobs) {
    static const FragmentProgram show = fragment<ShowAttribute>("show", 1);
    test::SampleFrame frame(fan(40000), kSize, kSize, 1);
    DrawBatch batch = frame.all_draws(mesh_position_program(), &show);
    batch.fragment_uniforms = std::make_shared<int>(0);
    batch.geometry = &geometry<Points>("points");
    batch.geometry_uniforms = std::make_shared<int>(0);
    frame.draw("draw", {batch});
    EmulationOptions options;
    options.jobs = jobs;
    return frame.run(options);
  };
  const Emulation one = run(1), three = run(3);
  const PassWork &a = test::pass_named(one.trace, "draw"), &b = test::pass_named(three.trace, "draw");
  ASSERT_EQ(a.chunks.size(), b.chunks.size());
  for (std::size_t c = 0; c < a.chunks.size(); ++c)
    for (std::size_t i = 0; i < kCounterCount; ++i)
      ASSERT_EQ(values(a.chunks[c])[i], values(b.chunks[c])[i]) << counter_catalog()[i].id;
  EXPECT_EQ(total(a).stats.geometry_shader_primitives, 10u + 5 * (40000 - 5));
}

TEST(IndexList, DrawsOnlyItsTriangles) {
  test::SampleFrame frame(fan(40), kSize, kSize, 1);
  DrawBatch batch = frame.all_draws(mesh_position_program(), &test::primitive_program());
  const std::vector<std::uint32_t>& all = frame.graph.scene().meshes[0].indices;
  batch.draws[0].list = make_index_list({all.begin() + 30, all.begin() + 45});  // triangles 10 to 14
  frame.draw("draw", {batch});
  const Emulation e = frame.run();
  const PassCounters n = total(test::pass_named(e.trace, "draw"));
  EXPECT_EQ(n.stats.input_assembly_primitives, 5u);
  EXPECT_EQ(n.stats.vertex_shader_invocations, 7u);  // the hub and six of the rim
  EXPECT_EQ(n.mem.index_read_bytes, 5u * 12);
  float highest = 0.0f;
  for (const glm::vec4& p : e.color.pixels) highest = std::max(highest, p.x);
  EXPECT_EQ(highest, 5.0f);
}

TEST(GeometryShader, WrongUseIsRefusedWithEveryReason) {
  test::SampleFrame frame(fan(3), kSize, kSize, 1);
  DrawBatch batch = frame.all_draws(mesh_surface_program(), &test::constant_program());
  GeometryProgram program = geometry<Points>("points");
  program.max_vertices = 300;
  batch.geometry = &program;
  batch.state.raster.topology = Topology::points;
  frame.draw("draw", {batch});
  try {
    frame.run();
    FAIL();
  } catch (const InputError& error) {
    std::vector<std::string> codes;
    for (const Diagnostic& d : error.diagnostics()) codes.push_back(d.code);
    // points as input, 8 varyings where it reads none, 1500 scalars, and a fragment program that reads none
    EXPECT_EQ(codes, (std::vector<std::string>{"G007", "G007", "G010", "G007"}));
  }
}

}  // namespace
}  // namespace hwsim::pipeline
