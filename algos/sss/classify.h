#pragma once
// Offline classification of selective supersampling (docs/techniques/sss.md#classification): triangles whose
// normals differ enough for a highlight to be smaller than they are. It depends on geometry alone.
#include <vector>

#include "algos/base/frame_parts.h"

namespace hwsim::algos {

/// The critical triangles of each draw, an empty list where it has none. `angle_rad`: between two normals.
std::vector<std::vector<std::uint32_t>> find_critical(const pipeline::Scene& scene,
                                                      const std::vector<pipeline::DrawCall>& draws,
                                                      double angle_rad);

}  // namespace hwsim::algos
