// CMAA 1.3: locally dominant edges, simple shapes and long Z shapes (docs/techniques/filters.md#cmaa). Works
// in place.
#include "algos/filters/shaders/cmaa.h"
#include "algos/base/frame_parts.h"
#include "algos/filters/filters.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

struct CmaaOptions {
  double threshold = 1.0 / 13.0;
  bool average_quirk = true;
};

void describe(OptionList& list, CmaaOptions& o) {
  list.real("threshold", o.threshold, {0.04, 0.125}, "color difference that makes an edge, weighted by luma");
  list.choice("cmaa_avg_quirk", o.average_quirk, "off|on",
              "pruning takes the mean of four neighbors, as the public source does");
}

/// A pass over quads of the image: as many invocations as quads.
Pass& add_quads(FrameGraph& graph, const char* name, ImageId mask, const FragmentProgram& program,
                std::shared_ptr<const CmaaUniforms> uniforms) {
  Pass& pass = graph.add_pass(name, PassKind::full_screen);
  pass.width = graph.image(mask).width;
  pass.height = graph.image(mask).height;
  pass.fragment = &program;
  pass.uniforms = std::move(uniforms);
  pass.depth = mask;
  // Depth 0 is less than the 1 of quads that are still of interest. A program that gives its depth is tested
  // by it, so it runs everywhere.
  pass.state.depth = {true, program.writes_depth, Compare::less};
  pass.state.force_early_z = !program.writes_depth;
  pass.depth_read_only = !program.writes_depth;
  return pass;
}

ImageId add_cmaa(FrameGraph& graph, ImageId input, const CmaaOptions& options) {
  CmaaUniforms u;
  u.threshold = static_cast<float>(options.threshold);
  u.average_quirk = options.average_quirk;
  const auto uniforms = std::make_shared<const CmaaUniforms>(u);
  const int width = graph.width(), height = graph.height();
  const int quads_x = (width + 1) / 2, quads_y = (height + 1) / 2;
  const ImageId strengths = graph.add_image({"cmaa_strengths", Format::rgba8_uint, quads_x, quads_y, 1});
  const ImageId mask = graph.add_image({"cmaa_mask", Format::d16_unorm, quads_x, quads_y, 1});
  const ImageId dominant = graph.add_image({"cmaa_dominant", Format::r8_uint, width, height, 1});
  const ImageId edges = graph.add_image({"cmaa_edges", Format::r8_uint, width, height, 1});
  const ImageId work = graph.add_image({"cmaa_work", Format::rgba8_unorm, width, height, 1});
  // The public program keeps both edge images from frame to frame and changes their roles: what combining
  // left of the last frame has no mark. Here each frame is the first one.
  graph.add_clear("cmaa_first_frame", {dominant});

  Pass& find = add_quads(graph, "cmaa_edges", mask, cmaa_edge_program(), uniforms);
  find.state.depth.compare = Compare::always;
  find.color = {strengths};
  find.sampled = {input};
  find.views = {Format::rgba8_unorm};
  find.targets = {work};
  Pass& prune = add_quads(graph, "cmaa_prune", mask, cmaa_prune_program(), uniforms);
  prune.sampled = {strengths};
  prune.targets = {dominant};
  Pass& combine = add_quads(graph, "cmaa_combine", mask, cmaa_combine_program(), uniforms);
  combine.sampled = {dominant};
  combine.targets = {edges};
  Pass& blend = add_quads(graph, "cmaa_blend", mask, cmaa_blend_program(), uniforms);
  blend.sampled = {edges, work};
  blend.targets = {input, input};  // lines over simple shapes
  blend.target_views = {Format::rgba8_unorm, Format::rgba8_unorm};
  return input;
}

}  // namespace

TechniqueInfo cmaa_filter() {
  return filter_technique("cmaa", "CMAA: locally dominant edges, corners and long steps, in place", add_cmaa);
}

}  // namespace hwsim::algos
