// A scene, drawn small and timed. An input that is no GLB file is JSON up to the first NUL and a buffer
// behind it: a GLB file is made of both, so that lengths fit.
#include "algos/techniques.h"
#include "fuzz/gpu_work.h"
#include "hwsim/gpu/every_feature.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/gltf/gltf_loader.h"
#include "pipeline/scene_glb.h"

namespace {
using namespace hwsim;

std::vector<std::uint8_t> glb_of(fuzz::Bytes input) {
  if (fuzz::text_of(input).starts_with("glTF")) return {input.begin(), input.end()};
  const std::string text(fuzz::text_of(input).substr(0, fuzz::text_of(input).find('\0')));
  const fuzz::Bytes rest = input.subspan(std::min(input.size(), text.size() + 1));
  std::vector<std::uint8_t> buffer(rest.begin(), rest.end());
  while (buffer.size() % 4 != 0) buffer.push_back(0);
  return pipeline::test::assemble_glb(text, buffer);
}

void draw(const std::shared_ptr<const pipeline::Scene>& scene, const char* technique) {
  algos::FrameRequest request;
  request.scene = scene;
  request.width_px = 48;
  request.height_px = 32;
  request.shadow_map_px = 64;
  request.features = every_feature(8);
  const pipeline::FrameGraph graph = algos::build_frame(algos::parse_technique(technique), request);
  const pipeline::Emulation frame = pipeline::emulate(graph, request.features, FunctionalConfig{}, {});
  for (const glm::vec4& pixel : frame.color.pixels)
    for (int c = 0; c < 3; ++c) fuzz::require(std::isfinite(pixel[c]), "a pixel is a number");
  static const GpuConfig gpu = test::sample_gpu();
  fuzz::check_times(frame.trace, gpu, Engine::queue);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr pipeline::SceneLoadOptions kSmall{std::size_t{1} << 20, 2000, std::uint64_t{64} << 20, 0.0};
  fuzz::answer_or_refuse([&] {
    const auto scene = std::make_shared<const pipeline::Scene>(
        pipeline::load_glb(glb_of(fuzz::Bytes(data, size)), "input.glb", kSmall));
    for (const pipeline::Mesh& mesh : scene->meshes)
      for (const std::uint32_t index : mesh.indices)
        fuzz::require(index < mesh.positions.size(), "an index is in its range");
    draw(scene, size % 2 == 0 ? "msaa4x" : "deferred:samples=2");
  });
  return 0;
}
