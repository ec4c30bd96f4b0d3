#include "hwsim/timing/tandem_queue.h"

#include <gtest/gtest.h>

#include <numeric>

namespace hwsim {
namespace {

ServiceTable<double> table(std::size_t units, std::vector<double> ns) {
  return {units, ns.size() / units, std::move(ns)};
}

TEST(TandemQueue, EqualsTheRecurrenceWorkedOutByHand) {
  // chunk 0: 2 3 1, chunk 1: 4 1 2, chunk 2: 1 5 1
  // done:    2 5 6,          6 7 9,          7 12 13
  const auto services = table(3, {2, 3, 1, 4, 1, 2, 1, 5, 1});
  const QueueResult<double> r = TandemQueue<double>(services, 8).run();
  EXPECT_DOUBLE_EQ(r.makespan_ns, 13.0);
  EXPECT_EQ(r.critical_ns,
            (std::vector<double>{6, 6, 1}));  // 2 4 | 1 5 | 1: the tie at 7 goes to the busy unit
}

TEST(TandemQueue, AFullQueueBlocksTheUnitBefore) {
  // Depth 1: unit 0 may start chunk k only when unit 1 has finished chunk k-1.
  const auto services = table(2, {1, 10, 1, 10, 1, 10});
  EXPECT_DOUBLE_EQ(TandemQueue<double>(services, 1).run().makespan_ns, 33.0);
  EXPECT_DOUBLE_EQ(TandemQueue<double>(services, 2).run().makespan_ns, 31.0);
}

TEST(TandemQueue, OneLimitingUnitGivesItsSumAndTheFillOfTheOthers) {
  std::vector<double> ns;
  for (int k = 0; k < 50; ++k) ns.insert(ns.end(), {1.0, 2.0, 9.0, 3.0});
  const QueueResult<double> r = TandemQueue<double>(table(4, ns), 4).run();
  EXPECT_DOUBLE_EQ(r.makespan_ns, 50 * 9.0 + 1 + 2 + 3);
  EXPECT_DOUBLE_EQ(r.critical_ns[2], 450.0);
}

TEST(TandemQueue, CriticalPathSumsToTheMakespan) {
  std::vector<double> ns;
  unsigned state = 7;
  for (int i = 0; i < 5 * 300; ++i)
    ns.push_back(static_cast<double>((state = state * 1664525u + 1013904223u) >> 24));
  for (const std::size_t depth : {1u, 2u, 5u}) {
    const QueueResult<double> r = TandemQueue<double>(table(5, ns), depth).run();
    EXPECT_NEAR(std::accumulate(r.critical_ns.begin(), r.critical_ns.end(), 0.0), r.makespan_ns, 1e-6);
  }
}

TEST(TandemQueue, NothingToDoTakesNoTime) {
  EXPECT_DOUBLE_EQ(TandemQueue<double>(table(3, {}), 2).run().makespan_ns, 0.0);
}

}  // namespace
}  // namespace hwsim
