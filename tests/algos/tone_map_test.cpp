// Tone mapping with bloom: what it takes from a base, and its arithmetic against plain loops.
#include <gtest/gtest.h>

#include "algos/frame_run.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

FrameRequest small_frame() {
  FrameRequest request;
  request.scene = hwsim::test::generated_scene("sponza_hall:bays=4");
  request.width_px = 173;
  request.height_px = 97;
  return request;
}

FrameGraph graph_of(const std::string& technique) {
  return build_frame(parse_technique(technique), small_frame());
}

Format output_of_base(const std::string& technique) {
  const FrameGraph graph = graph_of(technique);
  for (const Pass& pass : graph.passes())
    if (pass.name == "tone_map_luminance") return graph.image(pass.sampled.front()).format;
  return Format::none;
}

TEST(ToneMap, IsGivenLinearHalfFloatsByEveryBase) {
  for (const TechniqueInfo& t : techniques()) {
    if (t.kind() != TechniqueKind::base) continue;
    EXPECT_EQ(output_of_base(std::string(t.id) + "+tone_map"), Format::rgba16_float) << t.id;
  }
}

TEST(ToneMap, ComesBeforeOtherFilters) {
  EXPECT_EQ(technique_text(parse_technique("none+fxaa+tone_map")), "tone_map+fxaa");
}

TEST(ToneMap, ReadsAndWritesOnceInEightPassesOrNine) {
  const FrameGraph graph = graph_of("none+tone_map");
  const auto passes = std::ranges::count_if(
      graph.passes(), [](const Pass& pass) { return pass.name.starts_with("tone_map"); });
  EXPECT_GE(passes, 7);
  EXPECT_LE(passes, 9);
}

TEST(ToneMap, BringsTheMeanToItsKeyBeforeTheCurve) {
  FrameRequest request = small_frame();
  request.width_px = request.height_px =
      256;  // 4 x 8 x 8: no pixel of the chain stands for fewer than others
  const auto mean_of = [&](const char* technique) {
    const Image image =
        emulate(build_frame(parse_technique(technique), request), request.features, request.functional, {})
            .color;
    double sum = 0.0;  // before the curve: what c / (1 + c) came from
    for (const glm::vec4& c : image.pixels) {
      const auto before = [](float v) { return std::min(0.99, static_cast<double>(v)); };
      const double l = 0.2126 * before(c.x) / (1 - before(c.x)) + 0.7152 * before(c.y) / (1 - before(c.y)) +
                       0.0722 * before(c.z) / (1 - before(c.z));
      sum += l / static_cast<double>(image.pixels.size());
    }
    return sum;
  };
  EXPECT_NEAR(mean_of("none+tone_map:bloom=0,key=0.18"), 0.18, 0.01);
  EXPECT_NEAR(mean_of("none+tone_map:bloom=0,key=0.4"), 0.4, 0.02);
}

// Both light each complex pixel's samples; one averages them in a pass of its own.
TEST(TileResolve, GivesTheImageOfAPassOfItsOwn) {
  const FrameRequest request = small_frame();
  const auto image = [&](const std::string& options) {
    const auto technique =
        parse_technique("deferred_simple_complex:lighting=compute,layout=gb_mrt4," + options);
    return emulate(build_frame(technique, request), request.features, request.functional, {}).color;
  };
  for (const char* samples : {"samples=2", "samples=4", "samples=8"}) {
    const Image apart = image(std::string(samples)), inside = image(std::string(samples) + ",resolve=tiles");
    float worst = 0.0f;
    for (std::size_t i = 0; i < apart.pixels.size(); ++i)
      worst = std::max(worst, glm::length(apart.pixels[i] - inside.pixels[i]));
    EXPECT_LT(worst, 0.01f) << samples;
  }
}

TEST(TileLight, ReadsTargetsThatWereDrawnAndHasTheRegistersOfOnePhase) {
  FrameRequest request = small_frame();
  request.shadows = false;
  const auto technique = parse_technique(
      "deferred_simple_complex:samples=4,lighting=compute,resolve=tiles,layout=gb_mrt4,prepass=on");
  const Emulation e = emulate(build_frame(technique, request), request.features, request.functional, {});
  for (const PassWork& pass : e.trace.passes) {
    if (pass.name == "present") {
      EXPECT_TRUE(pass.read_targets.empty()) << "what shaders stored is raw";
    }
    if (pass.name != "light_tiles") continue;
    const PassCounters sum = total(pass);
    EXPECT_EQ(sum.shader.register_lanes % sum.stats.compute_shader_invocations, 0u);
    EXPECT_LE(sum.shader.register_lanes / sum.stats.compute_shader_invocations, 63u)
        << "a phase needs so many, not all together";
    ASSERT_EQ(pass.read_targets.size(), 5u) << "four of color, one of depth";
    for (const ReadTargetWork& target : pass.read_targets) {
      EXPECT_EQ(target.samples, 4);
      EXPECT_EQ(target.pixels, 173u * 97u);
    }
  }
}

}  // namespace
}  // namespace hwsim::algos
