#include "algos/deferred.h"

#include <algorithm>
#include <array>

#include "algos/frame_parts.h"
#include "algos/shaders/deferred.h"
#include "algos/shaders/post.h"
#include "pipeline/raster/sample_pattern.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

/// Layout gb_lauritzen: 16 bytes and depth a sample, lit color 8 bytes.
struct GBuffer {
  ImageId normal, albedo, gradient, depth, lit;
  int samples = 1;
};

GBuffer add_gbuffer(FrameGraph& graph, int samples) {
  const auto image = [&](const char* name, Format format) {
    return graph.add_image({name, format, graph.width(), graph.height(), samples});
  };
  GBuffer g;
  g.samples = samples;
  g.normal = image("gbuffer_normal", Format::rgba16_float);
  g.albedo = image("gbuffer_albedo", Format::rgba8_srgb);
  g.gradient = image("gbuffer_gradient", Format::rg16_float);
  g.depth = image("depth", samples > 1 ? Format::d32_float_s8 : Format::d32_float);
  g.lit = image("lit", Format::rgba16_float);
  return g;
}

DrawBatch gbuffer_batch(const FrameParts& parts, const std::vector<DrawCall>& draws, bool alpha_test) {
  DrawBatch batch;
  batch.state = opaque_state({});
  batch.vertex = parts.full_varyings ? &mesh_full_program() : &mesh_surface_program();
  batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{parts.clip_from_world});
  batch.fragment = &gbuffer_program(parts.full_varyings, alpha_test);
  batch.fragment_uniforms =
      std::make_shared<GBufferUniforms>(GBufferUniforms{parts.camera.view_from_world, parts.full_varyings});
  batch.draws = draws;
  return batch;
}

void add_gbuffer_pass(FrameGraph& graph, const FrameParts& parts, const GBuffer& g) {
  // Normals are cleared to a valid code, so that no pass decodes a NaN (techniques 2.3).
  graph.add_clear("clear", {g.normal, g.albedo, g.gradient, g.depth});
  Pass& pass = graph.add_pass("gbuffer", PassKind::draw);
  pass.samples = g.samples;
  pass.color = {g.normal, g.albedo, g.gradient};
  pass.depth = g.depth;
  pass.batches.push_back(gbuffer_batch(parts, parts.draws.opaque, false));
  if (!parts.draws.mask.empty()) pass.batches.push_back(gbuffer_batch(parts, parts.draws.mask, true));
}

std::shared_ptr<DeferredUniforms> make_uniforms(const FrameGraph& graph, const FrameParts& parts,
                                                int samples) {
  auto u = std::make_shared<DeferredUniforms>();
  u->lighting = parts.lighting;
  if (parts.shadow_map) u->lighting.shadow_slot = kShadowSlot;
  const float aspect = static_cast<float>(graph.width()) / static_cast<float>(graph.height());
  u->world_from_clip = glm::inverse(parts.clip_from_world);
  u->view_from_clip = glm::inverse(clip_from_view(parts.camera, aspect));
  u->view_from_world = parts.camera.view_from_world;
  u->background = graph.scene().background;
  u->width = graph.width();
  u->height = graph.height();
  u->samples = samples;
  std::ranges::copy(standard_sample_positions(samples), u->positions.begin());
  return u;
}

void bind_gbuffer(Pass& pass, const FrameParts& parts, const GBuffer& g) {
  pass.sampled = {g.normal, g.albedo, g.gradient, g.depth};
  if (parts.shadow_map) pass.sampled.push_back(parts.shadow_map);
}

Pass& add_light_pass(FrameGraph& graph, const FrameParts& parts, const GBuffer& g, const std::string& name,
                     std::shared_ptr<const void> uniforms) {
  Pass& pass = graph.add_pass(name, PassKind::full_screen);
  pass.samples = g.samples;
  pass.color = {g.lit};
  pass.fragment = &deferred_light_program();
  pass.uniforms = std::move(uniforms);
  bind_gbuffer(pass, parts, g);
  return pass;
}

void select_by_stencil(Pass& pass, const GBuffer& g, std::uint8_t value) {
  pass.depth = g.depth;
  pass.depth_read_only = true;
  pass.state.stencil.test = true;
  pass.state.stencil.compare = Compare::equal;
  pass.state.stencil.reference = value;
}

void add_classify_pass(FrameGraph& graph, const FrameParts& parts, const GBuffer& g,
                       std::shared_ptr<const void> uniforms) {
  Pass& pass = graph.add_pass("classify", PassKind::full_screen);
  pass.samples = g.samples;
  pass.depth = g.depth;
  pass.depth_read_only = true;
  pass.state.stencil.test = true;
  pass.state.stencil.reference = 1;
  pass.state.stencil.on_pass = StencilOp::replace;
  pass.fragment = &classify_program();
  pass.uniforms = std::move(uniforms);
  bind_gbuffer(pass, parts, g);
}

void add_tile_pass(FrameGraph& graph, const FrameParts& parts, const GBuffer& g,
                   std::shared_ptr<const void> uniforms) {
  Pass& pass = graph.add_pass("light_tiles", PassKind::compute);
  const ComputeProgram& program = tile_light_program();
  pass.compute = &program;
  pass.groups_x = (graph.width() + program.group_width - 1) / program.group_width;
  pass.groups_y = (graph.height() + program.group_height - 1) / program.group_height;
  pass.targets = {g.lit};
  pass.uniforms = std::move(uniforms);
  bind_gbuffer(pass, parts, g);
}

void finish(FrameGraph& graph, const FrameParts& parts, const GBuffer& g) {
  ForwardTarget target;
  target.color = g.lit;
  target.depth = g.depth;
  target.width = graph.width();
  target.height = graph.height();
  target.samples = g.samples;
  add_blended(graph, parts, "blended", target);
  const ImageId output = add_output(graph);
  if (g.samples > 1) {
    graph.add_resolve("resolve", g.lit, output);
    return;
  }
  add_full_screen(graph, "present", {g.lit}, output, scale_program(), std::make_shared<ScaleUniforms>());
}

FrameGraph build_deferred(const FrameRequest& request, const Parameters& parameters) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  const int samples = static_cast<int>(parameters.find("samples")->second);
  const GBuffer g = add_gbuffer(graph, samples);
  add_gbuffer_pass(graph, parts, g);
  Pass& light = add_light_pass(graph, parts, g, "light", make_uniforms(graph, parts, samples));
  light.state.raster.sample_rate = samples > 1;
  finish(graph, parts, g);
  return graph;
}

FrameGraph build_simple_complex(const FrameRequest& request, const Parameters& parameters) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  const int samples = static_cast<int>(parameters.find("samples")->second);
  const GBuffer g = add_gbuffer(graph, samples);
  add_gbuffer_pass(graph, parts, g);
  const auto uniforms = make_uniforms(graph, parts, samples);
  uniforms->normal_dot_min = static_cast<float>(parameters.find("normal_dot_min")->second);
  if (parameters.find("lighting")->second != 0) {
    add_tile_pass(graph, parts, g, uniforms);
  } else {
    add_classify_pass(graph, parts, g, uniforms);
    select_by_stencil(add_light_pass(graph, parts, g, "light_simple", uniforms), g, 0);
    Pass& complex = add_light_pass(graph, parts, g, "light_complex", uniforms);
    select_by_stencil(complex, g, 1);
    complex.state.raster.sample_rate = true;
  }
  finish(graph, parts, g);
  return graph;
}

constexpr std::array<ParameterInfo, 1> kDeferred = {
    ParameterInfo{"samples", 8, 1, 8, "samples a pixel: 1, 2, 4 or 8"}};
constexpr std::array<ParameterInfo, 3> kSimpleComplex = {
    ParameterInfo{"samples", 8, 2, 8, "samples a pixel: 2, 4 or 8"},
    ParameterInfo{"lighting", 0, 0, 1, "full-screen passes with stencil, or 16x16 compute tiles",
                  "stencil|compute"},
    ParameterInfo{"normal_dot_min", 0.99, 0, 1, "normals further apart make a pixel complex (cosine)"}};

constexpr TechniqueInfo kTechniques[] = {
    {"deferred", "multisampled G-buffer, every sample lit", kDeferred, build_deferred},
    {"deferred_simple_complex", "multisampled G-buffer, samples lit only where they differ (Lauritzen 2010)",
     kSimpleComplex, build_simple_complex},
};

}  // namespace

std::span<const TechniqueInfo> deferred_techniques() { return kTechniques; }

}  // namespace hwsim::algos
