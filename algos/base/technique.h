#pragma once
// What a technique is: a function that builds a frame graph, options, and what it declares of its own. It
// owns its shaders and runs nothing.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algos/base/options.h"
#include "algos/base/shaders/counters.h"
#include "hwsim/base/diagnostics.h"
#include "hwsim/gpu/gpu_features.h"
#include "hwsim/trace/work_trace.h"
#include "pipeline/graph/frame_graph.h"
#include "pipeline/scene/special_surfaces.h"

namespace hwsim::algos {

/// Which lights a frame has: the scene's and those that the request adds; one, directional if there is one;
/// 16, seeded point lights where the scene has fewer (the two profiles of SBAA, section 5.2); or those alone
/// that the request adds.
enum class LightProfile : std::uint8_t { scene, simple, complex, added };

/// Where lights that a request adds lie and how far they reach, in the scene's unit.
struct AddedLights {
  glm::dvec3 box_m{0.0};  ///< sides of the box around the scene's middle; 0: the scene's extent
  double range_from_m = 0.0, range_to_m = 0.0;  ///< ranges lie between; both 0: FrameRequest::light_range
  int seed = 0;                                 ///< another one: other lights
};
inline constexpr int kComplexLights = 16;

class SeparateDraws;  // frame_parts.h

/// What every technique is given.
struct FrameRequest {
  std::shared_ptr<const pipeline::Scene> scene;
  int width_px = 1280, height_px = 720;
  int camera = 0;               ///< index into Scene::cameras
  int point_lights = 0;         ///< 0..1024 seeded point lights added to those of the scene
  double light_range = 0.15;    ///< reach of the lights added, as a part of the scene's diagonal
  double light_strength = 1.0;  ///< factor on the light of the lights added
  AddedLights added;
  LightProfile lights = LightProfile::scene;
  bool shadows = true;  ///< a shadow map for the scene's shadow caster
  int shadow_map_px = 2048;
  bool metal_ambient = true;   ///< metals reflect ambient light (pipeline::LightingUniforms::extended)
  bool linear_output = false;  ///< a filter takes linear light: the output has half floats
  /// A modifier's: parts of the scene that it draws in its own way. Null: bases draw everything.
  std::shared_ptr<const SeparateDraws> separate;
  /// Stands for the scene, which is empty then: sRGB codes of a finished frame. Only filters work on it.
  std::shared_ptr<const pipeline::RawImage> image;
  GpuFeatures features;
  FunctionalConfig functional;
};

/// A frame that was emulated, as notes look at it: its work, and what its scene has of special surfaces.
struct DrawnFrame {
  const WorkTrace& trace;
  const std::vector<pipeline::SpecialSurface>& surfaces;
};

enum class TechniqueKind { base, modifier, filter };

/// One entry of the registry. Which function it has makes its kind: a base builds the frame, a modifier
/// changes what bases are asked for (before them), a filter appends passes that take the frame's image (after
/// them). Made by base_technique, modifier_technique or filter_technique.
struct TechniqueInfo {
  std::string_view id;  ///< "msaa4x"
  std::string_view description;
  Options defaults{NoOptions{}};
  std::vector<OptionInfo> options = {};  ///< what describes `defaults`, in the order in which users see them
  std::function<pipeline::FrameGraph(const FrameRequest& request, const Options& options)> build = nullptr;
  std::function<void(FrameRequest& request, const Options& options)> modify = nullptr;
  /// Returns the filtered image; both hold sRGB codes, one sample a pixel (filters/filters.h).
  std::function<pipeline::ImageId(pipeline::FrameGraph& graph, pipeline::ImageId input,
                                  const Options& options)>
      filter = nullptr;
  /// A filter of linear light, beyond 1 too: it comes before the others.
  bool linear_input = false;
  /// Why it cannot go with another technique; empty: it can.
  std::string_view (*refuses)(const TechniqueInfo& other) = nullptr;
  /// What a user should know of a frame that it made: notes and warnings with a code and a message, without
  /// the technique's name. None: nothing ever.
  std::function<std::vector<Diagnostic>(const Options& options, const DrawnFrame& frame)> notes = nullptr;

  bool has_option(std::string_view name) const {
    return std::ranges::any_of(options, [&](const OptionInfo& option) { return option.name == name; });
  }
  TechniqueKind kind() const {
    return build ? TechniqueKind::base : modify ? TechniqueKind::modifier : TechniqueKind::filter;
  }
};

/// Entries whose functions take the technique's own struct of options.
template <class Struct>
TechniqueInfo base_technique(std::string_view id, std::string_view description,
                             pipeline::FrameGraph (*build)(const FrameRequest&, const Struct&),
                             Struct defaults = {}) {
  TechniqueInfo info{id, description, Options(defaults)};
  info.options = info.defaults.infos();
  info.build = [build](const FrameRequest& request, const Options& options) {
    return build(request, options.as<Struct>());
  };
  return info;
}
template <class Struct>
TechniqueInfo modifier_technique(std::string_view id, std::string_view description,
                                 void (*modify)(FrameRequest&, const Struct&), Struct defaults = {}) {
  TechniqueInfo info{id, description, Options(defaults)};
  info.options = info.defaults.infos();
  info.modify = [modify](FrameRequest& request, const Options& options) {
    modify(request, options.as<Struct>());
  };
  return info;
}
template <class Struct>
TechniqueInfo filter_technique(std::string_view id, std::string_view description,
                               pipeline::ImageId (*filter)(pipeline::FrameGraph&, pipeline::ImageId,
                                                           const Struct&),
                               Struct defaults = {}) {
  TechniqueInfo info{id, description, Options(defaults)};
  info.options = info.defaults.infos();
  info.filter = [filter](pipeline::FrameGraph& graph, pipeline::ImageId input, const Options& options) {
    return filter(graph, input, options.as<Struct>());
  };
  return info;
}

/// The entry, with notes.
template <class Struct>
TechniqueInfo with_notes(TechniqueInfo info,
                         std::vector<Diagnostic> (*notes)(const Struct&, const DrawnFrame&)) {
  info.notes = [notes](const Options& options, const DrawnFrame& frame) {
    return notes(options.as<Struct>(), frame);
  };
  return info;
}

/// The explanation of a note's code, as `hwsim help T101` prints it.
struct MessageCode {
  std::string_view code, title, explanation;
};

/// What a room (a folder below algos/) adds to the program. The registry lists the rooms.
struct Room {
  std::vector<TechniqueInfo> techniques = {};
  std::span<const DeclaredCounter> counters = {};
  std::span<const CounterLaw> laws = {};      ///< what these counters obey in every pass
  std::vector<TechniqueCounter> shaded = {};  ///< those that count into a frame's shaded samples
  std::span<const MessageCode> codes = {};
};

}  // namespace hwsim::algos
