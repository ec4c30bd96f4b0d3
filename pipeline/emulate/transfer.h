#pragma once
// Clears, copies and resolves.
#include <vector>

#include "pipeline/graph/frame_graph.h"
#include "pipeline/image/image.h"
#include "pipeline/memory/gpu_image.h"

namespace hwsim::pipeline {

void clear_image(GpuImage& image, const Pass& pass);
/// Copies every texel: use_all first.
void copy_image(const GpuImage& from, GpuImage& to);
/// The mean of all samples, taken in linear light and summed in pairs. Returns the pixels of which only one
/// sample was read, because they hold one color.
std::uint64_t resolve_image(GpuImage& from, GpuImage& to, bool skip_single_colors, int jobs);

/// Sample 0 of every pixel, decoded from `format` to linear RGBA.
Image to_linear_image(const GpuImage& from, Format format, int jobs);

/// Texels as they are.
void upload_image(const RawImage& contents, GpuImage& image);

/// Work of a transfer, in a chunk for each band of tiles.
std::vector<PassCounters> count_transfer(const Pass& pass, const GpuImage* source,
                                         std::span<GpuImage* const> targets);

}  // namespace hwsim::pipeline
