#include "algos/forward/forward_plus.h"

#include <bit>

#include "algos/base/frame_parts.h"
#include "algos/base/prepass.h"
#include "algos/forward/options.h"
#include "algos/forward/shaders/light_lists.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

std::shared_ptr<const std::vector<std::uint32_t>> light_words(const LightingUniforms& lighting) {
  std::vector<std::uint32_t> words;
  for (const PointLight& light : lighting.points)
    for (const float value : {light.position.x, light.position.y, light.position.z, light.inv_range2,
                              light.color.x, light.color.y, light.color.z, light.cos_outer, light.axis.x,
                              light.axis.y, light.axis.z, light.inv_cos_span})
      words.push_back(std::bit_cast<std::uint32_t>(value));
  return std::make_shared<const std::vector<std::uint32_t>>(std::move(words));
}

bool has_spots(const LightingUniforms& lighting) {
  return std::ranges::any_of(lighting.points,
                             [](const PointLight& light) { return light.cos_outer > -1.5f; });
}

/// The lists of all tiles, and the lights that they index.
struct LightLists {
  TileGrid grid;
  BufferId lists, lights;
};

LightLists add_lists(FrameGraph& graph, const FrameParts& parts) {
  LightLists l;
  l.grid = {graph.width(), graph.height(), parts.lighting.point_count};
  l.lists = graph.add_buffer({"light_lists", static_cast<std::uint64_t>(l.grid.words())});
  const auto words = light_words(parts.lighting);
  l.lights = graph.add_buffer({"lights", words->size(), words});
  return l;
}

void add_cull_pass(FrameGraph& graph, const FrameParts& parts, const ForwardTarget& target,
                   const LightLists& l) {
  auto u = std::make_shared<CullUniforms>();
  u->grid = l.grid;
  u->samples = target.samples;
  u->view_from_world = parts.camera.view_from_world;
  u->view_from_clip = parts.view_from_clip;
  Pass& pass = add_frame_compute(graph, "cull_lights", cull_lights_program(), std::move(u));
  pass.sampled = {target.depth};
  pass.storage = {l.lists, l.lights};
  pass.storage_written = 1;
}

void add_listed_batch(Pass& pass, const FrameParts& parts, const ForwardTarget& target, const LightLists& l,
                      const std::vector<DrawCall>& draws) {
  DrawBatch batch = mesh_batch(parts, draws, surface_vertex_program(parts));
  batch.state = opaque_state(target);
  draw_where_equal(batch.state);
  batch.fragment = &listed_forward_program(parts.full_varyings, parts.lighting.extended);
  auto u = std::make_shared<ListedForwardUniforms>();
  u->forward = {parts.lighting, parts.full_varyings};
  u->grid = l.grid;
  u->spots = has_spots(parts.lighting);
  batch.fragment_uniforms = std::move(u);
  pass.batches.push_back(std::move(batch));
}

ForwardTarget add_target(FrameGraph& graph, const ForwardPlusOptions& options) {
  ForwardTarget target;
  if (options.samples > 1) {
    target = make_forward_target(graph, "multisampled", graph.width(), graph.height(), options.samples);
    target.centroid = options.centroid;
    return target;
  }
  target.width = graph.width();
  target.height = graph.height();
  target.color = add_output(graph);
  target.depth = graph.add_image({"depth", Format::d24_unorm_s8, graph.width(), graph.height(), 1});
  return target;
}

FrameGraph build_forward_plus(const FrameRequest& request, const ForwardPlusOptions& options) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  const ForwardTarget target = add_target(graph, options);
  const LightLists lists = add_lists(graph, parts);
  graph.add_clear("clear", {target.color, target.depth}, glm::vec4(request.scene->background, 1.0f));
  add_prepass(graph, parts, "", target);
  add_cull_pass(graph, parts, target, lists);
  Pass& pass = add_target_pass(graph, parts, "forward", target);
  pass.storage = {lists.lists, lists.lights};
  add_listed_batch(pass, parts, target, lists, parts.draws.opaque);
  if (!parts.draws.mask.empty()) add_listed_batch(pass, parts, target, lists, parts.draws.mask);
  add_blended(graph, parts, "", target);
  if (options.samples > 1) graph.add_resolve("resolve", target.color, add_output(graph));
  return graph;
}

}  // namespace

void describe(OptionList& list, ForwardPlusOptions& o) {
  list.choice("samples", o.samples, "1|2|4|8", std::array<int, 4>{1, 2, 4, 8}, "samples a pixel");
  describe_centroid(list, o.centroid);
}

TechniqueInfo forward_plus_technique() {
  return base_technique(
      "forward_plus", "forward shading by lists of lights, culled against 16x16 tiles after a depth pre-pass",
      build_forward_plus);
}

}  // namespace hwsim::algos
