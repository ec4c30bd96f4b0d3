#include "algos/skeleton/skeleton.h"

#include "algos/base/frame_parts.h"
#include "algos/skeleton/options.h"
#include "algos/skeleton/shaders/programs.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

/// Adds images and passes to a graph, and runs nothing. Which passes are needed, their order, lifetimes and
/// memory follow from what they read and write.
FrameGraph build(const FrameRequest& request, const SkeletonOptions& options) {
  FrameGraph graph(request.scene, request.width_px, request.height_px);
  // Camera, lights, draws by kind, and the shadow map, whose passes are added here.
  const FrameParts parts = prepare_frame(graph, request);
  // Everything drawn into a multisampled target: opaque, alpha-tested, what modifiers draw, blended.
  ForwardTarget target =
      make_forward_target(graph, "multisampled", graph.width(), graph.height(), options.samples);
  target.centroid = options.centroid;
  add_forward(graph, parts, "", target);
  // The technique's own pass.
  SkeletonUniforms uniforms;
  uniforms.samples = options.samples;
  uniforms.tolerance = static_cast<float>(options.tolerance);
  add_full_screen(graph, "resolve", {target.color}, add_output(graph), skeleton_resolve_program(),
                  std::make_shared<SkeletonUniforms>(uniforms));
  return graph;
}

/// Codes begin with T1; `hwsim help CODE` prints the explanation.
constexpr MessageCode kMixed = {"T199", "pixels hold several colors",
                                "The resolve averaged them. Nothing is wrong: this is the skeleton's note."};

/// What a user should know of a frame, from its options and its counts.
std::vector<Diagnostic> notes(const SkeletonOptions& options, const DrawnFrame& frame) {
  const std::uint64_t mixed = total(frame.trace).technique[SkeletonCounters::skeleton_mixed_pixels];
  if (mixed == 0) return {};
  Diagnostic note;
  note.severity = Severity::note;
  note.code = kMixed.code;
  note.message = std::to_string(mixed) + " pixels hold several colors in " + std::to_string(options.samples) +
                 " samples";
  note.help = "tolerance=1 leaves them alone";
  return {note};
}

/// Laws hold in every pass of every frame; each run checks them.
constexpr CounterLaw kLaws[] = {HWSIM_LAW_AT_MOST("technique.skeleton_mixed_pixels <= ps.invocations",
                                                  c.technique[SkeletonCounters::skeleton_mixed_pixels],
                                                  c.ps.invocations)};

}  // namespace

void describe(OptionList& list, SkeletonOptions& o) {
  list.choice("samples", o.samples, "2|4|8", std::array{2, 4, 8}, "samples a pixel");
  list.real("tolerance", o.tolerance, {0, 1}, "colors further apart are averaged");
  describe_centroid(list, o.centroid);  // an option that many techniques share
}

Room skeleton_room() {
  static constexpr MessageCode kCodes[] = {kMixed};
  return {.techniques = {with_notes(
              base_technique("skeleton", "multisampling, resolved where colors differ", build), notes)},
          .counters = SkeletonCounters::kDeclared,
          .laws = kLaws,
          .codes = kCodes};
}

}  // namespace hwsim::algos
