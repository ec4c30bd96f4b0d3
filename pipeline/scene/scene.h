#pragma once
// What is drawn: plain data, immutable once loaded. World space is right-handed, y up, in meters (glTF),
// unless the scene was moved or scaled while it was loaded (Scene::origin_m).
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hwsim/base/diagnostics.h"

namespace hwsim::pipeline {

enum class Filter : std::uint8_t { nearest, linear };
enum class MipFilter : std::uint8_t { none, nearest, linear };
enum class Wrap : std::uint8_t { repeat, clamp_to_edge, mirrored_repeat, clamp_to_border };

struct Sampler {
  Filter mag = Filter::linear;
  Filter min = Filter::linear;
  MipFilter mip = MipFilter::linear;
  Wrap wrap_u = Wrap::repeat;
  Wrap wrap_v = Wrap::repeat;
  int max_anisotropy = 1;  ///< 1..16
  glm::vec4 border_color{0.0f};
};

/// One mip level of 8-bit RGBA texels, row-major, row 0 on top, r in the lowest byte.
struct MipLevel {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> texels;
};

/// A texture with its full mip chain (box filter in linear light, level sizes max(1, floor(size / 2))).
struct Texture {
  std::string name;
  bool srgb = true;  ///< texels of r, g, b are sRGB encoded; alpha is always linear
  std::vector<MipLevel> levels;
  int same_texels_as = -1;  ///< an earlier texture of an equal image, which holds the levels; -1: none
};

struct TextureRef {
  int texture = -1;  ///< index into Scene::textures, -1: none
  int sampler = 0;   ///< index into Scene::samplers
  int uv_set = 0;    ///< 0 or 1
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };
enum class ShadingModel : std::uint8_t { blinn_phong, ggx, unlit, phong };

/// glTF metallic-roughness, from which both shading models derive their parameters
/// (docs/techniques/conventions.md#shading-models): alpha = roughness^2, exponent = 2/alpha^2 - 2, k_s =
/// lerp(0.04, base, metallic), albedo = base (1 - metallic).
struct Material {
  std::string name;
  glm::vec4 base_color{1.0f};
  float metallic = 1.0f;
  float roughness = 1.0f;
  glm::vec3 emissive{0.0f};  ///< times KHR_materials_emissive_strength
  float normal_scale = 1.0f;
  float occlusion_strength = 1.0f;
  TextureRef base_color_texture, metallic_roughness_texture, normal_texture, emissive_texture,
      occlusion_texture;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  ShadingModel model = ShadingModel::blinn_phong;
};

/// Positions are on the surface. A wire's vertex has its center at position - radius * normal, its axis is
/// the tangent; meshes without wires leave `radius` empty.
/// A run of a part's triangles: small enough to lie outside of a view that the mesh lies in.
struct TriangleCluster {
  glm::vec3 bounds_min{0.0f}, bounds_max{0.0f};
  std::uint32_t first_vertex = 0, last_vertex = 0;  ///< the range that its indices span, both ends included
};
inline constexpr std::uint32_t kClusterTriangles = 2048;

struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3>
      normals;  ///< unit length, same count as positions (generated where the file has none)
  std::vector<glm::vec4>
      tangents;  ///< xyz unit, w = +-1 handedness; empty unless a normal texture needs them
  std::vector<glm::vec2> uv0, uv1;     ///< empty, or one a vertex
  std::vector<glm::vec4> colors;       ///< linear, empty, or one a vertex
  std::vector<float> radius;           ///< wires only: empty, or one a vertex
  std::vector<std::uint32_t> indices;  ///< triangles, three each; every index < positions.size()

  struct Part {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;  ///< a multiple of 3
    int material = 0;
    std::vector<TriangleCluster> clusters =
        {};  ///< one for each kClusterTriangles triangles; empty: not known
  };
  std::vector<Part> parts;
  glm::vec3 bounds_min{0.0f}, bounds_max{0.0f};
  int index_bytes = 4;   ///< as the file stores them: 1 is fetched as 2
  int vertex_bytes = 0;  ///< bytes of all attributes of one vertex, as the file stores them
};

struct Instance {
  int mesh = 0;
  glm::mat4 world_from_local{1.0f};
  std::string name;
};

enum class LightKind : std::uint8_t { directional, point, spot };

/// Directional: illuminance in lux scaled so that 1 lights a white Lambert surface to 1 (no 1/pi,
/// docs/techniques/conventions.md#shading-models). Point and spot: the same at one meter, times 1/d^2
/// windowed to zero at range_m.
struct Light {
  std::string name;  ///< the node's, else the light's own, else "nodes[7]"
  LightKind kind = LightKind::directional;
  glm::vec3 color{1.0f};  ///< color times intensity
  glm::vec3 position{0.0f};
  glm::vec3 direction{0.0f, -1.0f, 0.0f};  ///< the way that light travels, unit length
  float range_m = 0.0f;                    ///< 0: no limit
  float inner_cone_rad = 0.0f, outer_cone_rad = 0.7853982f;
  bool casts_shadow = false;  ///< at most one directional light does
};

struct Camera {
  std::string name;
  glm::mat4 view_from_world{1.0f};  ///< looks along -z, y up
  float fov_y_rad = 1.0471976f;     ///< vertical; unused when orthographic
  float near_m = 0.1f;
  float far_m = 1000.0f;
  bool orthographic = false;
  float ortho_half_height_m = 1.0f;
  float aspect_ratio = 0.0f;  ///< width by height of the frame to be seen whole; 0: the image's
};

/// How much more than the camera's height an image of this shape shows, so that the camera's frame is seen
/// whole: 1 or above.
double frame_widening(const Camera& camera, double aspect_ratio);

/// Half the height of what an image of this shape shows, at unit distance (perspective) or in meters
/// (orthographic).
double half_height(const Camera& camera, double aspect_ratio);

/// Depth 0 at near and 1 at far.
glm::mat4 clip_from_view(const Camera& camera, float aspect_ratio);

struct Scene {
  std::string name;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Sampler> samplers;  ///< at least one
  std::vector<Light> lights;      ///< at least one: a default sun where the file has none
  std::vector<Camera> cameras;    ///< at least one: a default one that frames the scene
  glm::vec3 ambient{0.05f};
  glm::vec3 background{0.2f, 0.3f, 0.45f};  ///< linear
  /// For a scene too far away, too small or too large for floats: where its zero lies in the file,
  /// and how many of the file's meters a unit is. Lengths "in meters" are in these units everywhere else.
  glm::dvec3 origin_m{0.0};
  double meters_per_unit = 1.0;
  /// What a meter of a technique's option is here. A scene of 0.1 m to 1 km is taken to be in meters;
  /// any other to be in a unit of its own, in which its meshes are modeled.
  double units_per_option_m = 1.0;
  double exposure = 1.0;           ///< by which the file's lights were multiplied (gltf/exposure.h)
  std::uint64_t memory_bytes = 0;  ///< that loading took at most, as estimated beforehand
  std::vector<Diagnostic> notes;   ///< what the loader ignored, generated or clamped
  std::string content_hash;        ///< hex, of everything that was read
  std::vector<std::string> files;  ///< that were read, or looked for and missing; absolute paths
};

struct SceneStats {
  std::uint64_t stored_triangles = 0, drawn_triangles = 0, vertices = 0, texture_bytes = 0;
  std::uint64_t drawn_mask_triangles = 0, drawn_blend_triangles = 0;
  glm::vec3 bounds_min{0.0f}, bounds_max{0.0f};  ///< world space
};
SceneStats stats(const Scene& scene);

/// The mip chain of a texture: its own, or that of the one whose texels it shares.
const std::vector<MipLevel>& levels_of(const Scene& scene, std::size_t texture);

}  // namespace hwsim::pipeline
