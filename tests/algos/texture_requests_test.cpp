// Frames take their shadows by comparison samplers, and textures along the longer axis of a footprint where
// that is asked for.
#include <gtest/gtest.h>

#include "algos/techniques.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/image/metrics.h"
#include "pipeline/open/scene_source.h"
#include "support/places.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

FrameRequest hall(int max_anisotropy) {
  SceneLoadOptions options;
  options.max_anisotropy = max_anisotropy;
  FrameRequest request;
  request.scene = std::make_shared<const Scene>(
      open_scene("sponza_hall", hwsim::test::binary_dir() + "/test-cache/scenes", options));
  request.width_px = 160;
  request.height_px = 90;
  return request;
}

PassCounters work_of(const Emulation& e, const std::string& pass) {
  for (const PassWork& work : e.trace.passes)
    if (work.name == pass) return total(work);
  ADD_FAILURE() << "no pass " << pass;
  return {};
}

Emulation run(const FrameRequest& request, const std::string& technique) {
  return emulate(build_frame(parse_technique(technique), request), request.features, request.functional, {});
}

TEST(ShadowLookup, IsOneComparisonOfALitSample) {
  const FrameRequest request = hall(1);
  for (const auto& [technique, pass] :
       {std::pair{"none", "forward"}, std::pair{"deferred:samples=1", "light"}}) {
    const PassCounters n = work_of(run(request, technique), pass);
    EXPECT_GT(n.tex.comparisons, 0u) << technique;
    EXPECT_LE(n.tex.comparisons, n.ps.invocations + n.ps.helper_invocations) << technique;
    if (std::string(technique) == "none") {
      EXPECT_EQ(n.tex.fetched_32bit_texels, 0u) << "the shadow map is read by the sampler alone";
    }
  }
}

TEST(Anisotropy, ReachesEverySamplerThatFiltersLinearly) {
  for (const int probes : {1, 4, 16}) {
    const FrameRequest request = hall(probes);
    for (const Sampler& sampler : request.scene->samplers)
      EXPECT_EQ(sampler.max_anisotropy, sampler.min == Filter::linear ? probes : 1);
  }
}

TEST(Anisotropy, CostsAProbeForEachSampleTakenAndNothingElse) {
  const PassCounters one = work_of(run(hall(1), "none"), "forward");
  const PassCounters four = work_of(run(hall(4), "none"), "forward");
  const PassCounters all = work_of(run(hall(16), "none"), "forward");
  EXPECT_EQ(one.tex.requests, all.tex.requests);
  EXPECT_EQ(one.ps.invocations, all.ps.invocations);
  EXPECT_EQ(one.shader.alu_lane_ops, all.shader.alu_lane_ops);
  EXPECT_GT(four.tex.bilinear_probes, one.tex.bilinear_probes);
  EXPECT_GE(all.tex.bilinear_probes, four.tex.bilinear_probes);
  EXPECT_LE(all.tex.bilinear_probes, 32 * one.tex.requests) << "16 probes of two levels at most";
  EXPECT_EQ(all.tex.texels, 4 * (all.tex.bilinear_probes + all.tex.comparisons));
}

}  // namespace
}  // namespace hwsim::algos
