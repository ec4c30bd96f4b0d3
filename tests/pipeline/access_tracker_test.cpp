// A worker that keeps a bounded sample of its accesses gives the profile that all of them give.
#include "pipeline/access/access_tracker.h"

#include <gtest/gtest.h>

#include <random>

namespace hwsim::pipeline {
namespace {

BlockKinds followed_kinds() {
  BlockKinds kinds;
  kinds[index_of(ReuseStream::color)] = {4096, false, 1};
  kinds[index_of(ReuseStream::depth)] = {2048, false, 2};
  return kinds;
}

/// Far more accesses than are kept of texture and color, few of depth; many follow one to the same block,
/// some with one to another block between them.
void note(AccessTracker& tracker, std::uint32_t first_bin) {
  std::mt19937 random(first_bin);
  for (std::uint32_t bin = first_bin; bin < first_bin + 64; ++bin) {
    tracker.start_bin(bin);
    for (std::uint32_t primitive = 0; primitive < 40; ++primitive) {
      tracker.start_primitive(primitive);
      for (int i = 0; i < 40; ++i) {
        const auto near = static_cast<std::uint32_t>(bin * 16 + random() % 64);
        const auto stream = i % 3 == 0 ? ReuseStream::color : ReuseStream::texture;
        tracker.touch_if_sampled(stream, near, stream == ReuseStream::texture ? 64 : 0, 128);
        if (i % 5 == 0) tracker.touch_if_sampled(stream, near + 1, 64, 0);
        tracker.touch_if_sampled(stream, near, 64, 64);
      }
      tracker.touch_if_sampled(ReuseStream::depth, bin * 7 + primitive % 7, 32, 32);
    }
  }
}

ReuseProfile profile(std::size_t accesses_max, int workers) {
  std::vector<AccessTracker> trackers(static_cast<std::size_t>(workers));
  std::vector<AccessTracker*> all;
  for (AccessTracker& tracker : trackers) {
    tracker.start_pass(followed_kinds(), false, accesses_max);
    all.push_back(&tracker);
  }
  for (std::uint32_t part = 0; part < 4; ++part)
    note(trackers[part % static_cast<std::uint32_t>(workers)], part * 64);
  if (accesses_max == SIZE_MAX) {
    EXPECT_GT(trackers.front().accesses.size(), 4 * kAccessesMax) << "there is nothing to bound";
  } else {
    for (const AccessTracker& tracker : trackers)
      EXPECT_LE(tracker.accesses.size(), kReuseStreams * accesses_max);
  }
  return make_reuse_profile(all, false, 1);
}

TEST(AccessTracker, ABoundedSampleGivesTheSameProfile) {
  const ReuseProfile all = profile(SIZE_MAX, 1);
  EXPECT_EQ(profile(kAccessesMax, 1), all);
  EXPECT_EQ(profile(kAccessesMax, 2), all);
  EXPECT_EQ(profile(kAccessesMax, 3), all);
  EXPECT_GT(all.apart[index_of(ReuseStream::color)].requested_write_bytes, 0u);
}

TEST(AccessTracker, APassBeginsWithNothingOfTheLast) {
  AccessTracker tracker;
  tracker.start_pass(followed_kinds(), false, kAccessesMax);
  note(tracker, 0);
  tracker.start_pass(followed_kinds(), false, kAccessesMax);
  note(tracker, 64);
  AccessTracker fresh;
  fresh.start_pass(followed_kinds(), false, kAccessesMax);
  note(fresh, 64);
  AccessTracker* used[] = {&tracker};
  AccessTracker* unused[] = {&fresh};
  EXPECT_EQ(make_reuse_profile(used, false, 1), make_reuse_profile(unused, false, 1));
}

}  // namespace
}  // namespace hwsim::pipeline
