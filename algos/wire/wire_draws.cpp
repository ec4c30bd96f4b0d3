#include "algos/wire/wire_draws.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hwsim::algos {
namespace {
using namespace pipeline;

/// Sets of vertices that triangles connect.
class Wires {
 public:
  explicit Wires(std::size_t vertices) : parent_(vertices) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t of(std::uint32_t vertex) {
    while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
    return vertex;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

float pixel_scale(const Camera& camera, const ForwardTarget& target) {
  const float own = camera.orthographic ? camera.ortho_half_height_m : std::tan(0.5f * camera.fov_y_rad);
  const auto height_px = static_cast<float>(target.height);
  const float half =
      own * static_cast<float>(frame_widening(camera, static_cast<float>(target.width) / height_px));
  return half / height_px;  // Eq. 6.1
}

WireLook look_of(const WireOptions& o) {
  WireLook look;
  look.width_px = static_cast<float>(o.width_px);
  look.full_light_px = static_cast<float>(o.full_light_px);
  look.half_lambert = o.lighting == WireLighting::half_lambert || o.lighting == WireLighting::both;
  look.flatten = o.lighting == WireLighting::flatten || o.lighting == WireLighting::both;
  look.half_lambert_power = o.half_lambert_power;
  look.fade_per_pixel = o.fade == WireFade::pixel;
  return look;
}

}  // namespace

WireDraws::WireDraws(const WireOptions& options) : look_(look_of(options)), depth_(options.depth) {}

bool WireDraws::takes(const Mesh& mesh, const Material& material) const {
  return !mesh.radius.empty() && material.alpha_mode == AlphaMode::opaque;
}

DrawCall WireDraws::prepare(const Scene& scene, const Camera& camera, DrawCall call) const {
  const Instance& instance = scene.instances[static_cast<std::size_t>(call.instance)];
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
  const Mesh::Part& part = mesh.parts[static_cast<std::size_t>(call.part)];
  const std::span indices(mesh.indices.data() + part.first_index, part.index_count);
  Wires wires(mesh.positions.size());
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    wires.join(indices[i], indices[i + 1]);
    wires.join(indices[i], indices[i + 2]);
  }
  const glm::mat4 view = camera.view_from_world * instance.world_from_local;
  std::vector<double> depth(mesh.positions.size(), 0.0), count(mesh.positions.size(), 0.0);
  for (const std::uint32_t index : indices) {
    depth[wires.of(index)] += (view * glm::vec4(mesh.positions[index], 1.0f)).z;
    count[wires.of(index)] += 1.0;
  }
  std::vector<std::size_t> order(indices.size() / 3);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto mean_z = [&](std::size_t triangle) {
    const std::uint32_t wire = wires.of(indices[3 * triangle]);
    return depth[wire] / count[wire];
  };
  std::vector<double> z(order.size());
  for (std::size_t t = 0; t < z.size(); ++t) z[t] = mean_z(t);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return z[a] < z[b]; });
  std::vector<std::uint32_t> sorted;
  sorted.reserve(indices.size());
  for (const std::size_t t : order) sorted.insert(sorted.end(), &indices[3 * t], &indices[3 * t] + 3);
  call.list = make_index_list(std::move(sorted));
  return call;
}

DrawBatch WireDraws::depth_batch(const FrameParts& parts, const ForwardTarget& target) const {
  WireVertexUniforms uniforms;
  uniforms.clip_from_world = jittered(parts.clip_from_world, target.jitter_px, target.width, target.height);
  uniforms.pixel_scale = pixel_scale(parts.camera, target);
  uniforms.width_px = look_.width_px;
  DrawBatch batch = mesh_batch(parts, parts.draws.separate, wire_vertex_program());
  batch.state = opaque_state(target);
  batch.vertex_uniforms = std::make_shared<WireVertexUniforms>(uniforms);
  return batch;
}

DrawBatch WireDraws::batch(const FrameParts& parts, const ForwardTarget& target, WirePart part) const {
  DrawBatch batch = depth_batch(parts, target);
  batch.state.raster.centroid = true;  // the paper calls it crucial: normals turn within a pixel
  batch.state.depth = {true, part == WirePart::wide || depth_ == WireDepth::all, Compare::less_equal};
  if (part != WirePart::wide) batch.state.blend = {blend_over()};
  batch.fragment = &wire_program(part, parts.lighting.extended);
  WireUniforms uniforms;
  uniforms.lighting = parts.lighting;
  uniforms.pixel_scale = pixel_scale(parts.camera, target);
  uniforms.look = look_;
  batch.fragment_uniforms = std::make_shared<WireUniforms>(uniforms);
  return batch;
}

std::vector<DrawBatch> WireDraws::batches(const FrameParts& parts, const ForwardTarget& target) const {
  if (depth_ != WireDepth::split) return {batch(parts, target, WirePart::all)};
  return {batch(parts, target, WirePart::wide), batch(parts, target, WirePart::faded)};
}

}  // namespace hwsim::algos
