#pragma once
// How a technique declares counters of its own: one line each gives the slot, the name in the program's
// tables and the documentation.
#include <array>
#include <span>
#include <string_view>

#include "hwsim/trace/counters.h"

namespace hwsim::algos {

struct DeclaredCounter {
  TechniqueCounter counter;
  std::string_view id;    ///< "technique.sss_point_samples"
  std::string_view name;  ///< "sss_point_samples"
  std::string_view text;  ///< what one count is
};

#define HWSIM_COUNTER_PLACE(name, text) name##_place,
#define HWSIM_COUNTER_CONSTANT(name, text) \
  static constexpr TechniqueCounter name{kFirstSlot + static_cast<std::size_t>(Place::name##_place)};
#define HWSIM_COUNTER_DECLARED(name, text) DeclaredCounter{name, "technique." #name, #name, text},

/// Declares the counters of a room from LIST, a macro of lines X(name, "what one count is"), as
/// `Struct::name`, which shaders count with: s.count(Struct::name, mask). They take the slots from `first`
/// on, in the order of LIST. A test over all rooms finds slots that two rooms take.
#define HWSIM_TECHNIQUE_COUNTERS(Struct, first, LIST)                                                   \
  struct Struct {                                                                                       \
    static constexpr std::size_t kFirstSlot = first;                                                    \
    enum class Place : std::size_t { LIST(HWSIM_COUNTER_PLACE) end };                                   \
    LIST(HWSIM_COUNTER_CONSTANT)                                                                        \
    static constexpr std::size_t kCount = static_cast<std::size_t>(Place::end);                         \
    static constexpr std::array<DeclaredCounter, kCount> kDeclared = {LIST(HWSIM_COUNTER_DECLARED)};    \
    static_assert(kFirstSlot + kCount <= kTechniqueCounterSlots, "no slot is left for these counters"); \
  }

/// What every technique that lights surfaces counts.
#define HWSIM_BASE_COUNTERS(X) \
  X(lit_samples, "G-buffer samples, surfaces or aggregates that were lit, and pixels without any")
HWSIM_TECHNIQUE_COUNTERS(BaseCounters, 0, HWSIM_BASE_COUNTERS);

}  // namespace hwsim::algos
