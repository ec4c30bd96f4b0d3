// From a target to a texture: what GPUs decompress before a shader reads it.
#include <gtest/gtest.h>

#include "hwsim/engines/timing.h"
#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

constexpr double kPixels = 64'000;

PassWork reading(Format format, int samples) {
  PassCounters c;
  c.shader.alu_issued_lane_ops_w32 = 32'000;
  PassWork pass = repeated(PassKind::compute, c, 2);
  pass.read_targets = {{format, samples, static_cast<std::uint64_t>(kPixels)}};
  return pass;
}

GpuConfig expanding() {
  GpuConfig gpu = sample_gpu();
  gpu.shader_read_expands_color = gpu.shader_read_expands_depth = true;
  gpu.crop_msaa_samples_per_unit_clk = 4;
  return gpu;
}

double bytes(const FrameTiming& t) { return t.dram_bytes.total_read() + t.dram_bytes.total_write(); }

TEST(Transition, MultisampledColorIsWrittenOutRawBeforeTheFirstRead) {
  const PassWork pass = reading(Format::rgba8_unorm, 4);
  for (const Engine engine : {Engine::roofline, Engine::queue, Engine::detailed}) {
    SCOPED_TRACE(engine_name(engine));
    const FrameTiming plain = time_one(pass, sample_gpu(), engine),
                      expanded = time_one(pass, expanding(), engine);
    EXPECT_NEAR(expanded.time_ns - plain.time_ns, kPixels * 4 / (40 * 4), 1e-6) << "the ROPs' samples";
    EXPECT_NEAR(bytes(expanded) - bytes(plain), kPixels * 4 + kPixels * 16, 1e-6);
    WorkTrace trace;
    trace.passes = {pass};
    EXPECT_TRUE(check_timing(expanded, trace, expanding()).empty());
  }
}

TEST(Transition, ItsBytesLimitWhereMemoryIsSlow) {
  GpuConfig gpu = expanding(), plain = sample_gpu();
  gpu.dram_bandwidth_gb_s = plain.dram_bandwidth_gb_s = 10;
  const PassWork pass = reading(Format::rgba8_unorm, 4);
  EXPECT_NEAR(time_one(pass, gpu).time_ns - time_one(pass, plain).time_ns, kPixels * 20 / 10, 1e-6);
}

TEST(Transition, DepthIsExpandedAtEverySampleCount) {
  for (const int samples : {1, 4}) {
    const PassWork pass = reading(Format::d32_float, samples);
    const FrameTiming plain = time_one(pass, sample_gpu()), expanded = time_one(pass, expanding());
    EXPECT_NEAR(expanded.time_ns - plain.time_ns, kPixels * samples / (40 * 4), 1e-6);
    EXPECT_NEAR(bytes(expanded) - bytes(plain), kPixels / 64 * 32 + kPixels * samples * 4, 1e-6);
  }
}

TEST(Transition, ColorOfOneSampleIsNotCompressed) {
  const PassWork pass = reading(Format::rgba8_unorm, 1);
  EXPECT_EQ(time_one(pass, expanding()).time_ns, time_one(pass, sample_gpu()).time_ns);
}

}  // namespace
}  // namespace hwsim::test
