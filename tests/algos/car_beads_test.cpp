// The bead chains that selective supersampling exists for, on the car that stands for SSS's: along a moulding
// that is thinner than a pixel of the distant view, a highlight breaks up without shading samples, and is
// whole with 64.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "algos/base/reference_frame.h"
#include "algos/techniques.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/generate/spline_body.h"
#include "pipeline/open/scene_source.h"
#include "support/places.h"

namespace hwsim::algos {
namespace {
using pipeline::Image;

constexpr int kWidth = 320, kHeight = 96;
constexpr double kDistantHeight = 720.0;
constexpr double kMoulding = 6.0;  // the section at which the windows' moulding runs

/// The window of the distant view, at its scale, that looks at the left window's moulding.
FrameRequest moulding_request() {
  pipeline::Scene scene =
      pipeline::open_scene("car_body:mouldings=1", hwsim::test::binary_dir() + "/test-cache/scenes");
  for (pipeline::Camera& camera : scene.cameras)
    if (camera.name == "distant") {
      const glm::mat4 world_from_view = glm::inverse(camera.view_from_world);
      const glm::vec3 eye(world_from_view[3]), target(pipeline::generate::body_point(9.0, kMoulding));
      camera.view_from_world = glm::lookAt(eye, target, glm::vec3(0, 1, 0));
      camera.fov_y_rad =
          static_cast<float>(2.0 * std::atan(std::tan(0.5 * camera.fov_y_rad) * kHeight / kDistantHeight));
      scene.cameras = {camera};
      break;
    }
  FrameRequest request;
  request.scene = std::make_shared<const pipeline::Scene>(std::move(scene));
  request.width_px = kWidth;
  request.height_px = kHeight;
  request.shadows = false;
  return request;
}

/// By column: the light of the rows within two pixels of the moulding.
std::vector<double> light_along(const Image& image, const FrameRequest& request) {
  const pipeline::Camera& camera = request.scene->cameras.front();
  const glm::mat4 clip =
      pipeline::clip_from_view(camera, static_cast<float>(kWidth) / kHeight) * camera.view_from_world;
  std::vector<double> light(kWidth, -1.0);
  for (double s = 5.8; s < 12.2; s += 0.002) {
    const glm::vec4 p = clip * glm::vec4(glm::vec3(pipeline::generate::body_point(s, kMoulding)), 1.0f);
    const int x = static_cast<int>((0.5f + 0.5f * p.x / p.w) * kWidth),
              y = static_cast<int>((0.5f - 0.5f * p.y / p.w) * kHeight);
    if (x < 0 || x >= kWidth || y < 2 || y >= kHeight - 2 || light[static_cast<std::size_t>(x)] >= 0.0)
      continue;
    double sum = 0.0;
    for (int row = y - 2; row <= y + 2; ++row) sum += image.at(x, row).y;
    light[static_cast<std::size_t>(x)] = sum;
  }
  return light;
}

/// The error of the moulding's light from column to column, over its mean: 0 is a line without beads.
double beads(const std::string& technique, const FrameRequest& request, const std::vector<double>& truth) {
  const pipeline::FrameGraph graph = build_frame(parse_technique(technique), request);
  const std::vector<double> light =
      light_along(pipeline::emulate(graph, request.features, request.functional, {}).color, request);
  double squares = 0.0, sum = 0.0;
  int columns = 0;
  for (std::size_t x = 8; x + 8 < kWidth; ++x) {
    if (light[x] < 0.0) continue;
    squares += (light[x] - truth[x]) * (light[x] - truth[x]);
    sum += truth[x];
    ++columns;
  }
  EXPECT_GT(columns, 150);
  return std::sqrt(squares * columns) / sum;
}

TEST(CarBody, BreaksAHighlightIntoBeadsThatShadingSamplesClose) {
  const FrameRequest request = moulding_request();
  const std::vector<double> truth =
      light_along(render_reference_frame(request, {.samples = 256, .jobs = 2}), request);
  const double msaa8x = beads("msaa8x", request, truth), ssaa16x = beads("ssaa16x", request, truth);
  EXPECT_GT(beads("none", request, truth), 0.4);
  EXPECT_GT(msaa8x, 0.15);
  EXPECT_LT(ssaa16x, msaa8x / 3.0);
  EXPECT_LT(beads("ssaa64x", request, truth), ssaa16x / 2.0);
  // As they are timed: the defaults, which the published rows' mapping names.
  for (const char* technique : {"sss_gs", "sss_cs"})
    EXPECT_LT(beads(technique, request, truth), msaa8x / 2.5) << technique;
  EXPECT_LT(beads("sss_ppll", request, truth), ssaa16x);
  // Over the whole frame, which holds what was missed, beads stay.
  EXPECT_GT(beads("sss_ppll:rest=frame", request, truth), msaa8x * 0.9);
}

}  // namespace
}  // namespace hwsim::algos
