// MLAA on a GPU: edges, lengths of their runs, blending (docs/techniques/filters.md#mlaa).
#include "algos/filters/shaders/mlaa.h"
#include "algos/base/frame_parts.h"
#include "algos/filters/filters.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

struct MlaaOptions {
  double threshold = 0.03125;
  int count_bits = 8;
};

void describe(OptionList& list, MlaaOptions& o) {
  list.real("threshold", o.threshold, {0.01, 0.5}, "contrast of luma that makes an edge");
  list.choice("count_bits", o.count_bits, "4|8", std::array{4, 8},
              "bits of a run's length with its stop bit: cut at 7 pixels, or at 127");
}

ImageId add_mlaa(FrameGraph& graph, ImageId input, const MlaaOptions& options) {
  MlaaUniforms u;
  u.threshold = static_cast<float>(options.threshold);
  u.wide_counts = options.count_bits == 8;
  const auto uniforms = std::make_shared<MlaaUniforms>(u);
  const auto image = [&](const char* name, Format format) {
    return graph.add_image({name, format, graph.width(), graph.height(), 1});
  };
  const ImageId edges = image("mlaa_edges", Format::r8_uint);
  const ImageId counts = image("mlaa_counts", u.wide_counts ? Format::rg16_uint : Format::rg8_uint);
  const ImageId output = image("mlaa_output", Format::rgba8_unorm);
  add_full_screen(graph, "mlaa_edges", {input}, edges, mlaa_edge_program(), uniforms).views = {
      Format::rgba8_unorm};
  add_full_screen(graph, "mlaa_counts", {edges}, counts, mlaa_count_program(), uniforms);
  add_full_screen(graph, "mlaa_blend", {input, edges, counts}, output, mlaa_blend_program(), uniforms)
      .views = {Format::rgba8_unorm};
  return output;
}

}  // namespace

TechniqueInfo mlaa_filter() {
  return filter_technique("mlaa", "MLAA: runs of edges, re-vectorized by the colors at their ends", add_mlaa);
}

}  // namespace hwsim::algos
