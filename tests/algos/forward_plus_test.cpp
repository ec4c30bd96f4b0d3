// Light-indexed forward shading against a plain loop over all lights, its lists against brute force, and its
// work against closed forms.
#include <gtest/gtest.h>

#include <array>

#include "algos/base/frame_parts.h"
#include "algos/forward/shaders/light_lists.h"
#include "algos/frame_run.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;
namespace lanes = pipeline::HWY_NAMESPACE;

/// Where surfaces coincide, the first drawn shows without a pre-pass, the last with one.
constexpr std::size_t kCoincidentPixels = 330;  // 2 %; 236 were measured in foliage at 32 samples
constexpr int kWidth = 173, kHeight = 97;       // tiles that the frame's edge cuts

FrameRequest lit(const std::string& scene, int lights, double range = 0.15) {
  FrameRequest request;
  request.scene = hwsim::test::generated_scene(scene);
  request.width_px = kWidth;
  request.height_px = kHeight;
  request.point_lights = lights;
  request.light_range = range;
  return request;
}

Emulation run(const FrameGraph& graph, const FrameRequest& request, int jobs = 2) {
  EmulationOptions options;
  options.jobs = jobs;
  return emulate(graph, request.features, request.functional, options);
}
Emulation run(const FrameRequest& request, const std::string& technique, int jobs = 2) {
  return run(build_frame(parse_technique(technique), request), request, jobs);
}

const PassWork& pass_of(const Emulation& e, const std::string& name) {
  for (const PassWork& pass : e.trace.passes)
    if (pass.name == name) return pass;
  throw std::invalid_argument("no pass " + name);
}

std::size_t different_pixels(const Image& a, const Image& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) count += a.pixels[i] == b.pixels[i] ? 0 : 1;
  return count;
}

// The same pre-pass, so that of coincident surfaces both show the same one.
TEST(ForwardPlus, ShowsWhatALoopOverAllLightsShows) {
  for (const auto& [lights, range] : {std::pair{0, 0.15}, std::pair{40, 0.15}, std::pair{300, 0.04}}) {
    const FrameRequest request = lit("sponza_hall:bays=4", lights, range);
    for (const auto& [plus, plain] : {std::pair{"forward_plus", "none:prepass=on"},
                                      std::pair{"forward_plus:samples=2", "msaa2x:prepass=on"},
                                      std::pair{"forward_plus:samples=4", "msaa4x:prepass=on"},
                                      std::pair{"forward_plus:samples=8", "msaa8x:prepass=on"}})
      EXPECT_EQ(different_pixels(run(request, plus).color, run(request, plain).color), 0u)
          << plus << " with " << lights << " lights";
  }
}

TEST(ForwardPlus, ShowsAlphaTestedLeavesToo) {
  const FrameRequest request = lit("foliage", 30, 0.1);
  EXPECT_EQ(different_pixels(run(request, "forward_plus").color, run(request, "none:prepass=on").color), 0u);
}

TEST(ForwardPlus, LightsEachVisiblePixelOnceAndFewLights) {
  const FrameRequest request = lit("sponza_hall:bays=4", 200, 0.05);
  const Emulation plus = run(request, "forward_plus"), plain = run(request, "none");
  const PassCounters shaded = total(pass_of(plus, "forward")), all = total(pass_of(plain, "forward"));
  std::size_t drawn = 0;
  for (const glm::vec4& invocations : plus.shading_heat.pixels) drawn += invocations.x > 0.0f ? 1 : 0;
  // Once, but for a few pixels where two surfaces have one depth.
  EXPECT_GE(shaded.technique[BaseCounters::lit_samples], drawn);
  EXPECT_LE(shaded.technique[BaseCounters::lit_samples], drawn + kCoincidentPixels);
  EXPECT_LE(drawn, static_cast<std::size_t>(kWidth * kHeight));
  EXPECT_GT(all.technique[BaseCounters::lit_samples], drawn);
  EXPECT_LT(shaded.shader.alu_lane_ops, all.shader.alu_lane_ops / 4);
  EXPECT_EQ(total(pass_of(plus, "prepass")).crop.written_samples, 0u);
}

TEST(ForwardPlus, CullingReadsEachDepthAndTestsEachLightOnceATile) {
  for (const int samples : {1, 4}) {
    const FrameRequest request = lit("sponza_hall:bays=4", 300);
    const PassCounters n =
        total(pass_of(run(request, "forward_plus:samples=" + std::to_string(samples)), "cull_lights"));
    const TileGrid grid{kWidth, kHeight, 300};
    ASSERT_EQ(grid.columns(), 11);
    ASSERT_EQ(grid.rows(), 7);
    EXPECT_EQ(n.tex.fetched_32bit_texels, static_cast<std::uint64_t>(kWidth * kHeight * samples));
    // The hall fills the frame: each tile tests each light, which is four words of it.
    EXPECT_EQ(n.shader.load_lane_ops, 77u * 300 * 4);
    EXPECT_EQ(n.mem.storage_read_bytes, 77u * 300 * 16);
    // Kept lights, and a length a tile.
    const std::uint64_t kept = n.shader.store_lane_ops - 77;
    EXPECT_GT(kept, 77u);
    EXPECT_LT(kept, 77u * 300 / 2);
    EXPECT_EQ(n.mem.storage_write_bytes, 4 * (kept + 77));
    EXPECT_EQ(n.shader.group_memory_lane_ops, 4u * kWidth * kHeight + kept);
  }
}

constexpr int kListed = 24;  // bits that a float holds exactly

/// Which lights a pixel's list has, as bits, and the depth that the frame left there.
struct ListShader {
  using Uniforms = TileGrid;
  template <class S>
  static void run(S& s, const TileGrid& grid) {
    using I = typename S::I;
    using F = typename S::F;
    const I tile = shift_right<4>(s.pixel_y()) * I(grid.columns()) + shift_right<4>(s.pixel_x());
    const I list = tile * I(grid.list_words());
    const I count = s.load_buffer(0, list, s.active());
    F bits(0.0f), before(-1.0f), sorted(1.0f);
    s.loop_each(1, count, s.active(), [&](int i, typename S::M listed) HWY_ATTR {
      const F number = to_float(s.load_buffer(0, list + I(1 + i), listed));
      bits = select(listed, bits + exp2(number), bits);
      sorted = select(listed & (number <= before), F(0.0f), sorted);
      before = select(listed, number, before);
    });
    const F depth = s.load_image(0, s.pixel_x(), s.pixel_y(), I(0)).x;
    s.output(0, {bits, sorted, depth, F(1.0f)});
  }
};

const FragmentProgram& list_program() {
  static const FragmentProgram p = lanes::describe_fragment_shader<ListShader>(
      "lists", [](FragmentBatch& b, const void* u) { lanes::run_fragment_shader<ListShader>(b, u); });
  return p;
}

int named(std::span<const BufferDesc> all, const std::string& name) {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].name == name) return static_cast<int>(i);
  return -1;
}
int named(std::span<const ImageDesc> all, const std::string& name) {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].name == name) return static_cast<int>(i);
  return -1;
}

TEST(ForwardPlus, ListsHoldEveryLightThatReachesAPixel) {
  for (const double range : {0.05, 0.15, 0.4}) {
    const FrameRequest request = lit("sponza_hall:bays=4", kListed, range);
    FrameGraph graph = build_frame(parse_technique("forward_plus"), request);
    const ImageId shown = graph.add_image({"lists_shown", Format::rgba32_float, kWidth, kHeight, 1});
    Pass& pass = graph.add_pass("show_lists", PassKind::full_screen);
    pass.color = {shown};
    pass.sampled = {ImageId{named(graph.images(), "depth")}};
    pass.storage = {BufferId{named(graph.buffers(), "light_lists")}};
    pass.fragment = &list_program();
    pass.uniforms = std::make_shared<TileGrid>(TileGrid{kWidth, kHeight, kListed});
    graph.set_output(shown);
    const Image lists = run(graph, request).color;

    const LightingUniforms lighting = frame_lighting(request);
    ASSERT_EQ(lighting.point_count, kListed);
    const Camera& camera = request.scene->cameras[0];
    const glm::dmat4 world_from_clip = glm::inverse(
        glm::dmat4(clip_from_view(camera, static_cast<float>(kWidth) / kHeight) * camera.view_from_world));
    std::size_t reached = 0, listed = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const glm::vec4& pixel = lists.at(x, y);
        EXPECT_EQ(pixel.y, 1.0f) << "numbers grow";
        if (pixel.z >= 1.0f) continue;
        const glm::dvec4 p = world_from_clip * glm::dvec4(2.0 * (x + 0.5) / kWidth - 1.0,
                                                          1.0 - 2.0 * (y + 0.5) / kHeight, pixel.z, 1.0);
        const auto bits = static_cast<std::uint32_t>(pixel.x);
        listed += static_cast<std::size_t>(__builtin_popcount(bits));
        for (std::size_t i = 0; i < kListed; ++i) {
          const PointLight& light = lighting.points[i];
          const glm::dvec3 d = glm::dvec3(light.position) - glm::dvec3(p) / p.w;
          if (glm::dot(d, d) * light.inv_range2 >= 1.0) continue;
          ++reached;
          ASSERT_NE(bits >> i & 1u, 0u) << "light " << i << " at " << x << ", " << y << ", range " << range;
        }
      }
    EXPECT_GT(reached, 300u);
    // Conservative, but no more than tiles and boxes must be.
    EXPECT_LT(listed, static_cast<std::size_t>(kWidth * kHeight * kListed));
    EXPECT_LT(static_cast<double>(listed), 4.0 * static_cast<double>(reached) + kWidth * kHeight);
  }
}

TEST(ForwardPlus, ThreadsChangeNeitherImageNorWork) {
  const FrameRequest request = lit("sponza_hall:bays=4", 100);
  const Emulation one = run(request, "forward_plus:samples=4", 1);
  for (const int jobs : {2, 3}) {
    const Emulation more = run(request, "forward_plus:samples=4", jobs);
    EXPECT_EQ(different_pixels(one.color, more.color), 0u);
    ASSERT_EQ(one.trace.passes.size(), more.trace.passes.size());
    for (std::size_t i = 0; i < one.trace.passes.size(); ++i) {
      const PassCounters a = total(one.trace.passes[i]), b = total(more.trace.passes[i]);
      EXPECT_TRUE(std::ranges::equal(values(a), values(b))) << one.trace.passes[i].name;
    }
  }
}

TEST(Prepass, ChangesTheWorkAndTheImageOnlyWhereSurfacesCoincide) {
  for (const char* scene : {"sponza_hall:bays=4", "foliage"}) {
    FrameRequest request = lit(scene, 10);
    request.features = every_feature(8);
    for (const std::string name : {"none", "msaa4x", "msaa32x", "deferred"}) {
      const Emulation plain = run(request, name), first = run(request, name + ":prepass=on");
      EXPECT_LE(different_pixels(plain.color, first.color), kCoincidentPixels) << name << " of " << scene;
      const std::string pass = name == "deferred" ? "gbuffer" : "forward";
      EXPECT_LT(total(pass_of(first, pass)).ps.invocations, total(pass_of(plain, pass)).ps.invocations)
          << name << " of " << scene;
      EXPECT_GT(total(pass_of(first, "prepass")).zrop.written_samples, 0u);
    }
  }
}

TEST(TiledDeferred, ShowsWhatAFullScreenPassShowsAndLightsLess) {
  const FrameRequest request = lit("sponza_hall:bays=4", 200, 0.05);
  const Emulation tiles = run(request, "deferred:samples=1,lighting=tiles");
  const Emulation screen = run(request, "deferred:samples=1");
  EXPECT_EQ(different_pixels(tiles.color, screen.color), 0u);
  const PassCounters t = total(pass_of(tiles, "light_tiles")), s = total(pass_of(screen, "light"));
  EXPECT_EQ(t.technique[BaseCounters::lit_samples], static_cast<std::uint64_t>(kWidth * kHeight));
  EXPECT_LT(t.shader.alu_lane_ops, s.shader.alu_lane_ops / 4);
}

TEST(TiledDeferred, RefusesWhatItCannotDo) {
  for (const char* impossible :
       {"deferred:samples=4,lighting=tiles",
        "deferred_simple_complex:layout=gb_agaa16,alpha_to_coverage=on,prepass=on"}) {
    const FrameRequest request = lit("sponza_hall:bays=4", 1);
    try {
      build_frame(parse_technique(impossible), request);
      FAIL() << impossible;
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics().front().code, "T003") << impossible;
    }
  }
}

}  // namespace
}  // namespace hwsim::algos
