#pragma once
// Full-screen programs of supersampling.
#include "pipeline/batch/program.h"
#include "pipeline/batch/uniforms.h"

namespace hwsim::algos {

struct DownsampleUniforms {
  int factor = 1;  ///< source pixels a target pixel, each axis
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(pipeline::ContentDigest& digest, const DownsampleUniforms& uniforms) {
  const auto& [factor] = uniforms;
  digest.add(factor);
}
/// Box mean of factor x factor pixels of image slot 0, in linear light.
const pipeline::FragmentProgram& downsample_program();

struct MergeUniforms {
  int samples = 1;  ///< samples of all layers together
};
/// Mean of all samples of image slot 0, layer by layer: the resolve of a multicast target.
const pipeline::FragmentProgram& merge_program();

struct ScaleUniforms {
  float scale = 1.0f;
};
/// Image slot 0 times a constant: accumulation (with additive blending) and its normalization.
const pipeline::FragmentProgram& scale_program();

}  // namespace hwsim::algos
