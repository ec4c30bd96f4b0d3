#include "lab/point/frame_cost.h"

#include <algorithm>

#include "lab/request/image_input.h"
#include "pipeline/scene/scene.h"

namespace hwsim::lab {
namespace {

// Nanoseconds of one core.
constexpr double kTriangleNs = 220.0, kDepthSampleNs = 1.2, kColorSampleNs = 18.0, kShadedPixelNs = 90.0;
constexpr double kLightsOfThat = 8.0;  ///< lights that cost as much as the rest of a shaded pixel
constexpr double kLoadedTriangleNs = 1800.0, kLeastLoadNs = 1e8;
constexpr double kNsPerSecond = 1e9, kGroupPixels = 64.0;

/// Has all that frames are built of, and nothing to draw.
std::shared_ptr<const pipeline::Scene> stand_in() {
  auto scene = std::make_shared<pipeline::Scene>();
  scene->cameras.emplace_back();
  scene->lights.emplace_back();
  scene->samplers.emplace_back();
  return scene;
}

double pixels_of(const pipeline::Pass& pass) {
  return static_cast<double>(pass.width) * static_cast<double>(pass.height);
}

double pass_ns(const pipeline::Pass& pass, double triangles, double shaded_ns) {
  switch (pass.kind) {
    case PassKind::draw: {
      const double views = std::max<double>(1.0, static_cast<double>(pass.viewports.size()));
      const double samples = pixels_of(pass) * pass.samples;
      const double covered = samples * (pass.color.empty() ? kDepthSampleNs : kColorSampleNs);
      return views * (triangles * kTriangleNs + covered) +
             (pass.color.empty() ? 0.0 : pixels_of(pass) * shaded_ns);
    }
    case PassKind::full_screen:
      return pixels_of(pass) * shaded_ns;
    case PassKind::compute:
      return kGroupPixels * pass.groups_x * pass.groups_y * shaded_ns;
    case PassKind::clear:
    case PassKind::copy:
    case PassKind::resolve:
      return pixels_of(pass) * pass.samples;
  }
  return 0.0;
}

}  // namespace

FrameCost expected_cost(const SceneView& scene, const algos::TechniqueChoice& technique,
                        const GpuConfig& gpu) {
  const View& view = scene.plan();
  const auto triangles = static_cast<double>(scene.summary().triangles);
  algos::FrameRequest request;
  request.scene = stand_in();
  request.width_px = view.resolution.width_px;
  request.height_px = view.resolution.height_px;
  request.point_lights = view.point_lights;
  request.shadows = view.shadows;
  request.shadow_map_px = view.shadow_map_px;
  request.features = gpu.features;
  request.functional = gpu.functional;
  const double shaded_ns = kShadedPixelNs * (1.0 + view.point_lights / kLightsOfThat);
  FrameCost cost;
  if (is_image_file(view.scene)) request.image = std::make_shared<const pipeline::RawImage>();
  try {
    const pipeline::FrameGraph graph = algos::build_frame(technique, request);
    for (const pipeline::Pass& pass : graph.passes())
      cost.frame_s += pass_ns(pass, triangles, shaded_ns) / kNsPerSecond;
  } catch (const InputError&) {  // told when it is emulated; it takes no time
  }
  cost.load_s = (kLeastLoadNs + triangles * kLoadedTriangleNs) / kNsPerSecond;
  return cost;
}

}  // namespace hwsim::lab
