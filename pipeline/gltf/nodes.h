#pragma once
// Nodes of a glTF file, and the lights and cameras that they place.
#include <glm/glm.hpp>
#include <vector>

#include "pipeline/gltf/source.h"
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline::gltf {

struct PlacedNode {
  int node = 0;
  glm::dmat4 world_from_local{1.0};
};

/// The nodes of the file's scene, parents first, in document order. Throws InputError (S011) where a node is
/// reached twice (a cycle, or two parents) and (S010) where a transformation leaves the range of float.
std::vector<PlacedNode> walk_scene(Report& report, const tinygltf::Model& model);

std::vector<Light> build_lights(Report& report, const tinygltf::Model& model,
                                const std::vector<PlacedNode>& nodes);

/// far_m is 0 where the file leaves it infinite.
std::vector<Camera> build_cameras(Report& report, const tinygltf::Model& model,
                                  const std::vector<PlacedNode>& nodes);

}  // namespace hwsim::pipeline::gltf
