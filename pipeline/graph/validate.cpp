#include "pipeline/graph/validate.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "pipeline/batch/fragment_batch.h"
#include "pipeline/graph/validate_coverage.h"
#include "pipeline/raster/triangle.h"

namespace hwsim::pipeline {
namespace {

constexpr std::size_t kMaxProgrammablePositions = 16;
constexpr int kMaxLayers = 2048;

class Validator {
 public:
  Validator(const FrameGraph& graph, const GpuFeatures& features, const FunctionalConfig& functional)
      : graph_(graph), features_(features), functional_(functional), written_(graph.images().size(), 0) {}

  std::vector<Diagnostic> run() {
    for (const ImageDesc& image : graph_.images()) check_image(image);
    if (!errors_.empty()) return std::move(errors_);
    for (std::size_t i = 0; i < written_.size(); ++i) check_contents({static_cast<int>(i)});
    for (const Pass& pass : graph_.passes()) check_pass(pass);
    check_output();
    return std::move(errors_);
  }

 private:
  void tell(std::string code, std::string message, std::string help = "") {
    errors_.push_back({Severity::error, std::move(code), std::move(message), {}, {}, {}, std::move(help)});
  }

  void add(std::vector<Diagnostic> found) {
    errors_.insert(errors_.end(), std::make_move_iterator(found.begin()),
                   std::make_move_iterator(found.end()));
  }

  void check_image(const ImageDesc& image) {
    if (image.width < 1 || image.height < 1 || image.width > functional_.max_image_px ||
        image.height > functional_.max_image_px)
      tell("G001",
           "image " + text(image) + " must be 1 to " + std::to_string(functional_.max_image_px) +
               " pixels wide and high",
           "choose a smaller resolution or supersampling rate");
    if (image.format == Format::none) tell("G003", "image `" + image.name + "` has no format");
    if (image.layers < 1 || image.layers > kMaxLayers)
      tell("G001", "image " + text(image) + " must have 1 to " + std::to_string(kMaxLayers) + " layers");
    const int s = image.samples;
    const bool said =
        std::find(refused_samples_.begin(), refused_samples_.end(), s) != refused_samples_.end();
    const bool refused = s < 1 || s > kMaxSamples || (s & (s - 1)) != 0 || s > features_.native_msaa_max;
    if (refused) refused_samples_.push_back(s);
    if (said) return;  // once for all images of a frame
    if (s < 1 || s > kMaxSamples || (s & (s - 1)) != 0)
      tell("G002", "image " + text(image) + " must have 1, 2, 4, 8, 16 or 32 samples");
    else if (s > features_.native_msaa_max)
      tell("G006",
           "image " + text(image) + " needs " + std::to_string(s) + " samples, this GPU has " +
               std::to_string(features_.native_msaa_max) + " (gpu.features.native_msaa_max)",
           "gpu.features.native_msaa_max = " + std::to_string(s) + " makes it native");
    if (image.coverage_samples != 0) add(check_coverage_samples(image, features_));
  }

  void check_contents(ImageId id) {
    const RawImage* contents = graph_.contents(id);
    if (contents == nullptr) return;
    const ImageDesc& image = graph_.image(id);
    if (image.samples != 1 || contents->width != image.width || contents->height != image.height ||
        info(image.format).bytes > 4 || info(image.format).is_depth)
      tell("G009", "image " + text(image) + " is given contents of " + std::to_string(contents->width) + "x" +
                       std::to_string(contents->height) + " texels of 32 bits");
    mark_written(id);
  }

  void check_views(const Pass& pass) {
    for (std::size_t slot = 0; slot < pass.sampled.size(); ++slot)
      if (const Format view = pass.view_of(graph_, slot);
          !same_bits(view, graph_.image(pass.sampled[slot]).format))
        tell("G003", "pass `" + pass.name + "` reads image " + text(graph_.image(pass.sampled[slot])) +
                         " as " + std::string(info(view).name));
  }

  void check_pass(const Pass& pass) {
    check_slots(pass);
    for (const ImageId id : pass.sampled) check_read(pass, id);
    check_views(pass);
    if (pass.source) check_read(pass, pass.source);
    switch (pass.kind) {
      case PassKind::draw:
      case PassKind::full_screen:
        check_attachments(pass);
        break;
      case PassKind::compute:
        check_compute(pass);
        break;
      case PassKind::clear:
        for (const ImageId id : pass.targets) mark_written(id);
        break;
      case PassKind::copy:
      case PassKind::resolve:
        check_transfer(pass);
        break;
    }
  }

  void check_slots(const Pass& pass) {
    if (pass.sampled.size() > kMaxImageSlots || pass.storage.size() > kMaxBufferSlots)
      tell("G007", "pass `" + pass.name + "` binds " + std::to_string(pass.sampled.size()) + " images and " +
                       std::to_string(pass.storage.size()) + " buffers, at most " +
                       std::to_string(kMaxImageSlots) + " and " + std::to_string(kMaxBufferSlots) +
                       " are supported");
    const int s = pass.samples;
    if (s < 1 || s > kMaxSamples || (s & (s - 1)) != 0)
      tell("G002", "pass `" + pass.name + "` rasterizes " + std::to_string(s) +
                       " samples, must be 1, 2, 4, 8, 16 or 32");
    else if (s > features_.native_msaa_max && pass.depth == ImageId{} && pass.color.empty())
      tell("G006",
           "pass `" + pass.name + "` rasterizes " + std::to_string(s) + " samples, this GPU has " +
               std::to_string(features_.native_msaa_max) + " (gpu.features.native_msaa_max)",
           "gpu.features.native_msaa_max = " + std::to_string(s) + " makes them native");
  }

  void check_read(const Pass& pass, ImageId id) {
    if (written_[static_cast<std::size_t>(id.index)] == 0)
      tell("G005",
           "pass `" + pass.name + "` reads image " + text(graph_.image(id)) + " before any pass wrote it",
           "clear it, or order the passes by what they read");
    if (graph_.image(id).coverage_samples != 0 && pass.kind != PassKind::resolve && !shows_samples(pass, id))
      tell("G009",
           "pass `" + pass.name + "` reads image " + text(graph_.image(id)) + ", which has a coverage map",
           "only a resolve reads the map");
    const bool attached = std::find(pass.color.begin(), pass.color.end(), id) != pass.color.end() ||
                          (pass.depth == id && !pass.depth_read_only);
    if (attached)
      tell("G004",
           "pass `" + pass.name + "` reads image " + text(graph_.image(id)) + " while it draws into it",
           "a feedback loop is undefined: copy the image first, or bind depth read-only");
  }

  void mark_written(ImageId id) { written_[static_cast<std::size_t>(id.index)] = 1; }

  void check_viewports(const Pass& pass) {
    if (pass.viewports.empty()) return;
    if (!features_.viewport_multicast)
      tell("G006", "pass `" + pass.name + "` sends primitives to several viewports, which this GPU cannot",
           "gpu.features.viewport_multicast = true");
    const bool far = std::any_of(pass.viewports.begin(), pass.viewports.end(), [](ViewportShift shift) {
      return std::max(std::abs(shift.x), std::abs(shift.y)) > kSubpixelUnits;
    });
    if (!pass.targets.empty() || pass.compute != nullptr || pass.viewports.size() > kMaxViewports || far)
      tell("G011",
           "pass `" + pass.name + "` has " + std::to_string(pass.viewports.size()) +
               " viewports: draws may have up to 16, shifted by up to one pixel, and store to no image",
           "draw the layers in passes of their own");
  }

  // Layer l of every attachment is written under viewport l.
  void check_layers(const Pass& pass, const ImageDesc& image) {
    const int layers = pass.viewports.empty() ? 1 : static_cast<int>(pass.viewports.size());
    if (image.layers != layers)
      tell("G011", "pass `" + pass.name + "` draws " + std::to_string(layers) + " layers into image " +
                       text(image) + " of " + std::to_string(image.layers));
  }

  void check_attachments(const Pass& pass) {
    check_viewports(pass);
    if (pass.color.size() > kMaxColorTargets)
      tell("G007", "pass `" + pass.name + "` has " + std::to_string(pass.color.size()) +
                       " color attachments, at most " + std::to_string(kMaxColorTargets) + " are supported");
    for (const ImageId id : pass.color) {
      const ImageDesc& image = graph_.image(id);
      check_size(pass, image);
      if (info(image.format).is_depth)
        tell("G003",
             "pass `" + pass.name + "` writes color to image " + text(image) + ", which has a depth format");
      if (image.samples != pass.samples) check_mixed_samples(pass, image);
      mark_written(id);
    }
    if (pass.depth) check_depth(pass);
    add(check_coverage_pass(graph_, pass));
    check_stores(pass);
    if (pass.kind == PassKind::full_screen) {
      if (pass.fragment == nullptr)
        tell("G007", "full-screen pass `" + pass.name + "` has no fragment program");
      check_program(pass, pass.fragment, pass.state, 0);
    }
    for (const DrawBatch& batch : pass.batches) check_batch(pass, batch);
  }

  // Fewer color than raster samples: each color sample stands for a block of raster samples.
  void check_mixed_samples(const Pass& pass, const ImageDesc& image) {
    const std::string message = "pass `" + pass.name + "` rasterizes " + std::to_string(pass.samples) +
                                " samples into image " + text(image);
    if (image.samples > pass.samples || pass.samples % image.samples != 0)
      tell("G002", message, "give the color image as many samples as the pass rasterizes, or a divisor");
    else if (!features_.target_independent_raster)
      tell("G006", message + ", which this GPU cannot", "gpu.features.target_independent_raster = true");
  }

  void check_stores(const Pass& pass) {
    if (!pass.targets.empty() && pass.kind == PassKind::draw)
      tell("G007",
           "pass `" + pass.name + "` stores to images, which only full-screen and compute passes can");
    for (std::size_t slot = 0; slot < pass.targets.size(); ++slot) {
      const ImageDesc& image = graph_.image(pass.targets[slot]);
      if (image.samples != 1 || info(image.format).bytes > 4 || info(image.format).is_depth ||
          !same_bits(pass.target_view_of(graph_, slot), image.format))
        tell("G003", "pass `" + pass.name + "` stores to image " + text(image) + " as " +
                         std::string(info(pass.target_view_of(graph_, slot)).name));
      if (std::find(pass.sampled.begin(), pass.sampled.end(), pass.targets[slot]) != pass.sampled.end())
        tell("G004", "pass `" + pass.name + "` reads image " + text(image) + " while it stores to it");
      mark_written(pass.targets[slot]);
    }
    const bool gives = pass.fragment != nullptr && pass.fragment->writes_depth && !pass.state.force_early_z;
    if (pass.kind == PassKind::full_screen && pass.state.depth.write && (!gives || pass.samples != 1))
      tell("G007", "full-screen pass `" + pass.name +
                       "` writes depth, which its program must give, at one sample and without early tests");
  }

  void check_size(const Pass& pass, const ImageDesc& image) {
    check_layers(pass, image);
    if (image.width != pass.width || image.height != pass.height)
      tell("G001", "pass `" + pass.name + "` of " + std::to_string(pass.width) + "x" +
                       std::to_string(pass.height) + " pixels has attachment " + text(image));
  }

  void check_depth(const Pass& pass) {
    const ImageDesc& image = graph_.image(pass.depth);
    check_size(pass, image);
    if (!info(image.format).is_depth)
      tell("G003",
           "pass `" + pass.name + "` uses image " + text(image) + " as depth, which has a color format");
    if (image.samples != pass.samples)
      tell("G002", "pass `" + pass.name + "` rasterizes " + std::to_string(pass.samples) +
                       " samples, its depth image " + text(image) + " differs");
    if (pass.depth_read_only && written_[static_cast<std::size_t>(pass.depth.index)] == 0)
      tell("G005",
           "pass `" + pass.name + "` tests against depth image " + text(image) + " before any pass wrote it");
    const auto writes = [](const PipelineState& s) { return s.depth.write; };
    const bool any_write =
        writes(pass.state) || std::any_of(pass.batches.begin(), pass.batches.end(),
                                          [&](const DrawBatch& b) { return writes(b.state); });
    if (pass.depth_read_only && any_write)
      tell("G004",
           "pass `" + pass.name + "` writes depth image " + text(image) + ", which it binds read-only");
    if (!pass.depth_read_only) mark_written(pass.depth);
  }

  void check_batch(const Pass& pass, const DrawBatch& batch) {
    if (batch.vertex == nullptr) {
      tell("G007", "pass `" + pass.name + "` draws without a vertex program");
      return;
    }
    check_state(pass, batch.state);
    if (batch.geometry != nullptr) check_geometry(pass, batch);
    if (batch.fragment == nullptr) {
      if (!pass.color.empty())
        tell("G007", "pass `" + pass.name + "` has color attachments, but draws without a fragment program");
      return;
    }
    check_program(pass, batch.fragment, batch.state, batch.raster_scalars());
  }

  void check_geometry(const Pass& pass, const DrawBatch& batch) {
    const GeometryProgram& program = *batch.geometry;
    const std::string what = "pass `" + pass.name + "`: geometry program `" + program.name + "` ";
    if (batch.state.raster.topology != Topology::triangles)
      tell("G007", what + "takes triangles, the draw has points or lines");
    if (program.input_scalars != batch.vertex->varying_scalars)
      tell("G007", what + "reads " + std::to_string(program.input_scalars) +
                       " varyings, the vertex program writes " +
                       std::to_string(batch.vertex->varying_scalars));
    if (batch.tessellated_points) {
      if (program.output != GeometryOutput::points || !features_.tessellator_points)
        tell("G006", what + "emits points from the tessellator, which this GPU cannot",
             "gpu.features.tessellator_points = true");
      return;
    }
    const int scalars = program.max_vertices * (4 + program.varying_scalars);
    if (scalars > functional_.gs_max_scalars)
      tell("G012",
           what + "emits up to " + std::to_string(program.max_vertices) + " vertices of " +
               std::to_string(4 + program.varying_scalars) + " scalars, this GPU takes " +
               std::to_string(functional_.gs_max_scalars) + " scalars",
           "emit fewer vertices, or gpu.functional.gs_max_scalars = " + std::to_string(scalars));
  }

  void check_state(const Pass& pass, const PipelineState& state) {
    if (!state.raster.sample_positions.empty() && !features_.programmable_sample_positions)
      tell("G006", "pass `" + pass.name + "` sets sample positions, which this GPU cannot",
           "gpu.features.programmable_sample_positions = true");
    const std::size_t positions = state.raster.sample_positions.size();
    if (positions != 0 && positions != static_cast<std::size_t>(pass.samples))
      tell("G002", "pass `" + pass.name + "` sets " + std::to_string(positions) + " sample positions for " +
                       std::to_string(pass.samples) + " samples");
    if (positions > kMaxProgrammablePositions ||
        std::any_of(state.raster.sample_positions.begin(), state.raster.sample_positions.end(),
                    [](SamplePosition p) { return std::max(p.x, p.y) > 7 || std::min(p.x, p.y) < -8; }))
      tell("G002", "pass `" + pass.name + "` sets sample positions that no GPU can",
           "at most 16, each -8 to 7 sixteenths of a pixel from the center");
    if (state.raster.conservative && !features_.conservative_raster)
      tell("G006", "pass `" + pass.name + "` rasterizes conservatively, which this GPU cannot",
           "gpu.features.conservative_raster = true");
    check_coverage(pass, state);
    const bool needs_depth = state.depth.test || state.depth.write || state.stencil.test;
    if (needs_depth && !pass.depth)
      tell("G007", "pass `" + pass.name + "` tests or writes depth or stencil without a depth attachment");
    if (state.stencil.test && pass.depth && !info(graph_.image(pass.depth).format).has_stencil)
      tell("G003", "pass `" + pass.name + "` tests stencil in image " + text(graph_.image(pass.depth)) +
                       ", which has none");
    for (std::size_t i = 0; i < state.blend.size() && i < pass.color.size(); ++i) {
      const ImageDesc& image = graph_.image(pass.color[i]);
      if (state.blend[i].enabled && info(image.format).is_integer)
        tell("G003", "pass `" + pass.name + "` blends into integer image " + text(image));
    }
  }

  void check_coverage(const Pass& pass, const PipelineState& state) {
    const CoverageState& coverage = state.coverage;
    if (coverage.post_depth && !features_.post_depth_coverage)
      tell("G006", "pass `" + pass.name + "` reads the coverage after depth tests, which this GPU cannot",
           "gpu.features.post_depth_coverage = true");
    if (coverage.post_depth && (!state.force_early_z || !pass.depth))
      tell("G010", "pass `" + pass.name + "` reads the coverage after depth tests that are not early",
           "bind a depth image and force early tests");
    if (coverage.override_output && !features_.coverage_override)
      tell("G006", "pass `" + pass.name + "` replaces coverage by a shader's mask, which this GPU cannot",
           "gpu.features.coverage_override = true");
    if (coverage.override_output && (state.raster.sample_rate || coverage.alpha_to_coverage))
      tell("G010",
           "pass `" + pass.name + "` replaces coverage by a shader's mask, and runs the shader for each " +
               "sample or takes coverage from alpha",
           "a mask that replaces the coverage is one a pixel");
  }

  void check_outputs(const Pass& pass, const FragmentProgram& program, const CoverageState& coverage) {
    if (coverage.override_output && !program.writes_mask)
      tell("G010", "pass `" + pass.name + "`: fragment program `" + program.name +
                       "` has no mask to replace coverage");
    if (coverage.alpha_to_coverage && program.color_outputs < 1)
      tell("G010", "pass `" + pass.name + "`: fragment program `" + program.name +
                       "` has no alpha to take coverage from");
  }

  void check_program(const Pass& pass, const FragmentProgram* program, const PipelineState& state,
                     int varyings) {
    if (program == nullptr) return;
    if (pass.kind == PassKind::full_screen) check_state(pass, state);
    check_outputs(pass, *program, state.coverage);
    if (program->varying_scalars != varyings)
      tell("G007", "pass `" + pass.name + "`: fragment program `" + program->name + "` reads " +
                       std::to_string(program->varying_scalars) + " varyings, the vertex program writes " +
                       std::to_string(varyings));
    if (static_cast<std::size_t>(program->color_outputs) < pass.color.size())
      tell("G007", "pass `" + pass.name + "`: fragment program `" + program->name + "` writes " +
                       std::to_string(program->color_outputs) + " colors for " +
                       std::to_string(pass.color.size()) + " attachments");
  }

  void check_compute(const Pass& pass) {
    if (pass.compute == nullptr) tell("G007", "compute pass `" + pass.name + "` has no program");
    // Only sums of floats depend on the order of groups, nothing else that a program can store.
    if (pass.compute != nullptr && pass.compute->ordered_storage && !features_.float_atomics)
      tell("G006", "compute pass `" + pass.name + "` adds floats by atomics, which this GPU cannot",
           "gpu.features.float_atomics = true");
    if (pass.depth_planes && !pass.depth_planes_given && !features_.compressed_depth_read)
      tell("G006", "compute pass `" + pass.name + "` reads compressed depth, which this GPU cannot",
           "gpu.features.compressed_depth_read = true");
    if (pass.depth_planes &&
        (!info(graph_.image(pass.depth_planes).format).is_depth ||
         std::find(pass.sampled.begin(), pass.sampled.end(), pass.depth_planes) == pass.sampled.end()))
      tell("G009", "compute pass `" + pass.name + "` reads the planes of image " +
                       text(graph_.image(pass.depth_planes)) + ", which is no depth image that it samples");
    if (pass.groups_x < 1 || pass.groups_y < 1)
      tell("G001", "compute pass `" + pass.name + "` has no groups");
    if (pass.targets.size() > kMaxColorTargets)
      tell("G007", "compute pass `" + pass.name + "` stores to " + std::to_string(pass.targets.size()) +
                       " images, at most " + std::to_string(kMaxColorTargets) + " are supported");
    for (const ImageId id : pass.targets)
      mark_written(id);  // multisampled ones stand for flat buffers of samples
  }

  void check_transfer(const Pass& pass) {
    if (!pass.source || pass.targets.size() != 1) {
      tell("G009", "pass `" + pass.name + "` needs one source and one target");
      return;
    }
    const ImageDesc& from = graph_.image(pass.source);
    const ImageDesc& to = graph_.image(pass.targets.front());
    if (from.width != to.width || from.height != to.height)
      tell("G001",
           "pass `" + pass.name + "` from image " + text(from) + " to image " + text(to) + ": sizes differ");
    if (from.layers != to.layers || (pass.kind == PassKind::resolve && from.layers > 1))
      tell("G009",
           "pass `" + pass.name + "` transfers image " + text(from) + " of " + std::to_string(from.layers) +
               " layers to image " + text(to) + " of " + std::to_string(to.layers),
           "a resolve does not mix layers: merge them in a shader");
    if (pass.kind == PassKind::resolve) {
      if (from.samples < 2 || to.samples != 1)
        tell("G009", "pass `" + pass.name + "` resolves image " + text(from) + " to image " + text(to) +
                         ": the source must be multisampled, the target not");
      if (info(from.format).is_depth && pass.resolve == ResolveMode::max && from.format != to.format)
        tell("G003", "pass `" + pass.name + "` resolves depth image " + text(from) + " to image " + text(to) +
                         ", whose format differs");
      else if (info(from.format).is_integer ||
               (info(from.format).is_depth != (pass.resolve == ResolveMode::max)))
        tell("G003",
             "pass `" + pass.name + "` resolves image " + text(from) + ", whose values cannot be averaged");
    } else if (from.samples != to.samples || !same_bits(from.format, to.format)) {
      tell("G009", "pass `" + pass.name + "` copies image " + text(from) + " to image " + text(to) +
                       ": formats and sample counts must be equal");
    }
    mark_written(pass.targets.front());
  }

  void check_output() {
    if (!graph_.output()) {
      tell("G008", "the frame has no output image");
      return;
    }
    const ImageDesc& image = graph_.image(graph_.output());
    if (image.samples != 1 || image.layers != 1)
      tell("G008", "output image " + text(image) + " is multisampled or has layers", "resolve it first");
    if (!same_bits(graph_.output_view(), image.format))
      tell("G003",
           "output image " + text(image) + " is shown as " + std::string(info(graph_.output_view()).name));
    if (info(image.format).is_depth) tell("G008", "output image " + text(image) + " has a depth format");
    if (written_[static_cast<std::size_t>(graph_.output().index)] == 0)
      tell("G005", "no pass writes the output image " + text(image));
  }

  const FrameGraph& graph_;
  const GpuFeatures& features_;
  const FunctionalConfig& functional_;
  std::vector<char> written_;
  std::vector<int> refused_samples_;  ///< sample counts of images that were reported
  std::vector<Diagnostic> errors_;
};

}  // namespace

std::vector<Diagnostic> validate(const FrameGraph& graph, const GpuFeatures& features,
                                 const FunctionalConfig& functional) {
  return Validator(graph, features, functional).run();
}

}  // namespace hwsim::pipeline
