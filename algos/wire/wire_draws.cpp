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

float pixel_scale(const Camera& camera, int width, int height) {
  const float own = camera.orthographic ? camera.ortho_half_height_m : std::tan(0.5f * camera.fov_y_rad);
  const auto height_px = static_cast<float>(height);
  const float half = own * static_cast<float>(frame_widening(camera, static_cast<float>(width) / height_px));
  return half / height_px;  // Eq. 6.1
}

/// Triangles of `sorted` whose vertices are all as wide as they are drawn, and the others, in their order.
struct Parted {
  std::vector<std::uint32_t> opaque, rest;
};
Parted part_by_width(const std::vector<std::uint32_t>& sorted, const std::vector<bool>& wide) {
  Parted parted;
  for (std::size_t t = 0; t + 2 < sorted.size(); t += 3) {
    const bool all = wide[sorted[t]] && wide[sorted[t + 1]] && wide[sorted[t + 2]];
    auto& list = all ? parted.opaque : parted.rest;
    list.insert(list.end(), &sorted[t], &sorted[t] + 3);
  }
  return parted;
}

/// Which vertices the vertex shader leaves where they are.
std::vector<bool> wide_vertices(const Mesh& mesh, const glm::mat4& view, const Camera& camera,
                                float least_radius_at_1) {
  std::vector<bool> wide(mesh.positions.size());
  for (std::size_t i = 0; i < wide.size(); ++i) {
    const glm::vec3 out = glm::mat3(view) * mesh.normals[i];
    const glm::vec3 center(view * glm::vec4(mesh.positions[i] - mesh.normals[i] * mesh.radius[i], 1.0f));
    const float w = camera.orthographic ? 1.0f : std::max(-center.z, 0.0f);
    wide[i] = mesh.radius[i] * glm::length(out) >= w * least_radius_at_1;
  }
  return wide;
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

WireDraws::WireDraws(const WireOptions& options)
    : look_(look_of(options)), soft_(options.lighting != WireLighting::none), depth_(options.depth) {}

bool WireDraws::takes(const Mesh& mesh, const Material& material) const {
  return !mesh.radius.empty() && material.alpha_mode == AlphaMode::opaque;
}

SeparateCall WireDraws::prepare(const FrameRequest& request, const Camera& camera, DrawCall call) const {
  const Scene& scene = *request.scene;
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
  const float least = look_.width_px * pixel_scale(camera, request.width_px, request.height_px);
  Parted parted = part_by_width(sorted, wide_vertices(mesh, view, camera, least));
  const auto with = [&](std::vector<std::uint32_t>& list) {
    return DrawCall{call.instance, call.part, list.empty() ? nullptr : make_index_list(std::move(list))};
  };
  return {with(sorted), with(parted.opaque), with(parted.rest)};
}

WireVertexUniforms WireDraws::vertex_uniforms(const FrameParts& parts, const ForwardTarget& target) const {
  WireVertexUniforms uniforms;
  uniforms.clip_from_world = jittered(parts.clip_from_world, target.jitter_px, target.width, target.height);
  uniforms.pixel_scale = pixel_scale(parts.camera, target.width, target.height);
  uniforms.width_px = look_.width_px;
  uniforms.eye = parts.lighting.eye;
  uniforms.full_light_px = look_.full_light_px;
  return uniforms;
}

DrawBatch WireDraws::depth_batch(const FrameParts& parts, const ForwardTarget& target) const {
  DrawBatch batch = mesh_batch(parts, parts.draws.separate, wire_vertex_program(WireOutput::wire));
  batch.state = opaque_state(target);
  batch.vertex_uniforms = std::make_shared<WireVertexUniforms>(vertex_uniforms(parts, target));
  return batch;
}

DrawBatch WireDraws::opaque_batch(const FrameParts& parts, SurfaceInputs inputs) const {
  static constexpr WireOutput kOutputs[] = {WireOutput::position, WireOutput::normal, WireOutput::geometry,
                                            WireOutput::basic, WireOutput::full};
  ForwardTarget frame;
  frame.width = parts.request->width_px;
  frame.height = parts.request->height_px;
  WireVertexUniforms uniforms = vertex_uniforms(parts, frame);
  uniforms.bend = soft_;
  DrawBatch batch = mesh_batch(parts, parts.draws.separate_opaque,
                               wire_vertex_program(kOutputs[static_cast<std::size_t>(inputs)]));
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
  uniforms.pixel_scale = pixel_scale(parts.camera, target.width, target.height);
  uniforms.look = look_;
  if (parts.separate_taken) {  // as the opaque part beside it, which is lit as any surface
    uniforms.look.flatten = soft_;
    uniforms.look.half_lambert = false;
  }
  batch.fragment_uniforms = std::make_shared<WireUniforms>(uniforms);
  return batch;
}

std::vector<DrawBatch> WireDraws::batches(const FrameParts& parts, const ForwardTarget& target) const {
  if (depth_ != WireDepth::split) return {batch(parts, target, WirePart::all)};
  return {batch(parts, target, WirePart::wide), batch(parts, target, WirePart::faded)};
}

}  // namespace hwsim::algos
