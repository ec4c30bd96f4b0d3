#pragma once
// Sorts an item's triangles into screen bins.
#include "pipeline/emulate/pass_context.h"

namespace hwsim::pipeline {

/// Layer by layer bins in order, triangles in submission order within each.
void bin_triangles(const PassContext& context, GeometryItem& item);

}  // namespace hwsim::pipeline
