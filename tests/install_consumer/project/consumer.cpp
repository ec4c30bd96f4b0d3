// What the README shows to users of the library: a scene, a technique, a GPU, a time.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "algos/techniques.h"
#include "hwsim/engines/timing.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/open/scene_source.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string cache = (std::filesystem::temp_directory_path() / "hwsim-consumer").string();
  hwsim::algos::FrameRequest request;
  request.scene =
      std::make_shared<const hwsim::pipeline::Scene>(hwsim::pipeline::open_scene("grass:blades=100", cache));
  request.width_px = 64;
  request.height_px = 48;
  const hwsim::GpuConfig gpu = hwsim::load_gpu("gtx980", {}, {}, argv[1]);
  request.features = gpu.features;
  request.functional = gpu.functional;
  const auto choice = hwsim::algos::parse_technique("msaa4x");
  const auto graph = hwsim::algos::build_frame(choice, request);
  const auto frame = hwsim::pipeline::emulate(graph, gpu.features, gpu.functional, {});
  const auto timing = hwsim::time_frame(frame.trace, gpu, hwsim::Engine::queue);
  std::printf("%s: %.3f ms on %s\n", hwsim::algos::technique_text(choice).c_str(), timing.time_ns / 1e6,
              gpu.title.c_str());
  return timing.time_ns > 0.0 ? 0 : 1;
}
