#pragma once
// Every hardware unit once, in pipeline order. A unit's header holds all that the engines ask of it: its
// values with their keys, the rates that follow from them, its service time, and what the documents say.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hwsim/units/clocks.h"
#include "hwsim/units/color_rop.h"
#include "hwsim/units/depth_rop.h"
#include "hwsim/units/dram.h"
#include "hwsim/units/front_end.h"
#include "hwsim/units/hierarchical_z.h"
#include "hwsim/units/input_assembly.h"
#include "hwsim/units/l2.h"
#include "hwsim/units/passes.h"
#include "hwsim/units/raster.h"
#include "hwsim/units/resolve.h"
#include "hwsim/units/setup.h"
#include "hwsim/units/shader_cores.h"
#include "hwsim/units/texture.h"
#include "hwsim/units/tile_memory.h"
#include "hwsim/units/unit_work.h"
#include "hwsim/units/vertex_shading.h"

// clang-format off
/// X(id, struct), in the order in which work goes through them.
#define HWSIM_UNITS(X)    \
  X(fe, FrontEnd)         \
  X(ia, InputAssembly)    \
  X(vs, VertexShading)    \
  X(setup, Setup)         \
  X(raster, Raster)       \
  X(hiz, HierarchicalZ)   \
  X(zrop, DepthRop)       \
  X(shader, ShaderCores)  \
  X(tex, Texture)         \
  X(crop, ColorRop)       \
  X(resolve, Resolve)     \
  X(l2, L2)               \
  X(dram, Dram)

/// Everything with keys: the units, and what no work goes through.
#define HWSIM_GPU_PARTS(X) \
  X(clocks, Clocks)        \
  HWSIM_UNITS(X)           \
  X(tiles, TileMemory)     \
  X(passes, Passes)
// clang-format on

namespace hwsim {

#define HWSIM_UNIT_ID(id, Name) id,
enum class Unit : std::uint8_t { HWSIM_UNITS(HWSIM_UNIT_ID) };
#undef HWSIM_UNIT_ID

#define HWSIM_UNIT_INFO(id, Name) units::Name::kInfo,
inline constexpr std::array kUnits = {HWSIM_UNITS(HWSIM_UNIT_INFO)};
#undef HWSIM_UNIT_INFO

inline constexpr int kUnitCount = static_cast<int>(kUnits.size());

#define HWSIM_UNIT_HAS_ITS_ID(unit, Name) static_assert(units::Name::kInfo.id == #unit);
HWSIM_UNITS(HWSIM_UNIT_HAS_ITS_ID)
#undef HWSIM_UNIT_HAS_ITS_ID

constexpr std::size_t index_of(Unit unit) { return static_cast<std::size_t>(unit); }
constexpr const UnitInfo& info(Unit unit) { return kUnits[index_of(unit)]; }
constexpr std::string_view unit_name(Unit unit) { return info(unit).id; }
constexpr bool stands_in(std::size_t unit, UnitPlace place) { return kUnits[unit].place == place; }

constexpr std::size_t count_units(UnitPlace place) {
  std::size_t count = 0;
  for (const UnitInfo& unit : kUnits) count += unit.place == place ? 1 : 0;
  return count;
}

/// The units of a place, in order.
template <UnitPlace place>
constexpr std::array<Unit, count_units(place)> units_of() {
  std::array<Unit, count_units(place)> units{};
  std::size_t count = 0;
  for (std::size_t u = 0; u < kUnits.size(); ++u)
    if (stands_in(u, place)) units[count++] = static_cast<Unit>(u);
  return units;
}

/// The time that each unit needs for `work` alone, in ns; `rates` are the GPU's.
template <class T, class R>
std::array<T, kUnitCount> service_times_ns(const UnitWork<T>& work, const R& rates) {
#define HWSIM_UNIT_SERVICE(id, Name) units::Name::service_ns(work, rates),
  return {HWSIM_UNITS(HWSIM_UNIT_SERVICE)};
#undef HWSIM_UNIT_SERVICE
}

}  // namespace hwsim
