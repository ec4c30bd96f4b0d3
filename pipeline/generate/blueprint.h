#pragma once
// What a generator returns, and how it becomes a GLB file.
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "pipeline/generate/surface.h"

namespace hwsim::pipeline::generate {

struct Look {
  std::string name;
  glm::dvec3 color{0.8};
  double metallic = 0.0;
  double roughness = 0.8;
  bool double_sided = false;
  int texture = -1;  ///< index into Blueprint::textures, laid over the color
  bool unlit = false;
  bool alpha_test = false;  ///< the texture's alpha cuts holes
};

struct Piece {
  MeshSurface surface;
  int look = 0;
};

struct Model {
  std::string name;
  std::vector<Piece> pieces;
};

struct Placement {
  int model = 0;
  glm::dvec3 position{0.0};
  double turn_rad = 0.0;  ///< about y
  double scale = 1.0;
};

struct View {
  std::string name;
  glm::dvec3 eye{0.0}, target{0.0};
  double fov_y_rad = 1.0471975511965976;
};

struct Blueprint {
  std::vector<Look> looks;
  std::vector<std::vector<std::uint8_t>> textures;  ///< PNG files
  std::vector<Model> models;
  std::vector<Placement> placements;
  glm::dvec3 eye{0, 1, 5}, target{0.0};
  double fov_y_rad = 1.0471975511965976;
  double near_m = 0.1;
  std::vector<View> more_views;  ///< after the camera `suggested`, which the lines above describe
  glm::dvec3 sun_direction{0.4, -1.0, -0.35};
  double sun_lux = 1.0;
};

/// Deterministic: the same blueprint gives the same bytes.
std::vector<std::uint8_t> encode_glb(const Blueprint& blueprint);

}  // namespace hwsim::pipeline::generate
