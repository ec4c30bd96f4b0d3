// The ray-traced reference and the emulated pipeline draw the same scene by the same shader: what is left
// between them is aliasing, so more samples bring the pipeline closer.
#include "algos/base/reference_frame.h"

#include <gtest/gtest.h>

#include "algos/techniques.h"
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
  EXPECT_GT(ssaa64, 32.0);  // the rest: shadow-map texels against shadow rays
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

TEST(ReferenceFrame, NumberOfThreadsChangesNoBit) {
  const FrameRequest request = hall_request();
  EXPECT_TRUE(render_reference_frame(request, {.samples = 4, .jobs = 1}).pixels ==
              render_reference_frame(request, {.samples = 4, .jobs = 3}).pixels);
}

}  // namespace
}  // namespace hwsim::algos
