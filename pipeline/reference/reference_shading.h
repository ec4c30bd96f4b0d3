#pragma once
// The ground truth shaded by the emulator's own templates (shade/surface-inl.h, shade/lighting-inl.h) on a
// scalar lane: what differs from an emulated frame is sampling, storage formats and, with rays in place of a
// shadow map, shadows; never the material.
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/image/image.h"
#include "pipeline/reference/reference_scene.h"
#include "pipeline/scene/scene.h"
#include "pipeline/shade/lighting.h"

namespace hwsim::pipeline {

struct GroundTruthOptions {
  int width = 0;     ///< px
  int height = 0;    ///< px
  int camera = 0;    ///< index into Scene::cameras
  int samples = 64;  ///< a pixel
  /// Positions from the pixel's center, in pixels, x right, y down, the same in every pixel. Not empty:
  /// `samples` is ignored.
  std::vector<glm::vec2> offsets_px{};
  /// Footprint for texture filtering, as a part of a pixel. 0: 1 / sqrt(samples), so that the samples'
  /// footprints together fill the pixel.
  float footprint_scale = 0.0f;
  int jobs = 1;
  bool shadows = true;  ///< the shadow-casting directional light has its shadows; no other light casts any
  /// Those of the frame that is compared. None: make_lighting.
  std::optional<LightingUniforms> lighting{};
  /// The frame's shadow map, depths in r, looked up by the frame's own shader as `lighting` says. Null: rays.
  std::shared_ptr<const Image> shadow_map{};
  std::function<void(double done_ratio)> progress{};  ///< (0, 1], one thread at a time
};

/// Alpha as shaders compute it, base color textures at their finest level. The scene must live as long.
AlphaLookup texture_alpha(const Scene& scene);

/// Linear, alpha 1. Samples are clamped to 1 before they are averaged, as in an 8-bit multisampled target.
/// Mask materials are cut out at their textures' finest level: alpha that is averaged before the test moves
/// outlines. Blend materials are composed by depth, so a frame that draws them out of order differs.
Image render_ground_truth(const Scene& scene, const GroundTruthOptions& options);

}  // namespace hwsim::pipeline
