#pragma once
// Filters of a finished image (techniques 7). Images between filters hold perceptual color: sRGB codes in
// rgba8_srgb or rgba8_unorm, read and presented by whichever of the two views a pass needs.
#include "algos/base/technique.h"

namespace hwsim::algos {

std::span<const TechniqueInfo> post_filters();

pipeline::ImageId add_fxaa(pipeline::FrameGraph& graph, pipeline::ImageId input,
                           const Parameters& parameters);
pipeline::ImageId add_axaa(pipeline::FrameGraph& graph, pipeline::ImageId input,
                           const Parameters& parameters);
pipeline::ImageId add_smaa(pipeline::FrameGraph& graph, pipeline::ImageId input,
                           const Parameters& parameters);
pipeline::ImageId add_cmaa(pipeline::FrameGraph& graph, pipeline::ImageId input,
                           const Parameters& parameters);
pipeline::ImageId add_mlaa(pipeline::FrameGraph& graph, pipeline::ImageId input,
                           const Parameters& parameters);

}  // namespace hwsim::algos
