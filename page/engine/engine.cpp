// The `queue` engine as a WebAssembly module for report pages. Numbers go in and out through memory: the page
// writes the values of a GPU, asks for a trace's time, and reads doubles. It says the names and the order of
// all of them itself, so that a page never counts on them.
#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include "hwsim/engines/timing.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/timing/time_slopes.h"
#include "hwsim/trace/trace_file.h"

#define HWSIM_EXPORT(name) extern "C" __attribute__((export_name(name)))

// What is thrown (damaged bytes) ends the module in a trap, which the page reports: Debian's libraries for
// WebAssembly have no exceptions.
extern "C" void* __cxa_allocate_exception(std::size_t) noexcept { __builtin_trap(); }
extern "C" void __cxa_throw(void*, void*, void (*)(void*)) { __builtin_trap(); }
extern "C" void __cxa_free_exception(void*) noexcept {}

namespace {

using hwsim::kStreamCount;
using hwsim::kUnitCount;

hwsim::GpuConfig gpu;
std::vector<hwsim::WorkTrace> traces;
std::vector<std::uint8_t> incoming;
std::vector<std::uint8_t> mask;
std::vector<double> values, answer;
std::string text;

std::vector<hwsim::Key> keys() { return keys_of(static_cast<hwsim::GpuValues<double>&>(gpu)); }

/// A real, a whole number or a switch, from the page's double.
struct Assigner {
  double value;
  void operator()(double* slot) const { *slot = value; }
  void operator()(int* slot) const { *slot = static_cast<int>(value); }
  void operator()(bool* slot) const { *slot = value != 0.0; }
  void operator()(std::string*) const {}
};

/// Those of which derivatives are wanted, in order.
std::vector<std::string> masked_keys() {
  std::vector<std::string> names;
  const std::vector<hwsim::Key> all = keys();
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i] != 0 && std::holds_alternative<double*>(all[i].slot)) names.emplace_back(all[i].info.name);
  return names;
}

const char* keep(std::string words) {
  text = std::move(words);
  return text.c_str();
}

template <class Range>
void put(const Range& numbers) {
  answer.insert(answer.end(), numbers.begin(), numbers.end());
}

void put(const hwsim::PassTiming& pass) {
  put(std::vector{pass.time_ns, pass.overhead_ns, static_cast<double>(pass.limiter)});
  put(pass.busy_ns);
  put(pass.sol_ratio);
  put(pass.stack_ns);
  put(pass.dram_bytes.read);
  put(pass.dram_bytes.write);
}

/// Valid until the next call.
const hwsim::WorkTrace& first_passes(const hwsim::WorkTrace& whole, int passes) {
  static hwsim::WorkTrace part;
  part.passes.assign(whole.passes.begin(), whole.passes.begin() + passes);
  return part;
}

}  // namespace

/// Room for the bytes of a trace.
HWSIM_EXPORT("trace_bytes") std::uint8_t* trace_bytes(std::size_t size) {
  incoming.assign(size, 0);
  return incoming.data();
}

/// The number of the trace whose bytes were written; -1 for bytes of another version.
HWSIM_EXPORT("add_trace") int add_trace() {
  hwsim::DecodedTrace decoded = hwsim::decode_trace(incoming);
  incoming.clear();
  if (!decoded.trace) return -1;
  traces.push_back(std::move(*decoded.trace));
  return static_cast<int>(traces.size()) - 1;
}

/// Keys of a GPU's values, a line each: their order in memory.
HWSIM_EXPORT("key_names") const char* key_names() {
  std::string lines;
  for (const hwsim::Key& key : keys()) lines += std::string(key.info.name) + "\n";
  return keep(std::move(lines));
}

/// A byte for each key: not 0 where the derivative of the time is wanted. Keys that are no real numbers have
/// none.
HWSIM_EXPORT("slope_mask") std::uint8_t* slope_mask() {
  mask.resize(keys().size());
  return mask.data();
}

HWSIM_EXPORT("unit_names") const char* unit_names() {
  std::string lines;
  for (std::size_t u = 0; u < kUnitCount; ++u)
    lines += std::string(hwsim::unit_name(static_cast<hwsim::Unit>(u))) + "\n";
  return keep(std::move(lines));
}

HWSIM_EXPORT("stream_names") const char* stream_names() {
  std::string lines;
  for (std::size_t s = 0; s < kStreamCount; ++s)
    lines += std::string(hwsim::stream_name(static_cast<hwsim::Stream>(s))) + "\n";
  return keep(std::move(lines));
}

/// The GPU's values, in the order of key_names.
HWSIM_EXPORT("gpu_values") double* gpu_values() {
  values.resize(keys().size());
  return values.data();
}

/// Times the first `passes` passes of a trace on the GPU of gpu_values. The answer: the time; for each pass
/// its time, overhead, limiter, then by unit busy time, share and stack, then by stream bytes read and
/// written; at the end the derivatives of the time by the keys of slope_mask. In ns and bytes.
HWSIM_EXPORT("time_trace") const double* time_trace(int number, int passes) {
  const std::vector<hwsim::Key> slots = keys();
  for (std::size_t i = 0; i < slots.size(); ++i) std::visit(Assigner{values.at(i)}, slots[i].slot);
  const hwsim::WorkTrace& whole = traces.at(static_cast<std::size_t>(number));
  const bool all = static_cast<std::size_t>(passes) >= whole.passes.size();
  const hwsim::WorkTrace& trace = all ? whole : first_passes(whole, passes);
  const std::vector<std::string> wanted = masked_keys();
  hwsim::TimeSlopes slopes(gpu, wanted);
  const hwsim::FrameTiming frame =
      time_frame(trace, gpu, hwsim::Engine::queue, {}, wanted.empty() ? nullptr : &slopes);
  answer.assign(1, frame.time_ns);
  for (const hwsim::PassTiming& pass : frame.passes) put(pass);
  put(slopes.ns());
  return answer.data();
}
