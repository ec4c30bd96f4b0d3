// The ray-traced reference and the emulated pipeline draw the same scene by the same shader: what is left
// between them is aliasing, so more samples bring the pipeline closer.
#include "algos/base/reference_frame.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "algos/techniques.h"
#include "hwsim/gpu/every_feature.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/image/metrics.h"
#include "pipeline/open/scene_source.h"
#include "support/places.h"

namespace hwsim::algos {
namespace {

FrameRequest hall_request() {
  FrameRequest request;
  request.scene = std::make_shared<const pipeline::Scene>(
      pipeline::open_scene("sponza_hall:bays=3,detail=4", hwsim::test::binary_dir() + "/test-cache/scenes"));
  request.width_px = 128;
  request.height_px = 72;
  return request;
}

double psnr_db(const std::string& technique, const FrameRequest& request, const pipeline::Image& reference) {
  const pipeline::FrameGraph graph = build_frame(parse_technique(technique), request);
  const pipeline::Emulation frame = pipeline::emulate(graph, request.features, request.functional, {});
  return pipeline::compare(frame.color, reference).psnr_db;
}

TEST(ReferenceFrame, SupersamplingApproachesIt) {
  const FrameRequest request = hall_request();
  const pipeline::Image reference = render_reference_frame(request, {.samples = 64});
  const double none = psnr_db("none", request, reference), ssaa4 = psnr_db("ssaa4x", request, reference);
  const double ssaa64 = psnr_db("ssaa64x", request, reference);
  EXPECT_GT(ssaa4, none + 1.0);
  EXPECT_GT(ssaa64, ssaa4 + 1.0);
  EXPECT_GT(ssaa64, 38.0);  // textures and the 8 bits of the frame are left
}

TEST(ReferenceFrame, LooksUpTheFramesShadowMapUnlessRaysAreAskedFor) {
  const FrameRequest request = hall_request();
  const pipeline::Image by_map = render_reference_frame(request, {.samples = 64});
  const pipeline::Image by_rays =
      render_reference_frame(request, {.samples = 64, .shadows = ReferenceShadows::rays});
  // The map's texels are a larger error than what 64 samples leave.
  EXPECT_GT(psnr_db("ssaa64x", request, by_map), psnr_db("ssaa64x", request, by_rays) + 4.0);
  FrameRequest finer = request;
  finer.shadow_map_px = 4096;
  EXPECT_GT(pipeline::compare(render_reference_frame(finer, {.samples = 64}), by_rays).psnr_db,
            pipeline::compare(by_map, by_rays).psnr_db + 3.0);
}

// Layers that shaded beside what they sampled, and filtered textures for whole pixels, did.
TEST(ReferenceFrame, MoreSamplesInLayersDoNotLookWorse) {
  FrameRequest request = hall_request();
  request.features = every_feature(8);
  const pipeline::Image reference = render_reference_frame(request, {.samples = 64});
  const auto error = [&](const std::string& technique) {
    const pipeline::FrameGraph graph = build_frame(parse_technique(technique), request);
    return pipeline::compare(pipeline::emulate(graph, request.features, request.functional, {}).color,
                             reference);
  };
  const pipeline::ImageError eight = error("msaa8x"), sixteen = error("msaa16x"),
                             thirty_two = error("msaa32x");
  EXPECT_GT(sixteen.psnr_db, eight.psnr_db);
  EXPECT_GT(thirty_two.psnr_db, sixteen.psnr_db);
  EXPECT_LT(thirty_two.flip_mean, eight.flip_mean);
}

TEST(ReferenceFrame, ShadowsAndPointLightsAreThoseOfTheRequest) {
  FrameRequest request = hall_request();
  request.shadows = false;
  request.point_lights = 8;
  const pipeline::Image reference = render_reference_frame(request, {.samples = 64});
  const double alike = psnr_db("ssaa64x", request, reference);
  EXPECT_GT(alike, 40.0);  // without a shadow map only textures and edges differ
  request.point_lights = 0;
  EXPECT_LT(psnr_db("ssaa64x", request, reference), alike - 5.0);
}

TEST(FrameLights, SixteenOfFullReachLeaveLittleOfTheFrameWhite) {
  FrameRequest request;
  request.scene = std::make_shared<const pipeline::Scene>(
      pipeline::open_scene("bamboo", hwsim::test::binary_dir() + "/test-cache/scenes"));
  request.width_px = 160;
  request.height_px = 90;
  request.lights = LightProfile::complex;
  request.light_range = 1.0;
  const pipeline::Image frame = pipeline::emulate(build_frame(parse_technique("none"), request),
                                                  request.features, request.functional, {})
                                    .color;
  const auto white = std::count_if(frame.pixels.begin(), frame.pixels.end(), [](const glm::vec4& p) {
    return p.x >= 1.0f || p.y >= 1.0f || p.z >= 1.0f;
  });
  EXPECT_LT(white, static_cast<long>(frame.pixels.size() / 50));
}

TEST(ReferenceFrame, NumberOfThreadsChangesNoBit) {
  const FrameRequest request = hall_request();
  EXPECT_TRUE(render_reference_frame(request, {.samples = 4, .jobs = 1}).pixels ==
              render_reference_frame(request, {.samples = 4, .jobs = 3}).pixels);
}

}  // namespace
}  // namespace hwsim::algos
