// What AGAA's aggregates reflect where their normals spread: the material's color, and highlights as long as
// the spread is (docs/techniques/agaa.md#shading).
#include <gtest/gtest.h>

#include "algos/agaa_frames.h"

namespace hwsim::test {
namespace {

// Brass of any gloss and any spread of normals is brass: the color is stored with what its lobe reflects, so
// that no exponent has to be guessed. With chroma scaled by a guess blue vanished from spread normals.
TEST(AgaaLobes, SpreadNormalsKeepTheHue) {
  const glm::vec3 brass(0.8f, 0.6f, 0.25f);
  for (const float roughness : {0.2f, 0.5f, 0.7f})
    for (const float slope : {0.0f, 0.3f, 0.8f}) {
      pipeline::Scene scene = slats(slope);
      for (pipeline::Material& m : scene.materials) {
        m.metallic = 1.0f;
        m.roughness = roughness;
        m.base_color = glm::vec4(brass, 1.0f);
      }
      scene.lights.front().direction = glm::vec3(0.0f, 0.0f, -1.0f);
      // About white at the lobe's peak.
      const float cosine = 1.0f / std::sqrt(1.0f + slope * slope), spread = (1.0f - cosine) / cosine;
      const float wide = 1.0f / (spread + 1.0f / (2.0f / std::pow(roughness, 4.0f) - 2.0f));
      scene.lights.front().color = glm::vec3(8.0f * 3.14159f / (wide + 8.0f));
      scene.ambient = glm::vec3(0.0f);
      const pipeline::Image image = render({share(std::move(scene)), "agaa:c=1"}).color;
      int lit = 0;
      for (int x = kWidth / 2 - 4; x < kWidth / 2 + 4; ++x) {
        const glm::vec4& c = image.at(x, kHeight / 2);
        if (c.x < 0.2f || c.x > 0.99f) continue;  // eight bits of sRGB
        ++lit;
        EXPECT_NEAR(c.y / c.x, brass.y / brass.x, 0.03f) << roughness << " " << slope << " " << x;
        EXPECT_NEAR(c.z / c.x, brass.z / brass.x, 0.03f) << roughness << " " << slope << " " << x;
      }
      EXPECT_GT(lit, 0) << roughness << " " << slope;
    }
}

/// A metal sheet with grooves along y, four slopes a pixel, before the eye; the light comes from there.
pipeline::Scene brushed_metal() {
  constexpr float kSlopes[] = {-0.3f, 0.1f, 0.3f, -0.1f};
  const float width = 0.0725f / 4.0f;
  std::vector<Rectangle> grooves;
  for (int i = -100; i < 100; ++i)
    grooves.push_back({width * static_cast<float>(i), width * static_cast<float>(i + 1), 0, glm::vec3(0.5f),
                       kSlopes[i & 3]});
  pipeline::Scene scene = patches(grooves);
  for (pipeline::Material& m : scene.materials) {
    m.metallic = 1.0f;
    m.roughness = 0.35f;
  }
  scene.lights.front().direction = glm::vec3(0.0f, 0.0f, -1.0f);
  scene.lights.front().color = glm::vec3(0.2f);
  scene.ambient = glm::vec3(0.0f);
  return scene;
}

/// How much longer a highlight is across the picture than up: deviations of light about its mean place.
float elongation(const pipeline::Image& image) {
  double sum = 0, x1 = 0, y1 = 0, x2 = 0, y2 = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double light = image.at(x, y).x;
      sum += light;
      x1 += light * x;
      y1 += light * y;
      x2 += light * x * x;
      y2 += light * y * y;
    }
  const auto variance = [sum](double first, double second) {
    return second / sum - first / sum * first / sum;
  };
  return static_cast<float>(std::sqrt(variance(x1, x2) / variance(y1, y2)));
}

// Figures 10 and 16: LEAN, and SGGX with GGX, keep a highlight that grooves draw out, where Toksvig's one
// length makes it round.
TEST(AgaaLobes, AnisotropicOnesKeepHighlightsLong) {
  const auto scene = share(brushed_metal());
  const auto of = [&](const char* technique) { return elongation(render({scene, technique}).color); };
  const float truth = of("ssaa64x");
  EXPECT_GT(truth, 1.8f);
  for (const char* technique : {"agaa:c=1,ndf=lean", "agaa:c=2,ndf=lean", "agaa:c=1,ndf=sggx"})
    EXPECT_NEAR(of(technique), truth, 0.25f * truth) << technique;
  EXPECT_LT(of("agaa:c=1"), 0.7f * truth);
}

}  // namespace
}  // namespace hwsim::test
