#include "algos/agaa/agaa.h"

#include <algorithm>
#include <cmath>

#include "algos/agaa/layout.h"
#include "algos/agaa/shaders/programs.h"
#include "algos/agaa/uniforms.h"
#include "algos/base/frame_parts.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

/// Parameters, read.
struct Options {
  int aggregates, samples;
  float k_m, separation;
  Ndf ndf;
  bool ggx;
  DiffuseFilter diffuse;
  bool separate_gloss;
  bool footprint;
  float footprint_px;
  bool unit_mean, squared_sums;
  int shadow_taps;
  MaskStore mask;
  bool floats, moments, light_variance;
  int visible_normals;
  float gloss_reference;
  int emulate, accumulate;
  bool centroid, dither;
  int plane_path;
  bool covariance;
};

Options read_options(const Parameters& parameters) {
  const auto value = [&](std::string_view name) { return parameters.find(name)->second; };
  const auto index = [&](std::string_view name) { return static_cast<int>(value(name)); };
  const auto real = [&](std::string_view name) { return static_cast<float>(value(name)); };
  return {index("c") + 1,
          4 << index("msaa"),
          real("k"),
          real("t"),
          static_cast<Ndf>(index("ndf")),
          index("brdf") != 0,
          static_cast<DiffuseFilter>(index("diffuse_filter")),
          index("gloss") != 0,
          index("k_mode") != 0,
          real("footprint_px"),
          index("mean_normal") == 0,
          index("seed_sum") != 0,
          index("shadow_taps"),
          static_cast<MaskStore>(index("agg_bytes")),
          index("agg_float") != 0,
          index("depth_moments") != 0,
          index("light_variance") != 0,
          index("visible_normals"),
          real("s_ref"),
          index("emulate"),
          index("accumulate"),
          index("centroid") != 0,
          index("a2c_dither") != 0,
          index("plane_path"),
          index("shadow_axis") != 0};
}

/// Builds the frame pass by pass.
class Builder {
 public:
  Builder(const FrameRequest& request, const Options& options)
      : graph_(request.scene, request.width_px, request.height_px),
        o_(options),
        parts_(prepare_frame(graph_, request)),
        pattern_(multicast_layers(request, o_.samples, o_.emulate)),
        features_(request.features) {
    layers_ = std::max(1, static_cast<int>(pattern_.viewports.size()));
    raster_samples_ = o_.samples / layers_;
    code_bits_ = o_.aggregates == 1 ? 0 : o_.aggregates == 2 ? 1 : 2;
    // A GPU without mixed samples adds up in a storage buffer; without coverage after depth it cannot know
    // what to add, and the frame is refused by the name of that switch.
    const GpuFeatures& f = request.features;
    enum Accumulate { automatic, blend, atomics };
    atomic_ = o_.accumulate == atomics ||
              (o_.accumulate == automatic && !(f.target_independent_raster && f.coverage_override));
    // Color samples divide raster samples: three aggregates take four.
    color_samples_ = o_.aggregates == 3 && !atomic_ ? 4 : o_.aggregates;
    const auto effective =
        pattern_.viewports.empty() ? std::vector<SamplePosition>() : effective_positions(pattern_);
    const auto positions = effective.empty() ? standard_sample_positions(o_.samples)
                                             : std::span<const SamplePosition>(effective);
    std::ranges::copy(positions, positions_.begin());
    const float aspect = static_cast<float>(graph_.width()) / static_cast<float>(graph_.height());
    view_from_clip_ = glm::inverse(clip_from_view(parts_.camera, aspect));
    rays_ = center_rays(parts_.camera, view_from_clip_, graph_.width(), graph_.height());
    perspective_ = glm::length(rays_.per_y) > 0.0f;
    pixel_m_ = glm::length(perspective_ ? rays_.per_y : rays_.origin_per_y);
  }

  FrameGraph build() {
    add_images();
    add_visibility();
    add_define();
    add_generate();
    if (layers_ > 1 && !atomic_) add_merge();
    add_shade();
    return std::move(graph_);
  }

 private:
  ImageId image(const std::string& name, Format format, int samples, int layers) {
    return graph_.add_image({name, format, graph_.width(), graph_.height(), samples, layers});
  }

  LayoutChoice layout_choice(int samples) const {
    const bool geometric = o_.diffuse == DiffuseFilter::geometric || o_.separate_gloss;
    return {o_.ndf, o_.mask, samples, geometric, o_.moments && !atomic_, o_.floats};
  }

  void add_images() {
    depth_ = image("depth", Format::d24_unorm_s8, raster_samples_, layers_);
    normal_ = image("normal", Format::rg8_unorm, raster_samples_, layers_);
    // Eight samples' codes a layer: 8 or 16 bits.
    if (code_bits_ > 0)
      codes_ = image("codes", code_bits_ == 1 ? Format::r8_uint : Format::r16_uint, 1, (o_.samples + 7) / 8);
    layout_ = make_layout(layout_choice(raster_samples_));
    if (atomic_) {
      const auto pixels =
          static_cast<std::uint64_t>(graph_.width()) * static_cast<std::uint64_t>(graph_.height());
      buffer_ = graph_.add_buffer(
          {"aggregates", pixels * static_cast<std::uint64_t>(o_.aggregates) * kAggregateWords});
      return;
    }
    for (const AggregateLayout::Target& target : layout_.targets)
      targets_.push_back(image("aggregate_" + target.name, target.format, color_samples_, layers_));
  }

  Pass& add_geometry_pass(const std::string& name) {
    Pass& pass = graph_.add_pass(name, PassKind::draw);
    pass.samples = raster_samples_;
    pass.viewports = pattern_.viewports;
    pass.depth = depth_;
    return pass;
  }

  PipelineState geometry_state() const {
    ForwardTarget target;
    target.centroid = o_.centroid;
    target.layers = pattern_;
    return opaque_state(target);
  }

  void add_visibility() {
    graph_.add_clear("clear", {depth_, normal_});
    Pass& pass = add_geometry_pass("visibility");
    pass.color = {normal_};
    pass.batches.push_back(visibility_batch(parts_.draws.opaque, false));
    std::vector<DrawCall> alpha = parts_.draws.mask;  // alpha is coverage (techniques 4.7)
    alpha.insert(alpha.end(), parts_.draws.blend.begin(), parts_.draws.blend.end());
    if (!alpha.empty()) pass.batches.push_back(visibility_batch(alpha, true));
  }

  DrawBatch visibility_batch(const std::vector<DrawCall>& draws, bool alpha) const {
    DrawBatch batch;
    batch.state = geometry_state();
    batch.state.coverage.alpha_to_coverage = alpha;
    batch.state.coverage.alpha_dither = o_.dither;
    batch.vertex = &mesh_geometry_program();
    batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{parts_.clip_from_world});
    batch.fragment = &agaa_visibility_program(alpha);
    batch.fragment_uniforms = std::make_shared<VisibilityUniforms>(VisibilityUniforms{rays_});
    batch.draws = draws;
    return batch;
  }

  Pass& add_compute(const std::string& name, const ComputeProgram& program,
                    std::shared_ptr<const void> uniforms) {
    Pass& pass = graph_.add_pass(name, PassKind::compute);
    pass.compute = &program;
    pass.groups_x = (graph_.width() + program.group_width - 1) / program.group_width;
    pass.groups_y = (graph_.height() + program.group_height - 1) / program.group_height;
    pass.uniforms = std::move(uniforms);
    return pass;
  }

  void add_define() {
    if (code_bits_ == 0) return;  // one aggregate: nothing to tell apart
    auto u = std::make_shared<DefineUniforms>();
    u->view_from_clip = view_from_clip_;
    u->width = graph_.width();
    u->height = graph_.height();
    u->samples = o_.samples;
    u->aggregates = o_.aggregates;
    u->code_bits = code_bits_;
    u->positions = positions_;
    u->inv_k2 = 1.0f / (o_.k_m * o_.k_m);
    u->footprint_k = o_.footprint ? o_.footprint_px * pixel_m_ : 0.0f;
    u->perspective = perspective_;
    u->separation = o_.separation;
    u->unit_mean_normal = o_.unit_mean;
    u->squared_sums = o_.squared_sums;
    // A layer's planes are its own: layers that stand for one pixel would have to be matched.
    enum PlanePath { automatic, on, off };
    const bool planes = layers_ == 1 && (o_.plane_path == on ||
                                         (o_.plane_path == automatic && features_.compressed_depth_read));
    u->reads_planes = planes;
    Pass& pass = add_compute("define", agaa_define_program(), std::move(u));
    pass.sampled = {depth_, normal_};
    pass.targets = {codes_};
    if (planes) pass.depth_planes = depth_;
  }

  AggregateUniforms aggregate_uniforms(const AggregateTargets& targets) const {
    AggregateUniforms u;
    u.targets = targets;
    u.ndf = o_.ndf;
    u.rays = rays_;
    u.gloss_reference = o_.gloss_reference;
    // 1/8: |v| = 1/9, whose direction 16 bits still hold to 0.3 degrees at a 32nd of full weight. Where
    // diffuse light takes the vector's length, rough materials would darken by more than they gain.
    u.least_exponent = o_.diffuse == DiffuseFilter::folded ? 1.0f : 0.125f;
    u.samples = o_.samples;
    u.code_bits = code_bits_;
    u.width = graph_.width();
    return u;
  }

  void add_generate() {
    if (!atomic_) graph_.add_clear("clear_aggregates", targets_);
    Pass& pass = add_geometry_pass("generate");
    pass.depth_read_only = true;
    if (code_bits_ > 0) pass.sampled = {codes_};
    if (atomic_) {
      pass.storage = {buffer_};
      pass.storage_written = 1;
    } else {
      pass.color = targets_;
    }
    auto u = std::make_shared<GenerateUniforms>();
    u->aggregate = aggregate_uniforms(layout_.index);
    u->full_varyings = parts_.full_varyings;
    u->color_samples = color_samples_;
    u->raster_samples = raster_samples_;
    const glm::mat4& view = parts_.camera.view_from_world;
    u->view_z_row = -glm::vec4(view[0][2], view[1][2], view[2][2], view[3][2]);
    DrawBatch batch = generate_batch();
    batch.fragment_uniforms = std::move(u);
    for (const auto* list : {&parts_.draws.opaque, &parts_.draws.mask, &parts_.draws.blend})
      batch.draws.insert(batch.draws.end(), list->begin(), list->end());
    pass.batches.push_back(std::move(batch));
  }

  // Algorithm 2, 1: every sample takes the first fragment that meets its depth, in submission order.
  DrawBatch generate_batch() const {
    DrawBatch batch;
    PipelineState& state = batch.state;
    state = geometry_state();
    state.depth = {true, false, Compare::equal};
    state.stencil.test = true;
    state.stencil.compare = Compare::equal;
    state.stencil.on_pass = StencilOp::increment_saturate;
    state.force_early_z = true;
    state.coverage.post_depth = true;
    if (!atomic_) {
      state.coverage.override_output = true;
      state.blend.assign(targets_.size(),
                         {true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf});
    }
    batch.vertex = parts_.full_varyings ? &mesh_full_program() : &mesh_surface_program();
    batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{parts_.clip_from_world});
    batch.fragment = &agaa_generate_program(o_.ndf, parts_.full_varyings, atomic_);
    return batch;
  }

  // The layers' records become one, with a mask of all samples.
  void add_merge() {
    const AggregateLayout merged = make_layout(layout_choice(o_.samples));
    auto u = std::make_shared<MergeLayersUniforms>();
    u->from = layout_.index;
    u->to = merged.index;
    u->width = graph_.width();
    u->height = graph_.height();
    u->layers = layers_;
    u->color_samples = color_samples_;
    u->aggregates = o_.aggregates;
    Pass& pass = add_compute("merge", agaa_merge_program(), std::move(u));
    pass.sampled = targets_;
    // As many samples as aggregates, so far as images have such counts.
    for (const AggregateLayout::Target& target : merged.targets)
      pass.targets.push_back(graph_.add_image(
          {"merged_" + target.name, target.format, graph_.width(), graph_.height(), color_samples_, 1}));
    targets_ = pass.targets;
    layout_ = merged;
  }

  void add_shade() {
    auto u = std::make_shared<ShadeUniforms>();
    u->aggregate = aggregate_uniforms(layout_.index);
    u->lighting = parts_.lighting;
    if (o_.ggx) u->lighting.model = ShadingModel::ggx;
    u->eye_from_clip = glm::mat4(glm::transpose(glm::mat3(parts_.camera.view_from_world))) * view_from_clip_;
    u->background = graph_.scene().background;
    u->height = graph_.height();
    u->aggregates = o_.aggregates;
    u->positions = positions_;
    u->diffuse = o_.diffuse;
    u->separate_gloss = o_.separate_gloss;
    u->light_variance = o_.light_variance;
    u->covariance = o_.covariance;
    // The rows of view z and w hold no x and y: projections keep the planes of equal depth.
    const glm::mat4& m = view_from_clip_;
    u->depth_of_z = {-m[3][2], -m[2][2], m[3][3], m[2][3]};
    set_shadow_taps(*u, o_.shadow_taps);
    set_hemisphere(*u, o_.visible_normals);
    const ImageId output = add_output(graph_);
    Pass& pass = graph_.add_pass("shade", PassKind::full_screen);
    pass.color = {output};
    if (atomic_)
      pass.storage = {buffer_};
    else
      pass.sampled = targets_;
    u->depth_slot = static_cast<int>(pass.sampled.size());
    pass.sampled.push_back(depth_);
    if (o_.diffuse == DiffuseFilter::samples) {
      u->normal_slot = static_cast<int>(pass.sampled.size());
      pass.sampled.push_back(normal_);
    }
    if (layout_.index.counts_samples && code_bits_ > 0) {
      u->code_slot = static_cast<int>(pass.sampled.size());
      pass.sampled.push_back(codes_);
    }
    if (parts_.shadow_map) {
      u->lighting.shadow_slot = static_cast<int>(pass.sampled.size());
      pass.sampled.push_back(parts_.shadow_map);
    }
    pass.fragment = &agaa_shade_program(o_.ndf, atomic_);
    pass.uniforms = std::move(u);
  }

  FrameGraph graph_;
  const Options& o_;
  FrameParts parts_;
  MulticastPattern pattern_;
  GpuFeatures features_;
  int layers_ = 1, raster_samples_ = 8, code_bits_ = 1, color_samples_ = 2;
  bool atomic_ = false, perspective_ = true;
  float pixel_m_ = 0.0f;  ///< a pixel's height, at distance 1 if it grows with it
  std::array<SamplePosition, 32> positions_{};
  glm::mat4 view_from_clip_{1.0f};
  PixelRays rays_;
  AggregateLayout layout_;
  ImageId depth_, normal_, codes_;
  std::vector<ImageId> targets_;
  BufferId buffer_;
};

FrameGraph build_agaa(const FrameRequest& request, const Parameters& parameters) {
  const Options options = read_options(parameters);
  return Builder(request, options).build();
}

constexpr ParameterInfo kParameters[] = {
    {"c", 1, 0, 3, "aggregates a pixel; three take the memory of four where they are color samples",
     "1|2|3|4"},
    {"msaa", 1, 0, 3, "visibility samples a pixel", "4|8|16|32"},
    {"k", 0.1, 0.001, 10, "length at which positions weigh as much as normals, m"},
    {"t", 0.02, 0, 1, "distance that keeps aggregates apart"},
    {"ndf", 0, 0, 2, "distribution of normals", "toksvig|lean|sggx"},
    {"brdf", 0, 0, 1, "specular reflection", "blinn_phong|ggx"},
    {"diffuse_filter", 3, 0, 3,
     "diffuse light over the normals: none, by the lobe that holds the gloss too, by a mean of unit normals "
     "beside "
     "it, or by the samples' normals of the first pass",
     "off|folded|geometric|samples"},
    {"gloss", 0, 0, 1, "folded into the normals' lobe, or stored beside it", "folded|separate"},
    {"k_mode", 0, 0, 1, "k as given, or at least footprint_px pixels", "world|footprint"},
    {"footprint_px", 8, 1, 64, "with k_mode=footprint"},
    {"mean_normal", 0, 0, 1, "of the first seed's search", "unit|raw"},
    {"seed_sum", 0, 0, 1, "further seeds: by sums of distances, or of their squares", "d|d2"},
    {"shadow_taps", 4, 1, 8, "along the main axis of an aggregate's samples"},
    {"agg_bytes", 0, 0, 2, "mask: as many bytes as it needs, a sample count instead, or 32 bits of its own",
     "natural|16|20"},
    {"agg_float", 0, 0, 1, "half floats in the aggregate G-buffer", "off|on"},
    {"depth_moments", 0, 0, 1, "depth's moments stored, instead of read from the samples", "off|on"},
    {"light_variance", 0, 0, 1, "directions to near lights widen the lobe", "off|on"},
    {"visible_normals", 8, 4, 32, "of SGGX's diffuse light"},
    {"s_ref", 0, 0, 65535, "Toksvig's reference exponent; 0: infinite"},
    {"emulate", 0, 0, 2, "layers of 8 samples, by viewport multicast, or native samples", kEmulateChoices},
    {"accumulate", 0, 0, 2, "aggregates add up by blending into mixed samples, or by atomics",
     "auto|blend|atomics"},
    kCentroid,
    {"plane_path", 0, 0, 2,
     "native samples: depth tiles that are compressed to few planes take those for aggregates",
     "auto|on|off"},
    {"a2c_dither", 1, 0, 1, "alpha to coverage rounds by 2x2 pixels", "off|on"},
    {"shadow_axis", 0, 0, 1,
     "along which shadows are filtered: the depths of an aggregate's samples, or their places",
     "depth|places"},
};

constexpr TechniqueInfo kTechniques[] = {
    {"agaa",
     "aggregate G-buffer: dense visibility, up to four pre-filtered surfaces a pixel (Crassin et al. 2016)",
     kParameters, build_agaa},
};

}  // namespace

std::span<const TechniqueInfo> agaa_techniques() { return kTechniques; }

}  // namespace hwsim::algos
