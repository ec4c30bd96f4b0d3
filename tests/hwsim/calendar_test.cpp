// A server whose requests come in any order.
#include "hwsim/detailed/calendar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace hwsim {
namespace {

TEST(Calendar, AnUnloadedRequestTakesItsServiceAndNoMore) {
  Calendar calendar(100.0);
  EXPECT_DOUBLE_EQ(calendar.reserve(1000.0, 7.0), 1007.0);
  EXPECT_DOUBLE_EQ(calendar.reserve(0.0, 7.0), 7.0);  // asked for later, but earlier in time: nothing waits
  EXPECT_DOUBLE_EQ(calendar.reserve(250.0, 0.0), 250.0);
  EXPECT_DOUBLE_EQ(calendar.last_ns(), 1007.0);
}

TEST(Calendar, ALoadedServerIsBusyAllTheTime) {
  Calendar calendar(10.0);
  double done = 0.0;
  for (int i = 0; i < 1000; ++i) done = std::max(done, calendar.reserve(0.0, 3.0));
  EXPECT_NEAR(done, 3000.0, 1e-6);
}

TEST(Calendar, TheLastCompletionDoesNotDependOnTheOrder) {
  std::vector<double> at;
  for (int i = 0; i < 500; ++i) at.push_back(static_cast<double>(i * 37 % 500) * 2.0);
  const auto last = [&] {
    Calendar calendar(10.0);
    for (const double ns : at) calendar.reserve(ns, 2.5);
    return calendar.last_ns();
  };
  const double mixed = last();
  std::sort(at.begin(), at.end());
  EXPECT_NEAR(mixed, last(), 1e-6);
  EXPECT_NEAR(mixed, 500 * 2.5, 1e-6);  // one each 2 ns, 2.5 ns each: never idle
}

TEST(Calendar, OneBelowTheGateNothingWaitsAndOneAboveEverythingDoes) {
  const auto worst_wait = [](double service_ns) {
    Calendar calendar(1000.0);
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const double now = 10.0 * i;
      worst = std::max(worst, calendar.reserve(now, service_ns) - now - service_ns);
    }
    return worst;
  };
  EXPECT_LE(worst_wait(9.0), 1e-9);
  EXPECT_LE(worst_wait(10.0), 1e-6);
  EXPECT_NEAR(worst_wait(11.0), 2000.0 - 1.0, 12.0);
}

}  // namespace
}  // namespace hwsim
