#pragma once
// Which texture coordinates a material reads, and how KHR_texture_transform moves them: done to the vertices
// while they are loaded, as shaders know two sets of coordinates and no transformations.
#include <array>
#include <glm/glm.hpp>
#include <string>

namespace hwsim::pipeline::gltf {

/// new = offset + rotation * (scale * old); the rotation turns v toward u.
struct UvTransform {
  glm::dvec2 offset{0.0}, scale{1.0};
  double rotation_rad = 0.0;
  glm::vec2 applied(const glm::vec2& uv) const;
  bool operator==(const UvTransform&) const = default;
};

/// Coordinates that one of the two sets of the vertices holds.
struct UvSource {
  int file_set = 0;  ///< TEXCOORD_n
  UvTransform transform{};
  bool operator==(const UvSource&) const = default;
};

/// What a material's textures find in uv_set 0 and 1.
struct UvSources {
  std::array<UvSource, 2> sets{UvSource{0}, UvSource{1}};
  bool are_plain() const { return *this == UvSources{}; }
  std::string key() const;  ///< equal for equal sources
  bool operator==(const UvSources&) const = default;
};

}  // namespace hwsim::pipeline::gltf
