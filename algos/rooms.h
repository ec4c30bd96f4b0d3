#pragma once
// What the rooms of techniques declare, taken together: the techniques themselves, their counters and laws.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algos/base/technique.h"

namespace hwsim::algos {

/// The explicit registry (registry.cpp).
std::span<const Room> rooms();

/// The techniques of all rooms, in their order.
std::span<const TechniqueInfo> techniques();
std::string_view kind_name(TechniqueKind kind);

/// A counter as users see it, and its place in values(PassCounters).
struct ListedCounter {
  CounterInfo info;
  std::size_t place = 0;
};
/// All counters: those of the units, and before the last unit, `mem`, those that rooms declare.
std::span<const ListedCounter> counters();

/// WorkTrace::technique_counters of this program: ids by slot, empty where none is declared.
const std::vector<std::string>& technique_counter_ids();

/// Lighting evaluations of a frame, by whichever of the rooms' counters count them.
std::uint64_t shaded_samples(const WorkTrace& trace);

/// The laws of units and rooms that a pass breaks.
std::vector<CounterViolation> broken_laws(const PassCounters& counters);

/// The codes of the rooms' notes.
std::vector<MessageCode> message_codes();

}  // namespace hwsim::algos
