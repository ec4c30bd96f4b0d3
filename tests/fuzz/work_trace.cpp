// The payload of a work trace, behind a seal that fits: what is read can be written again, and timed.
#include "fuzz/gpu_work.h"
#include "hwsim/base/byte_codec.h"
#include "hwsim/trace/trace_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hwsim;
  const DecodedTrace read = decode_trace(seal("hwtrace", trace_version(), fuzz::Bytes(data, size)));
  fuzz::require(read.trace.has_value() == read.damage.empty(), "there is a trace, or a reason why not");
  if (!read.trace) return 0;
  const std::vector<std::uint8_t> written = encode_trace(*read.trace);
  const DecodedTrace again = decode_trace(written);
  fuzz::require(again.trace.has_value(), "a trace that was written is read");
  fuzz::require(encode_trace(*again.trace) == written, "a trace reads back to the same numbers");
  static const GpuConfig gpu = test::sample_gpu();
  for (const Engine engine : {Engine::roofline, Engine::queue}) time_frame(*read.trace, gpu, engine);
  return 0;
}
