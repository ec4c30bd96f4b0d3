#pragma once
// What a graph with coverage maps (CSAA, EQAA; docs/techniques/forward.md#coverage-sampling) must obey.
#include <string>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "pipeline/graph/frame_graph.h"

namespace hwsim::pipeline {

/// An image in messages: name, format, size, samples.
std::string text(const ImageDesc& image);

/// The numbers of samples and positions of an image with a map, and whether the GPU has them.
std::vector<Diagnostic> check_coverage_samples(const ImageDesc& image, const GpuFeatures& features);

/// A pass's positions are those of its image's map; and more positions than samples go with forward shading
/// of one color image.
std::vector<Diagnostic> check_coverage_pass(const FrameGraph& graph, const Pass& pass);

/// Whether a view is named for an image that the pass reads: it shows its samples, without its coverage map.
bool shows_samples(const Pass& pass, ImageId id);

}  // namespace hwsim::pipeline
