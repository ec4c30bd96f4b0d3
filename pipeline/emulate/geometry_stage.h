#pragma once
// The geometry shader: runs on assembled triangles, hands what it emits to set-up.
#include <span>

#include "pipeline/batch/geometry_batch.h"
#include "pipeline/emulate/primitive_setup.h"

namespace hwsim::pipeline {

/// All triangles of one item; `indices`: three each, into the draw's shaded vertices.
void run_geometry_shader_stage(const PassContext& context, const VertexSource& source,
                               std::span<const std::uint32_t> indices, GeometryItem& item,
                               GeometryBatch& batch, std::vector<PassCounters>& chunks);

}  // namespace hwsim::pipeline
