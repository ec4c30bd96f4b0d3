#include "algos/reference_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "algos/frame_parts.h"
#include "pipeline/emulate/fragment_batch.h"
#include "pipeline/emulate/material_views.h"
#include "pipeline/reference/reference.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

/// Varyings of one hit as a quad sees them: lane 0 is the hit, lane 1 its right and lane 2 its lower
/// neighbor. The "vertices" are the values at these three, so barycentrics (0,0), (1,0), (0,1) give them back
/// exactly.
struct QuadVaryings {
  std::array<std::array<float, SurfaceVaryings::kFull>, 3> at{};
};

QuadVaryings varyings_of(const SurfaceHit& hit) {
  using V = SurfaceVaryings;
  QuadVaryings quad;
  auto& v = quad.at[0];
  const glm::vec3 normal = hit.front_face ? hit.normal : -hit.normal;  // the shader turns it around again
  for (int i = 0; i < 3; ++i) {
    v[static_cast<std::size_t>(V::kNormal + i)] = normal[i];
    v[static_cast<std::size_t>(V::kPosition + i)] = hit.position[i];
  }
  for (int i = 0; i < 4; ++i) {
    v[static_cast<std::size_t>(V::kTangent + i)] = hit.tangent[i];
    v[static_cast<std::size_t>(V::kColor + i)] = hit.color[i];
  }
  for (int i = 0; i < 2; ++i) v[static_cast<std::size_t>(V::kUv0 + i)] = hit.uv0[i];
  quad.at[1] = quad.at[2] = v;
  for (int i = 0; i < 2; ++i) {
    quad.at[1][static_cast<std::size_t>(V::kUv0 + i)] += hit.uv0_dx[i];
    quad.at[2][static_cast<std::size_t>(V::kUv0 + i)] += hit.uv0_dy[i];
  }
  return quad;
}

/// Runs fragment programs on points that no rasterizer produced.
class PointShader {
 public:
  PointShader(const MaterialView& material, const FragmentProgram& program, const void* uniforms)
      : program_(program), uniforms_(uniforms), batch_(std::make_unique<FragmentBatch>()) {
    batch_->material = &material;
    batch_->resources = &resources_;
    batch_->sample_index = -1;
    batch_->coverage.fill(1u);
    batch_->pixel_x.fill(0);
    batch_->pixel_y.fill(0);
    batch_->b1.fill(0.0f);
    batch_->b2.fill(0.0f);
    for (std::size_t lane = 0; lane < kBatchLanes; ++lane) {
      batch_->b1_center[lane] = lane % 4 == 1 || lane % 4 == 3 ? 1.0f : 0.0f;
      batch_->b2_center[lane] = lane % 4 >= 2 ? 1.0f : 0.0f;
    }
  }

  /// At most kBatchQuads points; their colors are in lane 4 i of the batch that is returned.
  const FragmentBatch& run(std::span<const QuadVaryings> points, std::span<const bool> front_facing) {
    FragmentBatch& b = *batch_;
    b.quad_count = static_cast<int>(points.size());
    b.valid_lanes = 0;
    b.active_lanes = 0;
    b.discarded_lanes = 0;
    b.blocks.used = 0;
    for (std::size_t q = 0; q < points.size(); ++q) {
      for (std::size_t vertex = 0; vertex < 3; ++vertex) b.varyings[vertex][q] = points[q].at[vertex].data();
      b.triangle[q] = &triangles_[q];  // distinct: no two quads share their vertices
      b.primitive[q] = 0;
      b.front_facing[q] = front_facing[q];
      b.quad_x[q] = b.quad_y[q] = 0;
      b.valid_lanes |= std::uint64_t{0xf} << (4 * q);  // three helpers, for the derivatives
      b.active_lanes |= std::uint64_t{1} << (4 * q);
    }
    program_.run(b, uniforms_);
    return b;
  }

 private:
  const FragmentProgram& program_;
  const void* uniforms_;
  std::unique_ptr<FragmentBatch> batch_;
  ResourceView resources_;
  std::array<RasterTriangle, kBatchQuads> triangles_{};
};

class ReferenceFrame {
 public:
  explicit ReferenceFrame(const FrameRequest& request)
      : request_(request),
        textures_(*request.scene),
        graph_(request.scene, request.width_px, request.height_px) {
    FrameRequest without_map = request;
    without_map.shadows = false;
    const FrameParts parts = prepare_frame(graph_, without_map);
    lit_ = {parts.lighting, parts.full_varyings};
    shadowed_ = lit_;
    for (DirectionalLight& light : shadowed_.lighting.directional)
      if (light.shadowed) {
        to_caster_ = light.to_light;
        has_caster_ = request.shadows;
        light.color = glm::vec3(0.0f);
      }
    const bool colors = std::any_of(request.scene->meshes.begin(), request.scene->meshes.end(),
                                    [](const Mesh& mesh) { return !mesh.colors.empty(); });
    int index = 0;
    for (const Material& material : request.scene->materials) {
      materials_.push_back(make_material_view(material, index++, textures_));
      materials_.back().has_colors = colors;
    }
  }

  Image render(const ReferenceFrameOptions& options) {
    const ReferenceScene scene(
        *request_.scene, [this](const AlphaQuery& query) { return alpha(query); }, options.jobs);
    ReferenceOptions how;
    how.width = request_.width_px;
    how.height = request_.height_px;
    how.camera = request_.camera;
    how.samples = options.samples;
    how.jobs = options.jobs;
    how.largest_sample_value = 1.0f;  // as each sample of an 8-bit target
    // A sample stands for its share of the pixel, in textures too: mip levels chosen for whole pixels would
    // blur twice.
    how.footprint_scale = 1.0f / std::sqrt(static_cast<float>(options.samples));
    how.progress = options.progress;
    return render_reference(scene, how, [&](std::span<const SurfaceHit> hits, std::span<glm::vec4> colors) {
      shade(scene, hits, colors);
    });
  }

 private:
  /// 1 where the alpha test passes, by the alpha-test program itself; the finest mip level, as a ray has no
  /// footprint.
  float alpha(const AlphaQuery& query) const {
    QuadVaryings point;
    for (auto& vertex : point.at) vertex[0] = query.uv0.x, vertex[1] = query.uv0.y;
    const AlphaTestUniforms none;
    PointShader shader(materials_[static_cast<std::size_t>(query.material)], alpha_test_program(), &none);
    const bool front = true;
    return (shader.run({&point, 1}, {&front, 1}).discarded_lanes & 1u) != 0 ? 0.0f : 1.0f;
  }

  bool in_shadow(const ReferenceScene& scene, const SurfaceHit& hit) const {
    return has_caster_ && dot(hit.normal, to_caster_) > 0.0f && !scene.sees_sky(hit.position, to_caster_);
  }

  /// Hits of one material, in or out of the shadow, run together.
  void shade(const ReferenceScene& scene, std::span<const SurfaceHit> hits,
             std::span<glm::vec4> colors) const {
    std::vector<std::vector<std::uint32_t>> groups(2 * materials_.size());
    for (std::uint32_t i = 0; i < hits.size(); ++i)
      groups[2 * static_cast<std::size_t>(hits[i].material) + (in_shadow(scene, hits[i]) ? 1 : 0)].push_back(
          i);
    for (std::size_t group = 0; group < groups.size(); ++group)
      if (!groups[group].empty()) shade_group(group, groups[group], hits, colors);
  }

  void shade_group(std::size_t group, const std::vector<std::uint32_t>& members,
                   std::span<const SurfaceHit> hits, std::span<glm::vec4> colors) const {
    const ForwardUniforms& uniforms = group % 2 == 0 ? lit_ : shadowed_;
    PointShader shader(materials_[group / 2], forward_program(uniforms.full_varyings, false), &uniforms);
    std::array<QuadVaryings, kBatchQuads> points;
    std::array<bool, kBatchQuads> front{};
    for (std::size_t first = 0; first < members.size(); first += kBatchQuads) {
      const std::size_t count = std::min<std::size_t>(kBatchQuads, members.size() - first);
      for (std::size_t q = 0; q < count; ++q) {
        points[q] = varyings_of(hits[members[first + q]]);
        front[q] = hits[members[first + q]].front_face;
      }
      const FragmentBatch& batch = shader.run({points.data(), count}, {front.data(), count});
      for (std::size_t q = 0; q < count; ++q)
        colors[members[first + q]] = {batch.color[0][0][4 * q], batch.color[0][1][4 * q],
                                      batch.color[0][2][4 * q], batch.color[0][3][4 * q]};
    }
  }

  const FrameRequest& request_;
  TextureStore textures_;
  FrameGraph graph_;  // prepare_frame adds to one; it is not run
  ForwardUniforms lit_, shadowed_;
  glm::vec3 to_caster_{0.0f, 1.0f, 0.0f};
  bool has_caster_ = false;
  std::vector<MaterialView> materials_;
};

}  // namespace

Image render_reference_frame(const FrameRequest& request, const ReferenceFrameOptions& options) {
  return ReferenceFrame(request).render(options);
}

}  // namespace hwsim::algos
