// MLAA on a GPU: edges, lengths of their runs, blending (techniques 7.5).
#include "algos/filters/shaders/mlaa.h"
#include "algos/base/frame_parts.h"
#include "algos/filters/post_filters.h"

namespace hwsim::algos {
using namespace pipeline;

ImageId add_mlaa(FrameGraph& graph, ImageId input, const Parameters& parameters) {
  MlaaUniforms u;
  u.threshold = static_cast<float>(parameters.find("threshold")->second);
  u.wide_counts = parameters.find("count_bits")->second != 0;
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

}  // namespace hwsim::algos
