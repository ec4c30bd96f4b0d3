// Numbers that no GPU ever had are warned about, with the unit that they may be in.
#include "lab/catalog/plausible.h"

#include <gtest/gtest.h>

#include "lab/catalog/config_folder.h"

namespace hwsim::lab {
namespace {

GpuConfig with(const std::string& key, const std::string& value) {
  return load_gpu("rtx4090", {}, std::vector<Assignment>{{"gpu." + key, value}}, ConfigFolder().gpus());
}

std::string help_for(const std::string& key, const std::string& value) {
  const std::vector<Diagnostic> warnings = implausible_numbers(with(key, value));
  if (warnings.size() != 1) return std::to_string(warnings.size()) + " warnings";
  EXPECT_EQ(warnings.front().code, "C027");
  EXPECT_EQ(warnings.front().severity, Severity::warning);
  EXPECT_NE(warnings.front().message.find("`" + key + "` is "), std::string::npos);
  return warnings.front().help;
}

TEST(ImplausibleNumbers, NameTheUnitAndTheNumberInIt) {
  EXPECT_EQ(help_for("core_clock_mhz", "2.6"), "`core_clock_mhz` is in MHz: 2600 if 2.6 GHz was meant");
  EXPECT_EQ(help_for("dram_bandwidth_gb_s", "0.64"),
            "`dram_bandwidth_gb_s` is in GB/s: 640 if 0.64 TB/s was meant");
  EXPECT_EQ(help_for("l2_size_kib", "36"), "`l2_size_kib` is in KiB: 36864 if 36 MiB was meant");
  EXPECT_EQ(help_for("llc_size_kib", "96"), "`llc_size_kib` is in KiB: 98304 if 96 MiB was meant");
  EXPECT_EQ(help_for("core_clock_mhz", "50000"), "`core_clock_mhz` is in MHz");
  EXPECT_EQ(help_for("shader_cores", "16384"), "`shader_cores` counts SMs or compute units, not lanes");
}

TEST(ImplausibleNumbers, AreNoneOfTheGpusThatComeWithHwsim) {
  for (const std::string& id : list_gpus(ConfigFolder().gpus()))
    EXPECT_TRUE(implausible_numbers(load_gpu(id, {}, {}, ConfigFolder().gpus())).empty()) << id;
  EXPECT_TRUE(implausible_numbers(with("llc_size_kib", "0")).empty()) << "no such cache";
  EXPECT_TRUE(implausible_numbers(with("l2_size_kib", "64")).empty());
}

TEST(ImplausibleNumbers, HaveThePlaceThatGaveThem) {
  EXPECT_EQ(implausible_numbers(with("core_clock_mhz", "2")).front().place.file, "(command line)");
}

}  // namespace
}  // namespace hwsim::lab
