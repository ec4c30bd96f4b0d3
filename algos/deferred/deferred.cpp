#include "algos/deferred/deferred.h"

#include <algorithm>
#include <array>

#include "algos/base/frame_parts.h"
#include "algos/base/lost_light.h"
#include "algos/base/prepass.h"
#include "algos/base/shaders/post.h"
#include "algos/deferred/options.h"
#include "algos/deferred/shaders/programs.h"
#include "pipeline/state/sample_pattern.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

struct GBuffer {
  const GBufferLayout* layout = nullptr;
  std::vector<ImageId> attachments;
  ImageId depth, lit;
  int samples = 1;           ///< samples of a layer
  MulticastPattern pattern;  ///< layers of eight samples, or none
  bool centroid = true, alpha_to_coverage = false, prepass = false;

  int layers() const { return std::max(1, static_cast<int>(pattern.viewports.size())); }
};

ForwardTarget lit_target(const FrameGraph& graph, const GBuffer& g) {
  ForwardTarget target;
  target.color = g.lit;
  target.depth = g.depth;
  target.width = graph.width();
  target.height = graph.height();
  target.samples = g.samples;
  target.centroid = g.centroid;
  target.layers = g.pattern;
  return target;
}

GBuffer add_gbuffer(FrameGraph& graph, const FrameRequest& request, const DeferredOptions& options) {
  GBuffer g;
  g.layout = &gbuffer_layouts()[static_cast<std::size_t>(options.layout)];
  g.pattern = multicast_layers(request, options.samples, options.emulate);
  g.samples = options.samples / g.layers();
  g.centroid = options.centroid;
  g.prepass = options.prepass;
  const auto image = [&](std::string_view name, Format format) {
    return graph.add_image({std::string(name), format, graph.width(), graph.height(), g.samples, g.layers()});
  };
  for (const GBufferAttachment& attachment : g.layout->attachments)
    g.attachments.push_back(image(attachment.name, attachment.format));
  g.depth = image("depth", g.samples > 1 ? g.layout->depth_multisampled : g.layout->depth);
  g.lit = image("lit", g.layout->lit);
  return g;
}

DrawBatch gbuffer_batch(const FrameParts& parts, const GBuffer& g, const std::vector<DrawCall>& draws,
                        bool alpha_test) {
  DrawBatch batch = mesh_batch(parts, draws, surface_vertex_program(parts));
  ForwardTarget target;
  target.centroid = g.centroid;
  target.layers = g.pattern;
  batch.state = opaque_state(target);
  if (g.prepass) draw_where_equal(batch.state);
  batch.fragment =
      &gbuffer_program(g.layout->encoding, parts.full_varyings, alpha_test, parts.lighting.extended);
  batch.fragment_uniforms = std::make_shared<GBufferUniforms>(
      GBufferUniforms{parts.camera.view_from_world, parts.full_varyings, parts.lighting.extended});
  return batch;
}

void add_gbuffer_pass(FrameGraph& graph, const FrameParts& parts, const GBuffer& g) {
  // Normals are cleared to a valid code, so that no pass decodes a NaN
  // (docs/techniques/deferred.md#simple-and-complex).
  std::vector<ImageId> cleared = g.attachments;
  cleared.push_back(g.depth);
  graph.add_clear("clear", std::move(cleared));
  if (g.prepass) add_prepass(graph, parts, "", lit_target(graph, g));
  Pass& pass = graph.add_pass("gbuffer", PassKind::draw);
  pass.samples = g.samples;
  pass.viewports = g.pattern.viewports;
  pass.color = g.attachments;
  pass.depth = g.depth;
  pass.batches.push_back(gbuffer_batch(parts, g, parts.draws.opaque, false));
  add_opaque_separate(pass, parts, surface_inputs(parts), gbuffer_batch(parts, g, {}, false));
  if (parts.draws.mask.empty()) return;
  DrawBatch batch = gbuffer_batch(parts, g, parts.draws.mask, !g.alpha_to_coverage && !g.prepass);
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
  u->world_from_clip = glm::inverse(parts.clip_from_world);
  u->view_from_clip = parts.view_from_clip;
  u->view_from_world = parts.camera.view_from_world;
  u->background = graph.scene().background;
  u->width = graph.width();
  u->height = graph.height();
  u->samples = g.samples;
  if (g.layers() > 1)
    std::ranges::copy(effective_positions(g.pattern), u->positions.begin());
  else
    std::ranges::copy(standard_sample_positions(g.samples), u->positions.begin());
  return u;
}

void bind_gbuffer(Pass& pass, const FrameParts& parts, const GBuffer& g) {
  pass.sampled = lighting_inputs(g);
  if (parts.shadow_map) pass.sampled.push_back(parts.shadow_map);
}

/// A full-screen pass in each layer, with the samples where the G-buffer has them.
void cover_layers(Pass& pass, const GBuffer& g) {
  pass.samples = g.samples;
  pass.viewports = g.pattern.viewports;
  pass.state.raster.sample_positions = g.pattern.positions;
}

Pass& add_light_pass(FrameGraph& graph, const FrameParts& parts, const GBuffer& g, const std::string& name,
                     pipeline::Uniforms uniforms) {
  Pass& pass = graph.add_pass(name, PassKind::full_screen);
  cover_layers(pass, g);
  pass.color = {g.lit};
  pass.fragment = &deferred_light_program(g.layout->encoding, parts.lighting.extended);
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
                       pipeline::Uniforms uniforms) {
  Pass& pass = graph.add_pass("classify", PassKind::full_screen);
  cover_layers(pass, g);
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
/// samples, which the last pass reads and averages, as in Lauritzen's program. That program also holds the
/// multisampled target that its other ways of lighting draw to: with layout=gb_lauritzen both make the 40
/// bytes a sample of SBAA's reference (docs/techniques/deferred.md#g-buffers).
void add_tile_passes(FrameGraph& graph, const FrameParts& parts, const GBuffer& g,
                     std::shared_ptr<DeferredUniforms> uniforms) {
  const ImageId samples =
      graph.add_image({"lit_samples", g.layout->lit, graph.width(), graph.height(), g.samples, g.layers()});
  Pass& pass =
      add_frame_compute(graph, "light_tiles", tile_light_program(g.layout->encoding, parts.lighting.extended),
                        std::move(uniforms));
  pass.targets = {samples};
  bind_gbuffer(pass, parts, g);
  const ImageId output = add_output(graph);
  add_full_screen(graph, "resolve", {samples}, output, merge_program(),
                  std::make_shared<MergeUniforms>(MergeUniforms{g.samples * g.layers()}));
  add_over_output(graph, parts, output, g.depth, g.pattern, true);
}

[[noreturn]] void refuse(std::string message, std::string help) {
  Diagnostic error;
  error.code = "T003";
  error.message = std::move(message);
  error.help = std::move(help);
  throw InputError(std::move(error), ExitStatus::usage);
}

/// Lit color of one sample a pixel as the frame's image: what takes linear light takes it as it is.
void show(FrameGraph& graph, const FrameParts& parts, ImageId lit) {
  if (parts.request->linear_output)
    graph.set_output(lit);
  else
    add_full_screen(graph, "present", {lit}, add_output(graph), scale_program(),
                    std::make_shared<ScaleUniforms>());
}

/// The tiles write the mean of a pixel's samples, so that lit color has one sample a pixel.
void add_averaging_tiles(FrameGraph& graph, const FrameParts& parts, const GBuffer& g,
                         const std::shared_ptr<DeferredUniforms>& uniforms) {
  if (g.layers() > 1)
    refuse("resolve = tiles with " + std::to_string(g.samples * g.layers()) + " samples in layers",
           "emulate=off makes them samples of one layer, or resolve=pass averages layers");
  uniforms->mean_in_tiles = true;
  const ImageId mean = graph.add_image({"lit_mean", g.layout->lit, graph.width(), graph.height(), 1});
  Pass& pass = add_frame_compute(
      graph, "light_tiles", tile_light_program(g.layout->encoding, parts.lighting.extended, true), uniforms);
  pass.targets = {mean};
  bind_gbuffer(pass, parts, g);
  show(graph, parts, mean);
  add_over_output(graph, parts, graph.output(), g.depth, g.pattern, true);
}

void finish(FrameGraph& graph, const FrameParts& parts, const GBuffer& g) {
  add_blended(graph, parts, "", lit_target(graph, g));
  if (g.layers() == 1 && g.samples == 1) {
    show(graph, parts, g.lit);
    return;
  }
  const ImageId output = add_output(graph);
  if (g.layers() > 1) {
    add_full_screen(graph, "resolve", {g.lit}, output, merge_program(),
                    std::make_shared<MergeUniforms>(MergeUniforms{g.samples * g.layers()}));
    return;
  }
  graph.add_resolve("resolve", g.lit, output);
}

/// Coverage comes from the first target's alpha, which other layouts use for a value of their own.
void check_alpha_to_coverage(const GBuffer& g) {
  if (!g.alpha_to_coverage) return;
  if (g.layout->encoding != GBufferEncoding::compact)
    refuse("alpha_to_coverage = on with layout = " + std::string(g.layout->id) + ", must be gb_agaa16",
           "the other layouts keep a value of their own where alpha would stand");
  if (g.prepass)
    refuse("alpha_to_coverage = on with prepass = on",
           "a pass of depth alone has no color whose alpha would be coverage: one of both must be off");
}

void check_lighting(const GBuffer& g, const SimpleComplexOptions& options) {
  const bool tiles = options.lighting == DeferredLighting::compute_tiles;
  if (!tiles && options.resolve == TileResolve::tiles)
    refuse("resolve = tiles with lighting = stencil", "lighting=compute has tiles");
  if (!tiles && !info(g.layout->depth_multisampled).has_stencil)
    refuse("lighting = stencil with layout = " + std::string(g.layout->id) + ", which has none",
           "lighting=compute needs no stencil");
}

/// With one sample a pixel the tiles write what is shown.
void add_light_tiles(FrameGraph& graph, const FrameParts& parts, const GBuffer& g) {
  if (g.samples > 1)
    refuse("lighting = tiles with samples = " + std::to_string(g.samples) + ", must be 1",
           "deferred_simple_complex:lighting=compute lights several samples in tiles");
  Pass& pass =
      add_frame_compute(graph, "light_tiles", tile_light_program(g.layout->encoding, parts.lighting.extended),
                        make_uniforms(graph, parts, g));
  pass.targets = {g.lit};
  bind_gbuffer(pass, parts, g);
}

FrameGraph build_deferred(const FrameRequest& request, const EverySampleOptions& options) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_gbuffer_frame(graph, request);
  const GBuffer g = add_gbuffer(graph, request, options.gbuffer);
  add_gbuffer_pass(graph, parts, g);
  if (options.lighting == SampleLighting::compute_tiles) {
    add_light_tiles(graph, parts, g);
  } else {
    Pass& light = add_light_pass(graph, parts, g, "light", make_uniforms(graph, parts, g));
    light.state.raster.sample_rate = g.samples > 1;
  }
  finish(graph, parts, g);
  return graph;
}

FrameGraph build_simple_complex(const FrameRequest& request, const SimpleComplexOptions& options) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_gbuffer_frame(graph, request);
  GBuffer g = add_gbuffer(graph, request, options.gbuffer);
  g.alpha_to_coverage = options.alpha_to_coverage;
  check_alpha_to_coverage(g);
  check_lighting(g, options);
  add_gbuffer_pass(graph, parts, g);
  const auto uniforms = make_uniforms(graph, parts, g);
  uniforms->normal_dot_min = static_cast<float>(options.normal_dot_min);
  uniforms->z_scale = static_cast<float>(options.z_scale);
  uniforms->compare_all = options.compare_all;
  if (options.lighting == DeferredLighting::compute_tiles) {
    uniforms->samples = options.gbuffer.samples;  // tiles light the layers' samples together
    if (options.resolve == TileResolve::tiles)
      add_averaging_tiles(graph, parts, g, uniforms);
    else
      add_tile_passes(graph, parts, g, uniforms);
    return graph;
  }
  add_classify_pass(graph, parts, g, uniforms);
  select_by_stencil(add_light_pass(graph, parts, g, "light_simple", uniforms), g, 0);
  Pass& complex = add_light_pass(graph, parts, g, "light_complex", uniforms);
  select_by_stencil(complex, g, 1);
  complex.state.raster.sample_rate = true;
  finish(graph, parts, g);
  return graph;
}

constexpr std::string_view kSamplesWords = "samples a pixel";

void describe_gbuffer(OptionList& list, DeferredOptions& o) {
  list.choice("layout", o.layout, kLayoutChoices, "what the G-buffer holds of a sample");
  describe_centroid(list, o.centroid);
  list.choice("emulate", o.emulate, kEmulateChoices,
              "beyond 8 samples: layers of 8, by viewport multicast, or native samples");
  describe_prepass(list, o.prepass);
}

}  // namespace

void describe(OptionList& list, EverySampleOptions& o) {
  list.choice("samples", o.gbuffer.samples, "1|2|4|8|16|32", std::array{1, 2, 4, 8, 16, 32}, kSamplesWords);
  describe_gbuffer(list, o.gbuffer);
  list.choice("lighting", o.lighting, "full_screen|tiles",
              "a full-screen pass, or 16x16 compute tiles that cull lights: with samples=1");
}

void describe(OptionList& list, SimpleComplexOptions& o) {
  list.choice("samples", o.gbuffer.samples, "2|4|8|16|32", std::array{2, 4, 8, 16, 32}, kSamplesWords);
  describe_gbuffer(list, o.gbuffer);
  list.choice("lighting", o.lighting, "stencil|compute",
              "full-screen passes with stencil, or 16x16 compute tiles");
  list.choice("resolve", o.resolve, "pass|tiles",
              "with lighting=compute: samples are averaged in a pass of their own, or in the tiles");
  list.real("normal_dot_min", o.normal_dot_min, {0, 1},
            "normals further apart make a pixel complex (cosine)");
  list.real("z_scale", o.z_scale, {0, 1000},
            "depth steps beyond this many slopes of a pixel make it complex");
  list.choice("compare_all", o.compare_all, "off|on", "differing materials make a pixel complex, too");
  list.choice("alpha_to_coverage", o.alpha_to_coverage, "off|on",
              "alpha is coverage, not a test; with layout=gb_agaa16");
}

namespace {

std::vector<Diagnostic> gbuffer_notes(const DeferredOptions& options, const DrawnFrame& frame) {
  SurfaceRecord record;
  record.unlit_mark = true;
  const GBufferLayout& layout = gbuffer_layouts()[static_cast<std::size_t>(options.layout)];
  if (layout.encoding == GBufferEncoding::record) record.emission = StoredEmission::color;
  return lost_light(frame.surfaces, record,
                    record.emission == StoredEmission::color
                        ? "forward techniques keep it off"
                        : "layout=gb_sbaa40 keeps the color of emission, forward techniques all of it");
}
std::vector<Diagnostic> notes(const EverySampleOptions& options, const DrawnFrame& frame) {
  return gbuffer_notes(options.gbuffer, frame);
}
std::vector<Diagnostic> simple_complex_notes(const SimpleComplexOptions& options, const DrawnFrame& frame) {
  return gbuffer_notes(options.gbuffer, frame);
}

}  // namespace

Room deferred_room() {
  static constexpr MessageCode kCodes[] = {kEmissionIsGray, kOcclusionIsLost};
  const TechniqueInfo all =
      base_technique("deferred", "multisampled G-buffer, every sample lit", build_deferred);
  const TechniqueInfo simple_complex = base_technique(
      "deferred_simple_complex", "multisampled G-buffer, samples lit only where they differ (Lauritzen 2010)",
      build_simple_complex);
  return {.techniques = {with_notes(all, notes), with_notes(simple_complex, simple_complex_notes)},
          .codes = kCodes};
}

}  // namespace hwsim::algos
