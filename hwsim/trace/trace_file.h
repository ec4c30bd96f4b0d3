#pragma once
// A work trace as bytes: compact (columns of varint differences), with a version that follows from the fields
// and the counters themselves, and a check sum. For caches: another version is not converted, but emulated
// anew.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hwsim/trace/work_trace.h"

namespace hwsim {

/// Names and types of every field and counter, in order. Two builds with the same text can read each other's
/// traces.
std::string trace_layout();

/// A hash of trace_layout(): it changes by itself when a counter or a field is added, removed or renamed.
std::uint64_t trace_version();

std::vector<std::uint8_t> encode_trace(const WorkTrace& trace);

struct DecodedTrace {
  std::optional<WorkTrace> trace;
  std::string damage;  ///< why there is none
};

/// Never throws for damaged bytes, never returns other numbers than were encoded.
DecodedTrace decode_trace(std::span<const std::uint8_t> bytes);

}  // namespace hwsim
