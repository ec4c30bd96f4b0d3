#include "pipeline/reference/shadow_detail.h"

#include <algorithm>
#include <mutex>

#include "pipeline/reference/reference.h"
#include "pipeline/scene/shadow_view.h"

namespace hwsim::pipeline {
namespace {

constexpr int kRaysAcross = 96;

/// Distances along the optical axis of what a camera sees, m.
std::vector<float> seen_distances(const ReferenceScene& scene, int camera, double aspect_ratio) {
  ReferenceOptions rays;
  rays.width = kRaysAcross;
  rays.height = std::max(1, static_cast<int>(kRaysAcross / aspect_ratio));
  rays.camera = camera;
  rays.offsets_px = {glm::vec2(0.0f)};
  std::vector<float> distances;
  std::mutex one_at_a_time;
  render_reference(scene, rays, [&](std::span<const SurfaceHit> hits, std::span<glm::vec4>) {
    const std::scoped_lock lock(one_at_a_time);
    for (const SurfaceHit& hit : hits) distances.push_back(hit.view_distance_m);
  });
  return distances;
}

/// `texel_px`: a texel's side in the picture at a distance of one meter, or anywhere if `orthographic`.
ShadowDetail detail_of(std::vector<float> distances, double texel_px, bool orthographic) {
  if (distances.empty()) return {};
  const auto at = [&](float distance) {
    return orthographic ? texel_px : texel_px / static_cast<double>(distance);
  };
  const auto coarse = std::count_if(distances.begin(), distances.end(),
                                    [&](float distance) { return at(distance) > kCoarseTexelPx; });
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return {at(*middle), static_cast<double>(coarse) / static_cast<double>(distances.size())};
}

}  // namespace

std::vector<ShadowDetail> shadow_details(const Scene& scene, std::size_t cameras, int width_px, int height_px,
                                         int shadow_map_px) {
  const Light* caster = shadow_caster(scene);
  if (caster == nullptr || scene.instances.empty()) return {};
  const glm::vec2 per_m =
      shadow_texels_per_m(shadow_clip_from_world(scene, -glm::normalize(caster->direction)), shadow_map_px);
  const double texel_m = 1.0 / static_cast<double>(std::min(per_m.x, per_m.y));
  const double aspect_ratio = static_cast<double>(width_px) / height_px;
  const ReferenceScene traced(scene);
  std::vector<ShadowDetail> details;
  for (std::size_t i = 0; i < std::min(cameras, scene.cameras.size()); ++i) {
    const Camera& camera = scene.cameras[i];
    const double pixel_m = 2.0 * half_height(camera, aspect_ratio) / height_px;
    details.push_back(detail_of(seen_distances(traced, static_cast<int>(i), aspect_ratio), texel_m / pixel_m,
                                camera.orthographic));
  }
  return details;
}

}  // namespace hwsim::pipeline
