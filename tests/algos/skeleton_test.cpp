// The skeleton that new techniques are copied from: its image, its counter and its note.
#include "algos/skeleton/skeleton.h"

#include <gtest/gtest.h>

#include "algos/frame_run.h"
#include "algos/skeleton/options.h"
#include "algos/skeleton/shaders/counters.h"

namespace hwsim::algos::test {
namespace {

pipeline::Emulation run(const TechniqueInfo& technique, const Options& options) {
  FrameRequest request;
  request.scene = hwsim::test::generated_scene("sponza_hall:bays=2");
  request.width_px = 96;
  request.height_px = 54;
  request.shadow_map_px = 128;
  return pipeline::emulate(technique.build(request, options), GpuFeatures{}, FunctionalConfig{}, {});
}

pipeline::Emulation run(const SkeletonOptions& options) {
  return run(skeleton_room().techniques.front(), Options(options));
}

std::uint64_t mixed_pixels(const pipeline::Emulation& e) {
  return total(e.trace).technique[SkeletonCounters::skeleton_mixed_pixels];
}

std::vector<Diagnostic> notes_of(const pipeline::Emulation& e) {
  return skeleton_room().techniques.front().notes(Options(SkeletonOptions{}), {e.trace, {}});
}

// A mean of equal colors is the color: resolving only where colors differ changes nothing but rounding.
TEST(Skeleton, IsMultisampling) {
  const pipeline::Emulation e = run({});
  const TechniqueChoice choice = parse_technique("msaa4x");
  const pipeline::Emulation msaa = run(*choice.base().info, choice.base().options);
  EXPECT_GT(mixed_pixels(e), 50u);
  EXPECT_LT(mixed_pixels(e), 96u * 54u);
  for (std::size_t i = 0; i < msaa.color.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(e.color.pixels[i][c], msaa.color.pixels[i][c], 0.01f) << "pixel " << i;
}

TEST(Skeleton, CountsNoPixelThatItDoesNotAverage) {
  SkeletonOptions tolerant;
  tolerant.tolerance = 1.0;
  const pipeline::Emulation first_samples = run(tolerant), averaged = run({});
  EXPECT_EQ(mixed_pixels(first_samples), 0u);
  std::uint64_t changed = 0;
  for (std::size_t i = 0; i < averaged.color.pixels.size(); ++i)
    changed += averaged.color.pixels[i] != first_samples.color.pixels[i] ? 1 : 0;
  EXPECT_GT(changed, 0u);
  EXPECT_LE(changed, mixed_pixels(averaged));
}

TEST(Skeleton, TellsWhatItAveraged) {
  const pipeline::Emulation e = run({});
  const std::vector<Diagnostic> notes = notes_of(e);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].code, "T199");
  EXPECT_EQ(notes[0].message, std::to_string(mixed_pixels(e)) + " pixels hold several colors in 4 samples");
  EXPECT_TRUE(notes_of(pipeline::Emulation{}).empty());
}

TEST(Skeleton, ItsCounterIsNobodyElses) {
  for (const Room& room : rooms())
    for (const DeclaredCounter& c : room.counters)
      EXPECT_NE(c.counter.slot, SkeletonCounters::skeleton_mixed_pixels.slot) << c.id;
  for (const TechniqueInfo& t : techniques()) EXPECT_NE(t.id, "skeleton");
}

TEST(Skeleton, ItsLawIsChecked) {
  PassCounters c;
  c.technique[SkeletonCounters::skeleton_mixed_pixels] = 1;
  EXPECT_EQ(violations(c, skeleton_room().laws).size(), 1u);
  c.ps.invocations = 1;
  EXPECT_TRUE(violations(c, skeleton_room().laws).empty());
}

}  // namespace
}  // namespace hwsim::algos::test
