#pragma once
// Coverage by exact integers, written from the specification of Direct3D 11's and Vulkan's rasterization
// rules and from nothing else: slow, short, and with no code in common with the product's rasterizer.
#include <vector>

#include "oracle/fixed_triangle.h"

namespace hwsim::oracle {

/// Whether the triangle, in either orientation, covers the point (1/256 px). Any coordinates of 32 bits are
/// exact.
bool covers(const FixedTriangle& triangle, std::int64_t x, std::int64_t y);

/// The last triangle that covers a sample wins, in the order given. No depth is computed.
SampleImage exact_coverage(const std::vector<FixedTriangle>& triangles, int width, int height, int samples);

/// How many of the triangles cover each sample, indexed as SampleImage is.
std::vector<std::uint32_t> exact_cover_counts(const std::vector<FixedTriangle>& triangles, int width,
                                              int height, int samples);

}  // namespace hwsim::oracle
