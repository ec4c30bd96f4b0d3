#pragma once
// Up to 64 assembled triangles on their way through a geometry shader, a lane each.
#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/batch/fragment_batch.h"

namespace hwsim::pipeline {

struct GeometryBatch {
  int count = 0;
  int width_px = 0, height_px = 0;  ///< viewport
  bool mirrored = false;            ///< the draw's transform flips the winding
  const MaterialView* material = nullptr;
  const GeometryProgram* program = nullptr;
  PassCounters* counters = nullptr;

  // One value a lane
  alignas(64) float clip_position[3][4][kBatchLanes];
  std::array<const float*, kBatchLanes>
      varyings[3];  ///< the three vertices' values, as the vertex program wrote them
  alignas(64) std::array<std::int32_t, kBatchLanes> primitive;  ///< number in the draw

  // Results. A lane's vertices follow each other: clip position, then varyings.
  std::vector<float> vertices;             ///< lane l's begin at l * max_vertices * scalars_per_vertex()
  std::vector<std::uint8_t> starts_strip;  ///< one flag a vertex, in the same order
  alignas(64) std::array<std::int32_t, kBatchLanes> vertex_count{};
  std::array<bool, kBatchLanes> strip_ended{};
  BlockTrips blocks;

  std::size_t scalars_per_vertex() const { return 4 + static_cast<std::size_t>(program->varying_scalars); }
  std::size_t first_vertex(std::size_t lane) const {
    return lane * static_cast<std::size_t>(program->max_vertices);
  }
  const float* vertex(std::size_t lane, std::size_t i) const {
    return vertices.data() + (first_vertex(lane) + i) * scalars_per_vertex();
  }

  void start(const GeometryProgram& next) {
    program = &next;
    const std::size_t most = kBatchLanes * static_cast<std::size_t>(next.max_vertices);
    if (vertices.size() < most * scalars_per_vertex()) vertices.resize(most * scalars_per_vertex());
    if (starts_strip.size() < most) starts_strip.resize(most);
    vertex_count.fill(0);
    strip_ended.fill(true);
    blocks.used = 0;
  }
};

}  // namespace hwsim::pipeline
