#pragma once
// The draws of wire anti-aliasing within a frame.
#include "algos/base/frame_parts.h"
#include "algos/wire/options.h"
#include "algos/wire/shaders/wire.h"

namespace hwsim::algos {

/// The opaque parts of a scene that have a radius, drawn over lit color by wire from the farthest to the
/// nearest: blending needs the order.
class WireDraws : public SeparateDraws {
 public:
  explicit WireDraws(const WireOptions& options);

  bool takes(const pipeline::Mesh& mesh, const pipeline::Material& material) const override;
  SeparateCall prepare(const FrameRequest& request, const pipeline::Camera& camera,
                       pipeline::DrawCall call) const override;
  std::string pass_name() const override { return "wires"; }
  std::vector<pipeline::DrawBatch> batches(const FrameParts& parts,
                                           const ForwardTarget& target) const override;
  /// At the width with which they are drawn.
  pipeline::DrawBatch depth_batch(const FrameParts& parts, const ForwardTarget& target) const override;
  /// With normals bent as they are for lighting=flatten: what a G-buffer takes of the soft lighting.
  pipeline::DrawBatch opaque_batch(const FrameParts& parts, SurfaceInputs inputs) const override;

 private:
  WireVertexUniforms vertex_uniforms(const FrameParts& parts, const ForwardTarget& target) const;
  pipeline::DrawBatch batch(const FrameParts& parts, const ForwardTarget& target, WirePart part) const;

  WireLook look_;
  bool soft_;  ///< thin wires are lit in some softer form
  WireDepth depth_;
};

}  // namespace hwsim::algos
