#pragma once
// A scene of colored patches side by side, one for each way in which glTF says the same thing, or a thing of
// its own: vertex colors, strips, texture transforms, mirrored nodes. A closed form predicts each patch's
// color.
#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "tests/pipeline/scene_glb.h"

namespace hwsim::test {

struct Patch {
  std::string kind;  ///< what of glTF it is about
  std::string name;
  glm::vec3 color{0.0f};  ///< linear, as the closed form gives it
};

/// The scene's bytes as GLB, and its patches, kColumns a row from the lower left. The camera sees kColumns by
/// rows() meters, a patch a meter, orthographic.
class ConformanceScene {
 public:
  static constexpr int kColumns = 6;
  static constexpr float kAmbient = 0.05f;  ///< every loaded scene's
  static constexpr glm::vec3 kBackground{0.2f, 0.3f, 0.45f};

  ConformanceScene();
  pipeline::test::Bytes bytes() { return glb_.bytes(); }
  const std::vector<Patch>& patches() const { return patches_; }
  int rows() const { return (static_cast<int>(patches_.size()) + kColumns - 1) / kColumns; }

 private:
  using json = nlohmann::json;

  /// What a rough dielectric surface of this base color reflects of one white directional light at this
  /// cosine.
  static glm::vec3 lit(const glm::vec3& base, float cosine = 1.0f, float open = 1.0f);
  int add_material(const json& material);
  int add_texture(const std::vector<std::array<std::uint8_t, 4>>& texels, int width);
  json plain_material(const glm::vec3& base) const;
  /// A square of 0.8 m in its cell, of this primitive; `node` may hold a transformation below the cell's.
  void add(const std::string& name, const glm::vec3& color, json primitive,
           const json& node = json::object());
  json square(int material, bool with_normals = true);
  json textured_square(int material, const std::vector<float>& uv, const char* name = "TEXCOORD_0");

  void add_transforms();
  void add_vertex_colors();
  void add_modes();
  void add_alpha();
  void add_textures();
  void add_normal_maps();
  void add_accessors();
  void add_materials();
  void add_camera_and_light();

  pipeline::test::GlbBuilder glb_;
  std::string kind_;  ///< the kind of the patches that are added
  std::vector<Patch> patches_;
};

}  // namespace hwsim::test
