#include "algos/deferred/deferred.h"

#include <algorithm>
#include <array>

#include "algos/base/frame_parts.h"
#include "algos/base/shaders/deferred.h"
#include "algos/base/shaders/post.h"
#include "pipeline/shade/mesh_vertex.h"
#include "pipeline/state/sample_pattern.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

struct GBuffer {
  const GBufferLayout* layout = nullptr;
  std::vector<ImageId> attachments;
  ImageId depth, lit;
  int samples = 1;
  bool centroid = true, alpha_to_coverage = false;
};

GBuffer add_gbuffer(FrameGraph& graph, const Parameters& parameters) {
  GBuffer g;
  g.layout = &gbuffer_layouts()[static_cast<std::size_t>(parameters.find("layout")->second)];
  g.samples = static_cast<int>(parameters.find("samples")->second);
  g.centroid = parameters.find("centroid")->second != 0;
  const auto image = [&](std::string_view name, Format format) {
    return graph.add_image({std::string(name), format, graph.width(), graph.height(), g.samples});
  };
  for (const GBufferAttachment& attachment : g.layout->attachments)
    g.attachments.push_back(image(attachment.name, attachment.format));
  g.depth = image("depth", g.samples > 1 ? g.layout->depth_multisampled : g.layout->depth);
  g.lit = image("lit", g.layout->lit);
  return g;
}

DrawBatch gbuffer_batch(const FrameParts& parts, const GBuffer& g, const std::vector<DrawCall>& draws,
                        bool alpha_test) {
  DrawBatch batch;
  batch.state = opaque_state({});
  batch.state.raster.centroid = g.centroid;
  batch.vertex = parts.full_varyings ? &mesh_full_program() : &mesh_surface_program();
  batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{parts.clip_from_world});
  batch.fragment = &gbuffer_program(g.layout->encoding, parts.full_varyings, alpha_test);
  batch.fragment_uniforms =
      std::make_shared<GBufferUniforms>(GBufferUniforms{parts.camera.view_from_world, parts.full_varyings});
  batch.draws = draws;
  return batch;
}

void add_gbuffer_pass(FrameGraph& graph, const FrameParts& parts, const GBuffer& g) {
  // Normals are cleared to a valid code, so that no pass decodes a NaN (techniques 2.3).
  std::vector<ImageId> cleared = g.attachments;
  cleared.push_back(g.depth);
  graph.add_clear("clear", std::move(cleared));
  Pass& pass = graph.add_pass("gbuffer", PassKind::draw);
  pass.samples = g.samples;
  pass.color = g.attachments;
  pass.depth = g.depth;
  pass.batches.push_back(gbuffer_batch(parts, g, parts.draws.opaque, false));
  if (parts.draws.mask.empty()) return;
  DrawBatch batch = gbuffer_batch(parts, g, parts.draws.mask, !g.alpha_to_coverage);
  batch.state.coverage.alpha_to_coverage = batch.state.coverage.alpha_dither = g.alpha_to_coverage;
  pass.batches.push_back(std::move(batch));
}

/// What lighting passes read of the G-buffer, in the order of their slots.
std::vector<ImageId> lighting_inputs(const GBuffer& g) {
  std::vector<ImageId> images = g.attachments;
  if (depth_slot(g.layout->encoding) >= 0) images.push_back(g.depth);
  return images;
}

std::shared_ptr<DeferredUniforms> make_uniforms(const FrameGraph& graph, const FrameParts& parts,
                                                const GBuffer& g) {
  auto u = std::make_shared<DeferredUniforms>();
  u->lighting = parts.lighting;
  if (parts.shadow_map) u->lighting.shadow_slot = static_cast<int>(lighting_inputs(g).size());
  const float aspect = static_cast<float>(graph.width()) / static_cast<float>(graph.height());
  u->world_from_clip = glm::inverse(parts.clip_from_world);
  u->view_from_clip = glm::inverse(clip_from_view(parts.camera, aspect));
  u->view_from_world = parts.camera.view_from_world;
  u->background = graph.scene().background;
  u->width = graph.width();
  u->height = graph.height();
  u->samples = g.samples;
  std::ranges::copy(standard_sample_positions(g.samples), u->positions.begin());
  return u;
}

void bind_gbuffer(Pass& pass, const FrameParts& parts, const GBuffer& g) {
  pass.sampled = lighting_inputs(g);
  if (parts.shadow_map) pass.sampled.push_back(parts.shadow_map);
}

Pass& add_light_pass(FrameGraph& graph, const FrameParts& parts, const GBuffer& g, const std::string& name,
                     std::shared_ptr<const void> uniforms) {
  Pass& pass = graph.add_pass(name, PassKind::full_screen);
  pass.samples = g.samples;
  pass.color = {g.lit};
  pass.fragment = &deferred_light_program(g.layout->encoding);
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
  pass.fragment = &classify_program(g.layout->encoding);
  pass.uniforms = std::move(uniforms);
  bind_gbuffer(pass, parts, g);
}

/// Shaders cannot write single samples of a multisampled image (D3D11, GL): the tiles write a buffer of
/// samples, as in Lauritzen's program, and a full-screen pass at sample rate brings it to the render target.
/// With layout=gb_lauritzen that makes the 40 bytes a sample of SBAA's reference (techniques 3.6 b).
void add_tile_pass(FrameGraph& graph, const FrameParts& parts, const GBuffer& g,
                   std::shared_ptr<const void> uniforms) {
  Pass& pass = graph.add_pass("light_tiles", PassKind::compute);
  const ComputeProgram& program = tile_light_program(g.layout->encoding);
  pass.compute = &program;
  pass.groups_x = (graph.width() + program.group_width - 1) / program.group_width;
  pass.groups_y = (graph.height() + program.group_height - 1) / program.group_height;
  const ImageId samples =
      graph.add_image({"lit_samples", g.layout->lit, graph.width(), graph.height(), g.samples});
  pass.targets = {samples};
  pass.uniforms = std::move(uniforms);
  bind_gbuffer(pass, parts, g);
  Pass& copy = graph.add_pass("copy_lit", PassKind::full_screen);
  copy.samples = g.samples;
  copy.color = {g.lit};
  copy.sampled = {samples};
  copy.fragment = &copy_samples_program();
  copy.uniforms = std::make_shared<int>();  // of which the program reads nothing
  copy.state.raster.sample_rate = true;
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

/// Coverage comes from the first target's alpha, which other layouts use for a value of their own.
void check_alpha_to_coverage(const GBuffer& g) {
  if (!g.alpha_to_coverage || g.layout->encoding == GBufferEncoding::compact) return;
  Diagnostic error;
  error.code = "T003";
  error.message = "alpha_to_coverage = on with layout = " + std::string(g.layout->id) + ", must be gb_agaa16";
  error.help = "the other layouts keep a value of their own where alpha would stand";
  throw InputError(std::move(error), ExitStatus::usage);
}

FrameGraph build_deferred(const FrameRequest& request, const Parameters& parameters) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  const GBuffer g = add_gbuffer(graph, parameters);
  add_gbuffer_pass(graph, parts, g);
  Pass& light = add_light_pass(graph, parts, g, "light", make_uniforms(graph, parts, g));
  light.state.raster.sample_rate = g.samples > 1;
  finish(graph, parts, g);
  return graph;
}

FrameGraph build_simple_complex(const FrameRequest& request, const Parameters& parameters) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  GBuffer g = add_gbuffer(graph, parameters);
  g.alpha_to_coverage = parameters.find("alpha_to_coverage")->second != 0;
  check_alpha_to_coverage(g);
  add_gbuffer_pass(graph, parts, g);
  const auto uniforms = make_uniforms(graph, parts, g);
  uniforms->normal_dot_min = static_cast<float>(parameters.find("normal_dot_min")->second);
  uniforms->z_scale = static_cast<float>(parameters.find("z_scale")->second);
  uniforms->compare_all = parameters.find("compare_all")->second != 0;
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

constexpr ParameterInfo kLayout{"layout", 0, 0, 3, "what the G-buffer holds of a sample", kLayoutChoices};
constexpr std::array<ParameterInfo, 3> kDeferred = {
    ParameterInfo{"samples", 8, 1, 32, "samples a pixel: a power of two"}, kLayout, kCentroid};
constexpr std::array<ParameterInfo, 8> kSimpleComplex = {
    ParameterInfo{"samples", 8, 2, 32, "samples a pixel: a power of two"},
    kLayout,
    kCentroid,
    ParameterInfo{"lighting", 0, 0, 1, "full-screen passes with stencil, or 16x16 compute tiles",
                  "stencil|compute"},
    ParameterInfo{"normal_dot_min", 0.99, 0, 1, "normals further apart make a pixel complex (cosine)"},
    ParameterInfo{"z_scale", 1, 0, 1000, "depth steps beyond this many slopes of a pixel make it complex"},
    ParameterInfo{"compare_all", 0, 0, 1, "differing materials make a pixel complex, too", "off|on"},
    ParameterInfo{"alpha_to_coverage", 0, 0, 1, "alpha is coverage, not a test; with layout=gb_agaa16",
                  "off|on"}};

constexpr TechniqueInfo kTechniques[] = {
    {"deferred", "multisampled G-buffer, every sample lit", kDeferred, build_deferred},
    {"deferred_simple_complex", "multisampled G-buffer, samples lit only where they differ (Lauritzen 2010)",
     kSimpleComplex, build_simple_complex},
};

}  // namespace

std::span<const TechniqueInfo> deferred_techniques() { return kTechniques; }

}  // namespace hwsim::algos
