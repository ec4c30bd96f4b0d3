#include "algos/sss/sss.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "algos/sss/compute_data.h"
#include "algos/sss/frame.h"

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
    {"rest", 1, 0, 1,
     "under what samples leave of a pixel: the whole frame, as the paper has it, or its other triangles",
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
    {"node_bytes", 1, 0, 2,
     "of a list's node; 32: with its places and plane, so that nodes hide each other place by place",
     "12|16|32"},
    {"capacity_nodes", 0, 0, 1e9, "nodes in memory; 0: four a pixel"},
    {"budget_mib", 0, 0, 65536, "or as many as fit with the heads; 0: capacity_nodes says it"},
    {"list_cap", 32, 1, 64, "nodes that the resolve reads of a pixel"},
    {"conservative", 0, 0, 1, "boxes from the geometry shader, or the rasterizer's own", "boxes|raster"},
}});

/// auto|plain|wished: the hardware's feature decides, or the parameter does.
bool takes_feature(double choice, bool feature) { return choice == 2 || (choice == 0 && feature); }

FrameGraph build_points(const FrameRequest& request, const Parameters& p) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  SssFrame f = start_sss_frame(graph, request, p);
  if (f.critical.empty()) return graph;
  const ImageId sum = graph.add_image({"sum", Format::rgba16_float, graph.width(), graph.height(), 1});
  graph.add_clear("sum_clear", {sum});
  Pass& pass = graph.add_pass("sample", PassKind::draw);
  pass.color = {sum};
  pass.sampled = sss_slots(f);
  const bool tessellated = takes_feature(value(p, "points"), request.features.tessellator_points);
  add_sss_batches(pass, f, [&](DrawBatch& batch, SssVertex vertex) {
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
  add_sss_composite(graph, f, sss_composite_program(), {sum}, {});
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

FrameGraph build_compute(const FrameRequest& request, const Parameters& p) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  SssFrame f = start_sss_frame(graph, request, p);
  if (f.critical.empty()) return graph;
  const bool floats = takes_feature(value(p, "atomics"), request.features.float_atomics);
  f.uniforms.radiance_max = real(p, "radiance_max");
  f.uniforms.fixed_point_scale = static_cast<float>(std::exp2(std::floor(value(p, "fixed_bits"))));
  SssComputeData data = sss_compute_data(*request.scene, f.critical, f.uniforms);
  const int words = 4 * graph.width() * graph.height();
  const BufferId sums = graph.add_buffer({"sums", static_cast<std::uint64_t>(words)});
  add_fill(graph, "sum_clear", {sums}, 1, {words, 0, false});
  Pass& pass = graph.add_pass("sample", PassKind::compute);
  pass.compute = &sss_compute_program(floats);
  pass.groups_x = data.group_count();
  pass.groups_y = 1;
  pass.sampled = sss_slots(f);
  const auto add_words = [&](const char* name, std::vector<std::uint32_t>& words) {
    const std::uint64_t count = words.size();
    return graph.add_buffer(
        {name, count, std::make_shared<const std::vector<std::uint32_t>>(std::move(words))});
  };
  pass.storage = {add_words("triangles", data.triangles), add_words("vertices", data.vertices),
                  add_words("groups", data.groups), sums};
  pass.storage_written = std::uint64_t{1} << kSssSumBuffer;
  pass.uniforms = std::make_shared<SssUniforms>(f.uniforms);
  add_sss_composite(graph, f, sss_sum_composite_program(floats), {}, {sums});
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
  constexpr std::array<int, 4> kGrids = {2, 4, 8, 0};
  constexpr std::array<int, 3> kNodeWords = {3, 4, kSssPlaceNodeWords};
  const int node_words = kNodeWords[static_cast<std::size_t>(value(p, "node_bytes"))];
  SssFrame f = start_sss_frame(graph, request, p, node_words == kSssPlaceNodeWords);
  if (f.critical.empty()) return graph;
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
  pass.sampled = sss_slots(f);
  if (u.by_place()) {
    u.mark_slot = static_cast<int>(pass.sampled.size());
    pass.sampled.push_back(f.marks);
  }
  pass.storage = {heads, list, counter};
  pass.storage_written = 7;
  add_sss_batches(pass, f, [&](DrawBatch& batch, SssVertex vertex) {
    batch.geometry = &sss_boxes_program(vertex);
    batch.fragment = &sss_list_program(vertex, u.by_place());
    batch.geometry_uniforms = batch.fragment_uniforms = std::make_shared<SssUniforms>(u);
    batch.state.raster.conservative = u.conservative_raster;
  });
  add_sss_composite(graph, f, sss_list_resolve_program(u.by_place()), {}, {heads, list});
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
