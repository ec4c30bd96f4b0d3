#include "study_input.h"

#include <cstdio>
#include <sstream>

#include "algos/techniques.h"
#include "pipeline/open/scene_source.h"

namespace hwsim::benchmarks {

std::vector<std::string> split_list(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream in(list);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

ScenePointer open_study_scene(const std::string& name) {
  return std::make_shared<const pipeline::Scene>(
      pipeline::open_scene(name, pipeline::default_cache_directory() + "/scenes"));
}

pipeline::FrameGraph study_frame(const ScenePointer& scene, const std::string& technique,
                                 const GpuConfig& gpu, int width_px, int height_px) {
  algos::FrameRequest request;
  request.scene = scene;
  request.width_px = width_px;
  request.height_px = height_px;
  request.features = gpu.features;
  request.functional = gpu.functional;
  return algos::build_frame(algos::parse_technique(technique), request);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

int report(const InputError& error) {
  for (const Diagnostic& d : error.diagnostics())
    std::fprintf(stderr, "%s: %s\n", d.code.c_str(), d.message.c_str());
  return 3;
}

}  // namespace hwsim::benchmarks
