#include "hwsim/trace/counters.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "hwsim/trace/work_trace.h"

namespace hwsim {
namespace {

TEST(Catalog, IdsAreUniqueAndSayTheirUnitAndName) {
  std::set<std::string_view> ids;
  for (const CounterInfo& info : counter_catalog()) {
    EXPECT_TRUE(ids.insert(info.id).second) << info.id;
    EXPECT_EQ(info.id, std::string(info.unit) + "." + std::string(info.name));
    EXPECT_FALSE(info.description.empty());
    EXPECT_EQ(info.unit_kind, info.name.ends_with("_bytes") ? "bytes" : "generic");
  }
  EXPECT_EQ(ids.size(), kCounterCount);
}

// Each field, written through its name, is found at the place of its id in the flat array.
TEST(Catalog, OrderIsThatOfValues) {
  std::vector<std::string> ids;
  std::vector<std::size_t> places;
  PassCounters c;
  const auto remember = [&](const char* id, std::uint64_t& field) {
    ids.emplace_back(id);
    field = 1;
    const auto flat = values(std::as_const(c));
    for (std::size_t i = 0; i < flat.size(); ++i)
      if (flat[i] == 1) places.push_back(i);
    field = 0;
  };
#define REMEMBER(name, text) remember(#name, unit.name);
#define REMEMBER_UNIT(Prefix, id, LIST) \
  {                                     \
    auto& unit = c.id;                  \
    LIST(REMEMBER)                      \
  }
  HWSIM_COUNTER_UNITS(REMEMBER_UNIT)
#undef REMEMBER_UNIT
  for (std::size_t slot = 0; slot < kTechniqueCounterSlots; ++slot)
    remember(("slot_" + std::to_string(slot)).c_str(), c.technique[TechniqueCounter{slot}]);
#undef REMEMBER
  ASSERT_EQ(places.size(), kCounterCount);
  for (std::size_t i = 0; i < kCounterCount; ++i) {
    EXPECT_EQ(places[i], i);
    EXPECT_EQ(counter_catalog()[i].name, ids[i]);
  }
}

TEST(Counters, SumsAddEveryField) {
  PassCounters a;
  std::uint64_t n = 0;
  for (std::uint64_t& value : values(a)) value = ++n;
  PassWork pass;
  pass.chunks = {a, a, a};
  const PassCounters sum = total(pass);
  n = 0;
  for (const std::uint64_t value : values(sum)) EXPECT_EQ(value, 3 * ++n);
}

PassCounters lawful() {
  PassCounters c;
  c.setup.in_primitives = 10;
  c.setup.culled_backface_primitives = 4;
  c.setup.out_primitives = 6;
  c.hiz.tested_tiles = 9;
  c.hiz.killed_tiles = 2;
  c.hiz.accepted_tiles = 3;
  c.hiz.ambiguous_tiles = 4;
  c.raster.covered_samples = 100;
  c.raster.fragments = 40;
  c.raster.quads = 12;
  c.raster.partial_quads = 5;
  c.zrop.early_z_tested_samples = c.zrop.late_z_tested_samples = 50;
  c.zrop.early_z_killed_samples = c.zrop.late_z_killed_samples = 20;
  c.zrop.touched_tiles = c.crop.touched_tiles = 8;
  c.zrop.first_touched_tiles = c.crop.first_touched_tiles = 7;
  c.ps.invocations = 40;
  c.ps.helper_invocations = 8;
  c.ps.discarded_invocations = 3;
  c.stats.fragment_shader_invocations = 48;
  c.shader.alu_lane_ops = 100;
  c.shader.alu_issued_lane_ops_w8 = 110;
  c.shader.alu_issued_lane_ops_w64 = 120;
  c.crop.written_samples = 30;
  c.crop.blended_samples = 30;
  c.tex.texels = 64;
  return c;
}

using Break = void (*)(PassCounters&);

TEST(Conservation, LawfulCountersPassAndEachBrokenLawIsFoundAlone) {
  EXPECT_TRUE(violations(lawful(), unit_laws()).empty());
  const std::pair<const char*, Break> cases[] = {
      {"setup.in", [](PassCounters& c) { c.setup.culled_frustum_primitives = 1; }},
      {"hiz.tested", [](PassCounters& c) { ++c.hiz.tested_tiles; }},
      {"early_z_killed", [](PassCounters& c) { c.zrop.early_z_killed_samples = 51; }},
      {"late_z_killed", [](PassCounters& c) { c.zrop.late_z_killed_samples = 51; }},
      {"early_z_tested_samples <= raster", [](PassCounters& c) { c.zrop.early_z_tested_samples = 101; }},
      {"raster.fragments <= raster.covered",
       [](PassCounters& c) { c.raster.covered_samples = 39, c.zrop.early_z_tested_samples = 39; }},
      {"raster.fragments <= 4", [](PassCounters& c) { c.raster.fragments = 49; }},
      {"partial_quads", [](PassCounters& c) { c.raster.partial_quads = 13; }},
      {"helper_invocations", [](PassCounters& c) { ++c.ps.helper_invocations; }},
      {"discarded", [](PassCounters& c) { c.ps.discarded_invocations = 41; }},
      {"shader.alu_lane_ops", [](PassCounters& c) { c.shader.alu_lane_ops = 111; }},
      {"alu_issued_lane_ops_w64", [](PassCounters& c) { c.shader.alu_issued_lane_ops_w64 = 109; }},
      {"narrow_store", [](PassCounters& c) { c.shader.narrow_store_lane_ops = 1; }},
      {"same_address", [](PassCounters& c) { c.shader.same_address_atomic_lane_ops = 1; }},
      {"blended", [](PassCounters& c) { c.crop.blended_samples = 31; }},
      {"zrop.first_touched", [](PassCounters& c) { c.zrop.first_touched_tiles = 9; }},
      {"crop.first_touched", [](PassCounters& c) { c.crop.first_touched_tiles = 9; }},
  };
  for (const auto& [law, damage] : cases) {
    PassCounters c = lawful();
    damage(c);
    const auto found = violations(c, unit_laws());
    ASSERT_EQ(found.size(), 1u) << law;
    EXPECT_NE(found[0].law.find(law), std::string_view::npos) << found[0].law;
    EXPECT_NE(found[0].left, found[0].right);
  }
}

TEST(Conservation, EveryBrokenLawIsReported) {
  PassCounters c = lawful();
  c.setup.in_primitives = c.hiz.tested_tiles = 99;
  EXPECT_EQ(violations(c, unit_laws()).size(), 2u);
}

}  // namespace
}  // namespace hwsim
