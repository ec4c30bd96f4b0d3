#include "algos/sss/compute_data.h"

#include <algorithm>
#include <cstring>
#include <map>

#include "pipeline/emulate/material_views.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

std::uint32_t bits_of(float value) {
  std::uint32_t bits;
  static_assert(sizeof(bits) == sizeof(value));
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

class Collector {
 public:
  Collector(const Scene& scene, const std::vector<CriticalDraw>& critical, SssUniforms& uniforms)
      : scene_(scene), uniforms_(uniforms) {
    const bool full = std::any_of(critical.begin(), critical.end(),
                                  [](const CriticalDraw& d) { return d.vertex == SssVertex::full; });
    uniforms.vertex_words = full ? SurfaceVaryings::kFull : SurfaceVaryings::kBasic;
    uniforms.draws.clear();
    for (const CriticalDraw& draw : critical) add(draw);
  }

  SssComputeData data;

 private:
  void add(const CriticalDraw& draw) {
    const Instance& instance = scene_.instances[static_cast<std::size_t>(draw.call.instance)];
    const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(instance.mesh)];
    const auto [base, added] =
        first_vertex_.try_emplace(instance.mesh, static_cast<std::uint32_t>(data.vertices.size()) /
                                                     static_cast<std::uint32_t>(uniforms_.vertex_words));
    if (added) add_vertices(mesh);
    const auto number = static_cast<std::uint32_t>(uniforms_.draws.size());
    SssDraw info;
    info.world_from_local = instance.world_from_local;
    info.normal_from_local = normal_from_local(instance.world_from_local);
    info.mirrored = glm::determinant(glm::mat3(instance.world_from_local)) < 0.0f;
    info.material = mesh.parts[static_cast<std::size_t>(draw.call.part)].material;
    uniforms_.draws.push_back(info);
    const std::vector<std::uint32_t>& indices = draw.call.list->indices;
    const auto first = static_cast<std::uint32_t>(data.triangles.size() / 3),
               count = static_cast<std::uint32_t>(indices.size() / 3);
    for (const std::uint32_t index : indices) data.triangles.push_back(base->second + index);
    constexpr auto kGroup = static_cast<std::uint32_t>(kBatchLanes);
    for (std::uint32_t t = 0; t < count; t += kGroup)
      data.groups.insert(data.groups.end(), {first + t, std::min(kGroup, count - t), number, t});
  }

  void add_vertices(const Mesh& mesh) {
    const auto put = [&](float v) { data.vertices.push_back(bits_of(v)); };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      for (int k = 0; k < 3; ++k) put(mesh.normals[i][k]);
      for (int k = 0; k < 2; ++k) put(mesh.uv0.empty() ? 0.0f : mesh.uv0[i][k]);
      for (int k = 0; k < 3; ++k) put(mesh.positions[i][k]);
      if (uniforms_.vertex_words == SurfaceVaryings::kBasic) continue;
      for (int k = 0; k < 4; ++k)
        put(mesh.tangents.empty() ? (k == 0 || k == 3 ? 1.0f : 0.0f) : mesh.tangents[i][k]);
      for (int k = 0; k < 4; ++k) put(mesh.colors.empty() ? 1.0f : mesh.colors[i][k]);
      for (int k = 0; k < 2; ++k) put(mesh.uv1.empty() ? 0.0f : mesh.uv1[i][k]);
    }
  }

  const Scene& scene_;
  SssUniforms& uniforms_;
  std::map<int, std::uint32_t> first_vertex_;
};

}  // namespace

SssComputeData sss_compute_data(const Scene& scene, const std::vector<CriticalDraw>& critical,
                                SssUniforms& uniforms) {
  return std::move(Collector(scene, critical, uniforms).data);
}

}  // namespace hwsim::algos
