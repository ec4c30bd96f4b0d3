#pragma once
// What is asked of the lab, as plain data with defaults. Each value is declared once, in `describe`: from
// that line follow `--set`, run.toml both ways with its schema, and the keys of every cache. A member without
// a declaration does not compile.
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/config/key.h"
#include "hwsim/config/toml_value.h"

namespace hwsim::lab {

inline constexpr int kDefaultReferenceSamples = 64;
inline constexpr int kMaxSidePx = 16384;  ///< the largest Direct3D 11 texture
inline constexpr int kMaxPointLights = 1024;
inline constexpr int kMaxReferenceSamples = 65536;

struct Resolution {
  int width_px = 1280;
  int height_px = 720;
  bool operator==(const Resolution&) const = default;
};

/// What is drawn, before any technique.
struct View {
  std::string
      scene;  ///< as pipeline::open_scene takes it: a path, or a generator with its parameters; or an image
  Resolution resolution;
  std::string camera = "0";  ///< a name or an index
  int point_lights = 0;
  double light_range = 0.15;
  double light_strength = 1.0;
  double light_range_from = 0.0, light_range_to = 0.0;
  double light_box_x = 0.0, light_box_y = 0.0, light_box_z = 0.0;
  int light_seed = 0;
  std::string lights = "scene";
  bool shadows = true;
  int shadow_map_px = 2048;
  bool metal_ambient = true;
  int anisotropy = 1;
  bool alpha_test = true;
  std::string reference_shadows = "map";
  double exposure = 0.0;  ///< factor on the file's lights; 0: automatic (pipeline::SceneLoadOptions)
  int memory_mib = 2048;  ///< that loading the scene may take
  bool operator==(const View&) const = default;
};

/// How the view is executed and timed.
struct Settings {
  std::string skip = "all";
  std::string engine = "queue";
  double detailed_sample = 1.0;
  bool calibrated = true;
  int reference_samples = 0;  ///< 0: no reference
  bool images = true;
  bool operator==(const Settings&) const = default;
};

/// A view, drawn with each technique and timed on each GPU.
struct Request {
  View view;
  Settings settings;
  std::vector<std::string> techniques = {"none"};
  std::vector<std::string> gpus = {"gtx980"};
  std::vector<std::string> overlays{};  ///< laid over each GPU
  std::vector<Assignment>
      sets{};  ///< in the order in which they were given; technique.* and gpu.* act in the plan
};

/// What depends on a value.
enum FieldUse : unsigned {
  kNothing = 0,
  kWork = 1,       ///< the work trace: part of its cache's key
  kReference = 2,  ///< the ray-traced reference: part of its cache's key
};

/// The declaration of one value of a request.
struct FieldInfo {
  KeyInfo key;                     ///< name, range, meaning
  std::string_view group = "";     ///< GROUP of `--set GROUP.NAME`; empty: no `--set` reaches it
  std::string_view file_key = "";  ///< in run.toml; empty: not recorded
  unsigned uses = kNothing;
  std::string_view choices = "";  ///< "scene|simple|complex"; empty: any value of the type
};

/// A declaration with the address of its value.
struct Field {
  FieldInfo info;
  KeySlot slot;
};

template <class Visitor>
void describe(Visitor& v, View& view) {
  auto& [scene, resolution, camera, point_lights, light_range, light_strength, light_range_from,
         light_range_to, light_box_x, light_box_y, light_box_z, light_seed, lights, shadows, shadow_map_px,
         metal_ambient, anisotropy, alpha_test, reference_shadows, exposure, memory_mib] = view;
  auto& [width_px, height_px] = resolution;
  // The scene's content and the camera's index stand in the keys of caches, not what the user called them.
  v.field(
      {{"scene", 0, 0, kNoFlags, "a glTF file, a generator with its parameters, or an image"}, "", "scene"},
      scene);
  v.field({{"width_px", 1, kMaxSidePx, kNoFlags, "width of the frame"}, "", "width_px", kWork | kReference},
          width_px);
  v.field(
      {{"height_px", 1, kMaxSidePx, kNoFlags, "height of the frame"}, "", "height_px", kWork | kReference},
      height_px);
  v.field({{"camera", 0, 0, kNoFlags,
            "name or index of a camera of the scene, or one of its own: \"eye=1,2,3 target=0,0,0 fov=60\""},
           "",
           "camera"},
          camera);
  v.field({{"point_lights", 0, kMaxPointLights, kNoFlags, "seeded point lights added to those of the scene"},
           "scene",
           "point_lights",
           kWork | kReference},
          point_lights);
  v.field({{"light_range", 1e-3, 100, kNoFlags,
            "reach of the lights that are added (also by lights=complex), over the scene's diagonal"},
           "scene",
           "light_range",
           kWork | kReference},
          light_range);
  v.field(
      {{"light_strength", 0, 1000, kNoFlags,
        "factor on the light of the lights that are added; less than 1 where they whiten what is near them"},
       "scene",
       "light_strength",
       kWork | kReference},
      light_strength);
  v.field({{"light_range_from", 0, 1e6, kNoFlags, "least reach of an added light, in the scene's unit"},
           "scene",
           "light_range_from",
           kWork | kReference},
          light_range_from);
  v.field({{"light_range_to", 0, 1e6, kNoFlags,
            "greatest reach of an added light, in the scene's unit: reaches lie evenly between; 0: all have "
            "light_range"},
           "scene",
           "light_range_to",
           kWork | kReference},
          light_range_to);
  const auto box = [&](std::string_view name, double& side) {
    v.field({{name, 0, 1e6, kNoFlags,
              "side of the box around the scene's middle that added lights lie in, in the scene's unit; 0: "
              "the scene's own"},
             "scene",
             name,
             kWork | kReference},
            side);
  };
  box("light_box_x", light_box_x);
  box("light_box_y", light_box_y);
  box("light_box_z", light_box_z);
  v.field({{"light_seed", 0, 1 << 20, kNoFlags, "another number: other places and colors of added lights"},
           "scene",
           "light_seed",
           kWork | kReference},
          light_seed);
  v.field({{"lights", 0, 0, kNoFlags,
            "scene, simple (one light), complex (16 lights) or added (none of the scene's)"},
           "scene",
           "lights",
           kWork | kReference,
           "scene|simple|complex|added"},
          lights);
  v.field({{"shadows", 0, 1, kNoFlags, "a shadow map for the light that casts shadows"},
           "scene",
           "shadows",
           kWork | kReference},
          shadows);
  v.field({{"shadow_map_px", 16, kMaxSidePx, kNoFlags, "side of the shadow map"},
           "scene",
           "shadow_map_px",
           kWork | kReference},
          shadow_map_px);
  v.field({{"metal_ambient", 0, 1, kNoFlags,
            "metals reflect ambient light; the papers' shaders had no such term"},
           "scene",
           "metal_ambient",
           kWork | kReference},
          metal_ambient);
  v.field(
      {{"anisotropy", 1, 16, kNoFlags,
        "probes of a texture request at most, along the longer axis of a pixel's footprint; 1: none beyond "
        "the filter's own"},
       "scene",
       "anisotropy",
       kWork | kReference},
      anisotropy);
  v.field({{"alpha_test", 0, 1, kNoFlags, "materials with an alpha test have it; false: they are opaque"},
           "scene",
           "alpha_test",
           kWork | kReference},
          alpha_test);
  v.field(
      {{"reference_shadows", 0, 0, kNoFlags,
        "the reference's shadows: map, the frame's own shadow map, or rays, which show what the map costs"},
       "scene",
       "reference_shadows",
       kReference,
       "map|rays"},
      reference_shadows);
  // Part of the scene's content, as the loader sees it.
  v.field({{"exposure", 0, 1e12, kNoFlags,
            "factor of the file's lights; 0: 1, or less where they are in photometric units"},
           "scene",
           "exposure"},
          exposure);
  v.field({{"memory_mib", 1, 1 << 20, kNoFlags, "memory that loading the scene may take"}, "scene"},
          memory_mib);
}

template <class Visitor>
void describe(Visitor& v, Settings& settings) {
  auto& [skip, engine, detailed_sample, calibrated, reference_samples, images] = settings;
  v.field({{"skip", 0, 0, kNoFlags,
            "work to leave out: all, none, or some of the skips by name, separated by commas"},
           "emulator",
           "emulator_skip",
           kWork},
          skip);
  v.field({{"engine", 0, 0, kNoFlags, "roofline, queue or detailed"}, "timing", "engine"}, engine);
  v.field({{"detailed_sample", 1e-3, 1, kNoFlags, "engine detailed: part of a pass that is simulated"},
           "timing",
           "detailed_sample"},
          detailed_sample);
  v.field({{"calibrated", 0, 0, kNoFlags,
            "the fitted numbers of a GPU, where there are, not the documented ones"},
           "timing",
           "calibrated"},
          calibrated);
  v.field({{"reference_samples", 0, kMaxReferenceSamples, kNoFlags,
            "samples a pixel of the ray-traced reference; 0: none"},
           "",
           "reference_samples"},
          reference_samples);
  v.field({{"images", 0, 0, kNoFlags, "images are written"}}, images);
}

/// Every value of a view, or of settings, in the order of their declaration.
std::vector<Field> fields_of(View& view);
std::vector<Field> fields_of(Settings& settings);

/// A value that is none of its declaration's words, as a problem: `name` is what the user called it. None for
/// fields of any value.
std::optional<Diagnostic> choice_problem(const Field& field, const std::string& name, std::string code);

/// Appends the values of a view that are none of their words.
void check_choices(View view, std::vector<Diagnostic>& problems);

/// Every value by its name, in the order of declaration: what a manifest records.
nlohmann::ordered_json to_json(const View& view);
nlohmann::ordered_json to_json(const Settings& settings);

/// JSON Schema of one value: its type, range or words, default and meaning.
nlohmann::ordered_json field_schema(const Field& field);

/// "width_px 1280 height_px 720 ...": the values on which `use` depends, for a cache's key.
std::string key_text(const View& view, FieldUse use);
std::string key_text(const Settings& settings, FieldUse use);

/// A run.toml becomes its request, anything else a request with that scene and defaults. Throws InputError
/// for a damaged file.
Request open_request(const std::string& scene_or_run_file);

/// Applies words (request_words.h) and settings of the groups scene, emulator and timing to the request's
/// values, adds parameters of a generated scene to its name, and keeps all settings in request.sets. Appends
/// what is wrong to `problems`.
void apply(Request& request, const std::vector<Assignment>& settings, std::vector<Diagnostic>& problems);

/// "l2_size_kib" of `gpu.l2_size_kib`.
std::string key_of(const Assignment& set);

/// "grass:seed=3" with further parameters or other values for those that it has.
std::string with_parameters(const std::string& text, const std::vector<Assignment>& parameters);

/// Appends the diagnostics of a caught error.
void append(std::vector<Diagnostic>& problems, const InputError& error);

}  // namespace hwsim::lab
