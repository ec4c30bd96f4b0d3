// Kept traces read back as they were, share their passes, and are never believed when damaged.
#include "cost_models/kept_traces.h"

#include <gtest/gtest.h>

#include "cost_models/synthetic.h"
#include "hwsim/base/byte_codec.h"
#include "hwsim/trace/trace_file.h"

namespace hwsim::cost_models::test {
namespace {

RunSpec run(const std::string& technique) {
  return {"grass", "close", technique, "hd5870", 1280, 720, "scene.lights=complex", "scene.lights=simple"};
}

/// Two techniques that begin with the same pass.
KeptTraces two_runs() {
  KeptTraces kept;
  kept.sources = "0123abcd";
  auto first = std::make_shared<WorkTrace>(*random_trace(1));
  auto second = std::make_shared<WorkTrace>(*random_trace(2));
  second->passes.front() = first->passes.front();
  first->scene = second->scene = "grass";
  first->width_px = second->width_px = 1280;
  first->height_px = second->height_px = 720;
  first->technique = "a";
  second->technique = "b";
  second->allocated_memory_bytes = 123'456;
  first->technique_counters = second->technique_counters = {"technique.lit_samples", ""};
  kept.traces = {{run("a"), first}, {run("b"), second}};
  return kept;
}

TEST(KeptTraces, ReadBackAsTheyWere) {
  const KeptTraces kept = two_runs();
  const KeptTraces back = decode_kept(encode_kept(kept));
  EXPECT_EQ(back.sources, kept.sources);
  ASSERT_EQ(back.traces.size(), 2u);
  for (const auto& [spec, trace] : kept.traces) {
    ASSERT_TRUE(back.traces.contains(spec)) << spec.to_string();
    EXPECT_EQ(encode_trace(*back.traces.at(spec)), encode_trace(*trace));
  }
}

TEST(KeptTraces, HoldASharedPassOnce) {
  const KeptTraces kept = two_runs();
  std::size_t apart = 0;
  for (const auto& [spec, trace] : kept.traces) apart += encode_trace(*trace).size();
  WorkTrace shared;
  shared.passes = {kept.traces.begin()->second->passes.front()};
  EXPECT_LT(encode_kept(kept).size(), apart - encode_trace(shared).size() / 2);
}

TEST(KeptTraces, AreRefusedAtEveryLengthButTheirOwn) {
  const std::vector<std::uint8_t> bytes = encode_kept(two_runs());
  for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 20)
    EXPECT_THROW(decode_kept(std::span(bytes).first(length)), DamagedBytes) << length;
  std::vector<std::uint8_t> changed = bytes;
  changed[bytes.size() / 2] ^= 1;
  EXPECT_THROW(decode_kept(changed), DamagedBytes);
}

TEST(KeptTraces, GiveEachRunItsOwnAndRefuseOthers) {
  const KeptTraces kept = two_runs();
  const TraceSource source = source_of(kept);
  EXPECT_EQ(source(run("b"), {})->technique, "b");
  try {
    source(run("c"), {});
    FAIL() << "a trace was made up";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().front().code, "M008");
  }
}

TEST(KeptTraces, KeepWhatPassesThrough) {
  KeptTraces kept;
  const TraceSource source = keeping([](const RunSpec&, const GpuConfig&) { return random_trace(3); }, kept);
  const auto given = source(run("a"), {});
  EXPECT_EQ(kept.traces.at(run("a")), given);
}

}  // namespace
}  // namespace hwsim::cost_models::test
