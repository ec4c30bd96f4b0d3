#include "algos/agaa/agaa.h"

#include <algorithm>
#include <cmath>

#include "algos/agaa/layout.h"
#include "algos/agaa/options.h"
#include "algos/agaa/shaders/programs.h"
#include "algos/agaa/uniforms.h"
#include "algos/base/frame_parts.h"
#include "algos/base/lost_light.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

/// Builds the frame pass by pass.
class Builder {
 public:
  Builder(const FrameRequest& request, const AgaaOptions& options)
      : graph_(request.scene, request.width_px, request.height_px),
        o_(options),
        parts_(prepare_gbuffer_frame(graph_, request)),
        pattern_(multicast_layers(request, o_.samples, o_.emulate)),
        features_(request.features) {
    layers_ = std::max(1, static_cast<int>(pattern_.viewports.size()));
    raster_samples_ = o_.samples / layers_;
    code_bits_ = o_.aggregates == 1 ? 0 : o_.aggregates == 2 ? 1 : 2;
    // A GPU without mixed samples adds up in a storage buffer; without coverage after depth it cannot know
    // what to add, and the frame is refused by the name of that switch.
    const GpuFeatures& f = request.features;
    atomic_ =
        o_.accumulate == AgaaAccumulate::atomics ||
        (o_.accumulate == AgaaAccumulate::automatic && !(f.target_independent_raster && f.coverage_override));
    // Color samples divide raster samples: three aggregates take four.
    color_samples_ = o_.aggregates == 3 && !atomic_ ? 4 : o_.aggregates;
    const auto effective =
        pattern_.viewports.empty() ? std::vector<SamplePosition>() : effective_positions(pattern_);
    const auto positions = effective.empty() ? standard_sample_positions(o_.samples)
                                             : std::span<const SamplePosition>(effective);
    std::ranges::copy(positions, positions_.begin());
    rays_ = center_rays(parts_.camera, parts_.view_from_clip, graph_.width(), graph_.height());
    perspective_ = glm::length(rays_.per_y) > 0.0f;
    pixel_m_ = glm::length(perspective_ ? rays_.per_y : rays_.origin_per_y);
  }

  FrameGraph build() {
    add_images();
    add_visibility();
    add_define();
    add_generate();
    if (layers_ > 1 && !atomic_) add_merge();
    output_ = add_output(graph_);
    add_shade();
    add_over_output(graph_, parts_, output_, depth_, pattern_, false);
    return std::move(graph_);
  }

 private:
  ImageId image(const std::string& name, Format format, int samples, int layers) {
    return graph_.add_image({name, format, graph_.width(), graph_.height(), samples, layers});
  }

  DiffuseFilter diffuse() const {
    switch (o_.diffuse) {
      case AgaaDiffuse::automatic:
        return o_.ndf == Ndf::toksvig ? DiffuseFilter::folded : DiffuseFilter::samples;
      case AgaaDiffuse::off:
        return DiffuseFilter::off;
      case AgaaDiffuse::folded:
        return DiffuseFilter::folded;
      case AgaaDiffuse::geometric:
        return DiffuseFilter::geometric;
      case AgaaDiffuse::samples:
        return DiffuseFilter::samples;
    }
    return DiffuseFilter::off;
  }

  bool separate_gloss() const { return o_.gloss == AgaaGloss::separate; }

  LayoutChoice layout_choice(int samples) const {
    const bool geometric = diffuse() == DiffuseFilter::geometric || separate_gloss();
    return {o_.ndf, o_.mask, samples, geometric, o_.depth_moments && !atomic_, o_.half_floats};
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
    std::vector<DrawCall> alpha = parts_.draws.mask;  // alpha is coverage (docs/techniques/agaa.md#alpha)
    alpha.insert(alpha.end(), parts_.draws.blend.begin(), parts_.draws.blend.end());
    if (!alpha.empty()) pass.batches.push_back(visibility_batch(alpha, true));
    add_opaque_separate(pass, parts_, SurfaceInputs::geometry, visibility_batch({}, false));
  }

  DrawBatch visibility_batch(const std::vector<DrawCall>& draws, bool alpha) const {
    DrawBatch batch = mesh_batch(parts_, draws, mesh_geometry_program());
    batch.state = geometry_state();
    batch.state.coverage.alpha_to_coverage = alpha;
    batch.state.coverage.alpha_dither = o_.alpha_dither;
    batch.fragment = &agaa_visibility_program(alpha);
    batch.fragment_uniforms = std::make_shared<VisibilityUniforms>(VisibilityUniforms{rays_});
    return batch;
  }

  void add_define() {
    if (code_bits_ == 0) return;  // one aggregate: nothing to tell apart
    auto u = std::make_shared<DefineUniforms>();
    u->view_from_clip = parts_.view_from_clip;
    u->width = graph_.width();
    u->height = graph_.height();
    u->samples = o_.samples;
    u->aggregates = o_.aggregates;
    u->code_bits = code_bits_;
    u->positions = positions_;
    const auto k = static_cast<float>(o_.k_m * graph_.scene().units_per_option_m);
    u->inv_k2 = 1.0f / (k * k);
    u->footprint_k =
        o_.k_mode == AgaaScale::footprint ? static_cast<float>(o_.footprint_px) * pixel_m_ : 0.0f;
    u->perspective = perspective_;
    u->separation = static_cast<float>(o_.separation);
    u->unit_mean_normal = o_.mean_normal == AgaaMeanNormal::unit;
    u->seeds = o_.seeds;
    const bool given =
        o_.plane_path == AgaaPlanePath::given || (o_.plane_path == AgaaPlanePath::automatic && layers_ > 1);
    const bool planes = given || o_.plane_path == AgaaPlanePath::on ||
                        (o_.plane_path == AgaaPlanePath::automatic && features_.compressed_depth_read);
    u->reads_planes = planes;
    u->layers = layers_;
    for (std::size_t l = 0; l < pattern_.viewports.size(); ++l)
      u->layer_shift_px[l] = glm::vec2(pattern_.viewports[l].x, pattern_.viewports[l].y) / 256.0f;
    u->empty_exit = o_.empty_exit;
    Pass& pass = add_frame_compute(graph_, "define", agaa_define_program(), std::move(u));
    pass.sampled = {depth_, normal_};
    pass.targets = {codes_};
    if (planes) pass.depth_planes = depth_;
    pass.depth_planes_given = given;
  }

  AggregateUniforms aggregate_uniforms(const AggregateTargets& targets) const {
    AggregateUniforms u;
    u.targets = targets;
    u.ndf = o_.ndf;
    u.rays = rays_;
    u.gloss_reference = static_cast<float>(o_.gloss_reference);
    // 1/8: |v| = 1/9, whose direction 16 bits still hold to 0.3 degrees at a 32nd of full weight.
    u.matte_exponent = diffuse() == DiffuseFilter::folded ? static_cast<float>(o_.matte_exponent) : 0.0f;
    if (o_.ndf == Ndf::toksvig && o_.brdf == AgaaBrdf::blinn_phong)
      u.most_energy = (u.least_exponent + 8.0f) / (u.least_exponent + 1.0f);
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
    pass.batches.push_back(batch);
    add_opaque_separate(pass, parts_, surface_inputs(parts_), std::move(batch));
  }

  // Algorithm 2, 1: every sample takes the first fragment that meets its depth, in submission order.
  DrawBatch generate_batch() const {
    std::vector<DrawCall> draws;
    for (const auto* list : {&parts_.draws.opaque, &parts_.draws.mask, &parts_.draws.blend})
      draws.insert(draws.end(), list->begin(), list->end());
    DrawBatch batch = mesh_batch(parts_, draws, surface_vertex_program(parts_));
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
    Pass& pass = add_frame_compute(graph_, "merge", agaa_merge_program(), std::move(u));
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
    if (o_.brdf == AgaaBrdf::ggx) u->lighting.model = ShadingModel::ggx;
    u->eye_from_clip =
        glm::mat4(glm::transpose(glm::mat3(parts_.camera.view_from_world))) * parts_.view_from_clip;
    u->background = graph_.scene().background;
    u->height = graph_.height();
    u->aggregates = o_.aggregates;
    u->positions = positions_;
    u->diffuse = diffuse();
    u->separate_gloss = separate_gloss();
    u->light_variance = o_.light_variance;
    u->on_receiver = o_.shadow_axis == AgaaShadowAxis::receiver;
    u->covariance = o_.shadow_axis == AgaaShadowAxis::places;
    // The rows of view z and w hold no x and y: projections keep the planes of equal depth.
    const glm::mat4& m = parts_.view_from_clip;
    u->depth_of_z = {-m[3][2], -m[2][2], m[3][3], m[2][3]};
    set_shadow_taps(*u, o_.shadow_taps);
    set_hemisphere(*u, o_.visible_normals);
    Pass& pass = graph_.add_pass("shade", PassKind::full_screen);
    pass.color = {output_};
    if (atomic_)
      pass.storage = {buffer_};
    else
      pass.sampled = targets_;
    u->depth_slot = static_cast<int>(pass.sampled.size());
    pass.sampled.push_back(depth_);
    if (diffuse() == DiffuseFilter::samples) {
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
    pass.fragment = &agaa_shade_program({o_.ndf, atomic_, u->on_receiver, parts_.lighting.extended});
    pass.uniforms = std::move(u);
  }

  FrameGraph graph_;
  const AgaaOptions& o_;
  FrameParts parts_;
  MulticastPattern pattern_;
  GpuFeatures features_;
  int layers_ = 1, raster_samples_ = 8, code_bits_ = 1, color_samples_ = 2;
  bool atomic_ = false, perspective_ = true;
  float pixel_m_ = 0.0f;  ///< a pixel's height, at distance 1 if it grows with it
  std::array<SamplePosition, 32> positions_{};
  PixelRays rays_;
  AggregateLayout layout_;
  ImageId depth_, normal_, codes_, output_;
  std::vector<ImageId> targets_;
  BufferId buffer_;
};

FrameGraph build_agaa(const FrameRequest& request, const AgaaOptions& options) {
  return Builder(request, options).build();
}

constexpr MessageCode kPlaceLeftEmpty = {
    "T102", "an aggregate's place is left empty",
    "Mixed samples: the color samples of a target divide its raster samples, so three aggregates are stored "
    "as four. The image is not affected; memory and its bandwidth are those of four."};

constexpr MessageCode kPlanesGiven = {"T107", "depth planes are given",
                                      "Above 8 samples a pixel the paper (section 5) reads the planes of "
                                      "compressed depth, which no GPU lets shaders read: "
                                      "it makes them beforehand, and its times leave that out. So do ours. "
                                      "plane_path=off goes sample by sample."};

/// Samples of a pixel that the aggregates' blended targets have; 0 without such targets.
int target_samples(const WorkTrace& trace) {
  for (const PassWork& pass : trace.passes)
    if (pass.name == "generate" && !pass.color_targets.empty()) return pass.color_targets.front().samples;
  return 0;
}

/// Whether pixels took their aggregates from planes in a frame that may have been given them.
bool has_given_planes(const AgaaOptions& options, const WorkTrace& trace) {
  const bool may = options.plane_path == AgaaPlanePath::given ||
                   (options.plane_path == AgaaPlanePath::automatic && options.samples > 8);
  return may && total(trace).technique[AgaaCounters::agaa_plane_path_pixels] > 0;
}

std::vector<Diagnostic> notes(const AgaaOptions& options, const DrawnFrame& frame) {
  SurfaceRecord record;
  record.holds_blended = true;
  std::vector<Diagnostic> all =
      lost_light(frame.surfaces, record,
                 "forward techniques, as msaa8x, show it; so does `sbaa_merge` but for occlusion");
  if (has_given_planes(options, frame.trace)) {
    Diagnostic given;
    given.severity = Severity::note;
    given.code = kPlanesGiven.code;
    given.message =
        "the definition reads depth planes that are given, as in the paper above 8 samples a pixel; no GPU "
        "lets "
        "shaders read them";
    given.help = "plane_path=off goes sample by sample";
    all.push_back(std::move(given));
  }
  const int samples = target_samples(frame.trace);
  if (samples <= options.aggregates) return all;
  Diagnostic note;
  note.severity = Severity::note;
  note.code = kPlaceLeftEmpty.code;
  note.message = "color samples divide raster samples: " + std::to_string(options.aggregates) +
                 " aggregates take the memory of " + std::to_string(samples);
  note.help = "accumulate=atomics stores them without a gap";
  all.push_back(std::move(note));
  return all;
}

constexpr CounterLaw kLaws[] = {
    HWSIM_LAW_AT_MOST("technique.agaa_plane_split_pixels <= technique.agaa_aggregates",
                      c.technique[AgaaCounters::agaa_plane_split_pixels],
                      c.technique[AgaaCounters::agaa_aggregates]),
    HWSIM_LAW_AT_MOST("technique.agaa_mixed_code_fragments <= ps.invocations",
                      c.technique[AgaaCounters::agaa_mixed_code_fragments], c.ps.invocations),
};

}  // namespace

Room agaa_room() {
  static constexpr MessageCode kCodes[] = {kPlaceLeftEmpty, kPlanesGiven, kUnlitIsEmission};
  const TechniqueInfo agaa = base_technique(
      "agaa",
      "aggregate G-buffer: dense visibility, up to four pre-filtered surfaces a pixel (Crassin et al. 2016)",
      build_agaa);
  return {.techniques = {with_notes(agaa, notes)},
          .counters = AgaaCounters::kDeclared,
          .laws = kLaws,
          .codes = kCodes};
}

}  // namespace hwsim::algos
