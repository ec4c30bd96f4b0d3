#include "algos/sss/frame.h"

#include <algorithm>
#include <array>

#include "algos/sss/classify.h"

namespace hwsim::algos {
using namespace pipeline;

namespace {

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
  const auto nearest = [&](int x, int y) {
    const auto distance2 = [&](const SamplePosition& p) {
      const int dx = p.x + 8 - x, dy = p.y + 8 - y;
      return dx * dx + dy * dy;
    };
    return static_cast<int>(std::min_element(samples.begin(), samples.end(),
                                             [&](const SamplePosition& a, const SamplePosition& b) {
                                               return distance2(a) < distance2(b);
                                             }) -
                            samples.begin());
  };
  for (int cell = 0; cell < 16; ++cell)
    u.nearest_samples[static_cast<std::size_t>(cell / 8)] |= nearest(4 * (cell % 4) + 2, 4 * (cell / 4) + 2)
                                                             << (4 * (cell % 8));
  for (int k = 0; k < 8; ++k) {
    const int i = k < 4 ? k : k + 1, x = i % 3 - 1, y = i / 3 - 1;
    u.neighbor_samples[static_cast<std::size_t>(k)] = nearest(8 - 16 * x, 8 - 16 * y);
  }
}

SssUniforms make_uniforms(const FrameGraph& graph, const FrameParts& parts, const SssOptions& o) {
  SssUniforms u;
  u.lighting = parts.lighting;
  if (parts.shadow_map) u.lighting.shadow_slot = kSssShadowSlot;
  u.clip_from_world = parts.clip_from_world;
  u.width_px = graph.width();
  u.height_px = graph.height();
  u.mode = o.mode;
  u.triangle_px = static_cast<float>(o.triangle_px);
  u.highlight_px = static_cast<float>(o.highlight_px);
  u.early_exit = o.early_exit;
  u.threshold = static_cast<float>(o.threshold);
  const bool phong = parts.lighting.model == ShadingModel::phong;
  u.exponent_scale = phong ? 1.0f : 0.25f;  // half vectors turn half as fast as reflections
  u.normalized = !phong;
  u.samples_per_px = static_cast<float>(o.samples_per_px);
  u.samples_min = static_cast<float>(o.samples_min);
  u.samples_max = std::max(static_cast<float>(o.samples_max), u.samples_min);
  u.border_share = static_cast<float>(o.border_share);
  u.depth_bias = static_cast<float>(o.depth_bias_steps) * 0x1p-24f;
  u.depth_slope = static_cast<float>(o.depth_slope);
  set_samples(u);
  return u;
}

/// The paper presumes opaque solids. What is blended over them writes no depth, so samples behind it would
/// replace it: its depth is drawn apart, and they keep away.
void add_overlay_depth(FrameGraph& graph, const SssFrame& f) {
  const DrawLists& draws = f.parts.draws;
  if (draws.separate.empty() && draws.blend.empty()) return;
  Pass& pass = graph.add_pass("overlay_depth", PassKind::draw);
  pass.samples = f.base.samples;
  pass.depth = f.base.depth;
  if (!draws.separate.empty())
    pass.batches.push_back(f.parts.request->separate->depth_batch(f.parts, f.base));
  if (draws.blend.empty()) return;
  pass.batches.push_back(mesh_batch(f.parts, draws.blend, mesh_position_program()));
  pass.batches.back().state = opaque_state(f.base);
}

/// The multisampled frame's samples on triangles that are sampled: drawn once more, where the depth is
/// theirs.
void add_marks(FrameGraph& graph, SssFrame& f, const SssOptions& options, const SssNeeds& needs) {
  f.marks = graph.add_image(
      {"marks", Format::r8_unorm, graph.width(), graph.height(), graph.image(f.base.depth).samples});
  graph.add_clear("marks_clear", {f.marks});
  Pass& pass = graph.add_pass("marks", PassKind::draw);
  pass.samples = f.base.samples;
  pass.color = {f.marks};
  pass.depth = f.base.depth;
  pass.depth_read_only = true;
  add_sss_batches(pass, f, [&](DrawBatch& batch, SssVertex vertex) {
    auto uniforms = std::make_shared<SssUniforms>(f.uniforms);
    uniforms->counted = false;
    uniforms->largest_px2 = largest_sampled_px2(options, needs, vertex);
    batch.geometry = &sss_marks_program(vertex);
    batch.geometry_uniforms = uniforms;
    batch.fragment = &sss_mark_program();
    batch.fragment_uniforms = batch.geometry_uniforms;
    batch.state.depth = {true, false, Compare::equal};
  });
}

bool has_coverage_map(const FrameRequest& request, SssBase base) {
  if (base == SssBase::automatic) return request.features.coverage_samples_max >= kSssCoverageSamples;
  return base == SssBase::csaa32x;
}

ForwardTarget make_base(FrameGraph& graph, bool coverage_map) {
  ForwardTarget base;
  base.width = graph.width();
  base.height = graph.height();
  base.samples = kSssBaseSamples;
  base.coverage_samples = coverage_map ? kSssCoverageSamples : 0;
  base.centroid = true;
  base.color = graph.add_image({"multisampled_color", Format::rgba8_srgb, base.width, base.height,
                                base.samples, 1, base.coverage_samples});
  base.depth =
      graph.add_image({"multisampled_depth", Format::d24_unorm_s8, base.width, base.height, base.samples});
  return base;
}

}  // namespace

float largest_sampled_px2(const SssOptions& options, const SssNeeds& needs, SssVertex vertex) {
  if (!needs.most_points || options.sparsest_per_px <= 0.0) return 1e30f;
  return static_cast<float>(needs.most_points(vertex) / options.sparsest_per_px);
}

SssFrame start_sss_frame(FrameGraph& graph, const FrameRequest& request, const SssOptions& o,
                         const SssNeeds& needs) {
  SssFrame f;
  f.parts = prepare_frame(graph, request);
  if (o.shading == SssShading::phong) f.parts.lighting.model = ShadingModel::phong;
  f.base = make_base(graph, has_coverage_map(request, o.base));
  add_forward(graph, f.parts, "", f.base);
  f.critical = list_critical(f.parts, o.theta_c_deg);
  if (f.critical.empty()) {
    graph.add_resolve("resolve", f.base.color, add_output(graph));
    return f;
  }
  add_overlay_depth(graph, f);
  f.uniforms = make_uniforms(graph, f.parts, o);
  f.over_others = o.rest == SssRest::others;
  if (f.over_others || needs.marks) add_marks(graph, f, o, needs);
  f.below = graph.add_image({"resolved", Format::rgba8_srgb, graph.width(), graph.height(), 1});
  graph.add_resolve("resolve", f.base.color, f.below);
  return f;
}

void add_sss_composite(FrameGraph& graph, const SssFrame& f, const FragmentProgram& program,
                       std::vector<ImageId> sums, std::vector<BufferId> buffers) {
  Pass& pass = graph.add_pass("composite", PassKind::full_screen);
  SssUniforms uniforms = f.uniforms;
  pass.sampled = {f.below};
  pass.sampled.insert(pass.sampled.end(), sums.begin(), sums.end());
  uniforms.mark_slot = -1;
  if (f.over_others) {
    uniforms.mark_slot = static_cast<int>(pass.sampled.size());
    pass.sampled.push_back(f.marks);
    pass.sampled.push_back(f.base.color);
    pass.views.resize(pass.sampled.size(), Format::none);
    pass.views.back() = graph.image(f.base.color).format;
  }
  pass.storage = std::move(buffers);
  pass.fragment = &program;
  pass.uniforms = std::make_shared<SssUniforms>(std::move(uniforms));
  pass.color = {add_output(graph)};
}

std::vector<ImageId> sss_slots(const SssFrame& f) {
  std::vector<ImageId> images = {f.base.depth};
  if (f.parts.shadow_map) images.push_back(f.parts.shadow_map);
  return images;
}

}  // namespace hwsim::algos
