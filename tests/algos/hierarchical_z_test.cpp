// Without the coarse depth test the image is the same, and every covered sample is tested.
#include <gtest/gtest.h>

#include "algos/frame_run.h"

namespace hwsim::test {
namespace {

TEST(HierarchicalZ, OffGivesTheSameImageAndTestsEverySample) {
  for (const std::string technique : {"none", "msaa4x", "deferred_simple_complex"}) {
    const pipeline::FrameGraph graph = build_graph({technique, "sponza_hall", 160, 90});
    FunctionalConfig without;
    without.hierarchical_z = false;
    const pipeline::Emulation on = pipeline::emulate(graph, GpuFeatures{}, FunctionalConfig{}, {});
    const pipeline::Emulation off = pipeline::emulate(graph, GpuFeatures{}, without, {});
    EXPECT_EQ(difference(on.color, off.color, "color"), "") << technique;
    const PassCounters with = total(on.trace), plain = total(off.trace);
    EXPECT_GT(with.hiz.killed_tiles, 0u) << technique;
    EXPECT_EQ(plain.hiz.tested_tiles, 0u) << technique;
    EXPECT_GT(plain.zrop.early_z_tested_samples, with.zrop.early_z_tested_samples) << technique;
    EXPECT_EQ(plain.stats.samples_passed, with.stats.samples_passed) << technique;
    EXPECT_EQ(plain.ps.invocations, with.ps.invocations) << technique;
  }
}

}  // namespace
}  // namespace hwsim::test
