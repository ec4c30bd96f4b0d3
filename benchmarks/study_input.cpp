#include "study_input.h"

#include <cstdio>
#include <sstream>

#include "hwsim/gpu/gpu_keys.h"
#include "lab/catalog/config_folder.h"
#include "lab/environment.h"
#include "lab/store/scene_view.h"

namespace hwsim::benchmarks {

std::vector<std::string> split_list(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream in(list);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

lab::Cache study_cache() {
  const lab::LabOptions options = lab::options_of_environment();
  return lab::Cache(options.cache_folder, options.cache_limit_bytes);
}

algos::FrameRequest open_study(const lab::View& view) {
  const lab::Cache cache = study_cache();
  lab::Observer silent;
  return lab::SceneView(view, cache, silent).frame_request();
}

pipeline::FrameGraph study_frame(algos::FrameRequest request, const std::string& technique,
                                 const GpuConfig& gpu) {
  request.features = gpu.features;
  request.functional = gpu.functional;
  return algos::build_frame(algos::parse_technique(technique), request);
}

GpuConfig study_gpu(const std::string& id, const std::vector<std::string>& overlays) {
  const lab::ConfigFolder folder(lab::options_of_environment().config_folder);
  std::vector<std::string> files;
  for (const std::string& name : overlays) files.push_back(folder.overlay_file(name));
  return load_gpu(id, files, {}, folder.gpus());
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
