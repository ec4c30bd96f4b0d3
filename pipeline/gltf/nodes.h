#pragma once
// The nodes of a glTF scene, and the lights and cameras that they place.
#include <glm/glm.hpp>
#include <string>
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

/// The transformation of the lowest node that all meshes hang below; 1: there is none.
glm::dmat4 matrix_above_meshes(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes);

/// `units_per_m`: of the scene, whose coordinates the nodes are in; what the file gives in meters is scaled
/// by it.
std::vector<Light> build_lights(Report& report, const tinygltf::Model& model,
                                const std::vector<PlacedNode>& nodes, double units_per_m);

/// far_m is 0 where the file leaves it infinite. Wrong cameras are left out with a warning.
std::vector<Camera> build_cameras(Report& report, const tinygltf::Model& model,
                                  const std::vector<CameraSpec>& specs, const std::vector<PlacedNode>& nodes,
                                  double units_per_m);

}  // namespace hwsim::pipeline::gltf
