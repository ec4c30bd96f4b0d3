#pragma once
// The ground truth: ray tracing of the same scene, camera, materials and lights as the emulated pipeline.
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "pipeline/image/image.h"
#include "pipeline/reference/reference_scene.h"

namespace hwsim::pipeline {

struct ReferenceOptions {
  int width = 0;
  int height = 0;
  int camera = 0;    ///< index into Scene::cameras
  int samples = 64;  ///< a pixel, Halton points (2,3) turned by another shift in each pixel
  /// Positions from the pixel's center, in pixels, x right, y down, the same in every pixel. Not empty:
  /// `samples` is ignored.
  std::vector<glm::vec2> offsets_px{};
  int jobs = 1;
  /// A sample brighter than this is clamped before samples are averaged; 1 is what a multisampled 8-bit
  /// target does.
  float largest_sample_value = std::numeric_limits<float>::infinity();
  float footprint_scale = 1.0f;  ///< factor on the derivatives for texture filtering; 1: a pixel
  /// The share of rows done, (0,1], from one thread at a time. An exception thrown here ends the rendering.
  std::function<void(double share)> progress{};
};

int sample_count(const ReferenceOptions& options);
/// Where the samples of a pixel are, in pixels from its center: inside [-0.5, 0.5).
std::vector<glm::vec2> sample_offsets(const ReferenceOptions& options, int x, int y);

/// What each sample sees, samples of a pixel together, pixels row by row from the top. Blended surfaces are
/// left out unless `with_blend`.
std::vector<Visibility> trace_visibility(const ReferenceScene& scene, const ReferenceOptions& options,
                                         bool with_blend = false);

/// Fills colors[i], linear, for hits[i]; alpha counts for materials of AlphaMode::blend alone. Called from
/// several threads at a time with some thousand hits.
using ShadeBatch = std::function<void(std::span<const SurfaceHit> hits, std::span<glm::vec4> colors)>;

/// The mean of all samples, over the scene's background. Blended surfaces are composed front to back. The
/// same bits for any number of jobs.
Image render_reference(const ReferenceScene& scene, const ReferenceOptions& options, const ShadeBatch& shade);

}  // namespace hwsim::pipeline
