#pragma once
// A technique builds a frame graph and owns its shaders; it runs nothing.
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/gpu/gpu_features.h"
#include "pipeline/graph/frame_graph.h"

namespace hwsim::algos {

enum class DeferredLighting { stencil, compute_tiles };

/// Which lights a frame has: the scene's and those that the request adds; one, directional if there is one;
/// or 16, seeded point lights where the scene has fewer (the two profiles of SBAA, section 5.2).
enum class LightProfile : std::uint8_t { scene, simple, complex };
inline constexpr int kComplexLights = 16;
enum class WireDepth { split, none, all };  ///< which wires write depth: wide ones, none, all

/// Wire anti-aliasing (techniques 6), asked for by the modifier wire_aa.
struct WireOptions {
  float width_px = 1.0f;       ///< least width
  float full_light_px = 4.0f;  ///< from this width on a wire is lit as any surface
  bool half_lambert = false, flatten = false;
  int half_lambert_power = 2;
  bool fade_per_pixel = false;
  WireDepth depth = WireDepth::split;
};

/// What every technique is given.
struct FrameRequest {
  std::shared_ptr<const pipeline::Scene> scene;
  int width_px = 1280, height_px = 720;
  int camera = 0;             ///< index into Scene::cameras
  int point_lights = 0;       ///< 0..1024 seeded point lights added to those of the scene
  double light_range = 0.15;  ///< of the lights added: over the scene's diagonal
  LightProfile lights = LightProfile::scene;
  bool shadows = true;  ///< a shadow map for the scene's shadow caster
  int shadow_map_px = 2048;
  std::optional<WireOptions> wires;
  /// Stands for the scene, which is empty then: sRGB codes of a finished frame. Only filters work on it.
  std::shared_ptr<const pipeline::RawImage> image;
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

enum class TechniqueKind { base, modifier, filter };

/// One entry of the registry. Which function it has makes its kind: a base builds the frame, a modifier
/// changes what bases are asked for (before them), a filter appends passes that take the frame's image (after
/// them).
struct TechniqueInfo {
  std::string_view id;  ///< "msaa4x"
  std::string_view description;
  std::span<const ParameterInfo> parameters;
  pipeline::FrameGraph (*build)(const FrameRequest& request, const Parameters& parameters) = nullptr;
  void (*modify)(FrameRequest& request, const Parameters& parameters) = nullptr;
  /// Returns the filtered image; both hold sRGB codes, one sample a pixel (post_filters.h).
  pipeline::ImageId (*filter)(pipeline::FrameGraph& graph, pipeline::ImageId input,
                              const Parameters& parameters) = nullptr;
  /// Why it cannot go with another technique; empty: it can.
  std::string_view (*refuses)(const TechniqueInfo& other) = nullptr;

  TechniqueKind kind() const {
    return build != nullptr    ? TechniqueKind::base
           : modify != nullptr ? TechniqueKind::modifier
                               : TechniqueKind::filter;
  }
};

}  // namespace hwsim::algos
