// Files of the configuration folder, read once for a lab.
#include "lab/catalog/config_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "hwsim/base/diagnostics.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

TEST(ConfigFiles, GiveWhatLoadingAloneGives) {
  ConfigFiles files;
  const std::vector<Assignment> sets = {{"gpu.l2_size_kib", "1024"}, {"scene.shadows", "false"}};
  for (const char* name : {"gtx980", "hd7650m"}) {
    const GpuConfig plain = load_gpu(name, {}, {}, ConfigFolder().gpus());
    const GpuConfig changed = load_gpu(name, {}, sets, ConfigFolder().gpus());
    EXPECT_EQ(show(files.gpu(name, {}, sets, false), true), show(changed, true));
    EXPECT_EQ(show(files.gpu(name, {}, {}, false), true), show(plain, true))
        << "settings of one plan do not reach the next";
  }
}

// Settings are laid over a GPU that is resolved already; an overlay is resolved with the files.
TEST(ConfigFiles, SettingsGiveTheNumbersOfAnOverlay) {
  const fs::path path = fs::path(::testing::TempDir()) / "hwsim_as_settings.toml";
  std::ofstream(path) << "schema = 1\nkind = \"overlay\"\nl2_size_kib = 1024\ndram_bandwidth_gb_s = \"x2\"\n"
                         "rop_through_l2 = false\nqueue_packets = \"x2\"\nfeatures.native_msaa_max = 4\n";
  const std::vector<Assignment> sets = {{"gpu.l2_size_kib", "1024"},
                                        {"gpu.dram_bandwidth_gb_s", "x2"},
                                        {"gpu.rop_through_l2", "false"},
                                        {"gpu.queue_packets", "x2"},
                                        {"gpu.features.native_msaa_max", "4"}};
  ConfigFiles files;
  for (const char* name : {"gtx980", "hd7650m"}) {
    const GpuConfig plain = files.gpu(name, {}, {}, true), set = files.gpu(name, {}, sets, true);
    EXPECT_EQ(content_hash(set), content_hash(files.gpu(name, {path.string()}, {}, true)));
    EXPECT_EQ(set.queue_packets, 2 * plain.queue_packets);
    EXPECT_EQ(set.origins.at("l2_size_kib").to_string(), "--set");
    EXPECT_EQ(set.origins.at("core_clock_mhz").to_string(), plain.origins.at("core_clock_mhz").to_string());
  }
}

TEST(ConfigFiles, FittedNumbersAreTakenWhereAskedFor) {
  ConfigFiles files;
  ASSERT_NE(files.calibration(), nullptr);
  const GpuConfig fitted = files.gpu("gtx980", {}, {}, true), documented = files.gpu("gtx980", {}, {}, false);
  EXPECT_NE(content_hash(fitted), content_hash(documented));
  EXPECT_EQ(fitted.id, documented.id);
}

TEST(ConfigFiles, AGpuThatExtendsAFittedOneKeepsItsFittedNumbers) {
  ConfigFiles files;
  const GpuConfig fitted = files.gpu("gtx980", {}, {}, true), relative = files.gpu("gtx970", {}, {}, true),
                  documented = files.gpu("gtx970", {}, {}, false);
  EXPECT_EQ(relative.alu_efficiency_ratio, fitted.alu_efficiency_ratio);
  EXPECT_NE(relative.alu_efficiency_ratio, documented.alu_efficiency_ratio);
  EXPECT_EQ(relative.shader_cores, 13.0);
  EXPECT_EQ(relative.id, "gtx970");
  EXPECT_EQ(relative.parents.front(), "gtx980");
}

TEST(ConfigFiles, ReadAFileOnce) {
  const fs::path path = fs::path(::testing::TempDir()) / "hwsim_read_once.toml";
  std::ofstream(path)
      << "schema = 1\nkind = \"gpu\"\nid = \"mine\"\nextends = \"gtx980\"\nl2_size_kib = 512\n";
  ConfigFiles files;
  EXPECT_EQ(files.gpu(path.string(), {}, {}, true).l2_size_kib, 512.0);
  fs::remove(path);
  const std::vector<Assignment> sets = {{"gpu.dram_bandwidth_gb_s", "100"}};
  const GpuConfig again = files.gpu(path.string(), {}, sets, true);
  EXPECT_EQ(again.l2_size_kib, 512.0);
  EXPECT_EQ(again.dram_bandwidth_gb_s, 100.0);
  EXPECT_EQ(files.calibration(), files.calibration()) << "one calibration, not a copy for each question";
}

TEST(ConfigFiles, MistakesInFilesAndSettingsAreReportedTogetherEachTime) {
  const fs::path path = fs::path(::testing::TempDir()) / "hwsim_mistakes.toml";
  std::ofstream(path) << "schema = 1\nkind = \"gpu\"\nextends = \"gtx980\"\nno_such_key = 1\n";
  ConfigFiles files;
  const std::vector<Assignment> sets = {{"gpu.neither_this", "1"}};
  for (int time = 0; time < 2; ++time) try {
      files.gpu(path.string(), {}, sets, true);
      ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics().size(), 2u);
    }
  fs::remove(path);
}

}  // namespace
}  // namespace hwsim::lab
