#pragma once
// Runs techniques on scenes, and compares what two runs give: the image's bytes and every counter of the
// trace.
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "algos/techniques.h"
#include "hwsim/gpu/every_feature.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/open/scene_source.h"
#include "support/places.h"

namespace hwsim::test {

/// Every technique, and those of their variants that take other paths.
inline std::vector<std::string> technique_variants() {
  std::vector<std::string> all;
  for (const algos::TechniqueInfo& t : algos::techniques()) all.emplace_back(t.id);
  for (const char* variant :
       {"ssaa4x:variant=accumulate", "ssaa4x:variant=sample_rate", "msaa4x:centroid=off",
        "deferred:samples=1", "deferred:samples=1,lighting=tiles,prepass=on",
        "deferred_simple_complex:lighting=compute",
        "deferred_simple_complex:samples=4,lighting=compute,resolve=tiles,layout=gb_mrt4", "agaa:msaa=32",
        "csaa:mode=16xq,orphans=drop", "none+fxaa:gather=off", "forward_plus:samples=4", "msaa4x:prepass=on",
        "sss_cs:atomics=integer,rest=frame", "sss_ppll:node_bytes=32",
        "agaa:c=4,ndf=sggx,brdf=ggx,accumulate=atomics"})
    all.emplace_back(variant);
  return all;
}

/// Scenes are generated once for a build folder.
inline std::shared_ptr<const pipeline::Scene> generated_scene(const std::string& spec) {
  static std::map<std::string, std::shared_ptr<const pipeline::Scene>> scenes;
  auto& scene = scenes[spec];
  if (!scene)
    scene = std::make_shared<const pipeline::Scene>(
        pipeline::open_scene(spec, hwsim::test::binary_dir() + "/test_scenes"));
  return scene;
}

/// Everything but native sample counts beyond 8: so techniques take the paths that need features.
inline GpuFeatures test_features() { return every_feature(8); }

struct FrameSetup {
  std::string technique, scene;
  int width_px = 320, height_px = 180;
  int camera = 0;
};

inline pipeline::FrameGraph build_graph(const FrameSetup& setup) {
  algos::FrameRequest request;
  request.scene = generated_scene(setup.scene);
  request.width_px = setup.width_px;
  request.height_px = setup.height_px;
  request.camera = setup.camera;
  request.shadow_map_px = 512;
  request.point_lights = 8;
  request.features = test_features();
  return algos::build_frame(algos::parse_technique(setup.technique), request);
}

inline pipeline::Emulation run_frame(const FrameSetup& setup, const pipeline::EmulationOptions& options) {
  return pipeline::emulate(build_graph(setup), test_features(), FunctionalConfig{}, options);
}

/// Empty, or the first thing that differs.
inline std::string difference(const pipeline::Image& a, const pipeline::Image& b, const std::string& what) {
  if (a.width != b.width || a.height != b.height) return what + ": sizes differ";
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      if (std::memcmp(&a.at(x, y), &b.at(x, y), sizeof(glm::vec4)) != 0)
        return what + ": pixel (" + std::to_string(x) + ", " + std::to_string(y) + "), red " +
               std::to_string(a.at(x, y).x) + " and " + std::to_string(b.at(x, y).x);
  return "";
}

inline std::string difference(const PassWork& a, const PassWork& b) {
  const bool described = a.name == b.name && a.kind == b.kind && a.width_px == b.width_px &&
                         a.height_px == b.height_px && a.barrier_before == b.barrier_before &&
                         a.reuse == b.reuse && a.chunks.size() == b.chunks.size();
  if (!described) return "pass " + a.name + ": descriptions differ";
  for (std::size_t chunk = 0; chunk < a.chunks.size(); ++chunk) {
    const auto left = values(a.chunks[chunk]), right = values(b.chunks[chunk]);
    for (std::size_t i = 0; i < left.size(); ++i)
      if (left[i] != right[i])
        return "pass " + a.name + ", chunk " + std::to_string(chunk) + ": " +
               std::string(counter_catalog()[i].id) + " " + std::to_string(left[i]) + " and " +
               std::to_string(right[i]);
  }
  return "";
}

inline std::string difference(const pipeline::Emulation& a, const pipeline::Emulation& b) {
  std::string found = difference(a.color, b.color, "image");
  if (found.empty()) found = difference(a.shading_heat, b.shading_heat, "shading heat");
  if (found.empty() && a.trace.passes.size() != b.trace.passes.size()) found = "numbers of passes differ";
  if (found.empty() && a.trace.peak_memory_bytes != b.trace.peak_memory_bytes) found = "memory differs";
  for (std::size_t i = 0; found.empty() && i < a.trace.passes.size(); ++i)
    found = difference(a.trace.passes[i], b.trace.passes[i]);
  return found;
}

}  // namespace hwsim::test
