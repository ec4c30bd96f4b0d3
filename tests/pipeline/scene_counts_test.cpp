// Counts that papers publish about their scenes, and that generators hold: measured here by a small
// rasterizer of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>

#include "pipeline/open/scene_source.h"
#include "tests/pipeline/scene_glb.h"

namespace hwsim::pipeline {
namespace {
using test::TemporaryFolder;

constexpr int kWidth = 1280, kHeight = 720;

struct Window {
  int x = 0, y = 0, width = kWidth, height = kHeight;
  int columns = 1, rows = 1;  ///< samples of a pixel
};

// The nearest triangle at each sample of a window: 0 is the background.
class NearestTriangles {
 public:
  NearestTriangles(const Scene& scene, const Camera& camera, const Window& w) : w_(w) {
    const auto samples =
        static_cast<std::size_t>(w.width * w.columns) * static_cast<std::size_t>(w.height * w.rows);
    id.assign(samples, 0);
    depth_.assign(samples, 2.0f);
    const glm::mat4 clip =
        clip_from_view(camera, static_cast<float>(kWidth) / kHeight) * camera.view_from_world;
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
      const glm::mat4 m = clip * instance.world_from_local;
      for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        glm::vec3 p[3];
        bool in_front = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const glm::vec4 c = m * glm::vec4(mesh.positions[mesh.indices[i + k]], 1);
          in_front = in_front && c.w > 0.01f;
          p[k] = {
              ((c.x / c.w * 0.5f + 0.5f) * kWidth - static_cast<float>(w.x)) * static_cast<float>(w.columns),
              ((0.5f - c.y / c.w * 0.5f) * kHeight - static_cast<float>(w.y)) * static_cast<float>(w.rows),
              c.z / c.w};
        }
        ++drawn;
        const glm::vec3 middle = (p[0] + p[1] + p[2]) / 3.0f;
        if (in_front && middle.x > 0.0f && middle.y > 0.0f &&
            middle.x < static_cast<float>(w.width * w.columns) &&
            middle.y < static_cast<float>(w.height * w.rows))
          ++in_view;
        if (in_front) draw(p);
      }
    }
  }

  std::vector<std::uint32_t> id;
  std::uint32_t drawn = 0;
  std::uint32_t in_view = 0;  ///< whose middle lies in the window, hidden ones too

  double covered_share() const {
    return 1.0 - static_cast<double>(std::count(id.begin(), id.end(), 0u)) / static_cast<double>(id.size());
  }

  int most_triangles_in_a_pixel() const {
    std::size_t most = 0;
    for (int y = 0; y < w_.height; ++y)
      for (int x = 0; x < w_.width; ++x) {
        std::set<std::uint32_t> seen;
        for (int j = 0; j < w_.rows; ++j)
          for (int i = 0; i < w_.columns; ++i) seen.insert(id[at(x * w_.columns + i, y * w_.rows + j)]);
        seen.erase(0);
        most = std::max(most, seen.size());
      }
    return static_cast<int>(most);
  }

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(w_.width * w_.columns) +
           static_cast<std::size_t>(x);
  }

  void draw(const glm::vec3* p) {
    const auto low = glm::min(p[0], glm::min(p[1], p[2])), high = glm::max(p[0], glm::max(p[1], p[2]));
    const int right = w_.width * w_.columns - 1, bottom = w_.height * w_.rows - 1;
    if (high.x < 0 || high.y < 0 || low.x > static_cast<float>(right) + 1 ||
        low.y > static_cast<float>(bottom) + 1)
      return;
    const int x0 = std::max(0, static_cast<int>(low.x)), x1 = std::min(right, static_cast<int>(high.x));
    const int y0 = std::max(0, static_cast<int>(low.y)), y1 = std::min(bottom, static_cast<int>(high.y));
    const auto cross = [](const glm::vec3& a, const glm::vec3& b, float x, float y) {
      return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    };
    const float area = cross(p[0], p[1], p[2].x, p[2].y);
    if (area == 0.0f) return;
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const float sx = static_cast<float>(x) + 0.5f, sy = static_cast<float>(y) + 0.5f;
        const float a = cross(p[1], p[2], sx, sy) / area, b = cross(p[2], p[0], sx, sy) / area,
                    c = 1.0f - a - b;
        if (a < 0.0f || b < 0.0f || c < 0.0f) continue;
        const float z = a * p[0].z + b * p[1].z + c * p[2].z;
        if (z >= depth_[at(x, y)] || z < 0.0f) continue;
        depth_[at(x, y)] = z;
        id[at(x, y)] = drawn;
      }
  }

  Window w_;
  std::vector<float> depth_;
};

const Camera& camera_named(const Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                  [&](const Camera& camera) { return camera.name == name; });
  EXPECT_NE(found, scene.cameras.end()) << name;
  return found != scene.cameras.end() ? *found : scene.cameras.front();
}

// SSS, section 5: 500 k triangles; close up the car fills the screen, the distant view's covers about 10 % of
// it. No view of a car fills a screen to its corners and holds the whole car.
TEST(SceneCounts, CarBody) {
  const TemporaryFolder folder("car");
  const Scene scene = open_scene("car_body", folder.path());
  EXPECT_NEAR(static_cast<double>(stats(scene).drawn_triangles), 500e3, 10e3);
  const NearestTriangles distant(scene, camera_named(scene, "distant"), {});
  const NearestTriangles close_up(scene, camera_named(scene, "close_up"), {});
  std::printf(
      "car_body: %u triangles; %.1f %% of the screen distant, %.1f %% close up with %u of them in view\n",
      distant.drawn, 100.0 * distant.covered_share(), 100.0 * close_up.covered_share(), close_up.in_view);
  EXPECT_NEAR(distant.covered_share(), 0.10, 0.01);
  EXPECT_GT(close_up.covered_share(), 0.88);
  EXPECT_GT(close_up.in_view, close_up.drawn * 95 / 100);
}

TEST(SceneCounts, CarBodyKeepsToItsTriangleBudget) {
  const TemporaryFolder folder("cars");
  for (const double triangles : {50e3, 200e3}) {
    const Scene scene =
        open_scene("car_body:triangles=" + std::to_string(static_cast<int>(triangles)), folder.path());
    EXPECT_NEAR(static_cast<double>(stats(scene).drawn_triangles), triangles, 0.02 * triangles);
  }
}

// AGAA, Fig. 2: up to 32 triangles in a pixel. At 32 samples that is as many as can be told apart, and chance
// lets no pixel reach it.
TEST(SceneCounts, FurBall) {
  const TemporaryFolder folder("fur");
  const Scene scene = open_scene("fur_ball", folder.path());
  const NearestTriangles window(scene, scene.cameras.front(), {480, 240, 160, 80, 8, 4});
  const int most = window.most_triangles_in_a_pixel();
  std::printf("fur_ball: up to %d triangles in a pixel\n", most);
  EXPECT_GE(most, 26);
  EXPECT_LE(most, 32);
}

// SBAA, Fig. 2 and Table 3 (docs/counts.md#primitives-and-triangles): 6 primitives a covered pixel, about 12
// % of the screen covered.
TEST(SceneCounts, Dragon) {
  const TemporaryFolder folder("dragon");
  const Scene scene = open_scene("dragon", folder.path());
  const NearestTriangles seen(scene, scene.cameras.front(), {});
  const double per_pixel = seen.drawn / (seen.covered_share() * kWidth * kHeight);
  std::printf("dragon: %.2f triangles a covered pixel, %.2f %% covered\n", per_pixel,
              100.0 * seen.covered_share());
  EXPECT_NEAR(per_pixel, 6.0, 0.5);
  EXPECT_NEAR(seen.covered_share(), 0.12, 0.01);
}

}  // namespace
}  // namespace hwsim::pipeline
