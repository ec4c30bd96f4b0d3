#pragma once
// Offline classification of selective supersampling (techniques 5.1): triangles whose normals differ enough
// for a highlight to be smaller than they are. It depends on geometry alone.
#include <vector>

#include "algos/base/frame_parts.h"

namespace hwsim::algos {

/// Of each of the draws: its critical triangles, none where it has none. `angle_rad`: between two normals.
std::vector<std::vector<std::uint32_t>> find_critical(const pipeline::Scene& scene,
                                                      const std::vector<pipeline::DrawCall>& draws,
                                                      double angle_rad);

}  // namespace hwsim::algos
