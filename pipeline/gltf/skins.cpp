#include "pipeline/gltf/skins.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "pipeline/gltf/accessor.h"
#include "pipeline/gltf/nodes.h"
#include "pipeline/gltf/source.h"

namespace hwsim::pipeline::gltf {
namespace {
using nlohmann::json;

constexpr double kRounding = 1e-4;  // inverse matrices are floats of larger numbers

std::optional<int> index_into(const json& root, const char* array, const json& value) {
  if (!value.is_number() || !root.contains(array)) return std::nullopt;
  const double number = value.get<double>();
  const bool right =
      number >= 0.0 && number == std::floor(number) && number < static_cast<double>(root[array].size());
  return right ? std::optional<int>(static_cast<int>(number)) : std::nullopt;
}

SkinSpec read_skin(const json& root, const json& source) {
  SkinSpec skin;
  if (!source.contains("joints") || !source["joints"].is_array()) return {};
  for (const json& joint : source["joints"]) {
    const std::optional<int> node = index_into(root, "nodes", joint);
    if (!node) return {};
    skin.joints.push_back(*node);
  }
  if (!source.contains("inverseBindMatrices")) return skin;
  const std::optional<int> accessor = index_into(root, "accessors", source["inverseBindMatrices"]);
  if (!accessor) return {};
  const json& matrices = root["accessors"][static_cast<std::size_t>(*accessor)];
  const bool right = matrices["type"] == "MAT4" && matrices["componentType"].get<double>() == 5126.0 &&
                     matrices["count"].get<double>() >= static_cast<double>(skin.joints.size());
  if (!right) return {};
  skin.inverse_bind_matrices = *accessor;
  return skin;
}

double largest_difference(const glm::dmat4& a, const glm::dmat4& b) {
  double largest = 0.0;
  for (int i = 0; i < 16; ++i) largest = std::max(largest, std::abs(a[i / 4][i % 4] - b[i / 4][i % 4]));
  return largest;
}

double largest_element(const glm::dmat4& m) { return largest_difference(m, glm::dmat4(0.0)); }

// The scene's nodes by their number in the file; null: not in the scene.
using NodesByNumber = std::vector<const PlacedNode*>;

// A matrix for each joint that the scene has.
std::vector<glm::dmat4> joint_matrices(const SkinSpec& skin, const std::vector<float>& inverse,
                                       const NodesByNumber& nodes) {
  std::vector<glm::dmat4> out;
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const PlacedNode* placed = nodes[static_cast<std::size_t>(skin.joints[j])];
    if (placed == nullptr) continue;
    glm::dmat4 bind(1.0);
    for (int i = 0; i < 16 && !inverse.empty(); ++i)
      if (i % 4 != 3) bind[i / 4][i % 4] = static_cast<double>(inverse[16 * j + static_cast<std::size_t>(i)]);
    out.push_back(placed->world_from_local * bind);
  }
  return out;
}

glm::dmat4 matrix_of(Report& report, const Source& source, std::size_t index, const NodesByNumber& nodes) {
  const SkinSpec& skin = source.skins[index];
  const std::string where = element("skins", index);
  report.note("S110",
              "skins do not move: their joints place skinned meshes as modeled, the meshes' nodes do not",
              where);
  std::vector<float> inverse;
  if (skin.inverse_bind_matrices >= 0)
    inverse = read_floats(report, source.model,
                          {skin.inverse_bind_matrices, 16, where + ".inverseBindMatrices", false});
  const std::vector<glm::dmat4> matrices = joint_matrices(skin, inverse, nodes);
  if (matrices.empty()) {
    report.warn("S110", "a skin has no joint in the scene: its meshes are drawn as modeled", where);
    return glm::dmat4(1.0);
  }
  const glm::dmat4& first = matrices.front();
  const double rounding = kRounding * largest_element(first);
  const bool in_bind_pose = std::all_of(matrices.begin(), matrices.end(), [&](const glm::dmat4& m) {
    return largest_difference(m, first) <= rounding;
  });
  if (!in_bind_pose)
    report.warn("S110", "a skin's joints do not stand as they were bound: its meshes are not bent", where);
  return largest_difference(first, glm::dmat4(1.0)) <= kRounding ? glm::dmat4(1.0) : first;
}

}  // namespace

std::vector<SkinSpec> read_skins(const json& root) {
  std::vector<SkinSpec> out;
  if (root.contains("skins"))
    for (const json& skin : root["skins"]) out.push_back(read_skin(root, skin));
  return out;
}

std::vector<glm::dmat4> skin_matrices(Report& report, const Source& source,
                                      const std::vector<PlacedNode>& nodes) {
  const std::vector<tinygltf::Node>& all = source.model.nodes;
  NodesByNumber by_number(all.size(), nullptr);
  std::vector<bool> used(source.skins.size(), false);
  for (const PlacedNode& placed : nodes) {
    by_number[static_cast<std::size_t>(placed.node)] = &placed;
    const tinygltf::Node& node = all[static_cast<std::size_t>(placed.node)];
    if (node.mesh >= 0 && node.skin >= 0) used[static_cast<std::size_t>(node.skin)] = true;
  }
  std::vector<glm::dmat4> out(source.skins.size(), glm::dmat4(1.0));
  for (std::size_t i = 0; i < out.size(); ++i)
    if (used[i]) out[i] = matrix_of(report, source, i, by_number);
  return out;
}

}  // namespace hwsim::pipeline::gltf
