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
  pipeline::DrawCall prepare(const pipeline::Scene& scene, const pipeline::Camera& camera,
                             pipeline::DrawCall call) const override;
  std::string pass_name() const override { return "wires"; }
  std::vector<pipeline::DrawBatch> batches(const FrameParts& parts,
                                           const ForwardTarget& target) const override;
  /// At the width with which they are drawn.
  pipeline::DrawBatch depth_batch(const FrameParts& parts, const ForwardTarget& target) const override;

 private:
  pipeline::DrawBatch batch(const FrameParts& parts, const ForwardTarget& target, WirePart part) const;

  WireLook look_;
  WireDepth depth_;
};

}  // namespace hwsim::algos
