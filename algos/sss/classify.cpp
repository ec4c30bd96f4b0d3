#include "algos/sss/classify.h"

#include <algorithm>
#include <cmath>

#include "pipeline/emulate/material_views.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

std::vector<std::uint32_t> critical_of(const Mesh& mesh, const Mesh::Part& part,
                                       const glm::mat3& normal_from_local, double cos_limit) {
  std::vector<std::uint32_t> critical;
  const auto normal = [&](std::uint32_t index) {
    return glm::normalize(normal_from_local * mesh.normals[index]);
  };
  for (std::uint32_t i = part.first_index; i + 2 < part.first_index + part.index_count; i += 3) {
    const std::uint32_t* t = mesh.indices.data() + i;
    const glm::dvec3 a(normal(t[0])), b(normal(t[1])), c(normal(t[2]));
    // From chords: cosines of small angles lose their digits.
    const double chord2 = std::max({glm::dot(a - b, a - b), glm::dot(b - c, b - c), glm::dot(c - a, c - a)});
    if (1.0 - 0.5 * chord2 < cos_limit) critical.insert(critical.end(), t, t + 3);
  }
  return critical;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> find_critical(const Scene& scene, const std::vector<DrawCall>& draws,
                                                      double angle_rad) {
  std::vector<std::vector<std::uint32_t>> all;
  for (const DrawCall& draw : draws) {
    const Instance& instance = scene.instances[static_cast<std::size_t>(draw.instance)];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    all.push_back(critical_of(mesh, mesh.parts[static_cast<std::size_t>(draw.part)],
                              normal_from_local(instance.world_from_local), std::cos(angle_rad)));
  }
  return all;
}

}  // namespace hwsim::algos
