#pragma once
// Skins, as far as a picture without motion needs them: where they put their meshes in the bind pose.
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "pipeline/gltf/report.h"

namespace hwsim::pipeline::gltf {

struct PlacedNode;
struct Source;

/// As the file has it; nothing in it is wrong.
struct SkinSpec {
  std::vector<int> joints;         ///< nodes; none: the file's are not usable
  int inverse_bind_matrices = -1;  ///< an accessor of a matrix a joint; -1: none
};

std::vector<SkinSpec> read_skins(const nlohmann::json& root);

/// Where each skin that a node uses puts its meshes: its joints' transformations, each times its inverse bind
/// matrix, which are one and the same in the bind pose. Where the joints stand otherwise, the first one is
/// taken, with a warning: the mesh is not bent.
std::vector<glm::dmat4> skin_matrices(Report& report, const Source& source,
                                      const std::vector<PlacedNode>& nodes);

}  // namespace hwsim::pipeline::gltf
