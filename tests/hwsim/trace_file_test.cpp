// A trace that was written reads back to the same numbers, and damage is always noticed: cached traces are
// input.
#include "hwsim/trace/trace_file.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "hwsim/base/byte_codec.h"
#include "hwsim/sample_gpu.h"
#include "hwsim/trace/trace_fields.h"

namespace hwsim::test {
namespace {

WorkTrace sample_trace(std::size_t chunks) {
  WorkTrace trace;
  trace.scene = "hall:seed=3";
  trace.technique = "msaa4x";
  trace.width_px = 1280;
  trace.height_px = 720;
  trace.peak_memory_bytes = 123'456'789'012;
  trace.allocated_memory_bytes = 223'456'789'012;
  trace.passes = {busy_pass(chunks), fill_pass(Format::rgba16_float, true, 4096, 3), PassWork{}};
  trace.passes[0].sample_rate = trace.passes[0].barrier_before = true;
  trace.passes[2].kind = PassKind::clear;
  trace.passes[2].width_px = -1;  // nonsense comes back as it went in
  trace.passes[2].chunks.resize(5);
  return trace;
}

/// Every field as text: independent of the encoding under test.
class Printed {
 public:
  template <class T>
  void field(std::string_view name, const T& value) {
    text += std::string(name) + "=";
    add(value);
    text += "\n";
  }
  std::string text;

 private:
  void add(const std::string& value) { text += value; }
  void add(const PassCounters& counters) {
    for (const std::uint64_t value : values(counters)) text += std::to_string(value) + " ";
  }
  template <class T>
  void add(const std::vector<T>& list) {
    text += std::to_string(list.size()) + ":";
    for (const T& value : list) add(value);
  }
  template <class T, std::size_t N>
  void add(const std::array<T, N>& list) {
    for (const T& value : list) {
      add(value);
      text += " ";
    }
  }
  template <class T>
  void add(const T& value) {
    if constexpr (std::is_class_v<T>)
      describe_fields(*this, value);
    else
      text += std::to_string(static_cast<std::int64_t>(value));
  }
};

std::string printed(const WorkTrace& trace) {
  Printed print;
  describe_fields(print, trace);
  return print.text;
}

TEST(TraceFile, ReadsBackWhatWasWritten) {
  WorkTrace trace = sample_trace(70);
  auto extremes = values(trace.passes[0].chunks[3]);
  extremes[0] = std::numeric_limits<std::uint64_t>::max();  // a difference that wraps
  extremes[1] = std::uint64_t{1} << 63;
  const DecodedTrace read = decode_trace(encode_trace(trace));
  ASSERT_TRUE(read.trace) << read.damage;
  EXPECT_EQ(printed(*read.trace), printed(trace));
  EXPECT_EQ(printed(*decode_trace(encode_trace({})).trace), printed({}));
}

TEST(TraceFile, CutOffAtAnyLengthIsNoticed) {
  const std::vector<std::uint8_t> bytes = encode_trace(sample_trace(4));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const DecodedTrace read = decode_trace(std::span(bytes).first(length));
    ASSERT_FALSE(read.trace) << length;
    ASSERT_NE(read.damage, "") << length;
  }
}

TEST(TraceFile, AChangeOfAnyByteIsNoticed) {
  std::vector<std::uint8_t> bytes = encode_trace(sample_trace(4));
  for (std::uint8_t& byte : bytes)
    for (const int change : {1, 0x80, 0xff}) {
      byte = static_cast<std::uint8_t>(byte ^ change);
      ASSERT_FALSE(decode_trace(bytes).trace) << &byte - bytes.data();
      byte = static_cast<std::uint8_t>(byte ^ change);
    }
  bytes.push_back(0);
  EXPECT_FALSE(decode_trace(bytes).trace) << "a byte too many";
}

// Behind a check sum that fits, as a writer with a mistake would leave it: still no crash, no boundless
// memory.
TEST(TraceFile, NonsenseBehindAValidSealIsRefusedOrRead) {
  const std::vector<std::uint8_t> whole = encode_trace(sample_trace(2));
  const auto payload = open_seal("hwtrace", trace_version(), whole);
  std::mt19937 random(7);
  std::size_t refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::uint8_t> bytes(payload.begin(), payload.end());
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (round % 3 == 0) bytes.resize(random() % bytes.size());
    refused += decode_trace(seal("hwtrace", trace_version(), bytes)).trace ? 0 : 1;
  }
  EXPECT_GT(refused, 1000u);
}

TEST(TraceFile, LayoutNamesEveryCounterSoThatANewOneChangesTheVersion) {
  const std::string layout = trace_layout();
  for (const CounterInfo& counter : counter_catalog())
    EXPECT_NE(layout.find(std::string(counter.id) + ","), std::string::npos) << counter.id;
  EXPECT_NE(layout.find("depth_cleared_before:"), std::string::npos);
  EXPECT_NE(layout.find("|rgba16_float|"), std::string::npos);
}

TEST(TraceFile, IsCompact) {
  const WorkTrace trace = sample_trace(500);
  EXPECT_LT(encode_trace(trace).size(), 500 * kCounterCount * 2 + 4096) << "two bytes a count";
}

}  // namespace
}  // namespace hwsim::test
