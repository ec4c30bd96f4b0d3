// CMAA and MLAA on steps whose blended colors are known, and the memory of their tables.
#include <gtest/gtest.h>

#include "algos/picture.h"
#include "support/frames.h"

namespace hwsim::test {
namespace {

/// White below black, with a step down of one pixel in the middle.
Picture step(int width = 64) {
  Picture p(width, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < width; ++x) p.at(x, y).fill(y > 12 + (x >= width / 2 ? 1 : 0) ? 255 : 0);
  return p;
}

std::uint64_t bytes_of(const std::string& technique, const Picture& p) {
  const pipeline::FrameGraph graph = algos::build_frame(algos::parse_technique(technique), image_request(p));
  std::uint64_t bytes = 0;
  for (const pipeline::ImageDesc& image : graph.images()) bytes += pipeline::allocated_bytes(image);
  return bytes;
}

TEST(Mlaa, BlendsALongStepByTheAreasUnderItsLine) {
  const Picture p = step();
  const Picture f = filter(p, "mlaa").picture;
  for (int x = 0; x < 64; ++x) {
    // The line goes from the middle of the run on the left to that of the run on the right, 32 pixels.
    const double t = (x + 0.5 - 16.0) / 32.0;
    double white = x < 16 ? 1.0 : x >= 48 ? 0.0 : 1.0 - t;
    if (x == 31 || x == 32)
      white = 0.875 * white + (x == 32 ? 0.125 : 0.0);  // the step itself, a run of one pixel
    EXPECT_NEAR(f.at(x, 13)[0], 255.0 * std::sqrt(white), 1.0) << x;
    EXPECT_EQ(f.at(x, 12), p.at(x, 12));
    EXPECT_EQ(f.at(x, 14), p.at(x, 14));
  }
}

TEST(Mlaa, ShortCountsReachAsFarAsTheirBits) {
  const Picture p = step();
  const Picture f = filter(p, "mlaa:count_bits=4").picture;
  for (int x = 0; x < 64; ++x)
    if (x < 32 - 8 || x >= 32 + 8) {
      EXPECT_EQ(f.at(x, 13), p.at(x, 13)) << x;
    }
  EXPECT_NE(f.at(31, 13), p.at(31, 13));
  EXPECT_NE(f.at(32, 13), p.at(32, 13));
}

TEST(Mlaa, IsTheSameForTransposedSteps) {
  const Picture p = step();
  EXPECT_EQ(transposed(filter(transposed(p), "mlaa").picture), filter(p, "mlaa").picture);
}

TEST(Mlaa, TakesTheMemoryOfItsTable) {
  const Picture p(64, 32);
  EXPECT_EQ(bytes_of("mlaa", p), 64u * 32u * (8 + 5));
  EXPECT_EQ(bytes_of("mlaa:count_bits=4", p), 64u * 32u * (8 + 3));
}

TEST(Cmaa, BlendsALongStepAndKeepsItsMean) {
  const Picture p = step();
  const Picture f = filter(p, "cmaa").picture;
  int before = 0, after = 0, changed = 0;
  for (int x = 0; x < 64; ++x) {
    before += p.at(x, 13)[0];
    after += f.at(x, 13)[0];
    changed += p.at(x, 13) != f.at(x, 13) ? 1 : 0;
    if (x > 0) {
      EXPECT_LE(f.at(x, 13)[0], f.at(x - 1, 13)[0]) << x;
    }
  }
  EXPECT_GT(changed, 16);
  EXPECT_NEAR(after, before, 64);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      if (y != 13) {
        EXPECT_EQ(f.at(x, y), p.at(x, y)) << x << ", " << y;
      }
    }
}

TEST(Cmaa, IsTheSameForTransposedSteps) {
  const Picture p = step();
  EXPECT_EQ(transposed(filter(transposed(p), "cmaa").picture), filter(p, "cmaa").picture);
}

TEST(Cmaa, LeavesStrokesOfAPixel) {
  const Picture p =
      gray(64, 48, [](int x, int y) { return (x % 8 == 3 || y == 20) && y > 4 && y < 44 ? 20 : 230; });
  const Picture f = filter(p, "cmaa").picture;
  for (int y = 8; y < 40; ++y)
    for (int x = 0; x < 64; ++x)
      if (std::abs(y - 20) > 1) {
        EXPECT_EQ(f.at(x, y), p.at(x, y)) << x << ", " << y;
      }
}

TEST(Cmaa, TakesTheMemoryOfItsTableAndWorksInPlace) {
  const Picture p(64, 32);
  EXPECT_EQ(bytes_of("cmaa", p), 64u * 32u * 4 + 64u * 32u * 15 / 2);
}

/// The pass that combines gives the depth that is tested, so nothing rejects a quad before it.
TEST(Cmaa, LaterPassesRunOnlyWhereEdgesAreButForCombining) {
  const Picture p = step(128);
  const Filtered f = filter(p, "cmaa");
  const auto counters = [&](const std::string& name) {
    for (const PassWork& pass : f.trace.passes)
      if (pass.name == name) return total(pass);
    return PassCounters{};
  };
  const auto invocations = [&](const std::string& name) { return counters(name).ps.invocations; };
  EXPECT_EQ(invocations("cmaa_edges"), 64u * 16u);
  EXPECT_GE(invocations("cmaa_prune"), 64u);  // the quads of one row, and those of the other half
  EXPECT_LE(invocations("cmaa_prune"), 130u);
  EXPECT_EQ(invocations("cmaa_combine"), 64u * 16u);
  EXPECT_LT(invocations("cmaa_blend"), 8u);
  const PassCounters combine = counters("cmaa_combine");
  EXPECT_EQ(combine.hiz.tested_tiles, 0u);
  EXPECT_EQ(combine.zrop.late_z_tested_samples, 64u * 16u);
  // What passes are marked quads that lose their mark.
  EXPECT_EQ(combine.zrop.late_z_tested_samples - combine.zrop.late_z_killed_samples,
            invocations("cmaa_prune") - invocations("cmaa_blend"));
}

/// Edges have a byte a pixel and are stored everywhere; the colors that blending stores have four.
TEST(Cmaa, StoresABytePerPixelWhereItCombines) {
  const Filtered f = filter(step(128), "cmaa");
  const auto shader = [&](const std::string& name) { return total(pass_named(f.trace, name)).shader; };
  EXPECT_EQ(shader("cmaa_combine").narrow_store_lane_ops, 128u * 32u);
  EXPECT_EQ(shader("cmaa_blend").narrow_store_lane_ops, 0u);
  EXPECT_GT(shader("cmaa_blend").store_lane_ops, 0u);
}

}  // namespace
}  // namespace hwsim::test
