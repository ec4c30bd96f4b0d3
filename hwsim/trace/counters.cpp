#include "hwsim/trace/counters.h"

#include <string>

namespace hwsim {
namespace {

constexpr bool is_bytes(std::string_view name) { return name.ends_with("_bytes"); }

#define HWSIM_ENTRY_OF(id, name, text) \
  CounterInfo{#id "." #name, #id, #name, text, is_bytes(#name) ? "bytes" : "generic"},
#define HWSIM_STATS_ENTRY(name, text) HWSIM_ENTRY_OF(stats, name, text)
#define HWSIM_FE_ENTRY(name, text) HWSIM_ENTRY_OF(fe, name, text)
#define HWSIM_VS_ENTRY(name, text) HWSIM_ENTRY_OF(vs, name, text)
#define HWSIM_GS_ENTRY(name, text) HWSIM_ENTRY_OF(gs, name, text)
#define HWSIM_SETUP_ENTRY(name, text) HWSIM_ENTRY_OF(setup, name, text)
#define HWSIM_RASTER_ENTRY(name, text) HWSIM_ENTRY_OF(raster, name, text)
#define HWSIM_HIZ_ENTRY(name, text) HWSIM_ENTRY_OF(hiz, name, text)
#define HWSIM_ZROP_ENTRY(name, text) HWSIM_ENTRY_OF(zrop, name, text)
#define HWSIM_PS_ENTRY(name, text) HWSIM_ENTRY_OF(ps, name, text)
#define HWSIM_SHADER_ENTRY(name, text) HWSIM_ENTRY_OF(shader, name, text)
#define HWSIM_TEX_ENTRY(name, text) HWSIM_ENTRY_OF(tex, name, text)
#define HWSIM_CROP_ENTRY(name, text) HWSIM_ENTRY_OF(crop, name, text)
#define HWSIM_RESOLVE_ENTRY(name, text) HWSIM_ENTRY_OF(resolve, name, text)
#define HWSIM_MEM_ENTRY(name, text) HWSIM_ENTRY_OF(mem, name, text)

// The order is that of HWSIM_COUNTER_UNITS; the assertion below and a test on ids keep them together.
constexpr CounterInfo kUnitCounters[] = {HWSIM_STATS_COUNTERS(HWSIM_STATS_ENTRY)      //
                                         HWSIM_FRONT_END_COUNTERS(HWSIM_FE_ENTRY)     //
                                         HWSIM_VS_COUNTERS(HWSIM_VS_ENTRY)            //
                                         HWSIM_GS_COUNTERS(HWSIM_GS_ENTRY)            //
                                         HWSIM_SETUP_COUNTERS(HWSIM_SETUP_ENTRY)      //
                                         HWSIM_RASTER_COUNTERS(HWSIM_RASTER_ENTRY)    //
                                         HWSIM_HIZ_COUNTERS(HWSIM_HIZ_ENTRY)          //
                                         HWSIM_ZROP_COUNTERS(HWSIM_ZROP_ENTRY)        //
                                         HWSIM_PS_COUNTERS(HWSIM_PS_ENTRY)            //
                                         HWSIM_SHADER_COUNTERS(HWSIM_SHADER_ENTRY)    //
                                         HWSIM_TEX_COUNTERS(HWSIM_TEX_ENTRY)          //
                                         HWSIM_CROP_COUNTERS(HWSIM_CROP_ENTRY)        //
                                         HWSIM_RESOLVE_COUNTERS(HWSIM_RESOLVE_ENTRY)  //
                                         HWSIM_MEM_COUNTERS(HWSIM_MEM_ENTRY)};
static_assert(std::size(kUnitCounters) + kTechniqueCounterSlots == kCounterCount);

/// "technique.slot_0" and so on: ids and the names within them.
std::vector<CounterInfo> catalog_with_slots() {
  static const std::vector<std::string> ids = [] {
    std::vector<std::string> list;
    for (std::size_t slot = 0; slot < kTechniqueCounterSlots; ++slot)
      list.push_back("technique.slot_" + std::to_string(slot));
    return list;
  }();
  std::vector<CounterInfo> catalog(std::begin(kUnitCounters), std::end(kUnitCounters));
  for (const std::string& id : ids)
    catalog.push_back({id, "technique", std::string_view(id).substr(10),
                       "what the technique that has this slot declares", "generic"});
  return catalog;
}

constexpr CounterLaw kUnitLaws[] = {
    HWSIM_LAW_EQUAL("setup.culled_* + setup.out_primitives = setup.in_primitives",
                    c.setup.culled_frustum_primitives + c.setup.culled_backface_primitives +
                        c.setup.culled_zero_area_primitives + c.setup.culled_sample_miss_primitives +
                        c.setup.out_primitives,
                    c.setup.in_primitives),
    HWSIM_LAW_AT_MOST("stats.geometry_shader_primitives <= gs.output_vertices",
                      c.stats.geometry_shader_primitives, c.gs.output_vertices),
    HWSIM_LAW_EQUAL("hiz.killed_tiles + hiz.accepted_tiles + hiz.ambiguous_tiles = hiz.tested_tiles",
                    c.hiz.killed_tiles + c.hiz.accepted_tiles + c.hiz.ambiguous_tiles, c.hiz.tested_tiles),
    HWSIM_LAW_AT_MOST("zrop.early_z_killed_samples <= zrop.early_z_tested_samples",
                      c.zrop.early_z_killed_samples, c.zrop.early_z_tested_samples),
    HWSIM_LAW_AT_MOST("zrop.late_z_killed_samples <= zrop.late_z_tested_samples",
                      c.zrop.late_z_killed_samples, c.zrop.late_z_tested_samples),
    HWSIM_LAW_AT_MOST("zrop.early_z_tested_samples <= raster.covered_samples", c.zrop.early_z_tested_samples,
                      c.raster.covered_samples),
    HWSIM_LAW_AT_MOST("raster.fragments <= raster.covered_samples", c.raster.fragments,
                      c.raster.covered_samples),
    HWSIM_LAW_AT_MOST("raster.fragments <= 4 raster.quads", c.raster.fragments, 4 * c.raster.quads),
    HWSIM_LAW_AT_MOST("raster.partial_quads <= raster.quads", c.raster.partial_quads, c.raster.quads),
    HWSIM_LAW_EQUAL("ps.invocations + ps.helper_invocations = stats.fragment_shader_invocations",
                    c.ps.invocations + c.ps.helper_invocations, c.stats.fragment_shader_invocations),
    HWSIM_LAW_AT_MOST("ps.discarded_invocations <= ps.invocations", c.ps.discarded_invocations,
                      c.ps.invocations),
    HWSIM_LAW_AT_MOST("shader.alu_lane_ops <= shader.alu_issued_lane_ops_w8", c.shader.alu_lane_ops,
                      c.shader.alu_issued_lane_ops_w8),
    HWSIM_LAW_AT_MOST("shader.alu_issued_lane_ops_w8 <= shader.alu_issued_lane_ops_w64",
                      c.shader.alu_issued_lane_ops_w8, c.shader.alu_issued_lane_ops_w64),
    HWSIM_LAW_AT_MOST("shader.narrow_store_lane_ops <= shader.store_lane_ops", c.shader.narrow_store_lane_ops,
                      c.shader.store_lane_ops),
    HWSIM_LAW_AT_MOST("shader.same_address_atomic_lane_ops <= shader.atomic_lane_ops",
                      c.shader.same_address_atomic_lane_ops, c.shader.atomic_lane_ops),
    HWSIM_LAW_AT_MOST("tex.gathers + tex.comparisons <= tex.requests", c.tex.gathers + c.tex.comparisons,
                      c.tex.requests),
    HWSIM_LAW_AT_MOST("tex.requests <= tex.bilinear_probes + tex.gathers + tex.comparisons", c.tex.requests,
                      c.tex.bilinear_probes + c.tex.gathers + c.tex.comparisons),
    HWSIM_LAW_AT_MOST("crop.blended_samples <= crop.written_samples", c.crop.blended_samples,
                      c.crop.written_samples),
    HWSIM_LAW_AT_MOST("zrop.first_touched_tiles <= zrop.touched_tiles", c.zrop.first_touched_tiles,
                      c.zrop.touched_tiles),
    HWSIM_LAW_AT_MOST("crop.first_touched_tiles <= crop.touched_tiles", c.crop.first_touched_tiles,
                      c.crop.touched_tiles),
};

}  // namespace

// PassCounters is a struct of structs of uint64_t only: no padding, and its members are reachable as one
// array.
static_assert(sizeof(PassCounters) % sizeof(std::uint64_t) == 0 &&
              alignof(PassCounters) == alignof(std::uint64_t));

std::span<const std::uint64_t, kCounterCount> values(const PassCounters& counters) {
  return std::span<const std::uint64_t, kCounterCount>(reinterpret_cast<const std::uint64_t*>(&counters),
                                                       kCounterCount);
}

std::span<std::uint64_t, kCounterCount> values(PassCounters& counters) {
  return std::span<std::uint64_t, kCounterCount>(reinterpret_cast<std::uint64_t*>(&counters), kCounterCount);
}

PassCounters& operator+=(PassCounters& sum, const PassCounters& part) {
  const auto to = values(sum);
  const auto from = values(part);
  for (std::size_t i = 0; i < kCounterCount; ++i) to[i] += from[i];
  return sum;
}

std::span<const CounterInfo> counter_catalog() {
  static const std::vector<CounterInfo> catalog = catalog_with_slots();
  return catalog;
}

std::span<const CounterLaw> unit_laws() { return kUnitLaws; }

std::vector<CounterViolation> violations(const PassCounters& counters, std::span<const CounterLaw> laws) {
  std::vector<CounterViolation> found;
  for (const CounterLaw& law : laws) {
    const std::uint64_t left = law.left(counters), right = law.right(counters);
    const bool holds = law.relation == CounterLaw::Relation::equal ? left == right : left <= right;
    if (!holds) found.push_back({law.text, left, right});
  }
  return found;
}

}  // namespace hwsim
