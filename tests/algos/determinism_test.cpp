// The same bytes and the same counters whatever runs them: threads, vector width, skipped work.
// HWSIM_SIGNATURE_FILE names a file that the first program to run writes and later ones, built otherwise, must meet.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <hwy/targets.h>

#include "algos/frame_run.h"

namespace hwsim::test {
namespace {
using pipeline::Emulation;
using pipeline::EmulationOptions;

// Ends at the target that it was before, whatever a test does.
class ForcedTarget {
 public:
  explicit ForcedTarget(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~ForcedTarget() { hwy::SetSupportedTargetsForTest(0); }
  ForcedTarget(const ForcedTarget&) = delete;
  ForcedTarget& operator=(const ForcedTarget&) = delete;
};

class Determinism : public ::testing::TestWithParam<std::string> {
 protected:
  static std::vector<FrameSetup> setups() {
    const bool large = GetParam().starts_with("ssaa16x") || GetParam().starts_with("ssaa64x");
    const int width = large ? 80 : 320, height = large ? 45 : 180;
    return {{GetParam(), "sponza_hall", width, height}, {GetParam(), "grass:blades=4000", width, height}};
  }
};

std::string signature(const Emulation& e) {
  std::uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a
  const auto add = [&](const void* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) hash = (hash ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3ull;
  };
  add(e.color.pixels.data(), e.color.pixels.size() * sizeof(glm::vec4));
  for (const PassWork& pass : e.trace.passes)
    for (const PassCounters& chunk : pass.chunks) add(&chunk, sizeof(chunk));
  return std::to_string(hash);
}

void meet_signature(const std::string& key, const std::string& value) {
  const char* path = std::getenv("HWSIM_SIGNATURE_FILE");
  if (path == nullptr) return;
  std::ifstream in(path);
  for (std::string name, known; in >> name >> known;) {
    if (name != key) continue;
    EXPECT_EQ(known, value) << key << ": another build gave another result";
    return;
  }
  std::ofstream(path, std::ios::app) << key << " " << value << "\n";
}

TEST_P(Determinism, ThreadsChangeNothing) {
  for (const FrameSetup& setup : setups()) {
    const Emulation one = run_frame(setup, {});
    meet_signature(setup.technique + "/" + setup.scene, signature(one));
    for (const int jobs : {2, 3}) {
      EmulationOptions options;
      options.jobs = jobs;
      EXPECT_EQ(difference(one, run_frame(setup, options)), "") << setup.scene << ", " << jobs << " threads";
    }
  }
}

TEST_P(Determinism, VectorTargetsChangeNothing) {
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  if (targets.size() < 2) GTEST_SKIP() << "built for one vector target: configure with HWSIM_SIMD=all";
  for (const FrameSetup& setup : setups()) {
    const Emulation first = run_frame(setup, {});
    for (const std::int64_t target : targets) {
      const ForcedTarget forced(target);
      EXPECT_EQ(difference(first, run_frame(setup, {})), "") << setup.scene << ", " << hwy::TargetName(target);
    }
  }
}

TEST_P(Determinism, SkippedWorkChangesNothing) {
  std::uint64_t skipped = 0;
  for (const FrameSetup& setup : setups()) {
    const Emulation with = run_frame(setup, {});
    skipped += with.skipped.at("frustum") + with.skipped.at("accepted_tiles");
    for (const pipeline::SkipSwitches skip : {pipeline::SkipSwitches{false, true}, pipeline::SkipSwitches{true, false},
                                              pipeline::SkipSwitches{false, false}}) {
      EmulationOptions options;
      options.skip = skip;
      const Emulation without = run_frame(setup, options);
      EXPECT_EQ(difference(with, without), "") << setup.scene;
      if (!skip.frustum) {
        EXPECT_EQ(without.skipped.at("frustum"), 0u);
      }
      if (!skip.accepted_tiles) {
        EXPECT_EQ(without.skipped.at("accepted_tiles"), 0u);
      }
    }
  }
  RecordProperty("skipped", std::to_string(skipped));
}

INSTANTIATE_TEST_SUITE_P(Techniques, Determinism, ::testing::ValuesIn(technique_variants()),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           for (char& c : name)
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           return name;
                         });

}  // namespace
}  // namespace hwsim::test
