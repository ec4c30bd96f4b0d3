#include "algos/wire/draws.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "algos/wire/shaders/wire.h"

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

float pixel_scale(const Camera& camera, int height_px) {
  const float half = camera.orthographic ? camera.ortho_half_height_m : std::tan(0.5f * camera.fov_y_rad);
  return half / static_cast<float>(height_px);  // Eq. 6.1
}

BlendState over() {
  BlendState blend;
  blend.enabled = true;
  blend.src_color = BlendFactor::src_alpha;
  blend.dst_color = BlendFactor::one_minus_src_alpha;
  blend.dst_alpha = BlendFactor::one_minus_src_alpha;
  return blend;
}

WireVertexUniforms vertex_uniforms(const FrameParts& parts, const ForwardTarget& target) {
  WireVertexUniforms uniforms;
  uniforms.clip_from_world = jittered(parts.clip_from_world, target.jitter_px, target.width, target.height);
  uniforms.pixel_scale = pixel_scale(parts.camera, target.height);
  uniforms.width_px = parts.request->wires->width_px;
  return uniforms;
}

DrawBatch wire_batch(const FrameParts& parts, const ForwardTarget& target, WirePart part) {
  const WireOptions& options = *parts.request->wires;
  DrawBatch batch = wire_depth_batch(parts, target);
  batch.state.raster.centroid = true;  // the paper calls it crucial: normals turn within a pixel
  batch.state.depth = {true, part == WirePart::wide || options.depth == WireDepth::all, Compare::less_equal};
  if (part != WirePart::wide) batch.state.blend = {over()};
  batch.fragment = &wire_program(part);
  WireUniforms uniforms;
  uniforms.lighting = parts.lighting;
  uniforms.pixel_scale = pixel_scale(parts.camera, target.height);
  uniforms.options = options;
  batch.fragment_uniforms = std::make_shared<WireUniforms>(uniforms);
  return batch;
}

}  // namespace

DrawCall sorted_wires(const Scene& scene, const Camera& camera, DrawCall call) {
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

DrawBatch wire_depth_batch(const FrameParts& parts, const ForwardTarget& target) {
  DrawBatch batch;
  if (!parts.request->wires) return batch;
  batch.state = opaque_state(target);
  batch.vertex = &wire_vertex_program();
  batch.vertex_uniforms = std::make_shared<WireVertexUniforms>(vertex_uniforms(parts, target));
  batch.draws = parts.draws.wires;
  return batch;
}

void add_wires(FrameGraph& graph, const FrameParts& parts, const std::string& name,
               const ForwardTarget& target) {
  if (!parts.request->wires || parts.draws.wires.empty()) return;
  Pass& pass = graph.add_pass(name, PassKind::draw);
  pass.width = target.width;
  pass.height = target.height;
  pass.samples = target.samples;
  pass.coverage_samples = target.coverage_samples;
  pass.drop_orphans = target.drop_orphans;
  pass.color = {target.color};
  pass.depth = target.depth;
  if (parts.shadow_map) pass.sampled = {parts.shadow_map};
  if (parts.request->wires->depth != WireDepth::split) {
    pass.batches.push_back(wire_batch(parts, target, WirePart::all));
    return;
  }
  pass.batches.push_back(wire_batch(parts, target, WirePart::wide));
  pass.batches.push_back(wire_batch(parts, target, WirePart::faded));
}

}  // namespace hwsim::algos
