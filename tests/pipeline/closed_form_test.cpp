// Frames whose images and counters follow from a formula.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <random>

#include "pipeline/emulate/vertex_stage.h"
#include "pipeline/memory/stencil.h"
#include "pipeline/state/sample_pattern.h"
#include "support/frames.h"

namespace hwsim::pipeline {
namespace {
using test::SampleFrame;

std::shared_ptr<const Scene> quad(float z) {
  return test::share(
      test::clip_space_scene({{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}}, {0, 1, 2, 0, 2, 3}));
}

const BlendState kAdd{true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf};

TEST(ClosedForm, TrianglesThatFillTheScreenCoverEverySampleOnce) {
  std::mt19937 random(1);
  for (const int samples : {1, 2, 4, 8, 16, 32}) {
    for (int i = 0; i < 6; ++i) {
      const int width = 1 + static_cast<int>(random() % 150), height = 1 + static_cast<int>(random() % 90);
      const float x = static_cast<float>(random() % 2001) / 1000 - 1,
                  y = static_cast<float>(random() % 2001) / 1000 - 1;
      const auto scene = test::share(test::clip_space_scene(
          {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {x, y, 0}}, {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4}));
      SampleFrame frame(scene, width, height, samples);
      DrawBatch batch = frame.all_draws(mesh_position_program(), &test::constant_program());
      batch.state.blend = {kAdd};
      frame.draw("fill", {batch});
      const Emulation e = frame.run();
      for (const glm::vec4& sample : e.color.pixels) ASSERT_EQ(sample.x, 1.0f) << width << "x" << height;
      EXPECT_EQ(total(test::pass_named(e.trace, "fill")).raster.covered_samples,
                static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height * samples));
    }
  }
}

TEST(ClosedForm, TrianglesThatOverlapBlendInOrder) {
  std::vector<std::uint32_t> indices;
  for (int i = 0; i < 40; ++i) indices.insert(indices.end(), {0, 1, 2, 0, 2, 3});
  SampleFrame frame(
      test::share(test::clip_space_scene({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, indices)), 40, 24,
      4);
  DrawBatch batch = frame.all_draws(mesh_position_program(), &test::constant_program());
  batch.state.blend = {kAdd};
  frame.draw("pile", {batch});
  for (const glm::vec4& sample : frame.run().color.pixels) ASSERT_EQ(sample.x, 40.0f);
}

TEST(ClosedForm, CountsCulledTrianglesByReason) {
  const std::vector<glm::vec3> positions = {
      {-0.5f, -0.5f, 0},   {0.5f, -0.5f, 0},    {0, 0.5f, 0},          // drawn, or turned away
      {2, 0, 0},           {3, 0, 0},           {2, 1, 0},             // outside
      {0, 0, 2},           {1, 0, 2},           {0, 1, 2},             // beyond far
      {0.001f, 0.001f, 0}, {0.002f, 0.001f, 0}, {0.001f, 0.002f, 0}};  // no sample
  std::vector<std::uint32_t> indices;
  const auto add = [&](int times, std::initializer_list<std::uint32_t> t) {
    for (int i = 0; i < times; ++i) indices.insert(indices.end(), t);
  };
  add(3, {0, 1, 2});
  add(5, {0, 2, 1});
  add(7, {3, 4, 5});
  add(11, {6, 7, 8});
  add(13, {0, 1, 1});
  add(17, {9, 10, 11});
  SampleFrame frame(test::share(test::clip_space_scene(positions, indices)), 64, 64, 1);
  DrawBatch batch = frame.all_draws(mesh_position_program(), &test::constant_program());
  batch.state.raster.cull = CullMode::back;
  frame.draw("list", {batch});
  const SetupCounters n = total(test::pass_named(frame.run().trace, "list")).setup;
  EXPECT_EQ(n.in_primitives, 56u);
  EXPECT_EQ(n.out_primitives, 3u);
  EXPECT_EQ(n.culled_backface_primitives, 5u);
  EXPECT_EQ(n.culled_frustum_primitives, 18u);
  EXPECT_EQ(n.culled_zero_area_primitives, 13u);
  EXPECT_EQ(n.culled_sample_miss_primitives, 17u);
}

std::uint64_t misses_of(const std::vector<std::uint32_t>& indices, std::uint32_t vertices, int entries) {
  Mesh mesh;
  mesh.positions.resize(vertices);
  mesh.indices = indices;
  std::uint64_t sum = 0;
  for (const std::uint32_t n : count_cache_misses(indices, mesh.positions.size(), 3, entries)) sum += n;
  return sum;
}

TEST(ClosedForm, TheVertexCacheMissesAsAQueueDoes) {
  std::vector<std::uint32_t> strip, random_list;
  for (std::uint32_t i = 0; i < 5000; ++i) strip.insert(strip.end(), {i, i + 1, i + 2});
  EXPECT_EQ(misses_of(strip, 5002, 32), 5002u);
  EXPECT_EQ(misses_of(strip, 5002, 3), 5002u);
  EXPECT_EQ(misses_of(strip, 5002, 1), 15000u);
  std::vector<std::uint32_t> grid;  // rows of 10 quads: two rows of vertices fit
  for (std::uint32_t y = 0; y < 50; ++y)
    for (std::uint32_t x = 0; x < 10; ++x) {
      const std::uint32_t v = y * 11 + x;
      grid.insert(grid.end(), {v, v + 1, v + 11, v + 11, v + 1, v + 12});
    }
  EXPECT_EQ(misses_of(grid, 51 * 11, 32), 51u * 11u);
  std::mt19937 random(3);
  for (int i = 0; i < 9000; ++i) random_list.push_back(static_cast<std::uint32_t>(random() % 60));
  for (const int entries : {4, 16, 32, 59}) {
    std::deque<std::uint32_t> queue;
    std::uint64_t misses = 0;
    for (const std::uint32_t v : random_list) {
      if (std::find(queue.begin(), queue.end(), v) != queue.end()) continue;
      ++misses;
      queue.push_back(v);
      if (queue.size() > static_cast<std::size_t>(entries)) queue.pop_front();
    }
    EXPECT_EQ(misses_of(random_list, 60, entries), misses) << entries;
  }
}

// Blending, against the formula of the state in floats.
float factor(BlendFactor f, const glm::vec4& src, const glm::vec4& dst, int channel) {
  switch (f) {
    case BlendFactor::zero:
      return 0;
    case BlendFactor::one:
      return 1;
    case BlendFactor::src_alpha:
      return src.w;
    case BlendFactor::one_minus_src_alpha:
      return 1 - src.w;
    case BlendFactor::dst_alpha:
      return dst.w;
    case BlendFactor::one_minus_dst_alpha:
      return 1 - dst.w;
    case BlendFactor::src_color:
      return src[channel];
    case BlendFactor::dst_color:
      return dst[channel];
  }
  return -1;
}

glm::vec4 blended(const BlendState& state, const glm::vec4& src, const glm::vec4& dst) {
  FrameGraph graph(quad(0.5f), 9, 5);
  const ImageId image = graph.add_image({"color", Format::rgba32_float, 9, 5, 1});
  graph.add_clear("clear", {image}, dst);
  Pass& pass = graph.add_pass("blend", PassKind::full_screen);
  pass.color = {image};
  pass.fragment = &test::constant_program();
  pass.uniforms = std::make_shared<glm::vec4>(src);
  pass.state.blend = {state};
  graph.set_output(image);
  const Emulation e = emulate(graph, GpuFeatures{}, FunctionalConfig{}, {});
  for (const glm::vec4& p : e.color.pixels) EXPECT_EQ(p, e.color.pixels.front());
  return e.color.pixels.front();
}

TEST(ClosedForm, BlendsByEveryPairOfFactors) {
  const glm::vec4 src(0.75f, 0.3f, 1.5f, 0.4f), dst(0.1f, 0.9f, 0.2f, 0.7f);
  for (int s = 0; s < 8; ++s)
    for (int d = 0; d < 8; ++d) {
      const auto sf = static_cast<BlendFactor>(s), df = static_cast<BlendFactor>(d);
      const auto sa = static_cast<BlendFactor>((s + 3) % 8), da = static_cast<BlendFactor>((d + 5) % 8);
      const auto mask = static_cast<std::uint8_t>((8 * s + d) % 16);
      const glm::vec4 result = blended({true, sf, df, sa, da, mask}, src, dst);
      for (int c = 0; c < 4; ++c) {
        const float expected = c < 3 ? src[c] * factor(sf, src, dst, c) + dst[c] * factor(df, src, dst, c)
                                     : src.w * factor(sa, src, dst, c) + dst.w * factor(da, src, dst, c);
        EXPECT_EQ(result[c], (mask >> c & 1) != 0 ? expected : dst[c]) << s << " " << d << " " << c;
      }
    }
}

TEST(ClosedForm, StencilOperationsFollowTheirTables) {
  for (int op = 0; op < 8; ++op)
    for (int stored = 0; stored < 256; ++stored)
      for (const int write_mask : {0xff, 0x0f, 0xa5}) {
        StencilState state;
        state.reference = 0x5a;
        state.write_mask = static_cast<std::uint8_t>(write_mask);
        const int full[] = {stored,
                            0,
                            0x5a,
                            std::min(stored + 1, 255),
                            std::max(stored - 1, 0),
                            255 - stored,
                            (stored + 1) % 256,
                            (stored + 255) % 256};
        EXPECT_EQ(stencil_result(state, static_cast<StencilOp>(op), static_cast<std::uint8_t>(stored)),
                  (stored & ~write_mask) | (full[op] & write_mask));
      }
  for (const int read_mask : {0xff, 0x3c})
    for (int reference = 0; reference < 256; reference += 5)
      for (int stored = 0; stored < 256; ++stored) {
        const int a = reference & read_mask, b = stored & read_mask;
        const bool passes[] = {false, a<b, a == b, a <= b, a> b, a != b, a >= b, true};
        for (int compare = 0; compare < 8; ++compare) {
          StencilState state;
          state.compare = static_cast<Compare>(compare);
          state.reference = static_cast<std::uint8_t>(reference);
          state.read_mask = static_cast<std::uint8_t>(read_mask);
          EXPECT_EQ(stencil_passes(state, static_cast<std::uint8_t>(stored)), passes[compare]);
        }
      }
}

const FragmentProgram& keeping_program() {  // may discard, so that tests run after it, but does not
  static const FragmentProgram program = [] {
    FragmentProgram p = test::constant_program();
    p.can_discard = true;
    return p;
  }();
  return program;
}

// Which of the three operations a sample gets, early and late, with a coarse test that can decide tiles
// alone.
TEST(ClosedForm, StencilAndDepthPickTheOperation) {
  for (const FragmentProgram* program : {&test::constant_program(), &keeping_program()})
    for (const bool stencil_passes : {false, true})
      for (const bool depth_passes : {false, true})
        for (int alone = 0; alone < 4; ++alone) {  // all three operations, or one alone
          SampleFrame frame(quad(depth_passes ? 0.25f : 0.75f), 21, 13, 2, Format::r32_float,
                            Format::d24_unorm_s8);
          Pass& clear = frame.graph.add_clear("clear_depth", {frame.depth()});
          clear.clear_depth = 0.5f;
          clear.clear_stencil = 5;
          DrawBatch batch = frame.all_draws(mesh_position_program(), program);
          batch.state.depth = {true, true, Compare::less};
          StencilState& stencil = batch.state.stencil;
          stencil = {true,
                     stencil_passes ? Compare::equal : Compare::never,
                     5,
                     0xff,
                     0xff,
                     StencilOp::keep,
                     StencilOp::keep,
                     StencilOp::keep};
          if (alone == 0 || alone == 1) stencil.on_fail = StencilOp::increment_wrap;
          if (alone == 0 || alone == 2) stencil.on_depth_fail = StencilOp::invert;
          if (alone == 0 || alone == 3) stencil.on_pass = StencilOp::zero;
          const StencilOp op = !stencil_passes ? stencil.on_fail
                               : depth_passes  ? stencil.on_pass
                                               : stencil.on_depth_fail;
          frame.draw("operate", {batch});
          DrawBatch show = frame.all_draws(mesh_position_program(), &test::constant_program());
          show.state.stencil = {true,
                                Compare::equal,
                                stencil_result(stencil, op, 5),
                                0xff,
                                0xff,
                                StencilOp::keep,
                                StencilOp::keep,
                                StencilOp::keep};
          show.state.blend = {kAdd};
          show.fragment_uniforms = std::make_shared<glm::vec4>(10.0f);
          frame.draw("show", {show});
          for (const glm::vec4& sample : frame.run().color.pixels)
            ASSERT_EQ(sample.x, stencil_passes && depth_passes ? 11.0f : 10.0f)
                << program->name << (program->can_discard ? " late" : " early") << " stencil "
                << stencil_passes << " depth " << depth_passes << " operations " << alone;
        }
}

TEST(ClosedForm, ShadersThatWriteStorageRunForHiddenSamples) {
  FragmentProgram program = test::constant_program();
  program.writes_storage = true;
  for (const bool force_early : {false, true}) {
    SampleFrame frame(quad(0.75f), 32, 16, 1);
    frame.graph.add_clear("clear_depth", {frame.depth()}).clear_depth = 0.5f;
    DrawBatch batch = frame.all_draws(mesh_position_program(), &program);
    batch.state.depth = {true, true, Compare::less};
    batch.state.force_early_z = force_early;
    frame.draw("hidden", {batch});
    const Emulation e = frame.run();
    EXPECT_EQ(total(test::pass_named(e.trace, "hidden")).ps.invocations, force_early ? 0u : 512u);
    for (const glm::vec4& sample : e.color.pixels) ASSERT_EQ(sample.x, 0.0f);
  }
}

// World x at the shading point, in pixels; uniforms: int, the width.
const FragmentProgram& place_program() {
  static const FragmentProgram program = [] {
    FragmentProgram p = test::make_program("place", [](FragmentBatch& batch, const void*) {
      test::for_each_lane(batch, [&](std::size_t lane) {
        const auto at = [&](std::size_t v) {
          return batch.varyings[v][lane / 4][SurfaceVaryings::kPosition];
        };
        const float x = at(0) + batch.b1[lane] * (at(1) - at(0)) + batch.b2[lane] * (at(2) - at(0));
        for (int c = 0; c < 4; ++c) batch.color[0][c][lane] = x;
      });
    });
    p.varying_scalars = mesh_surface_program().varying_scalars;
    return p;
  }();
  return program;
}

TEST(ClosedForm, CentroidsLieOnTheFirstCoveredSample) {
  constexpr int kWidth = 48, kHeight = 32;
  const auto scene = test::share(
      test::clip_space_scene({{-0.9f, -0.8f, 0.5f}, {0.95f, -0.3f, 0.5f}, {0.1f, 0.9f, 0.5f}}, {0, 1, 2}));
  for (const int samples : {2, 4, 8, 16}) {
    const auto positions = standard_sample_positions(samples);
    for (const int mode : {0, 1, 2}) {  // center, centroid, sample rate
      SampleFrame frame(scene, kWidth, kHeight, samples);
      frame.graph.add_clear("mark", {frame.color()}, glm::vec4(100.0f));
      DrawBatch batch = frame.all_draws(mesh_surface_program(), &place_program());
      batch.state.raster.centroid = mode == 1;
      batch.state.raster.sample_rate = mode == 2;
      frame.draw("place", {batch});
      const Image image = frame.run().color;
      int partly = 0;
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          int first = -1, covered = 0;
          for (int s = samples - 1; s >= 0; --s)
            if (image.at(x * samples + s, y).x != 100.0f) first = s, ++covered;
          const bool moves = mode == 1 && covered != samples;
          partly += moves && covered > 0 ? 1 : 0;
          for (int s = 0; s < samples; ++s) {
            const float value = image.at(x * samples + s, y).x;
            if (value == 100.0f) continue;
            const int from = mode == 2 ? s : first;
            const float offset =
                moves || mode == 2 ? static_cast<float>(positions[static_cast<std::size_t>(from)].x) / 16 : 0;
            ASSERT_NEAR(value, (static_cast<float>(x) + 0.5f + offset) / kWidth * 2 - 1, 2e-4)
                << x << " " << y << " " << s;
          }
        }
      if (mode == 1) {
        EXPECT_GT(partly, 20);
      }
    }
  }
}

TEST(ClosedForm, ResolvesToTheMeanOfTheSamples) {
  std::mt19937 random(5);
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < 60; ++i) {
    positions.emplace_back(static_cast<float>(random() % 2001) / 1000 - 1,
                           static_cast<float>(random() % 2001) / 1000 - 1, 0.5f);
    indices.push_back(i);
  }
  const auto scene = test::share(test::clip_space_scene(positions, indices));
  for (const int samples : {2, 4, 8}) {
    SampleFrame all(scene, 37, 23, samples);
    all.draw("ids", {all.all_draws(mesh_position_program(), &test::primitive_program())});
    const Image samples_image = all.run().color;
    SampleFrame frame(scene, 37, 23, samples);
    frame.draw("ids", {frame.all_draws(mesh_position_program(), &test::primitive_program())});
    const ImageId out = frame.graph.add_image({"out", Format::r32_float, 37, 23, 1});
    frame.graph.add_resolve("resolve", frame.color(), out);
    frame.graph.set_output(out);
    const Emulation e = emulate(frame.graph, GpuFeatures{}, FunctionalConfig{}, {});
    for (int y = 0; y < 23; ++y)
      for (int x = 0; x < 37; ++x) {
        float sum = 0;
        for (int s = 0; s < samples; ++s) sum += samples_image.at(x * samples + s, y).x;
        ASSERT_EQ(e.color.at(x, y).x, sum / static_cast<float>(samples));
      }
  }
}

// Whether the triangle, grown by `margin`, and the pixel's square overlap: no axis separates them (1/256 px).
bool touches(const std::int64_t (&p)[3][2], int x, int y, double margin) {
  const double lo[2] = {x * 256.0 - margin, y * 256.0 - margin},
               hi[2] = {x * 256.0 + 256 + margin, y * 256.0 + 256 + margin};
  for (int axis = 0; axis < 2; ++axis) {
    const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
    if (static_cast<double>(high) < lo[axis] || static_cast<double>(low) > hi[axis]) return false;
  }
  const double area = static_cast<double>((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                                          (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]));
  for (int i = 0; i < 3; ++i) {
    const auto &a = p[i], &b = p[(i + 1) % 3];
    const double nx = static_cast<double>(a[1] - b[1]) * (area > 0 ? 1 : -1),
                 ny = static_cast<double>(b[0] - a[0]) * (area > 0 ? 1 : -1);
    const double px = nx > 0 ? hi[0] : lo[0], py = ny > 0 ? hi[1] : lo[1];  // the corner furthest inside
    if (nx * (px - static_cast<double>(a[0])) + ny * (py - static_cast<double>(a[1])) < 0) return false;
  }
  return true;
}

TEST(ClosedForm, ConservativeRasterCoversWhatTheTriangleTouches) {
  constexpr int kSize = 64;
  std::mt19937 random(9);
  std::uint64_t covered = 0;
  for (int i = 0; i < 300; ++i) {
    std::int64_t fixed[3][2];
    std::vector<glm::vec3> positions;
    for (auto& v : fixed) {
      for (std::int64_t& c : v) c = static_cast<std::int64_t>(random() % (kSize * 256 + 1));
      positions.emplace_back(static_cast<float>(v[0]) / (kSize * 128) - 1,
                             1 - static_cast<float>(v[1]) / (kSize * 128), 0.5f);
    }
    SampleFrame frame(test::share(test::clip_space_scene(positions, {0, 1, 2})), kSize, kSize, 1);
    DrawBatch batch = frame.all_draws(mesh_position_program(), &test::constant_program());
    batch.state.raster.conservative = true;
    batch.state.raster.sample_positions = {
        {static_cast<std::int8_t>(i % 16 - 8), static_cast<std::int8_t>(7 - i / 16 % 16)}};
    frame.draw("touch", {batch});
    const Image image = frame.run().color;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const bool found = image.at(x, y).x != 0.0f;
        covered += found ? 1 : 0;
        ASSERT_TRUE(found || !touches(fixed, x, y, -0.001)) << i << ": " << x << " " << y;
        ASSERT_TRUE(!found || touches(fixed, x, y, 1.001)) << i << ": " << x << " " << y;
      }
  }
  EXPECT_GT(covered, 50000u);
}

}  // namespace
}  // namespace hwsim::pipeline
