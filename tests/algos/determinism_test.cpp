// The same bytes and the same counters whatever runs them: threads, vector width, skipped work.
// HWSIM_SIGNATURE_FILE names a file that the first program to run writes and later ones, built otherwise,
// must meet.
#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <cstdlib>
#include <fstream>
#include <span>
#include <type_traits>

#include "algos/frame_run.h"
#include "hwsim/base/content_hash.h"

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
    const int width = large ? 80 : 128, height = large ? 45 : 72;
    return {{GetParam(), "sponza_hall:bays=4", width, height},
            {GetParam(), "grass:blades=2000", width, height}};
  }
};

template <class T>
std::span<const std::uint8_t> bytes_of(const T* values, std::size_t count) {
  return {reinterpret_cast<const std::uint8_t*>(values), count * sizeof(T)};
}

/// Hashes of the image, of every chunk and of the reuse of blocks, and the frame's counters by name.
std::map<std::string, std::uint64_t> signature(const FrameSetup& setup, const Emulation& e) {
  const std::string key = setup.technique + "/" + setup.scene + "/";
  std::map<std::string, std::uint64_t> all;
  all[key + "image"] = fnv1a(bytes_of(e.color.pixels.data(), e.color.pixels.size()));
  static_assert(std::has_unique_object_representations_v<ReuseProfile>, "its bytes are its numbers");
  std::uint64_t& chunks = all[key + "chunks"];
  std::uint64_t& reuse = all[key + "reuse"];
  const PassCounters sum = total(e.trace);
  for (const PassWork& pass : e.trace.passes) {
    reuse = fnv1a(bytes_of(&pass.reuse, 1), reuse);
    for (const PassCounters& chunk : pass.chunks)
      for (const auto& [info, place] : algos::counters())
        chunks = fnv1a(bytes_of(&values(chunk)[place], 1), chunks);
  }
  for (const auto& [info, place] : algos::counters()) all[key + std::string(info.id)] = values(sum)[place];
  return all;
}

void meet_signature(const std::map<std::string, std::uint64_t>& found) {
  const char* path = std::getenv("HWSIM_SIGNATURE_FILE");
  if (path == nullptr) return;
  std::map<std::string, std::uint64_t> known;
  std::ifstream in(path);
  std::uint64_t value = 0;
  for (std::string name; in >> name >> value;) known[name] = value;
  std::ofstream out(path, std::ios::app);
  for (const auto& [name, number] : found) {
    if (const auto before = known.find(name); before != known.end())
      EXPECT_EQ(before->second, number) << name << ": another build gave another result";
    else
      out << name << " " << number << "\n";
  }
}

TEST_P(Determinism, ThreadsChangeNothing) {
  for (const FrameSetup& setup : setups()) {
    const Emulation one = run_frame(setup, {});
    meet_signature(signature(setup, one));
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
      EXPECT_EQ(difference(first, run_frame(setup, {})), "")
          << setup.scene << ", " << hwy::TargetName(target);
    }
  }
}

TEST_P(Determinism, SkippedWorkChangesNothing) {
  for (const FrameSetup& setup : setups()) {
    const Emulation with = run_frame(setup, {});
    EmulationOptions nothing;
    for (const pipeline::SkipInfo& off : pipeline::kSkips) {
      nothing.skip.*off.flag = false;
      EmulationOptions options;
      options.skip.*off.flag = false;
      const Emulation without = run_frame(setup, options);
      EXPECT_EQ(difference(with, without), "") << setup.scene << ", without " << off.name;
      EXPECT_EQ(without.skipped.at(std::string(off.name)), 0u);
    }
    EXPECT_EQ(difference(with, run_frame(setup, nothing)), "") << setup.scene << ", without any";
  }
}

// A skip that never applies would make the comparisons above empty.
TEST(Skips, EachAppliesSomewhere) {
  std::map<std::string, std::uint64_t> skipped;
  for (const FrameSetup& setup : {FrameSetup{"msaa4x", "sponza_hall", 320, 180},
                                  FrameSetup{"deferred:samples=4", "grass:blades=2000", 320, 180}})
    for (const auto& [name, count] : run_frame(setup, {}).skipped) skipped[name] += count;
  for (const pipeline::SkipInfo& skip : pipeline::kSkips)
    EXPECT_GT(skipped[std::string(skip.name)], 0u) << skip.name;
}

// The close-up shows a fifth of a body that is one mesh: as a whole it is in view.
TEST(Skips, ClustersBesideTheViewAreSkipped) {
  const FrameSetup setup{"none", "old_city", 160, 90};
  const Emulation with = run_frame(setup, {});
  std::uint64_t culled = 0;
  for (const PassWork& pass : with.trace.passes)
    if (pass.name == "forward")
      for (const PassCounters& chunk : pass.chunks) culled += chunk.setup.culled_frustum_primitives;
  EXPECT_GT(with.skipped.at("frustum") * pipeline::kClusterTriangles, culled / 4);
  EmulationOptions options;
  options.skip.frustum = false;
  EXPECT_EQ(difference(with, run_frame(setup, options)), "");
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
