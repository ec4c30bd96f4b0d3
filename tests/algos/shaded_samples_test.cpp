// SBAA (Salvi, Vidimce 2012), Table 3: samples that the deferred reference lights at 1280x720 and 8x. The
// generated stand-ins hold them, with attributes at pixel centers.
#include <gtest/gtest.h>

#include <cstdio>

#include "algos/frame_run.h"

namespace hwsim {
namespace {

std::uint64_t lit_samples(const std::string& scene) {
  algos::FrameRequest request;
  request.scene = test::generated_scene(scene);
  request.width_px = 1280;
  request.height_px = 720;
  request.shadows = false;
  const auto choice = algos::parse_technique("deferred_simple_complex:samples=8,centroid=off");
  const auto e =
      pipeline::emulate(algos::build_frame(choice, request), GpuFeatures{}, FunctionalConfig{}, {});
  std::uint64_t lit = 0;
  for (const PassWork& pass : e.trace.passes)
    if (pass.name.rfind("light", 0) == 0) lit += total(pass).ps.invocations;
  return lit;
}

struct Row {
  const char* scene;
  double published;
};

TEST(ShadedSamples, GeneratedScenesHoldThePublishedCounts) {
  // At 4x the same views give +0.6, +1.3 and +0.7 % for SPONZA, POWERPLANT and DRAGON; GRASS prints 2.9 %
  // complex pixels at 4x against 16.5 % at 8x, which cannot be the same view
  // (docs/published_tables.md#contradiction-16).
  const Row rows[] = {
      {"sponza_hall", 1265839}, {"grass", 1987385}, {"powerplant", 1447662}, {"dragon", 999965}};
  for (const Row& row : rows) {
    const double ratio = static_cast<double>(lit_samples(row.scene)) / row.published;
    std::printf("%s 8x: %+.2f %%\n", row.scene, 100.0 * (ratio - 1.0));
    EXPECT_NEAR(ratio, 1.0, 0.02) << row.scene;
  }
}

}  // namespace
}  // namespace hwsim
