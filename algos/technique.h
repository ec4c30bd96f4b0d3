#pragma once
// A technique builds a frame graph and owns its shaders; it runs nothing.
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/config/gpu_features.h"
#include "pipeline/graph/frame_graph.h"

namespace hwsim::algos {

enum class DeferredLighting { stencil, compute_tiles };

/// What every technique is given.
struct FrameRequest {
  std::shared_ptr<const pipeline::Scene> scene;
  int width_px = 1280, height_px = 720;
  int camera = 0;        ///< index into Scene::cameras
  int point_lights = 0;  ///< 0..1024 seeded point lights added to those of the scene
  bool shadows = true;   ///< a shadow map for the scene's shadow caster
  int shadow_map_px = 2048;
  GpuFeatures features;
  FunctionalConfig functional;
};

/// A parameter of a technique, all numeric or one of named choices.
struct ParameterInfo {
  std::string_view name;
  double default_value = 0.0, min = 0.0, max = 0.0;
  std::string_view description;
  std::string_view choices = "";  ///< "stencil|compute": the value is the index; empty for numbers
};
using Parameters = std::map<std::string, double, std::less<>>;

struct TechniqueInfo {
  std::string_view id;  ///< "msaa4x"
  std::string_view description;
  std::span<const ParameterInfo> parameters;
  pipeline::FrameGraph (*build)(const FrameRequest& request, const Parameters& parameters) = nullptr;
};

/// The explicit registry: the only shared source that a new technique touches.
std::span<const TechniqueInfo> techniques();

struct TechniqueChoice {
  const TechniqueInfo* info = nullptr;
  Parameters parameters;  ///< complete: defaults filled in
};

/// "agaa:c=2,msaa=8". Throws InputError (T0xx) for unknown names (with the nearest), unknown keys and values
/// out of range.
TechniqueChoice parse_technique(std::string_view text);

}  // namespace hwsim::algos
