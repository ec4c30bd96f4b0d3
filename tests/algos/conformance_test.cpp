// The ways of glTF, each a patch whose color a closed form predicts: the emulated pipeline and the ray-traced
// reference must both show it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "algos/base/reference_frame.h"
#include "algos/techniques.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/gltf/gltf_loader.h"
#include "tests/algos/conformance_scene.h"

namespace hwsim::test {
namespace {

constexpr int kCellPx = 16;

std::array<int, 3> codes(const glm::vec3& linear) {
  std::array<int, 3> out{};
  for (int i = 0; i < 3; ++i)
    out[static_cast<std::size_t>(i)] =
        static_cast<int>(std::lround(std::min(pipeline::srgb_from_linear(linear[i]), 1.0f) * 255.0f));
  return out;
}

int largest_difference(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  int most = 0;
  for (std::size_t i = 0; i < 3; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

class Conformance : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    patches_ = new ConformanceScene();
    const pipeline::test::TemporaryFolder folder("conformance");
    request_ = new algos::FrameRequest();
    request_->scene = std::make_shared<const pipeline::Scene>(
        pipeline::load_gltf(folder.write("patches.glb", patches_->bytes())));
    request_->width_px = ConformanceScene::kColumns * kCellPx;
    request_->height_px = patches_->rows() * kCellPx;
  }
  static void TearDownTestSuite() {
    delete patches_;
    delete request_;
  }

  static pipeline::Image drawn_by(const std::string& technique) {
    const auto graph = algos::build_frame(algos::parse_technique(technique), *request_);
    return pipeline::emulate(graph, request_->features, request_->functional, {}).color;
  }
  static std::array<int, 3> shown(const pipeline::Image& image, std::size_t patch) {
    const int cell = static_cast<int>(patch), x = cell % ConformanceScene::kColumns,
              y = cell / ConformanceScene::kColumns;
    return codes(
        glm::vec3(image.at(x * kCellPx + kCellPx / 2, image.height - 1 - y * kCellPx - kCellPx / 2)));
  }
  static void expect_patches(const pipeline::Image& image, const std::string& what, int tolerance) {
    for (std::size_t i = 0; i < patches_->patches().size(); ++i) {
      const Patch& patch = patches_->patches()[i];
      const auto got = shown(image, i), want = codes(patch.color);
      EXPECT_LE(largest_difference(got, want), tolerance)
          << what << ": " << patch.name << " shows " << got[0] << " " << got[1] << " " << got[2] << ", not "
          << want[0] << " " << want[1] << " " << want[2];
    }
  }

  static ConformanceScene* patches_;
  static algos::FrameRequest* request_;
};
ConformanceScene* Conformance::patches_ = nullptr;
algos::FrameRequest* Conformance::request_ = nullptr;

TEST_F(Conformance, TheEmulatedPipelineShowsWhatTheClosedFormSays) {
  expect_patches(drawn_by("none"), "none", 1);
}

TEST_F(Conformance, TheReferenceShowsWhatTheClosedFormSays) {
  expect_patches(algos::render_reference_frame(*request_, {.samples = 4}), "reference", 1);
}

TEST_F(Conformance, TechniquesThatKeepColoredEmissionShowItToo) {
  // Positions, normals and colors are rounded on their way through a G-buffer.
  for (const char* technique : {"msaa4x", "ssaa4x", "deferred:samples=4,layout=gb_sbaa40",
                                "deferred_simple_complex:layout=gb_sbaa40", "sbaa_top", "sbaa_merge"})
    expect_patches(drawn_by(technique), technique, 3);
}

TEST_F(Conformance, UnlitSurfacesAreUnlitInEveryLayout) {
  for (const char* technique :
       {"deferred:samples=4,layout=gb_lauritzen", "deferred:samples=1,layout=gb_agaa16",
        "deferred:samples=4,layout=gb_20", "deferred_simple_complex:lighting=compute",
        "deferred_simple_complex:layout=gb_agaa16", "sss_gs", "sss_cs"}) {
    const pipeline::Image image = drawn_by(technique);
    for (std::size_t i = 0; i < patches_->patches().size(); ++i) {
      const Patch& patch = patches_->patches()[i];
      if (!patch.name.starts_with("unlit")) continue;
      EXPECT_LE(largest_difference(shown(image, i), codes(patch.color)), 1)
          << technique << ": " << patch.name;
    }
  }
}

TEST_F(Conformance, TableOnRequest) {  // a line a patch: HWSIM_CONFORMANCE_TABLE=FILE
  const char* path = std::getenv("HWSIM_CONFORMANCE_TABLE");
  if (path == nullptr) GTEST_SKIP() << "no file asked for";
  std::FILE* out = std::fopen(path, "w");
  ASSERT_NE(out, nullptr);
  const pipeline::Image emulated = drawn_by("none"),
                        traced = algos::render_reference_frame(*request_, {.samples = 4});
  for (std::size_t i = 0; i < patches_->patches().size(); ++i) {
    const Patch& patch = patches_->patches()[i];
    std::fprintf(out, "%s", patch.name.c_str());
    for (const auto& c : {codes(patch.color), shown(emulated, i), shown(traced, i)})
      std::fprintf(out, "\t%d %d %d", c[0], c[1], c[2]);
    std::fprintf(out, "\n");
  }
  std::fclose(out);
}

/// A white square of 2 m at the origin seen by an orthographic camera, lit by one light at `node`.
pipeline::Image lit_square(const nlohmann::json& light, const nlohmann::json& node, bool reference) {
  pipeline::test::GlbBuilder glb;
  glb.add_attribute("POSITION", {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0}, "VEC3", 3);
  glb.add_attribute("NORMAL", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  glb.primitive()["mode"] = 5;
  glb.primitive()["material"] = 0;
  glb.root["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}}};
  glb.root["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 20}}}}};
  glb.root["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 5}}});
  glb.root["nodes"].push_back(node);
  glb.root["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  glb.root["scenes"][0]["nodes"] = {0, 1, 2};
  glb.root["extensions"]["KHR_lights_punctual"]["lights"] = nlohmann::json::array({light});
  const pipeline::test::TemporaryFolder folder("lit_square");
  algos::FrameRequest request;
  request.scene =
      std::make_shared<const pipeline::Scene>(pipeline::load_gltf(folder.write("square.glb", glb.bytes())));
  request.width_px = request.height_px = 33;
  if (reference) return algos::render_reference_frame(request, {.samples = 16});
  const auto graph = algos::build_frame(algos::parse_technique("none"), request);
  return pipeline::emulate(graph, request.features, request.functional, {}).color;
}

// Base color 1, roughness 1; see ConformanceScene::lit.
float white_lit_by(float light, float cosine) {
  return std::min(0.05f + light * (cosine + 0.04f / 3.14159265f), 1.0f);
}

TEST(ConformanceLights, FallAsTheirClosedFormsSay) {
  using nlohmann::json;
  struct Case {
    const char* name;
    json light, node;
    float middle;  ///< linear
  };
  const json down_the_axis = {{"translation", {0, 0, 2}}};
  const float window = std::pow(1.0f - std::pow(4.0f / 16.0f, 2.0f), 2.0f);
  const std::vector<Case> cases = {
      {"directional", {{"type", "directional"}, {"intensity", 0.5}}, json::object(), white_lit_by(0.5f, 1)},
      {"directional, at 60 degrees",
       {{"type", "directional"}, {"intensity", 0.5}},
       {{"rotation", {0, 0.5, 0, std::sqrt(0.75)}}},
       white_lit_by(0.5f, 0.5f)},
      {"point, two meters away",
       {{"type", "point"}, {"intensity", 2}, {"range", 1e6}},
       down_the_axis,
       white_lit_by(0.5f, 1)},
      {"point, windowed by its range",
       {{"type", "point"}, {"intensity", 2}, {"range", 4}},
       down_the_axis,
       white_lit_by(0.5f * window, 1)},
      {"spot, on its axis",
       {{"type", "spot"},
        {"intensity", 2},
        {"range", 1e6},
        {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}},
       down_the_axis,
       white_lit_by(0.5f, 1)},
      {"spot, looking away",
       {{"type", "spot"}, {"intensity", 2}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}},
       {{"translation", {0, 0, 2}}, {"rotation", {0, 1, 0, 0}}},
       0.05f}};
  for (const Case& c : cases)
    for (const bool reference : {false, true}) {
      const auto got = codes(glm::vec3(lit_square(c.light, c.node, reference).at(16, 16)));
      EXPECT_LE(largest_difference(got, codes(glm::vec3(c.middle))), 1)
          << c.name << (reference ? ", reference: " : ": ") << got[0];
    }
}

}  // namespace
}  // namespace hwsim::test
