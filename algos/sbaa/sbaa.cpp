#include "algos/sbaa/sbaa.h"

#include <array>
#include <cmath>

#include "algos/base/frame_parts.h"
#include "algos/base/lost_light.h"
#include "algos/sbaa/options.h"
#include "algos/sbaa/shaders/programs.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

/// What follows from the options.
struct Setup {
  int samples = 8;
  int slots = 2;
  int id_bits = 7;
  int record_bytes = kFullRecordBytes;
  bool weigh_background = true, centroid = true, empty_exit = false;
  SbaaSample sample = SbaaSample::id;
  float cos_alpha = 0.0f, end_region = 0.0f;
  bool linear_depth = false;

  int id_mask() const { return (1 << id_bits) - 1; }
  bool full_record() const { return record_bytes >= kFullRecordBytes; }
  bool merges() const { return sample != SbaaSample::id; }
};

Setup make_setup(const SbaaOptions& options) {
  Setup o;
  o.samples = options.samples;
  o.slots = options.surfaces;
  o.id_bits = options.id_bits;
  o.record_bytes = 4 * ((options.record_bytes + 3) / 4);  // whole words
  o.weigh_background = options.background == SbaaBackground::weighted;
  o.centroid = options.centroid;
  o.empty_exit = options.empty_exit;
  if (o.slots > o.samples) {
    Diagnostic error;
    error.code = "T003";
    error.message =
        "n = " + std::to_string(o.slots) + " surfaces, must be at most msaa = " + std::to_string(o.samples);
    error.help = "a pixel has no more surfaces than samples";
    throw InputError(std::move(error));
  }
  return o;
}

/// Bits of number and validity, as the smallest integer format that holds them.
Format id_format(int id_bits) {
  return id_bits < 8 ? Format::r8_uint : id_bits < 16 ? Format::r16_uint : Format::r32_uint;
}

struct SbaaImages {
  ImageId depth, id, normal;
  ImageId surfaces;  ///< the slots of each pixel, one below the other
  BufferId records;
};

/// The paper's two bytes a surface hold 7 bits of the number and, in the first slot, the counts of surface
/// and background in four bits each. Longer numbers and more than 8 samples need four.
bool two_byte_surfaces(const Setup& o) { return o.id_bits < 8 && o.samples <= 8; }

SbaaSurfaces describe_surfaces(const FrameGraph& graph, const Setup& o) {
  SbaaSurfaces s;
  s.width = graph.width();
  s.height = graph.height();
  s.slots = o.slots;
  s.background_unit = two_byte_surfaces(o) ? 16 : 256;
  s.record_words = o.record_bytes / 4;
  return s;
}

SbaaImages add_images(FrameGraph& graph, const Setup& o) {
  const int width = graph.width(), height = graph.height();
  SbaaImages images;
  // The format of gb_sbaa40, so that both see the same samples.
  images.depth = graph.add_image({"depth", Format::d24_unorm_s8, width, height, o.samples});
  const Format number = o.sample == SbaaSample::packed ? Format::rgba8_uint : id_format(o.id_bits);
  images.id = graph.add_image({"primitive_id", number, width, height, o.samples});
  if (o.sample == SbaaSample::id_and_normal)
    images.normal = graph.add_image({"normal", Format::rgba8_snorm, width, height, o.samples});
  images.surfaces = graph.add_image(
      {"surfaces", two_byte_surfaces(o) ? Format::rg8_uint : Format::rg16_uint, width, height * o.slots, 1});
  images.records =
      graph.add_buffer({"records", static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
                                       static_cast<std::uint64_t>(o.slots * o.record_bytes / 4)});
  return images;
}

DrawBatch visibility_batch(const FrameParts& parts, const Setup& o, const std::vector<DrawCall>& draws,
                           bool alpha_test) {
  const VertexProgram& vertex = o.merges() ? (alpha_test ? mesh_normal_uv_program() : mesh_normal_program())
                                           : (alpha_test ? mesh_uv_program() : mesh_position_program());
  DrawBatch batch = mesh_batch(parts, draws, vertex);
  batch.state.raster.centroid = o.centroid;
  batch.fragment = &sbaa_id_program(o.sample, alpha_test);
  batch.fragment_uniforms = std::make_shared<SbaaIdUniforms>(SbaaIdUniforms{o.id_mask()});
  return batch;
}

void add_visibility_pass(FrameGraph& graph, const FrameParts& parts, const Setup& o,
                         const SbaaImages& images) {
  std::vector<ImageId> targets = {images.id};
  if (images.normal) targets.push_back(images.normal);
  std::vector<ImageId> cleared = targets;
  cleared.push_back(images.depth);
  graph.add_clear("clear", std::move(cleared));
  Pass& pass = graph.add_pass("visibility", PassKind::draw);
  pass.samples = o.samples;
  pass.color = std::move(targets);
  pass.depth = images.depth;
  pass.batches.push_back(visibility_batch(parts, o, parts.draws.opaque, false));
  if (!parts.draws.mask.empty()) pass.batches.push_back(visibility_batch(parts, o, parts.draws.mask, true));
  add_opaque_separate(pass, parts, o.merges() ? SurfaceInputs::normal : SurfaceInputs::none,
                      visibility_batch(parts, o, {}, false));
}

void add_analysis_pass(FrameGraph& graph, const FrameParts& parts, const Setup& o, const SbaaImages& images) {
  auto u = std::make_shared<SbaaAnalysisUniforms>();
  u->surfaces = describe_surfaces(graph, o);
  u->samples = o.samples;
  u->id_mask = o.id_mask();
  u->cos_alpha = o.cos_alpha;
  u->end_region = o.end_region;
  u->linear_depth = o.linear_depth;
  u->empty_exit = o.empty_exit;
  u->view_from_clip = parts.view_from_clip;
  Pass& pass = add_frame_compute(graph, "analysis", sbaa_analysis_program(o.sample, o.id_bits), std::move(u));
  pass.sampled = {images.id};
  if (images.normal) pass.sampled.push_back(images.normal);
  if (o.merges()) pass.sampled.push_back(images.depth);
  pass.targets = {images.surfaces};
}

DrawBatch record_batch(const FrameGraph& graph, const FrameParts& parts, const Setup& o,
                       const std::vector<DrawCall>& draws, bool alpha_test) {
  DrawBatch batch = mesh_batch(parts, draws, surface_vertex_program(parts));
  batch.state.raster.centroid = o.centroid;
  batch.state.depth = {true, false, Compare::equal};
  batch.state.force_early_z = true;
  batch.fragment =
      &sbaa_gbuffer_program(o.full_record(), parts.full_varyings, alpha_test, parts.lighting.extended);
  auto u = std::make_shared<SbaaGBufferUniforms>();
  u->surfaces = describe_surfaces(graph, o);
  u->id_mask = o.id_mask();
  u->full_varyings = parts.full_varyings;
  u->extended = parts.lighting.extended;
  u->clip_from_world = parts.clip_from_world;
  u->view_from_world = parts.camera.view_from_world;
  batch.fragment_uniforms = std::move(u);
  return batch;
}

// The same draws in the same order as for visibility, so that primitives have the same numbers.
void add_gbuffer_pass(FrameGraph& graph, const FrameParts& parts, const Setup& o, const SbaaImages& images) {
  Pass& pass = graph.add_pass("gbuffer", PassKind::draw);
  pass.samples = o.samples;
  pass.depth = images.depth;
  pass.depth_read_only = true;
  pass.sampled = {images.surfaces};
  pass.storage = {images.records};
  pass.storage_written = 1;
  pass.batches.push_back(record_batch(graph, parts, o, parts.draws.opaque, false));
  if (!parts.draws.mask.empty())
    pass.batches.push_back(record_batch(graph, parts, o, parts.draws.mask, true));
  add_opaque_separate(pass, parts, surface_inputs(parts), record_batch(graph, parts, o, {}, false));
}

void add_shade_pass(FrameGraph& graph, const FrameParts& parts, const Setup& o, const SbaaImages& images,
                    ImageId output) {
  auto u = std::make_shared<SbaaShadeUniforms>();
  u->surfaces = describe_surfaces(graph, o);
  u->weigh_background = o.weigh_background;
  DeferredUniforms& frame = u->frame;
  frame.lighting = parts.lighting;
  if (parts.shadow_map) frame.lighting.shadow_slot = 1;
  frame.world_from_clip = glm::inverse(parts.clip_from_world);
  frame.background = graph.scene().background;
  frame.width = graph.width();
  frame.height = graph.height();
  Pass& pass = graph.add_pass("shade", PassKind::full_screen);
  pass.color = {output};
  pass.fragment = &sbaa_shade_program(o.full_record(), parts.lighting.extended);
  pass.uniforms = std::move(u);
  pass.sampled = {images.surfaces};
  if (parts.shadow_map) pass.sampled.push_back(parts.shadow_map);
  pass.storage = {images.records};
}

FrameGraph build(const FrameRequest& request, const Setup& o) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_gbuffer_frame(graph, request);
  const SbaaImages images = add_images(graph, o);
  add_visibility_pass(graph, parts, o, images);
  add_analysis_pass(graph, parts, o, images);
  add_gbuffer_pass(graph, parts, o, images);
  const ImageId output = add_output(graph);
  add_shade_pass(graph, parts, o, images, output);
  add_over_output(graph, parts, output, images.depth, {}, true);
  return graph;
}

FrameGraph build_sbaa_top(const FrameRequest& request, const SbaaOptions& options) {
  return build(request, make_setup(options));
}

FrameGraph build_sbaa_merge(const FrameRequest& request, const SbaaMergeOptions& options) {
  Setup o = make_setup(options.sbaa);
  o.sample = options.pack_id_normal && o.id_bits < 8 ? SbaaSample::packed : SbaaSample::id_and_normal;
  o.cos_alpha = static_cast<float>(std::cos(options.alpha_rad));
  o.end_region = static_cast<float>(options.end_region);
  o.linear_depth = options.merge_depth == SbaaMergeDepth::linear;
  return build(request, o);
}

using C = SbaaCounters;
constexpr CounterLaw kLaws[] = {
    HWSIM_LAW_EQUAL(
        "technique.slots_emitted_first + _second + _third + _further = technique.slots_emitted_surfaces",
        c.technique[C::slots_emitted_first_surfaces] + c.technique[C::slots_emitted_second_surfaces] +
            c.technique[C::slots_emitted_third_surfaces] + c.technique[C::slots_emitted_further_surfaces],
        c.technique[C::slots_emitted_surfaces]),
    HWSIM_LAW_AT_MOST("technique.slots_emitted_second_surfaces <= technique.slots_emitted_first_surfaces",
                      c.technique[C::slots_emitted_second_surfaces],
                      c.technique[C::slots_emitted_first_surfaces]),
    HWSIM_LAW_AT_MOST("technique.merge_fallbacks_surfaces <= technique.slots_emitted_surfaces",
                      c.technique[C::merge_fallbacks_surfaces], c.technique[C::slots_emitted_surfaces]),
};

std::vector<Diagnostic> notes(const SbaaOptions& options, const DrawnFrame& frame) {
  SurfaceRecord record;
  record.unlit_mark = true;
  const int words = (options.record_bytes + 3) / 4;
  record.emission = words < 4 ? StoredEmission::none : StoredEmission::color;
  return lost_light(frame.surfaces, record,
                    record.emission == StoredEmission::none
                        ? "record_bytes=16 holds emission, forward techniques show all of it"
                        : "forward techniques keep it off");
}
std::vector<Diagnostic> merge_notes(const SbaaMergeOptions& options, const DrawnFrame& frame) {
  return notes(options.sbaa, frame);
}

}  // namespace

void describe(OptionList& list, SbaaOptions& o) {
  list.whole("n", o.surfaces, {1, 32}, "surfaces kept of a pixel, at most its samples");
  list.choice("msaa", o.samples, "2|4|8|16|32", std::array{2, 4, 8, 16, 32}, "visibility samples a pixel");
  list.whole("id_bits", o.id_bits, {4, 16}, "low bits of primitive numbers that are kept");
  list.whole("record_bytes", o.record_bytes, {kLeastRecordBytes, kLargestRecordBytes},
             "G-buffer of a surface; below 32 without position, below 16 without emission");
  list.choice("background", o.background, "weighted|ignore",
              "whether background samples weigh in at partly covered pixels");
  describe_centroid(list, o.centroid);
  list.choice("empty_exit", o.empty_exit, "off|on",
              "whether the analysis leaves pixels that nothing was drawn to at once");
}

void describe(OptionList& list, SbaaMergeOptions& o) {
  describe(list, o.sbaa);
  list.real("alpha", o.alpha_rad, {0.001, 1.57}, "angle within which normals are of one surface, in radians");
  list.real("end_region", o.end_region, {0, 0.5},
            "share of the depth range at each end: samples only there are two surfaces");
  list.choice("merge_depth", o.merge_depth, "stored|linear", "depth as stored, or distances");
  list.choice("pack_id_normal", o.pack_id_normal, "off|on",
              "number and normal in one texel of 4 bytes (up to 7 bits of the number)");
}

Room sbaa_room() {
  static constexpr MessageCode kCodes[] = {kEmissionIsLost};
  const TechniqueInfo top = base_technique(
      "sbaa_top", "deferred, the n primitives with the most samples of a pixel lit (SBAA)", build_sbaa_top);
  const TechniqueInfo merge = base_technique(
      "sbaa_merge", "the same, primitives that form one surface merged (SBAA)", build_sbaa_merge);
  return {.techniques = {with_notes(top, notes), with_notes(merge, merge_notes)},
          .counters = C::kDeclared,
          .laws = kLaws,
          .codes = kCodes};
}

}  // namespace hwsim::algos
