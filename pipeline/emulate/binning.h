#pragma once
// Sorts an item's triangles, or its points, into screen bins.
#include "pipeline/emulate/pass_context.h"

namespace hwsim::pipeline {

/// Copies what was built of an item into the arena, bin by bin, in submission order within each. A triangle
/// is in the bins that it may touch, a point in those of its halves.
void sort_into_bins(const PassContext& context, GeometryItem& item, Arena& arena);

/// Lists the runs of each bin, item by item, and the bins that have any, in order.
void list_bins(const PassContext& context, Segment& segment);

/// The bins with most primitives first, so that no thread is left with one of them at the end.
void sort_bins_by_work(const PassContext& context, Segment& segment);

}  // namespace hwsim::pipeline
