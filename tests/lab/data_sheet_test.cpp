// GPUs of data sheets: what is given, what follows, what a file forgets.
#include "lab/catalog/data_sheet.h"

#include <gtest/gtest.h>

#include <fstream>

#include "hwsim/base/diagnostics.h"
#include "lab/base/files.h"
#include "lab/catalog/config_folder.h"

namespace hwsim::lab {
namespace {

GpuConfig documented(const std::string& id) { return load_gpu(id, {}, {}, ConfigFolder().gpus()); }

const SheetValue& value_of(const SheetGpu& made, const std::string& key) {
  return *std::ranges::find(made.values, key, &SheetValue::key);
}

TEST(DataSheet, WhatIsGivenIsTakenAndWhatDependsOnItIsScaled) {
  const GpuConfig like = documented("gtx980");
  const SheetGpu made = gpu_of_sheet(like, {.id = "half", .cores = 8, .rops = 32});
  EXPECT_EQ(made.gpu.shader_cores, 8.0);
  EXPECT_EQ(made.gpu.crop_units, 32.0);
  EXPECT_EQ(made.gpu.tex_bilinear_per_clk, like.tex_bilinear_per_clk / 2.0);
  EXPECT_EQ(made.gpu.export_px_per_clk, like.export_px_per_clk / 2.0);
  EXPECT_EQ(made.gpu.raster_engines, 2.0);
  EXPECT_EQ(made.gpu.hiz_px_per_clk, like.hiz_px_per_clk / 2.0);
  EXPECT_EQ(made.gpu.dram_bandwidth_gb_s, like.dram_bandwidth_gb_s);
  EXPECT_FALSE(value_of(made, "shader_cores").interval);
  EXPECT_EQ(value_of(made, "tex_bilinear_per_clk").interval,
            (std::array{like.tex_bilinear_per_clk / 2.0, like.tex_bilinear_per_clk}));
}

TEST(DataSheet, AGivenRateIsNotScaled) {
  const SheetGpu made = gpu_of_sheet(documented("gtx980"), {.id = "x", .cores = 8, .tmus = 100});
  EXPECT_EQ(made.gpu.tex_bilinear_per_clk, 100.0);
  EXPECT_EQ(value_of(made, "tex_bilinear_per_clk").how, "data sheet");
}

TEST(DataSheet, TheFileLoadsToTheSameNumbersAndKeepsNoRate) {
  const TemporaryFolder folder;
  const SheetGpu made = gpu_of_sheet(
      documented("gtx980"), {.id = "cut", .cores = 13, .rops = 56, .clock_mhz = 1178, .bandwidth_gb_s = 196});
  write_file(folder.file("cut.toml"), to_toml(made));
  const GpuConfig loaded = load_gpu(folder.file("cut.toml"), {}, {}, ConfigFolder().gpus());
  EXPECT_EQ(content_hash(loaded), content_hash(made.gpu));
  EXPECT_EQ(loaded.id, "cut");
  EXPECT_TRUE(kept_rates(loaded).empty());
}

TEST(DataSheet, AFileThatForgetsARateIsWarnedAbout) {
  const TemporaryFolder folder;
  write_file(
      folder.file("x.toml"),
      "schema = 1\nkind = \"gpu\"\nid = \"x\"\nextends = \"gtx980\"\nshader_cores = 8\nraster_engines = 2\n");
  const std::vector<Diagnostic> warnings =
      kept_rates(load_gpu(folder.file("x.toml"), {}, {}, ConfigFolder().gpus()));
  ASSERT_EQ(warnings.size(), 5u) << "textures; samples, coarse depth and both setup rates of the rasterizers";
  EXPECT_EQ(warnings.front().code, "C024");
  EXPECT_EQ(warnings.front().place.line, 5);
  for (const std::string& id : list_gpus(ConfigFolder().gpus()))
    EXPECT_TRUE(kept_rates(documented(id)).empty()) << id;
}

TEST(DataSheet, NumbersOutsideOfARangeAreAllNamed) {
  try {
    gpu_of_sheet(documented("gtx980"), {.id = "x", .rops = -1, .clock_mhz = 1e9});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_GE(error.diagnostics().size(), 2u);
    for (const Diagnostic& d : error.diagnostics()) EXPECT_EQ(d.code, "C014");
  }
}

TEST(DataSheet, SizesHaveUnits) {
  EXPECT_EQ(size_in_kib("36M"), 36864.0);
  EXPECT_EQ(size_in_kib("512K"), 512.0);
  EXPECT_EQ(size_in_kib("512"), 512.0);
  EXPECT_EQ(size_in_kib("0.5G"), 524288.0);
  for (const char* text : {"", "M", "36MB", "-1M", "nanM", "inf", "1 M"})
    EXPECT_FALSE(size_in_kib(text)) << text;
}

}  // namespace
}  // namespace hwsim::lab
