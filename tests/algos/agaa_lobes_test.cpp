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

}  // namespace
}  // namespace hwsim::test
