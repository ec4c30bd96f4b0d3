#pragma once
// What the compute variant of selective supersampling reads instead of drawing: scene data.
#include <cstdint>
#include <vector>

#include "algos/sss/frame.h"

namespace hwsim::algos {

/// Vertices, triangles and groups, as the compute shader's buffers hold them.
struct SssComputeData {
  std::vector<std::uint32_t> triangles, vertices, groups;
  int group_count() const { return static_cast<int>(groups.size()) / kSssGroupWords; }
};

/// The buffers of critical triangles; `uniforms` get the draws and the length of a vertex.
SssComputeData sss_compute_data(const pipeline::Scene& scene, const std::vector<CriticalDraw>& critical,
                                SssUniforms& uniforms);

}  // namespace hwsim::algos
