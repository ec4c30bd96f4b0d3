// The ways of glTF, each a patch whose color a closed form predicts: the emulated pipeline and the ray-traced
// reference must both show it, and docs/conformance.md must say so.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>

#include "tests/algos/conformance_rows.h"

namespace hwsim::test {
namespace {

std::string text(const Codes& c) {
  return std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]);
}

class Conformance : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    pictures_ = new PatchPictures();
    rows_ = new std::vector<ConformanceRow>(patch_rows(*pictures_));
    for (const auto& more : {camera_rows(), light_rows()})
      rows_->insert(rows_->end(), more.begin(), more.end());
  }
  static void TearDownTestSuite() {
    delete pictures_;
    delete rows_;
  }

  static void expect_patches(const std::string& technique, int tolerance) {
    const pipeline::Image image = pictures_->drawn_by(technique);
    for (std::size_t i = 0; i < pictures_->patches().size(); ++i) {
      const Patch& patch = pictures_->patches()[i];
      const Codes got = pictures_->shown(image, i), want = codes_of(patch.color);
      EXPECT_LE(largest_difference(got, want), tolerance)
          << technique << ": " << patch.name << " shows " << text(got) << ", not " << text(want);
    }
  }

  static PatchPictures* pictures_;
  static std::vector<ConformanceRow>* rows_;
};
PatchPictures* Conformance::pictures_ = nullptr;
std::vector<ConformanceRow>* Conformance::rows_ = nullptr;

TEST_F(Conformance, EmulationAndReferenceShowWhatTheClosedFormSays) {
  for (const ConformanceRow& row : *rows_) {
    EXPECT_LE(largest_difference(row.emulated, row.want), 1)
        << row.kind << ", " << row.name << ": emulation shows " << text(row.emulated) << ", not "
        << text(row.want);
    EXPECT_LE(largest_difference(row.traced, row.want), 1)
        << row.kind << ", " << row.name << ": the reference shows " << text(row.traced) << ", not "
        << text(row.want);
  }
}

TEST_F(Conformance, CoversEveryKind) {
  std::set<std::string> kinds;
  for (const ConformanceRow& row : *rows_) kinds.insert(row.kind);
  for (const char* kind :
       {"negative scales", "non-uniform scales", "vertex colors", "texture transforms",
        "multiple coordinates", "primitive modes", "alpha modes", "double-sided", "occlusion",
        "emissive strength", "normal maps with tangents", "normal maps without tangents",
        "interleaved accessors", "sparse accessors", "quantized meshes", "cameras", "lights"})
    EXPECT_TRUE(kinds.contains(kind)) << kind;
}

TEST_F(Conformance, ThePageSaysWhatIsShown) {
  const std::string page = conformance_page(*rows_), path = source_dir() + "/docs/conformance.md";
  if (std::getenv("HWSIM_WRITE_CONFORMANCE") != nullptr) std::ofstream(path) << page;
  std::ifstream in(path);
  const std::string written((std::istreambuf_iterator<char>(in)), {});
  EXPECT_EQ(written, page) << "scripts/conformance.sh writes the page anew";
}

TEST_F(Conformance, TechniquesThatKeepColoredEmissionShowItToo) {
  // Positions, normals and colors are rounded on their way through a G-buffer.
  for (const char* technique : {"msaa4x", "ssaa4x", "deferred:samples=4,layout=gb_sbaa40",
                                "deferred_simple_complex:layout=gb_sbaa40", "sbaa_top", "sbaa_merge"})
    expect_patches(technique, 3);
}

TEST_F(Conformance, UnlitSurfacesAreUnlitInEveryLayout) {
  for (const char* technique :
       {"deferred:samples=4,layout=gb_lauritzen", "deferred:samples=1,layout=gb_agaa16",
        "deferred:samples=4,layout=gb_20", "deferred_simple_complex:lighting=compute",
        "deferred_simple_complex:layout=gb_agaa16", "sss_gs", "sss_cs"}) {
    const pipeline::Image image = pictures_->drawn_by(technique);
    for (std::size_t i = 0; i < pictures_->patches().size(); ++i) {
      const Patch& patch = pictures_->patches()[i];
      if (patch.kind != "unlit") continue;
      EXPECT_LE(largest_difference(pictures_->shown(image, i), codes_of(patch.color)), 1)
          << technique << ": " << patch.name;
    }
  }
}

}  // namespace
}  // namespace hwsim::test
