#include "algos/sbaa/sbaa.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "algos/base/frame_parts.h"
#include "algos/sbaa/shaders/programs.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

struct SbaaOptions {
  int samples = 8;
  int slots = 2;
  int id_bits = 7;
  int record_bytes = kFullRecordBytes;
  bool weigh_background = true, centroid = true;
  SbaaSample sample = SbaaSample::id;
  float cos_alpha = 0.0f, end_region = 0.0f;
  bool linear_depth = false;

  int id_mask() const { return (1 << id_bits) - 1; }
  bool full_record() const { return record_bytes >= kFullRecordBytes; }
  bool merges() const { return sample != SbaaSample::id; }
};

double value(const Parameters& parameters, std::string_view name) { return parameters.find(name)->second; }

SbaaOptions read_options(const Parameters& parameters) {
  SbaaOptions o;
  o.samples = static_cast<int>(value(parameters, "msaa"));
  o.slots = static_cast<int>(value(parameters, "n"));
  o.id_bits = static_cast<int>(value(parameters, "id_bits"));
  o.record_bytes = 4 * static_cast<int>(std::ceil(value(parameters, "record_bytes") / 4.0));
  o.weigh_background = value(parameters, "background") == 0;
  o.centroid = value(parameters, "centroid") != 0;
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
bool two_byte_surfaces(const SbaaOptions& o) { return o.id_bits < 8 && o.samples <= 8; }

SbaaSurfaces describe_surfaces(const FrameGraph& graph, const SbaaOptions& o) {
  SbaaSurfaces s;
  s.width = graph.width();
  s.height = graph.height();
  s.slots = o.slots;
  s.background_unit = two_byte_surfaces(o) ? 16 : 256;
  s.record_words = o.record_bytes / 4;
  return s;
}

SbaaImages add_images(FrameGraph& graph, const SbaaOptions& o) {
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

DrawBatch visibility_batch(const FrameParts& parts, const SbaaOptions& o, const std::vector<DrawCall>& draws,
                           bool alpha_test) {
  DrawBatch batch;
  batch.state = opaque_state({});
  batch.state.raster.centroid = o.centroid;
  batch.vertex = o.merges() ? (alpha_test ? &mesh_normal_uv_program() : &mesh_normal_program())
                            : (alpha_test ? &mesh_uv_program() : &mesh_position_program());
  batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{parts.clip_from_world});
  batch.fragment = &sbaa_id_program(o.sample, alpha_test);
  batch.fragment_uniforms = std::make_shared<SbaaIdUniforms>(SbaaIdUniforms{o.id_mask()});
  batch.draws = draws;
  return batch;
}

void add_visibility_pass(FrameGraph& graph, const FrameParts& parts, const SbaaOptions& o,
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
}

glm::mat4 view_from_clip(const FrameGraph& graph, const FrameParts& parts) {
  const float aspect = static_cast<float>(graph.width()) / static_cast<float>(graph.height());
  return glm::inverse(clip_from_view(parts.camera, aspect));
}

void add_analysis_pass(FrameGraph& graph, const FrameParts& parts, const SbaaOptions& o,
                       const SbaaImages& images) {
  const ComputeProgram& program = sbaa_analysis_program(o.sample, o.id_bits);
  auto u = std::make_shared<SbaaAnalysisUniforms>();
  u->surfaces = describe_surfaces(graph, o);
  u->samples = o.samples;
  u->id_mask = o.id_mask();
  u->cos_alpha = o.cos_alpha;
  u->end_region = o.end_region;
  u->linear_depth = o.linear_depth;
  u->view_from_clip = view_from_clip(graph, parts);
  Pass& pass = graph.add_pass("analysis", PassKind::compute);
  pass.compute = &program;
  pass.groups_x = (graph.width() + program.group_width - 1) / program.group_width;
  pass.groups_y = (graph.height() + program.group_height - 1) / program.group_height;
  pass.sampled = {images.id};
  if (images.normal) pass.sampled.push_back(images.normal);
  if (o.merges()) pass.sampled.push_back(images.depth);
  pass.targets = {images.surfaces};
  pass.storage = {images.records};
  pass.storage_written = 1;
  pass.uniforms = std::move(u);
}

DrawBatch record_batch(const FrameGraph& graph, const FrameParts& parts, const SbaaOptions& o,
                       const std::vector<DrawCall>& draws, bool alpha_test) {
  DrawBatch batch;
  batch.state = opaque_state({});
  batch.state.raster.centroid = o.centroid;
  batch.state.depth = {true, false, Compare::equal};
  batch.state.force_early_z = true;
  batch.vertex = parts.full_varyings ? &mesh_full_program() : &mesh_surface_program();
  batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{parts.clip_from_world});
  batch.fragment = &sbaa_gbuffer_program(o.full_record(), parts.full_varyings, alpha_test);
  auto u = std::make_shared<SbaaGBufferUniforms>();
  u->surfaces = describe_surfaces(graph, o);
  u->id_mask = o.id_mask();
  u->full_varyings = parts.full_varyings;
  u->clip_from_world = parts.clip_from_world;
  u->view_from_world = parts.camera.view_from_world;
  batch.fragment_uniforms = std::move(u);
  batch.draws = draws;
  return batch;
}

// The same draws in the same order as for visibility, so that primitives have the same numbers.
void add_gbuffer_pass(FrameGraph& graph, const FrameParts& parts, const SbaaOptions& o,
                      const SbaaImages& images) {
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
}

void add_shade_pass(FrameGraph& graph, const FrameParts& parts, const SbaaOptions& o,
                    const SbaaImages& images, ImageId output) {
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
  pass.fragment = &sbaa_shade_program(o.full_record());
  pass.uniforms = std::move(u);
  pass.sampled = {images.surfaces};
  if (parts.shadow_map) pass.sampled.push_back(parts.shadow_map);
  pass.storage = {images.records};
}

FrameGraph build(const FrameRequest& request, const SbaaOptions& o) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  const SbaaImages images = add_images(graph, o);
  add_visibility_pass(graph, parts, o, images);
  add_analysis_pass(graph, parts, o, images);
  add_gbuffer_pass(graph, parts, o, images);
  const ImageId output = add_output(graph);
  add_shade_pass(graph, parts, o, images, output);
  add_blended_on_output(graph, parts, output);
  return graph;
}

FrameGraph build_sbaa_top(const FrameRequest& request, const Parameters& parameters) {
  return build(request, read_options(parameters));
}

FrameGraph build_sbaa_merge(const FrameRequest& request, const Parameters& parameters) {
  SbaaOptions o = read_options(parameters);
  o.sample = value(parameters, "pack_id_normal") != 0 && o.id_bits < 8 ? SbaaSample::packed
                                                                       : SbaaSample::id_and_normal;
  o.cos_alpha = static_cast<float>(std::cos(value(parameters, "alpha")));
  o.end_region = static_cast<float>(value(parameters, "end_region"));
  o.linear_depth = value(parameters, "merge_depth") != 0;
  return build(request, o);
}

constexpr ParameterInfo kSurfaces{"n", 2, 1, 32, "surfaces kept of a pixel, at most its samples"};
constexpr ParameterInfo kSamples{"msaa", 8, 2, 32, "visibility samples a pixel: a power of two"};
constexpr ParameterInfo kIdBits{"id_bits", 7, 4, 16, "low bits of primitive numbers that are kept"};
constexpr ParameterInfo kRecordBytes{"record_bytes", 32, 12, 64,
                                     "G-buffer of a surface; below 32 without position, below 16 without "
                                     "emission"};
constexpr ParameterInfo kBackground{
    "background", 0, 0, 1, "whether background samples weigh in at partly covered pixels", "weighted|ignore"};
constexpr std::array<ParameterInfo, 6> kTop = {kSurfaces,    kSamples,    kIdBits,
                                               kRecordBytes, kBackground, kCentroid};
constexpr std::array<ParameterInfo, 10> kMerge = {
    kSurfaces,
    kSamples,
    kIdBits,
    kRecordBytes,
    kBackground,
    kCentroid,
    ParameterInfo{"alpha", 0.19634954084936207, 0.001, 1.57,
                  "angle within which normals are of one surface, in radians"},
    ParameterInfo{"end_region", 0.25, 0, 0.5,
                  "share of the depth range at each end: samples only there are two surfaces"},
    ParameterInfo{"merge_depth", 0, 0, 1, "depth as stored, or distances", "stored|linear"},
    ParameterInfo{"pack_id_normal", 0, 0, 1,
                  "number and normal in one texel of 4 bytes (up to 7 bits of the number)", "off|on"}};

constexpr TechniqueInfo kTechniques[] = {
    {"sbaa_top", "deferred, the n primitives with the most samples of a pixel lit (SBAA)", kTop,
     build_sbaa_top},
    {"sbaa_merge", "the same, primitives that form one surface merged (SBAA)", kMerge, build_sbaa_merge},
};

}  // namespace

std::span<const TechniqueInfo> sbaa_techniques() { return kTechniques; }

}  // namespace hwsim::algos
