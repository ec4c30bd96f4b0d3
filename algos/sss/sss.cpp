#include "algos/sss/sss.h"

#include <algorithm>
#include <cmath>

#include "algos/sss/compute_data.h"
#include "algos/sss/frame.h"
#include "algos/sss/options.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

/// The mean over a pixel's samples.
ImageId resolved_sum(FrameGraph& graph, ImageId sum) {
  if (graph.image(sum).samples == 1) return sum;
  const ImageId mean = graph.add_image({"sum_mean", Format::rgba16_float, graph.width(), graph.height(), 1});
  graph.add_resolve("resolve_sum", sum, mean);
  return mean;
}

int most_points(const SssOptions& options) {
  return std::max(1, static_cast<int>(std::max(options.samples_max, options.samples_min)));
}

bool from_tessellator(const FrameRequest& request, const SssPointOptions& options) {
  return options.points == SssPointSource::tessellator ||
         (options.points == SssPointSource::automatic && request.features.tessellator_points);
}

/// The same of a geometry shader, which emits so many scalars at most.
int most_emitted(const FrameRequest& request, const SssPointOptions& options, SssVertex vertex) {
  const int most = most_points(options.sss);
  if (from_tessellator(request, options)) return most;
  const int scalars = 4 + sss_point_shading_program(vertex, options.depth, false).varying_scalars;
  return std::max(1, std::min(most, request.functional.gs_max_scalars / scalars));
}

FrameGraph build_points(const FrameRequest& request, const SssPointOptions& options) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const SssNeeds needs{.most_points = [&](SssVertex v) { return most_emitted(request, options, v); }};
  SssFrame f = start_sss_frame(graph, request, options.sss, needs);
  if (f.critical.empty()) return graph;
  const bool fixed = options.depth == SssPointDepth::fixed;
  const int samples = fixed ? kSssBaseSamples : 1;
  const ImageId sum = graph.add_image({"sum", Format::rgba16_float, graph.width(), graph.height(), samples});
  graph.add_clear("sum_clear", {sum});
  Pass& pass = graph.add_pass("sample", PassKind::draw);
  pass.samples = samples;
  pass.color = {sum};
  pass.sampled = sss_slots(f);
  if (fixed) {
    pass.depth = f.base.depth;
    pass.depth_read_only = true;
    f.uniforms.depth_slope += 1.0f;  // a point is flat, half a pixel both ways
  }
  const bool tessellated = from_tessellator(request, options);
  add_sss_batches(pass, f, [&](DrawBatch& batch, SssVertex vertex) {
    batch.fragment = &sss_point_shading_program(vertex, options.depth, f.uniforms.lighting.extended);
    const int most = most_emitted(request, options, vertex);
    batch.tessellated_points = tessellated;
    auto uniforms = std::make_shared<SssUniforms>(f.uniforms);
    uniforms->samples_max = static_cast<float>(most);
    uniforms->largest_px2 = largest_sampled_px2(options.sss, needs, vertex);
    batch.geometry = &sss_points_program(vertex, options.depth, most);
    batch.geometry_uniforms = uniforms;
    batch.fragment_uniforms = uniforms;
    batch.state.depth = {fixed, false, Compare::less_equal};
    batch.state.blend = {{true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf}};
  });
  add_sss_composite(graph, f, sss_composite_program(), {resolved_sum(graph, sum)}, {});
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

FrameGraph build_compute(const FrameRequest& request, const SssComputeOptions& options) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const SssNeeds needs{.most_points = [&](SssVertex) { return most_points(options.sss); }};
  SssFrame f = start_sss_frame(graph, request, options.sss, needs);
  if (f.critical.empty()) return graph;
  f.uniforms.largest_px2 = largest_sampled_px2(options.sss, needs, SssVertex::plain);
  const bool floats = options.atomics == SssAtomics::floats ||
                      (options.atomics == SssAtomics::automatic && request.features.float_atomics);
  f.uniforms.radiance_max = static_cast<float>(options.radiance_max);
  f.uniforms.fixed_point_scale = static_cast<float>(1 << options.fixed_bits);
  SssComputeData data = sss_compute_data(*request.scene, f.critical, f.uniforms);
  const int words = 4 * graph.width() * graph.height();
  const BufferId sums = graph.add_buffer({"sums", static_cast<std::uint64_t>(words)});
  add_fill(graph, "sum_clear", {sums}, 1, {words, 0, false});
  Pass& pass = graph.add_pass("sample", PassKind::compute);
  pass.compute = &sss_compute_program(
      {floats, f.uniforms.vertex_words == SurfaceVaryings::kFull, f.uniforms.lighting.extended});
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

/// As many nodes as the options say.
std::uint64_t capacity(const FrameGraph& graph, const SssListOptions& o) {
  const auto pixels = static_cast<std::uint64_t>(graph.width()) * static_cast<std::uint64_t>(graph.height());
  const double budget = o.budget_mib * 1024.0 * 1024.0 - 4.0 * static_cast<double>(pixels);
  if (o.budget_mib > 0.0) return static_cast<std::uint64_t>(std::max(1.0, std::floor(budget / o.node_bytes)));
  return o.capacity_nodes > 0 ? static_cast<std::uint64_t>(o.capacity_nodes) : 4 * pixels;
}

/// Places along a pixel's side; 0: as many as its triangle needs.
int grid_of(SssGrid grid) {
  switch (grid) {
    case SssGrid::places_2x2:
      return 2;
    case SssGrid::places_4x4:
      return 4;
    case SssGrid::places_8x8:
      return 8;
    case SssGrid::adaptive:
      break;
  }
  return 0;
}

FrameGraph build_lists(const FrameRequest& request, const SssListOptions& options) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  const int node_words = options.node_bytes / 4;
  SssFrame f = start_sss_frame(graph, request, options.sss, {.marks = node_words == kSssPlaceNodeWords});
  if (f.critical.empty()) return graph;
  const std::uint64_t nodes = capacity(graph, options);
  SssUniforms& u = f.uniforms;
  u.grid = grid_of(options.grid);
  u.node_words = node_words;
  u.capacity_nodes =
      static_cast<int>(std::min<std::uint64_t>(nodes, 0x1fffffff));  // indices are signed words
  u.list_nodes_max = options.list_cap;
  u.conservative_raster = options.conservative == SssBoxes::raster;
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
    batch.fragment = &sss_list_program(vertex, u.by_place(), u.lighting.extended);
    batch.geometry_uniforms = batch.fragment_uniforms = std::make_shared<SssUniforms>(u);
    batch.state.raster.conservative = u.conservative_raster;
  });
  add_sss_composite(graph, f, sss_list_resolve_program(u.by_place()), {}, {heads, list});
  return graph;
}

using C = SssCounters;
constexpr MessageCode kListsOverflowed = {
    "T101", "lists overflowed",
    "Per-pixel lists had too little memory, or were longer than the resolve reads: the image is incomplete."};

Diagnostic overflow_warning(std::string message, std::string help) {
  Diagnostic warning;
  warning.severity = Severity::warning;
  warning.code = kListsOverflowed.code;
  warning.message = std::move(message);
  warning.help = std::move(help);
  return warning;
}

std::vector<Diagnostic> list_notes(const SssListOptions&, const DrawnFrame& frame) {
  const TechniqueCounters n = total(frame.trace).technique;
  const std::uint64_t dropped = n[C::sss_dropped_fragments], truncated = n[C::sss_truncated_pixels];
  const std::string all = std::to_string(dropped + n[C::sss_stored_fragments]);
  std::vector<Diagnostic> notes;
  if (dropped > 0)
    notes.push_back(overflow_warning(
        std::to_string(dropped) + " of " + all + " fragments found the lists full: the image lacks them",
        "capacity_nodes=" + all + " holds all"));
  if (truncated > 0)
    notes.push_back(overflow_warning(
        "the lists of " + std::to_string(truncated) + " pixels are longer than the resolve reads",
        "list_cap reads up to 64"));
  return notes;
}

constexpr CounterLaw kLaws[] = {HWSIM_LAW_EQUAL(
    "technique.sss_uncritical_primitives + early_exit + processed = technique.sss_tested_primitives",
    c.technique[C::sss_uncritical_primitives] + c.technique[C::sss_early_exit_primitives] +
        c.technique[C::sss_processed_primitives],
    c.technique[C::sss_tested_primitives])};

}  // namespace

Room sss_room() {
  static constexpr MessageCode kCodes[] = {kListsOverflowed};
  return {
      .techniques = {base_technique("sss_gs",
                                    "8x multisampling, points on critical triangles from a geometry shader",
                                    build_points),
                     base_technique("sss_cs",
                                    "8x multisampling, points on critical triangles from a compute shader",
                                    build_compute),
                     with_notes(base_technique("sss_ppll",
                                               "8x multisampling, critical triangles in per-pixel "
                                               "linked lists",
                                               build_lists),
                                list_notes)},
      .counters = C::kDeclared,
      .laws = kLaws,
      .shaded = {C::sss_shaded_samples},
      .codes = kCodes};
}

}  // namespace hwsim::algos
