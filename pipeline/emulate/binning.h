#pragma once
// Sorts an item's triangles, or its points, into screen bins.
#include "pipeline/emulate/pass_context.h"

namespace hwsim::pipeline {

/// Layer by layer bins in order, triangles in submission order within each.
void bin_triangles(const PassContext& context, GeometryItem& item);
/// The same, of an item of points: a point is in the bins of its halves.
void bin_points(const PassContext& context, GeometryItem& item);

}  // namespace hwsim::pipeline
