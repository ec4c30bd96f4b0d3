// The GPU files that ship: all load, and they reach the peaks that their sources give.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "hwsim/gpu/gpu_config.h"
#include "hwsim/sample_gpu.h"
#include "support/places.h"

namespace hwsim::test {
namespace {

const std::string kConfigDir = hwsim::test::source_dir() + "/configs/gpus";
const std::string kCalibratedDir = hwsim::test::source_dir() + "/configs/calibrated";

GpuConfig shipped(const std::string& id, std::vector<Assignment> sets = {}) {
  return load_gpu(id, {}, sets, kConfigDir);
}

TEST(ShippedGpus, AllLoadAndSayWhereEveryFileValueComesFrom) {
  const std::vector<std::string> ids = list_gpus(kConfigDir);
  EXPECT_FALSE(ids.empty());
  for (const std::string& id : ids) {
    const GpuConfig c = shipped(id);
    EXPECT_EQ(c.id, id);
    for (const auto& [key, origin] : c.origins) {
      const bool label =
          key == "title" || key == "vendor" || key == "architecture" || key == "features.native_msaa_max";
      if (origin.layer != Origin::Layer::file || label) continue;
      EXPECT_TRUE(origin.provenance.has_value() && !origin.source.empty()) << id << " " << key;
    }
  }
}

/// Fixed-function units can keep DRAM busy: bandwidth x latency, and half as many lines again, at least 512.
void expect_lines_for_dram(const GpuConfig& gpu) {
  const double latency_ns = gpu.dram_latency_cycles * 1000.0 / gpu.core_clock_mhz;
  const double lines = std::max(512.0, 1.5 * gpu.dram_bandwidth_gb_s * latency_ns / 64.0);
  EXPECT_NEAR(gpu.unit_lines_max / lines, 1.0, 1e-9) << gpu.id;
}

TEST(ShippedGpus, FixedFunctionUnitsHaveTheLinesInFlightThatKeepTheirDramBusy) {
  for (const std::string& id : list_gpus(kConfigDir)) expect_lines_for_dram(shipped(id));
}

// What a GPU's own file gains reaches the calibrated GPU without another fit.
TEST(ShippedGpus, CalibratedFilesHoldFittedKeysAndWhatTheFitAssumedAndTakeTheOthersFromTheGpu) {
  EXPECT_FALSE(list_gpus(kCalibratedDir).empty());
  for (const std::string& id : list_gpus(kCalibratedDir)) {
    const std::string path = kCalibratedDir + "/" + id + ".toml";
    const GpuConfig fitted = load_gpu(path, {}, {}, kConfigDir), documented = shipped(id);
    EXPECT_EQ(fitted.id, id);
    for (const auto& [key, origin] : fitted.origins) {
      SCOPED_TRACE(id + ": " + key);
      if (origin.layer == Origin::Layer::file) {
        EXPECT_EQ(origin.provenance, Provenance::fitted);
        EXPECT_TRUE(origin.interval.has_value());
      } else {
        EXPECT_EQ(value_of(fitted, key), value_of(documented, key));
      }
    }
  }
}

TEST(ShippedGpus, ShowRoundTrips) {
  for (const std::string& id : list_gpus(kConfigDir)) {
    const auto path = std::filesystem::path(::testing::TempDir()) / ("hwsim_shown_" + id + ".toml");
    std::ofstream(path) << show(shipped(id), true);
    EXPECT_EQ(content_hash(load_gpu(path.string(), {}, {}, "")), content_hash(shipped(id))) << id;
    std::filesystem::remove(path);
  }
}

TEST(ShippedGpus, OnlyGtx980OfTheSevenHasTheGm20xFeatures) {
  for (const char* id : {"gtx470", "hd5870", "gtx980", "hd4600", "gf840m", "hd7650m", "tegrak1"}) {
    const GpuFeatures f = shipped(id).features;
    const bool expected = std::string(id) == "gtx980";
    EXPECT_EQ(f.post_depth_coverage, expected) << id;
    EXPECT_EQ(f.viewport_multicast, expected) << id;
    EXPECT_EQ(f.conservative_raster, expected) << id;
    EXPECT_EQ(f.programmable_sample_positions, expected) << id;
  }
}

double fill_px_per_clk(const std::string& id, Format format) {
  const GpuConfig gpu = shipped(id, {{"gpu.pass_overhead_us", "0"}});
  const PassWork pass = fill_pass(format, false, 1024, 2000);
  return 1024.0 * 2000 / (time_one(pass, gpu).time_ns * gpu.core_clock_mhz / 1000.0);
}

TEST(ShippedGpus, FillReachesTheDocumentedPixelsPerClock) {
  const struct {
    const char* id;
    Format format;
    double px_per_clk;  // docs/hardware_sources.md#rops
  } cases[] = {{"gtx470", Format::rgba8_unorm, 28},  {"hd5870", Format::rgba8_unorm, 32},
               {"hd5870", Format::rgba16_float, 32}, {"gtx980", Format::rgba8_unorm, 64},
               {"gtx980", Format::rgba16_float, 32}, {"gtx980", Format::rgba32_float, 16},
               {"hd4600", Format::rgba8_unorm, 4},   {"gf840m", Format::rgba8_unorm, 8},
               {"gf840m", Format::rgba32_float, 2},  {"hd7650m", Format::rgba8_unorm, 8},
               {"tegrak1", Format::rgba8_unorm, 4},  {"tegrak1", Format::rgba16_float, 2}};
  for (const auto& c : cases)
    EXPECT_NEAR(fill_px_per_clk(c.id, c.format) / c.px_per_clk, 1.0, 0.01)
        << c.id << " " << info(c.format).name;
  EXPECT_GE(fill_px_per_clk("gtx470", Format::rgba16_float), 13.9);
  EXPECT_LE(fill_px_per_clk("gtx470", Format::rgba16_float), 20.0);
}

TEST(ShippedGpus, CulledTrianglesReachTheMeasuredRate) {
  PassCounters c;
  c.stats.input_assembly_vertices = 3000;
  c.setup.in_primitives = c.setup.culled_backface_primitives = 1000;
  const auto per_clk = [&](const char* id) {
    const GpuConfig gpu = shipped(id, {{"gpu.pass_overhead_us", "0"}});
    return 1000.0 * 2000 /
           (time_one(repeated(PassKind::draw, c, 2000), gpu).time_ns * gpu.core_clock_mhz / 1000.0);
  };
  EXPECT_NEAR(per_clk("gtx470"), 3.51, 0.0351);
  EXPECT_NEAR(per_clk("hd5870"), 1.0, 0.01);
}

}  // namespace
}  // namespace hwsim::test
