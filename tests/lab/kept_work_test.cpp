// The kept traces that the accuracy test reads are those that this version emulates: a run of each paper,
// anew.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "cost_models/kept_traces.h"
#include "hwsim/trace/trace_file.h"
#include "lab/base/observer.h"
#include "lab/studies/published_runs.h"
#include "support/places.h"

namespace hwsim::lab::test {
namespace {

using cost_models::KeptTraces;

KeptTraces kept_traces() {
  std::ifstream in(hwsim::test::source_dir() + "/tests/data/published.traces", std::ios::binary);
  const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(in)), {});
  return cost_models::decode_kept(bytes);
}

TEST(KeptWork, IsWhatThisVersionEmulates) {
  const Cache cache(hwsim::test::binary_dir() + "/test-cache");
  const KeptTraces kept = kept_traces();
  Observer silent;
  const cost_models::TraceSource traces = emulated_traces(2, cache, silent);
  std::size_t compared = 0;
  for (const char* run_begins : {"sbaa_merge:n=2,msaa=8 of dragon", "agaa:c=2,msaa=8 of metal",
                                 "sss_cs of car_body:mouldings=1", "axaa of sponza_hall"})
    for (const auto& [run, trace] : kept.traces) {
      if (run.to_string().rfind(run_begins, 0) != 0) continue;
      ++compared;
      const GpuConfig gpu = load_gpu(run.gpu, {}, {}, hwsim::test::source_dir() + "/configs/gpus");
      EXPECT_EQ(encode_trace(*traces(run, gpu)), encode_trace(*trace))
          << run.to_string() << ": where this was meant, scripts/keep_traces.sh keeps the new work";
      break;
    }
  EXPECT_EQ(compared, 4u);
}

}  // namespace
}  // namespace hwsim::lab::test
