#include "algos/sss.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "algos/frame_parts.h"
#include "algos/shaders/sss.h"
#include "algos/sss_classify.h"
#include "algos/wire_draws.h"
#include "pipeline/emulate/material_views.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

// Shared by the variants (techniques 5.6).
constexpr std::array<ParameterInfo, 14> kShared = {{
    {"theta_c", 5, 0.01, 90, "triangles are critical whose normals differ by more, in degrees"},
    {"tri_px", 4, 0, 1e6, "a triangle is small below the square of this, in pixels"},
    {"hl_px", 1, 0, 1e6, "a highlight is small below this, in pixels"},
    {"mode", 0, 0, 1, "sampled are triangles with small area, small highlight: both, or one of them",
     "and|or"},
    {"early_exit", 1, 0, 1, "leave out triangles that no highlight comes near", "off|on"},
    {"tau", 1.0 / 255.0, 0, 0.2, "a highlight below this does not count"},
    {"rho", 16, 1, 256, "points for a pixel of area"},
    {"k_min", 4, 1, 64, "points of a triangle, at least"},
    {"k_max", 64, 1, 256, "and at most"},
    {"border_frac", 0.25, 0, 1, "share of them on the border"},
    {"pt_bias_units", 2, 0, 65536, "samples come forward by this many steps of 24-bit depth"},
    {"pt_bias_slope", 0.1, 0, 16, "and by this times the change of depth for a pixel"},
    {"shading", 0, 0, 1, "highlights of the whole frame: the scene's model, or Phong's, as the paper has it",
     "scene|phong"},
    {"rest", 0, 0, 1,
     "under what samples leave of a pixel: the frame, as the paper has it, or its other triangles",
     "frame|others"},
}};

template <std::size_t kCount>
constexpr std::array<ParameterInfo, kShared.size() + kCount> with_shared(
    const std::array<ParameterInfo, kCount>& own) {
  std::array<ParameterInfo, kShared.size() + kCount> all{};
  std::copy(kShared.begin(), kShared.end(), all.begin());
  std::copy(own.begin(), own.end(), all.begin() + kShared.size());
  return all;
}

constexpr auto kPoints = with_shared(std::array<ParameterInfo, 1>{{
    {"points", 0, 0, 2, "from a geometry shader, or from the tessellator, whose points fill no buffer",
     "auto|geometry_shader|tessellator"},
}});
constexpr auto kCompute = with_shared(std::array<ParameterInfo, 3>{{
    {"atomics", 0, 0, 2, "sums in fixed point, or in floats", "auto|integer|float"},
    {"fixed_bits", 20, 12, 24, "of a sum's 32 bits, those behind the point"},
    {"radiance_max", 1, 1, 1024, "brightest sample; more takes bits from the rest"},
}});
constexpr auto kLists = with_shared(std::array<ParameterInfo, 6>{{
    {"m", 1, 0, 3, "m x m places in a pixel", "2|4|8|adaptive"},
    {"node_bytes", 1, 0, 1, "of a list's node", "12|16"},
    {"capacity_nodes", 0, 0, 1e9, "nodes in memory; 0: four a pixel"},
    {"budget_mib", 0, 0, 65536, "or as many as fit with the heads; 0: capacity_nodes says it"},
    {"list_cap", 32, 1, 64, "nodes that the resolve reads of a pixel"},
    {"conservative", 0, 0, 1, "boxes from the geometry shader, or the rasterizer's own", "boxes|raster"},
}});

/// auto|plain|wished: the hardware's feature decides, or the parameter does.
bool takes_feature(double choice, bool feature) { return choice == 2 || (choice == 0 && feature); }

double value(const Parameters& parameters, std::string_view name) { return parameters.find(name)->second; }
float real(const Parameters& parameters, std::string_view name) {
  return static_cast<float>(value(parameters, name));
}

/// The critical triangles of a draw, and which of its attributes samples need.
struct CriticalDraw {
  DrawCall call;
  SssVertex vertex = SssVertex::plain;
};

struct SssFrame {
  FrameParts parts;
  ForwardTarget base;
  std::vector<CriticalDraw> critical;
  ImageId below;  ///< of the composite: the frame, resolved or, with marks, not
  ImageId marks;  ///< samples of the frame whose triangle is sampled; none: all count as the rest
  SssUniforms uniforms;
};

SssVertex vertex_of(const FrameParts& parts, const Material& material, const Mesh& mesh) {
  const std::array<const TextureRef*, 5> textures = {
      &material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
      &material.emissive_texture, &material.occlusion_texture};
  const auto any = [&](auto&& what) {
    return std::any_of(textures.begin(), textures.end(),
                       [&](const TextureRef* t) { return t->texture >= 0 && what(*t); });
  };
  const bool full = material.normal_texture.texture >= 0 || !mesh.colors.empty() ||
                    any([](const TextureRef& t) { return t.uv_set == 1; });
  if (parts.full_varyings && full) return SssVertex::full;
  if (any([](const TextureRef&) { return true; })) return SssVertex::textured;
  return SssVertex::plain;
}

/// Closed opaque solids are what the technique presumes: alpha-tested and blended materials stay out.
std::vector<CriticalDraw> list_critical(const FrameParts& parts, double theta_c_deg) {
  const Scene& scene = *parts.request->scene;
  std::vector<std::vector<std::uint32_t>> triangles =
      find_critical(scene, parts.draws.opaque, theta_c_deg * 3.14159265358979323846 / 180.0);
  std::vector<CriticalDraw> critical;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (triangles[i].empty()) continue;
    CriticalDraw draw;
    draw.call = parts.draws.opaque[i];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(
        scene.instances[static_cast<std::size_t>(draw.call.instance)].mesh)];
    const Mesh::Part& part = mesh.parts[static_cast<std::size_t>(draw.call.part)];
    draw.vertex = vertex_of(parts, scene.materials[static_cast<std::size_t>(part.material)], mesh);
    draw.call.list = make_index_list(std::move(triangles[i]));
    critical.push_back(std::move(draw));
  }
  return critical;
}

/// Where the multisampled frame's samples lie.
void set_samples(SssUniforms& u) {
  const std::span<const SamplePosition> samples = standard_sample_positions(kSssBaseSamples);
  for (int k = 0; k < kSssBaseSamples; ++k) {
    const SamplePosition& p = samples[static_cast<std::size_t>(k)];
    u.samples_x |= (p.x + 8) << (4 * k);
    u.samples_y |= (p.y + 8) << (4 * k);
  }
  for (int cell = 0; cell < 16; ++cell) {
    const auto distance2 = [&](const SamplePosition& p) {
      const int dx = p.x + 8 - (4 * (cell % 4) + 2), dy = p.y + 8 - (4 * (cell / 4) + 2);
      return dx * dx + dy * dy;
    };
    const auto nearest = std::min_element(samples.begin(), samples.end(), [&](const auto& a, const auto& b) {
      return distance2(a) < distance2(b);
    });
    u.nearest_samples[static_cast<std::size_t>(cell / 8)] |= static_cast<int>(nearest - samples.begin())
                                                             << (4 * (cell % 8));
  }
}

SssUniforms make_uniforms(const FrameGraph& graph, const FrameParts& parts, const Parameters& p) {
  SssUniforms u;
  u.lighting = parts.lighting;
  if (parts.shadow_map) u.lighting.shadow_slot = kSssShadowSlot;
  u.clip_from_world = parts.clip_from_world;
  u.width_px = graph.width();
  u.height_px = graph.height();
  u.mode = value(p, "mode") == 0 ? SssMode::both : SssMode::either;
  u.triangle_px = real(p, "tri_px");
  u.highlight_px = real(p, "hl_px");
  u.early_exit = value(p, "early_exit") != 0;
  u.threshold = real(p, "tau");
  const bool phong = parts.lighting.model == ShadingModel::phong;
  u.exponent_scale = phong ? 1.0f : 0.25f;  // half vectors turn half as fast as reflections
  u.normalized = !phong;
  u.samples_per_px = real(p, "rho");
  u.samples_min = real(p, "k_min");
  u.samples_max = std::max(real(p, "k_max"), u.samples_min);
  u.border_share = real(p, "border_frac");
  u.depth_bias = real(p, "pt_bias_units") * 0x1p-24f;
  u.depth_slope = real(p, "pt_bias_slope");
  set_samples(u);
  return u;
}

/// The paper presumes opaque solids. What is blended over them writes no depth, so samples behind it would
/// replace it: its depth is drawn apart, and they keep away.
void add_overlay_depth(FrameGraph& graph, const SssFrame& f) {
  const DrawBatch wires = wire_depth_batch(f.parts, f.base);
  if (wires.draws.empty() && f.parts.draws.blend.empty()) return;
  Pass& pass = graph.add_pass("overlay_depth", PassKind::draw);
  pass.samples = f.base.samples;
  pass.depth = f.base.depth;
  if (!wires.draws.empty()) pass.batches.push_back(wires);
  if (f.parts.draws.blend.empty()) return;
  DrawBatch blended;
  blended.state = opaque_state(f.base);
  blended.vertex = &mesh_position_program();
  blended.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{f.parts.clip_from_world});
  blended.draws = f.parts.draws.blend;
  pass.batches.push_back(std::move(blended));
}

/// One batch for each kind of vertex that the critical triangles have.
template <class Fill>
void add_batches(Pass& pass, const SssFrame& f, Fill&& fill) {
  for (const SssVertex vertex : {SssVertex::plain, SssVertex::textured, SssVertex::full}) {
    DrawBatch batch;
    for (const CriticalDraw& draw : f.critical)
      if (draw.vertex == vertex) batch.draws.push_back(draw.call);
    if (batch.draws.empty()) continue;
    batch.vertex = vertex == SssVertex::full ? &mesh_full_program() : &mesh_surface_program();
    batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{f.parts.clip_from_world});
    batch.state.raster.cull = CullMode::none;  // the geometry shader has done it
    fill(batch, vertex);
    pass.batches.push_back(std::move(batch));
  }
}

/// The multisampled frame's samples on triangles that are sampled: drawn once more, where the depth is
/// theirs.
void add_marks(FrameGraph& graph, SssFrame& f) {
  f.below = f.base.color;
  f.marks = graph.add_image(
      {"marks", Format::r8_unorm, graph.width(), graph.height(), graph.image(f.base.depth).samples});
  graph.add_clear("marks_clear", {f.marks});
  Pass& pass = graph.add_pass("marks", PassKind::draw);
  pass.samples = f.base.samples;
  pass.color = {f.marks};
  pass.depth = f.base.depth;
  pass.depth_read_only = true;
  add_batches(pass, f, [&](DrawBatch& batch, SssVertex vertex) {
    batch.geometry = &sss_marks_program(vertex);
    batch.geometry_uniforms = std::make_shared<SssUniforms>(f.uniforms);
    batch.fragment = &sss_mark_program();
    batch.fragment_uniforms = batch.geometry_uniforms;
    batch.state.depth = {true, false, Compare::equal};
  });
}

/// The multisampled frame. With critical triangles, what the further passes start from; without, the output.
SssFrame start_frame(FrameGraph& graph, const FrameRequest& request, const Parameters& p) {
  SssFrame f;
  f.parts = prepare_frame(graph, request);
  if (value(p, "shading") != 0) f.parts.lighting.model = ShadingModel::phong;
  f.base = make_forward_target(graph, "multisampled", graph.width(), graph.height(), kSssBaseSamples);
  f.base.centroid = true;
  add_forward(graph, f.parts, "", f.base);
  f.critical = list_critical(f.parts, value(p, "theta_c"));
  if (f.critical.empty()) {
    graph.add_resolve("resolve", f.base.color, add_output(graph));
    return f;
  }
  add_overlay_depth(graph, f);
  f.uniforms = make_uniforms(graph, f.parts, p);
  if (value(p, "rest") != 0) {
    add_marks(graph, f);
    return f;
  }
  f.below = graph.add_image({"resolved", Format::rgba8_srgb, graph.width(), graph.height(), 1});
  graph.add_resolve("resolve", f.base.color, f.below);
  return f;
}

void add_composite(FrameGraph& graph, const SssFrame& f, const FragmentProgram& program,
                   std::vector<ImageId> sums, std::vector<BufferId> buffers) {
  Pass& pass = graph.add_pass("composite", PassKind::full_screen);
  SssUniforms uniforms = f.uniforms;
  pass.sampled = {f.below};
  pass.sampled.insert(pass.sampled.end(), sums.begin(), sums.end());
  if (f.marks) {
    uniforms.mark_slot = static_cast<int>(pass.sampled.size());
    pass.sampled.push_back(f.marks);
  }
  pass.storage = std::move(buffers);
  pass.fragment = &program;
  pass.uniforms = std::make_shared<SssUniforms>(std::move(uniforms));
  pass.color = {add_output(graph)};
}

std::vector<ImageId> slots(const SssFrame& f) {
  std::vector<ImageId> images = {f.base.depth};
  if (f.parts.shadow_map) images.push_back(f.parts.shadow_map);
  return images;
}

FrameGraph build_points(const FrameRequest& request, const Parameters& p) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  SssFrame f = start_frame(graph, request, p);
  if (f.critical.empty()) return graph;
  const ImageId sum = graph.add_image({"sum", Format::rgba16_float, graph.width(), graph.height(), 1});
  graph.add_clear("sum_clear", {sum});
  Pass& pass = graph.add_pass("sample", PassKind::draw);
  pass.color = {sum};
  pass.sampled = slots(f);
  const bool tessellated = takes_feature(value(p, "points"), request.features.tessellator_points);
  add_batches(pass, f, [&](DrawBatch& batch, SssVertex vertex) {
    const int scalars = 4 + sss_point_shading_program(vertex).varying_scalars;
    const int limit =
        tessellated ? static_cast<int>(f.uniforms.samples_max) : request.functional.gs_max_scalars / scalars;
    const int most = std::max(1, std::min(static_cast<int>(f.uniforms.samples_max), limit));
    batch.tessellated_points = tessellated;
    auto uniforms = std::make_shared<SssUniforms>(f.uniforms);
    uniforms->samples_max = static_cast<float>(most);
    batch.geometry = &sss_points_program(vertex, most);
    batch.fragment = &sss_point_shading_program(vertex);
    batch.geometry_uniforms = uniforms;
    batch.fragment_uniforms = uniforms;
    batch.state.blend = {{true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf}};
  });
  add_composite(graph, f, sss_composite_program(), {sum}, {});
  return graph;
}

void add_fill(FrameGraph& graph, const std::string& name, std::vector<BufferId> buffers,
              std::uint64_t written, const SssClearUniforms& uniforms) {
  Pass& pass = graph.add_pass(name, PassKind::compute);
  pass.compute = &sss_clear_program();
  const int words = pass.compute->group_width * kSssClearWords;
  pass.groups_x = (uniforms.words + words - 1) / words;
  pass.groups_y = 1;
  pass.storage = std::move(buffers);
  pass.storage_written = written;
  pass.uniforms = std::make_shared<SssClearUniforms>(uniforms);
}

std::uint32_t bits_of(float value) {
  std::uint32_t bits;
  static_assert(sizeof(bits) == sizeof(value));
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/// Vertices, triangles and groups as the compute shader reads them: scene data.
class ComputeData {
 public:
  ComputeData(const Scene& scene, const std::vector<CriticalDraw>& critical, SssUniforms& uniforms)
      : scene_(scene), uniforms_(uniforms) {
    const bool full = std::any_of(critical.begin(), critical.end(),
                                  [](const CriticalDraw& d) { return d.vertex == SssVertex::full; });
    uniforms.vertex_words = full ? SurfaceVaryings::kFull : SurfaceVaryings::kBasic;
    uniforms.draws.clear();
    for (const CriticalDraw& draw : critical) add(draw);
  }

  BufferId add_to(FrameGraph& graph, const char* name, std::vector<std::uint32_t>& words) const {
    const std::uint64_t count = words.size();
    return graph.add_buffer(
        {name, count, std::make_shared<const std::vector<std::uint32_t>>(std::move(words))});
  }
  int group_count() const { return static_cast<int>(groups.size()) / kSssGroupWords; }

  std::vector<std::uint32_t> triangles, vertices, groups;

 private:
  void add(const CriticalDraw& draw) {
    const Instance& instance = scene_.instances[static_cast<std::size_t>(draw.call.instance)];
    const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(instance.mesh)];
    const auto [base, added] =
        first_vertex_.try_emplace(instance.mesh, static_cast<std::uint32_t>(vertices.size()) /
                                                     static_cast<std::uint32_t>(uniforms_.vertex_words));
    if (added) add_vertices(mesh);
    const auto number = static_cast<std::uint32_t>(uniforms_.draws.size());
    SssDraw info;
    info.world_from_local = instance.world_from_local;
    info.normal_from_local = normal_from_local(instance.world_from_local);
    info.mirrored = glm::determinant(glm::mat3(instance.world_from_local)) < 0.0f;
    info.material = mesh.parts[static_cast<std::size_t>(draw.call.part)].material;
    uniforms_.draws.push_back(info);
    const std::vector<std::uint32_t>& indices = draw.call.list->indices;
    const auto first = static_cast<std::uint32_t>(triangles.size() / 3),
               count = static_cast<std::uint32_t>(indices.size() / 3);
    for (const std::uint32_t index : indices) triangles.push_back(base->second + index);
    constexpr auto kGroup = static_cast<std::uint32_t>(kBatchLanes);
    for (std::uint32_t t = 0; t < count; t += kGroup)
      groups.insert(groups.end(), {first + t, std::min(kGroup, count - t), number, t});
  }

  void add_vertices(const Mesh& mesh) {
    const auto put = [&](float v) { vertices.push_back(bits_of(v)); };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      for (int k = 0; k < 3; ++k) put(mesh.normals[i][k]);
      for (int k = 0; k < 2; ++k) put(mesh.uv0.empty() ? 0.0f : mesh.uv0[i][k]);
      for (int k = 0; k < 3; ++k) put(mesh.positions[i][k]);
      if (uniforms_.vertex_words == SurfaceVaryings::kBasic) continue;
      for (int k = 0; k < 4; ++k)
        put(mesh.tangents.empty() ? (k == 0 || k == 3 ? 1.0f : 0.0f) : mesh.tangents[i][k]);
      for (int k = 0; k < 4; ++k) put(mesh.colors.empty() ? 1.0f : mesh.colors[i][k]);
      for (int k = 0; k < 2; ++k) put(mesh.uv1.empty() ? 0.0f : mesh.uv1[i][k]);
    }
  }

  const Scene& scene_;
  SssUniforms& uniforms_;
  std::map<int, std::uint32_t> first_vertex_;
};

FrameGraph build_compute(const FrameRequest& request, const Parameters& p) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  SssFrame f = start_frame(graph, request, p);
  if (f.critical.empty()) return graph;
  const bool floats = takes_feature(value(p, "atomics"), request.features.float_atomics);
  f.uniforms.radiance_max = real(p, "radiance_max");
  f.uniforms.fixed_point_scale = static_cast<float>(std::exp2(std::floor(value(p, "fixed_bits"))));
  ComputeData data(*request.scene, f.critical, f.uniforms);
  const int words = 4 * graph.width() * graph.height();
  const BufferId sums = graph.add_buffer({"sums", static_cast<std::uint64_t>(words)});
  add_fill(graph, "sum_clear", {sums}, 1, {words, 0, false});
  Pass& pass = graph.add_pass("sample", PassKind::compute);
  pass.compute = &sss_compute_program(floats);
  pass.groups_x = data.group_count();
  pass.groups_y = 1;
  pass.sampled = slots(f);
  pass.storage = {data.add_to(graph, "triangles", data.triangles),
                  data.add_to(graph, "vertices", data.vertices), data.add_to(graph, "groups", data.groups),
                  sums};
  pass.storage_written = std::uint64_t{1} << kSssSumBuffer;
  pass.uniforms = std::make_shared<SssUniforms>(f.uniforms);
  add_composite(graph, f, sss_sum_composite_program(floats), {}, {sums});
  return graph;
}

/// As many nodes as the parameters say.
std::uint64_t capacity(const FrameGraph& graph, const Parameters& p, int node_bytes) {
  const auto pixels = static_cast<std::uint64_t>(graph.width()) * static_cast<std::uint64_t>(graph.height());
  const double budget = value(p, "budget_mib") * 1024.0 * 1024.0 - 4.0 * static_cast<double>(pixels);
  if (value(p, "budget_mib") > 0.0)
    return static_cast<std::uint64_t>(std::max(1.0, std::floor(budget / node_bytes)));
  const auto nodes = static_cast<std::uint64_t>(value(p, "capacity_nodes"));
  return nodes > 0 ? nodes : 4 * pixels;
}

FrameGraph build_lists(const FrameRequest& request, const Parameters& p) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  SssFrame f = start_frame(graph, request, p);
  if (f.critical.empty()) return graph;
  constexpr std::array<int, 4> kGrids = {2, 4, 8, 0};
  const int node_words = value(p, "node_bytes") == 0 ? 3 : 4;
  const std::uint64_t nodes = capacity(graph, p, 4 * node_words);
  SssUniforms& u = f.uniforms;
  u.grid = kGrids[static_cast<std::size_t>(value(p, "m"))];
  u.node_words = node_words;
  u.capacity_nodes =
      static_cast<int>(std::min<std::uint64_t>(nodes, 0x1fffffff));  // indices are signed words
  u.list_nodes_max = static_cast<int>(value(p, "list_cap"));
  u.conservative_raster = value(p, "conservative") != 0;
  const int pixels = graph.width() * graph.height();
  const BufferId heads = graph.add_buffer({"heads", static_cast<std::uint64_t>(pixels)});
  const BufferId list = graph.add_buffer(
      {"nodes", static_cast<std::uint64_t>(u.capacity_nodes) * static_cast<std::uint64_t>(node_words)});
  const BufferId counter = graph.add_buffer({"counter", 1});
  add_fill(graph, "list_clear", {heads, list, counter}, 5, {pixels, -1, true});
  Pass& pass = graph.add_pass("sample", PassKind::draw);
  pass.sampled = slots(f);
  pass.storage = {heads, list, counter};
  pass.storage_written = 7;
  add_batches(pass, f, [&](DrawBatch& batch, SssVertex vertex) {
    batch.geometry = &sss_boxes_program(vertex);
    batch.fragment = &sss_list_program(vertex);
    batch.geometry_uniforms = batch.fragment_uniforms = std::make_shared<SssUniforms>(u);
    batch.state.raster.conservative = u.conservative_raster;
  });
  add_composite(graph, f, sss_list_resolve_program(), {}, {heads, list});
  return graph;
}

}  // namespace

std::span<const TechniqueInfo> sss_techniques() {
  static constexpr TechniqueInfo kTechniques[] = {
      {.id = "sss_gs",
       .description = "8x multisampling, points on critical triangles from a geometry shader",
       .parameters = kPoints,
       .build = build_points},
      {.id = "sss_cs",
       .description = "8x multisampling, points on critical triangles from a compute shader",
       .parameters = kCompute,
       .build = build_compute},
      {.id = "sss_ppll",
       .description = "8x multisampling, critical triangles in per-pixel linked lists",
       .parameters = kLists,
       .build = build_lists},
  };
  return kTechniques;
}

}  // namespace hwsim::algos
