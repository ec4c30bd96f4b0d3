// The list of hardware units: its order, and what the documents say about each.
#include "hwsim/units/units.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "hwsim/gpu/gpu_rates.h"
#include "hwsim/sample_gpu.h"
#include "support/places.h"

namespace hwsim::test {
namespace {

TEST(Units, StandInTheOrderOfTheirPlacesAndHaveNamesOfTheirOwn) {
  std::set<std::string_view> ids;
  for (std::size_t u = 0; u < kUnits.size(); ++u) {
    EXPECT_TRUE(ids.insert(kUnits[u].id).second) << kUnits[u].id;
    if (u == 0) continue;
    EXPECT_LE(kUnits[u - 1].place, kUnits[u].place) << kUnits[u].id;
  }
  std::size_t count = 0;
  for (const UnitPlace place : {UnitPlace::front, UnitPlace::cores, UnitPlace::rops, UnitPlace::memory})
    count += count_units(place);
  EXPECT_EQ(count, kUnits.size());
  EXPECT_EQ(units_of<UnitPlace::memory>().front(), Unit::l2);
}

TEST(Units, AreDescribedInTheHardwareModelByTheWordsOfTheirHeaders) {
  std::ifstream file(source_dir() + "/docs/hardware_model.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  for (const UnitInfo& unit : kUnits) {
    const std::string row = "\n| `" + std::string(unit.id) + "` | " + std::string(unit.service) + " |\n";
    EXPECT_NE(page.find(row), std::string::npos) << "docs/hardware_model.md lacks the row" << row;
  }
}

TEST(Units, AllServeAChunkThatAsksThemAll) {
  const PassWork pass = busy_pass(1);
  ChunkTraffic<double> traffic;
  traffic.l2_bytes = traffic.dram.read[index_of(Stream::color)] = 1000.0;
  const auto ns =
      service_times_ns(UnitWork<double>{pass.chunks[0], pass, traffic}, derive_rates<double>(sample_gpu()));
  for (std::size_t u = 0; u < ns.size(); ++u) EXPECT_GT(ns[u], 0.0) << kUnits[u].id;
}

}  // namespace
}  // namespace hwsim::test
