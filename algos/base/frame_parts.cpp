#include "algos/base/frame_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "algos/base/prepass.h"
#include "algos/base/shaders/post.h"
#include "pipeline/emulate/material_views.h"
#include "pipeline/scene/shadow_view.h"
#include "pipeline/scene/special_surfaces.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

using ByDepth = std::vector<std::pair<float, DrawCall>>;

std::vector<DrawCall> back_to_front(ByDepth calls) {
  std::stable_sort(calls.begin(), calls.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<DrawCall> sorted;
  for (auto& [z, call] : calls) sorted.push_back(std::move(call));
  return sorted;
}

DrawLists list_draws(const FrameRequest& request, const Camera& camera) {
  const Scene& scene = *request.scene;
  DrawLists lists;
  ByDepth blended, separate, separate_opaque, separate_rest;
  for (int i = 0; i < static_cast<int>(scene.instances.size()); ++i) {
    const Instance& instance = scene.instances[static_cast<std::size_t>(i)];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const glm::vec3 center = 0.5f * (mesh.bounds_min + mesh.bounds_max);
    const float view_z = (camera.view_from_world * instance.world_from_local * glm::vec4(center, 1.0f)).z;
    for (int p = 0; p < static_cast<int>(mesh.parts.size()); ++p) {
      const Mesh::Part& part = mesh.parts[static_cast<std::size_t>(p)];
      const Material& material = scene.materials[static_cast<std::size_t>(part.material)];
      if (request.separate && request.separate->takes(mesh, material)) {
        const SeparateCall call = request.separate->prepare(request, camera, {i, p});
        separate.push_back({view_z, call.all});
        if (call.opaque.list) separate_opaque.push_back({view_z, call.opaque});
        if (call.rest.list) separate_rest.push_back({view_z, call.rest});
        continue;
      }
      switch (material.alpha_mode) {
        case AlphaMode::opaque:
          lists.opaque.push_back({i, p});
          break;
        case AlphaMode::mask:
          lists.mask.push_back({i, p});
          break;
        case AlphaMode::blend:
          blended.push_back({view_z, {i, p}});
          break;
      }
    }
  }
  lists.blend = back_to_front(std::move(blended));
  lists.separate = back_to_front(std::move(separate));
  lists.separate_opaque = back_to_front(std::move(separate_opaque));
  lists.separate_rest = back_to_front(std::move(separate_rest));
  return lists;
}

// PCG (O'Neill 2014): the same lights on every machine.
class Pcg {
 public:
  explicit Pcg(int seed)
      : state_(0x853c49e6748fea9bull + 0x9e3779b97f4a7c15ull * static_cast<std::uint64_t>(seed)) {}
  float next() {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    const auto shifted = static_cast<std::uint32_t>(((state_ >> 18u) ^ state_) >> 27u);
    const auto rotation = static_cast<std::uint32_t>(state_ >> 59u);
    const std::uint32_t bits = shifted >> rotation | shifted << ((32 - rotation) & 31);
    return static_cast<float>(bits >> 8) * 0x1p-24f;
  }

 private:
  std::uint64_t state_;
};

/// The box that added lights lie in, and how far they reach.
struct LightSpace {
  glm::vec3 low{0.0f}, extent{0.0f};
  float range_from = 0.0f, range_to = 0.0f;

  /// Mean volume that a light reaches; ranges are uniform.
  float light_m3() const {
    const float from2 = range_from * range_from, to2 = range_to * range_to;
    return 4.18879f * 0.25f * (range_from + range_to) * (from2 + to2);
  }
};

LightSpace light_space(const FrameRequest& request) {
  const SceneStats s = stats(*request.scene);
  LightSpace space{s.bounds_min, s.bounds_max - s.bounds_min};
  space.range_from = space.range_to = static_cast<float>(request.light_range) * glm::length(space.extent);
  const AddedLights& added = request.added;
  if (added.range_to_m > 0.0) {
    space.range_to = static_cast<float>(added.range_to_m);
    space.range_from = std::min(static_cast<float>(added.range_from_m), space.range_to);
  }
  const glm::vec3 middle = 0.5f * (s.bounds_min + s.bounds_max);
  for (int axis = 0; axis < 3; ++axis) {
    if (added.box_m[axis] <= 0.0) continue;
    space.extent[axis] = static_cast<float>(added.box_m[axis]);
    space.low[axis] = middle[axis] - 0.5f * space.extent[axis];
  }
  return space;
}

void add_point_lights(const FrameRequest& request, int count, LightingUniforms& lighting) {
  if (count <= 0) return;
  const LightSpace space = light_space(request);
  // Strength such that a light gives about 1/2 at a third of its range. Where more than two lights reach a
  // point, they share what two give: sixteen of full reach would leave most of the frame white.
  const float box_m3 = space.extent.x * space.extent.y * space.extent.z, light_m3 = space.light_m3();
  const float lights_at_a_point = static_cast<float>(count) * (light_m3 < box_m3 ? light_m3 / box_m3 : 1.0f);
  const float share = static_cast<float>(request.light_strength) / std::max(1.0f, lights_at_a_point / 2.0f);
  Pcg random(request.added.seed);
  if (lighting.point_count == 0) lighting.points.clear();
  for (int i = 0; i < count; ++i) {
    PointLight light;
    for (int axis = 0; axis < 3; ++axis)
      light.position[axis] = space.low[axis] + space.extent[axis] * random.next();
    for (int axis = 0; axis < 3; ++axis) light.color[axis] = 0.3f + 0.7f * random.next();
    float range = space.range_from;
    if (space.range_to > range) range += (space.range_to - range) * random.next();
    light.color *= share * 0.5f * range * range / 9.0f;
    light.inv_range2 = 1.0f / (range * range);
    lighting.points.push_back(light);
  }
  lighting.point_count = static_cast<int>(lighting.points.size());
}

/// The first of a frame's lights: directional ones, then points.
void keep_lights(int count, LightingUniforms& lighting) {
  lighting.directional_count = std::min(lighting.directional_count, count);
  lighting.point_count = std::min(lighting.point_count, count - lighting.directional_count);
  // The vectors keep at least one element (LightingUniforms).
  lighting.directional.resize(static_cast<std::size_t>(std::max(1, lighting.directional_count)));
  lighting.points.resize(static_cast<std::size_t>(std::max(1, lighting.point_count)));
}

DrawBatch depth_batch(const glm::mat4& clip_from_world, const std::vector<DrawCall>& draws, bool alpha_test) {
  DrawBatch batch;
  batch.state.depth = {true, true, Compare::less};
  batch.state.raster.cull =
      CullMode::none;  // both sides of a surface cast shadows, as for the reference's rays
  batch.vertex = alpha_test ? &mesh_uv_program() : &mesh_position_program();
  batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{clip_from_world});
  if (alpha_test) {
    batch.fragment = &alpha_test_program();
    batch.fragment_uniforms = std::make_shared<AlphaTestUniforms>();
  }
  batch.draws = draws;
  return batch;
}

void add_shadow_map(FrameGraph& graph, FrameParts& parts) {
  const FrameRequest& request = *parts.request;
  LightingUniforms& lighting = parts.lighting;
  const auto caster = std::find_if(lighting.directional.begin(), lighting.directional.end(),
                                   [](const DirectionalLight& l) { return l.shadowed; });
  if (!request.shadows || caster == lighting.directional.end() || request.scene->instances.empty()) return;
  const int size = request.shadow_map_px;
  const glm::mat4 clip = shadow_clip_from_world(*request.scene, caster->to_light);
  parts.shadow_map = graph.add_image({"shadow_map", Format::d32_float, size, size, 1});
  graph.add_clear("shadow_clear", {parts.shadow_map});
  Pass& pass = graph.add_pass("shadow", PassKind::draw);
  pass.width = pass.height = size;
  pass.depth = parts.shadow_map;
  pass.batches.push_back(depth_batch(clip, parts.draws.opaque, false));
  if (!parts.draws.separate.empty()) pass.batches.push_back(depth_batch(clip, parts.draws.separate, false));
  if (!parts.draws.mask.empty()) pass.batches.push_back(depth_batch(clip, parts.draws.mask, true));
  const float half = 0.5f * static_cast<float>(size);
  const glm::mat4 texels = glm::translate(glm::mat4(1.0f), glm::vec3(half, half, 0.0f)) *
                           glm::scale(glm::mat4(1.0f), glm::vec3(half, -half, 1.0f));
  lighting.shadow_from_world = texels * clip;
  lighting.shadow_slot = 0;
  // Moving the receiver by 1.5 texels keeps a slope of 45 degrees from shadowing itself.
  lighting.shadow_offset_m = 1.5f / shadow_texels_per_m(clip, size).x;
  lighting.shadow_bias = 1e-4f;
}

DrawBatch surface_batch(const FrameParts& parts, const ForwardTarget& target,
                        const std::vector<DrawCall>& draws, bool alpha_test) {
  DrawBatch batch = mesh_batch(parts, draws, surface_vertex_program(parts));
  batch.state = opaque_state(target);
  batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(
      MeshVertexUniforms{jittered(parts.clip_from_world, target.jitter_px, target.width, target.height)});
  batch.fragment = &forward_program(parts.full_varyings, alpha_test, parts.lighting.extended);
  batch.fragment_uniforms =
      std::make_shared<ForwardUniforms>(ForwardUniforms{parts.lighting, parts.full_varyings});
  return batch;
}

void add_separate(FrameGraph& graph, const FrameParts& parts, const std::string& prefix,
                  const ForwardTarget& target) {
  if (parts.draws.separate.empty()) return;
  const SeparateDraws& separate = *parts.request->separate;
  add_target_pass(graph, parts, prefix + separate.pass_name(), target).batches =
      separate.batches(parts, target);
}

}  // namespace

void describe_centroid(OptionList& list, bool& centroid) {
  list.choice("centroid", centroid, "off|on", "attributes inside the primitive at partly covered pixels");
}

Pass& add_target_pass(FrameGraph& graph, const FrameParts& parts, const std::string& name,
                      const ForwardTarget& target) {
  Pass& pass = graph.add_pass(name, PassKind::draw);
  pass.width = target.width;
  pass.height = target.height;
  pass.samples = target.samples;
  pass.coverage_samples = target.coverage_samples;
  pass.drop_orphans = target.drop_orphans;
  pass.viewports = target.layers.viewports;
  pass.color = {target.color};
  pass.depth = target.depth;
  if (parts.shadow_map) pass.sampled = {parts.shadow_map};
  return pass;
}

const VertexProgram& surface_vertex_program(const FrameParts& parts) {
  return parts.full_varyings ? mesh_full_program() : mesh_surface_program();
}

SurfaceInputs surface_inputs(const FrameParts& parts) {
  return parts.full_varyings ? SurfaceInputs::full : SurfaceInputs::basic;
}

DrawBatch mesh_batch(const FrameParts& parts, const std::vector<DrawCall>& draws,
                     const VertexProgram& vertex) {
  DrawBatch batch;
  batch.state = opaque_state({});
  batch.vertex = &vertex;
  batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{parts.clip_from_world});
  batch.draws = draws;
  return batch;
}

glm::mat4 jittered(const glm::mat4& clip_from_world, glm::vec2 jitter_px, int width, int height) {
  // Clip x and y move by a multiple of w: a sample further right sees what lies further right, so geometry
  // moves left.
  glm::mat4 result = clip_from_world;
  for (int column = 0; column < 4; ++column) {
    result[column][0] -= 2.0f * jitter_px.x / static_cast<float>(width) * clip_from_world[column][3];
    result[column][1] += 2.0f * jitter_px.y / static_cast<float>(height) * clip_from_world[column][3];
  }
  return result;
}

PipelineState opaque_state(const ForwardTarget& target) {
  PipelineState state;
  state.depth = {true, true, Compare::less};
  state.raster.cull = CullMode::back;
  state.raster.centroid = target.centroid;
  state.raster.sample_rate = target.sample_rate;
  state.raster.sample_positions = target.layers.positions;
  // Each layer shades its pixel: textures filtered for a whole one would blur, and more layers look worse.
  const auto layers = static_cast<float>(std::max<std::size_t>(1, target.layers.viewports.size()));
  state.raster.texture_footprint = 1.0f / std::sqrt(layers);
  return state;
}

BlendState blend_over() {
  BlendState over;
  over.enabled = true;
  over.src_color = BlendFactor::src_alpha;
  over.dst_color = BlendFactor::one_minus_src_alpha;
  over.dst_alpha = BlendFactor::one_minus_src_alpha;
  return over;
}

LightingUniforms frame_lighting(const FrameRequest& request) {
  const Scene& scene = *request.scene;
  LightingUniforms lighting =
      make_lighting(scene, scene.cameras.at(static_cast<std::size_t>(request.camera)));
  if (!request.metal_ambient) lighting.extended = has_unlit(scene);
  switch (request.lights) {
    case LightProfile::scene:
      add_point_lights(request, request.point_lights, lighting);
      break;
    case LightProfile::added:
      keep_lights(0, lighting);
      add_point_lights(request, request.point_lights, lighting);
      break;
    case LightProfile::simple:
      keep_lights(1, lighting);
      break;
    case LightProfile::complex:
      add_point_lights(request, kComplexLights - lighting.directional_count - lighting.point_count, lighting);
      keep_lights(kComplexLights, lighting);
      break;
  }
  return lighting;
}

FrameParts prepare_frame(FrameGraph& graph, const FrameRequest& request) {
  FrameParts parts;
  parts.request = &request;
  const Scene& scene = *request.scene;
  parts.camera = scene.cameras.at(static_cast<std::size_t>(request.camera));
  const float aspect = static_cast<float>(request.width_px) / static_cast<float>(request.height_px);
  parts.clip_from_world = clip_from_view(parts.camera, aspect) * parts.camera.view_from_world;
  parts.view_from_clip = glm::inverse(clip_from_view(parts.camera, aspect));
  parts.draws = list_draws(request, parts.camera);
  parts.full_varyings = needs_full_varyings(scene);
  parts.lighting = frame_lighting(request);
  add_shadow_map(graph, parts);
  return parts;
}

ForwardTarget make_forward_target(FrameGraph& graph, const std::string& name, int width, int height,
                                  int samples, Format color, Format depth, const MulticastPattern& layers) {
  ForwardTarget target;
  target.width = width;
  target.height = height;
  const int layer_count = std::max(1, static_cast<int>(layers.viewports.size()));
  target.samples = samples / layer_count;
  target.layers = layers;
  target.color = graph.add_image({name + "_color", color, width, height, target.samples, layer_count});
  target.depth = graph.add_image({name + "_depth", depth, width, height, target.samples, layer_count});
  return target;
}

MulticastPattern multicast_layers(const FrameRequest& request, int samples, Emulate emulate) {
  const bool native = emulate == Emulate::off ||
                      (emulate == Emulate::automatic && samples <= request.features.native_msaa_max);
  return native || samples <= 8 ? MulticastPattern{} : multicast_pattern(samples);
}

void add_forward(FrameGraph& graph, const FrameParts& parts, const std::string& prefix,
                 const ForwardTarget& target) {
  graph.add_clear(prefix + "clear", {target.color, target.depth},
                  glm::vec4(parts.request->scene->background, 1.0f));
  if (target.prepass) add_prepass(graph, parts, prefix, target);
  Pass& pass = add_target_pass(graph, parts, prefix + "forward", target);
  pass.batches.push_back(surface_batch(parts, target, parts.draws.opaque, false));
  // After a pre-pass that dropped what is below the cutoff, equal depth is the alpha test.
  if (!parts.draws.mask.empty())
    pass.batches.push_back(surface_batch(parts, target, parts.draws.mask, !target.prepass));
  if (target.prepass)
    for (DrawBatch& batch : pass.batches) draw_where_equal(batch.state);
  add_blended(graph, parts, prefix, target);
}

void add_blended(FrameGraph& graph, const FrameParts& parts, const std::string& prefix,
                 const ForwardTarget& target) {
  add_separate(graph, parts, prefix, target);
  if (parts.draws.blend.empty()) return;
  Pass& pass = add_target_pass(graph, parts, prefix + "blended", target);
  DrawBatch batch = surface_batch(parts, target, parts.draws.blend, false);
  batch.state.depth.write = false;
  batch.state.blend = {blend_over()};
  pass.batches.push_back(std::move(batch));
}

FrameParts prepare_gbuffer_frame(FrameGraph& graph, const FrameRequest& request) {
  FrameParts parts = prepare_frame(graph, request);
  parts.draws.separate = std::move(parts.draws.separate_rest);
  parts.draws.separate_rest.clear();
  parts.separate_taken = true;
  return parts;
}

void add_opaque_separate(Pass& pass, const FrameParts& parts, SurfaceInputs inputs, DrawBatch like) {
  if (parts.draws.separate_opaque.empty()) return;
  const DrawBatch own = parts.request->separate->opaque_batch(parts, inputs);
  like.vertex = own.vertex;
  like.vertex_uniforms = own.vertex_uniforms;
  like.draws = own.draws;
  pass.batches.push_back(std::move(like));
}

void add_over_output(FrameGraph& graph, const FrameParts& parts, ImageId output, ImageId depth,
                     const MulticastPattern& layers, bool blended) {
  if (parts.draws.separate.empty() && (!blended || parts.draws.blend.empty())) return;
  const ImageDesc like = graph.image(depth);
  ForwardTarget target;
  target.width = like.width;
  target.height = like.height;
  target.samples = like.samples;
  target.layers = layers;
  target.depth = depth;
  target.color =
      graph.add_image({"over", Format::rgba8_srgb, like.width, like.height, like.samples, like.layers});
  graph.add_clear("over_clear", {target.color});
  if (blended)
    add_blended(graph, parts, "", target);
  else
    add_separate(graph, parts, "", target);
  Pass& pass = add_full_screen(graph, "over", {target.color}, output, merge_program(),
                               std::make_shared<MergeUniforms>(MergeUniforms{like.samples * like.layers}));
  BlendState over = blend_over();  // what was drawn is multiplied by its alpha already
  over.src_color = BlendFactor::one;
  pass.state.blend = {over};
}

Pass& add_frame_compute(FrameGraph& graph, const std::string& name, const ComputeProgram& program,
                        pipeline::Uniforms uniforms) {
  Pass& pass = graph.add_pass(name, PassKind::compute);
  pass.compute = &program;
  pass.groups_x = (graph.width() + program.group_width - 1) / program.group_width;
  pass.groups_y = (graph.height() + program.group_height - 1) / program.group_height;
  pass.uniforms = std::move(uniforms);
  return pass;
}

Pass& add_full_screen(FrameGraph& graph, const std::string& name, std::vector<ImageId> sampled,
                      ImageId target, const FragmentProgram& program, pipeline::Uniforms uniforms) {
  Pass& pass = graph.add_pass(name, PassKind::full_screen);
  pass.width = graph.image(target).width;
  pass.height = graph.image(target).height;
  pass.sampled = std::move(sampled);
  pass.color = {target};
  pass.fragment = &program;
  pass.uniforms = std::move(uniforms);
  return pass;
}

ImageId add_output(FrameGraph& graph) {
  const ImageId output = graph.add_image({"output", Format::rgba8_srgb, graph.width(), graph.height(), 1});
  graph.set_output(output);
  return output;
}

}  // namespace hwsim::algos
