#include "pipeline/reference/reference_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/parallel.h"
#include "pipeline/emulate/material_views.h"
#include "pipeline/reference/interpolate.h"

namespace hwsim::pipeline {
namespace {

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceRelease>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, SceneRelease>;

// What the filter of a part's geometry needs; its address is the geometry's user data.
struct PartData {
  const Mesh* mesh = nullptr;
  const Material* material = nullptr;
  const AlphaLookup* alpha = nullptr;
  int material_index = 0;
  std::uint32_t first_primitive = 0;
  bool turned_around = false;  ///< triangles in world space, of a mirrored instance
};

enum class RayKind { camera, camera_without_blend, shadow };

// Embree hands the context to the filter; it must be the first member.
struct Context {
  RTCIntersectContext embree;
  RayKind kind;
};

bool passes_mask(const PartData& part, std::uint32_t primitive, float u, float v) {
  const TriangleWeights weights = triangle_weights(*part.mesh, primitive, u, v);
  AlphaQuery query{.material = part.material_index};
  query.uv0 = interpolate(part.mesh->uv0, weights, glm::vec2(0.0f));
  query.uv1 = interpolate(part.mesh->uv1, weights, glm::vec2(0.0f));
  query.vertex_alpha = interpolate(part.mesh->colors, weights, glm::vec4(1.0f)).w;
  return (*part.alpha)(query) < part.material->alpha_cutoff;
}

// Embree's geometric normal and the filter's ray are in the mesh's space.
bool is_front(const RTCRay& ray, const RTCHit& hit, bool turned_around) {
  const float along = ray.dir_x * hit.Ng_x + ray.dir_y * hit.Ng_y + ray.dir_z * hit.Ng_z;
  return turned_around ? along > 0.0f : along < 0.0f;
}

void filter(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  const auto& part = *static_cast<const PartData*>(args->geometryUserPtr);
  const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);
  const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
  const RayKind kind = reinterpret_cast<const Context*>(args->context)->kind;
  const Material& material = *part.material;
  const bool blended = material.alpha_mode == AlphaMode::blend && kind != RayKind::camera;
  const bool culled =
      !material.double_sided && kind != RayKind::shadow && !is_front(ray, hit, part.turned_around);
  if (blended || culled ||
      (material.alpha_mode == AlphaMode::mask &&
       passes_mask(part, part.first_primitive + hit.primID, hit.u, hit.v)))
    args->valid[0] = 0;
}

RTCRay embree_ray(const Ray& ray) {
  RTCRay r{};
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = ray.t_min, r.tfar = ray.t_max;
  r.mask = 0xFFFFFFFFu;
  return r;
}

// Embree brings rays into the mesh's space: that takes an inverse, and room for both in a float.
bool can_be_instanced(const glm::mat4& matrix) {
  const glm::mat3 linear(matrix);
  const float determinant = glm::determinant(linear);
  if (!std::isnormal(determinant) || !std::isnormal(1.0f / determinant)) return false;
  const glm::mat3 inverse = glm::inverse(linear);
  constexpr float kLargest = 1e6f;
  for (int i = 0; i < 9; ++i)
    if (!(std::abs(linear[i / 3][i % 3]) < kLargest) || !(std::abs(inverse[i / 3][i % 3]) < kLargest))
      return false;
  return true;
}

std::vector<glm::vec3> world_positions(const Mesh& mesh, const glm::mat4& world_from_local) {
  std::vector<glm::vec3> out;
  out.reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) out.emplace_back(world_from_local * glm::vec4(p, 1.0f));
  return out;
}

}  // namespace

struct ReferenceScene::Impl {
  const Scene& scene;
  AlphaLookup alpha;
  Device device;
  std::vector<std::vector<PartData>> parts;  // by mesh
  std::vector<EmbreeScene> meshes;
  /// Instances whose triangles were brought to world space once: flattened ones, and scales beyond Embree's.
  std::vector<std::vector<PartData>> world_parts;  // by instance; empty: drawn by its mesh's scene
  std::vector<EmbreeScene> world_meshes;
  EmbreeScene top;
  std::vector<glm::mat3> world_normal_from_local;  // by instance
  float shadow_offset_m = 0.0f;

  Impl(const Scene& s, AlphaLookup lookup, int jobs);
  EmbreeScene new_scene() const;
  EmbreeScene build(const Mesh& mesh, const std::vector<glm::vec3>& positions, bool turned_around,
                    std::vector<PartData>& parts) const;
  void attach_part(RTCScene target, RTCBuffer vertices, const Mesh& mesh, PartData& data,
                   std::size_t part) const;
  void build_top();
  void attach_instance(std::size_t index);
  bool unoccluded(glm::vec3 from, glm::vec3 direction, float t_max) const;
};

ReferenceScene::Impl::Impl(const Scene& s, AlphaLookup lookup, int jobs)
    : scene(s), alpha(std::move(lookup)), device(rtcNewDevice("isa=sse4.2")) {
  if (!device)
    throw std::runtime_error("Embree cannot start: error " + std::to_string(rtcGetDeviceError(nullptr)));
  if (!alpha)
    alpha = [&materials = scene.materials](const AlphaQuery& query) {
      return materials[static_cast<std::size_t>(query.material)].base_color.w * query.vertex_alpha;
    };
  parts.resize(scene.meshes.size());
  meshes.resize(scene.meshes.size());
  parallel_for(scene.meshes.size(), jobs, [this](std::size_t i, int) {
    meshes[i] = build(scene.meshes[i], scene.meshes[i].positions, false, parts[i]);
  });
  build_top();
  if (const RTCError error = rtcGetDeviceError(device.get()); error != RTC_ERROR_NONE)
    throw std::runtime_error(error == RTC_ERROR_OUT_OF_MEMORY ? "Embree: out of memory"
                                                              : "Embree: error " + std::to_string(error));
}

EmbreeScene ReferenceScene::Impl::new_scene() const {
  EmbreeScene created(rtcNewScene(device.get()));
  rtcSetSceneFlags(created.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(created.get(), RTC_BUILD_QUALITY_MEDIUM);
  return created;
}

// Vertices are copied: Embree reads four bytes past the last one.
EmbreeScene ReferenceScene::Impl::build(const Mesh& mesh, const std::vector<glm::vec3>& positions,
                                        bool turned_around, std::vector<PartData>& data) const {
  EmbreeScene built = new_scene();
  RTCBuffer vertices = rtcNewBuffer(device.get(), positions.size() * sizeof(glm::vec3) + 16);
  if (!vertices) throw std::runtime_error("Embree: out of memory");
  std::copy(positions.begin(), positions.end(), static_cast<glm::vec3*>(rtcGetBufferData(vertices)));
  data.resize(mesh.parts.size());
  for (std::size_t part = 0; part < mesh.parts.size(); ++part) {
    data[part].turned_around = turned_around;
    attach_part(built.get(), vertices, mesh, data[part], part);
  }
  rtcReleaseBuffer(vertices);
  rtcCommitScene(built.get());
  return built;
}

void ReferenceScene::Impl::attach_part(RTCScene target, RTCBuffer vertices, const Mesh& mesh, PartData& data,
                                       std::size_t part_index) const {
  const Mesh::Part& part = mesh.parts[part_index];
  const Material& material = scene.materials[static_cast<std::size_t>(part.material)];
  data = {&mesh, &material, &alpha, part.material, part.first_index / 3, data.turned_around};
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices, 0, sizeof(glm::vec3),
                       mesh.positions.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(std::uint32_t), part.index_count / 3);
  if (indices && part.index_count > 0)
    std::copy_n(mesh.indices.begin() + part.first_index, part.index_count,
                static_cast<std::uint32_t*>(indices));
  rtcSetGeometryUserData(geometry, &data);
  const bool needs_filter = !material.double_sided || material.alpha_mode != AlphaMode::opaque;
  if (needs_filter) {
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryOccludedFilterFunction(geometry, filter);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(target, geometry, static_cast<unsigned>(part_index));
  rtcReleaseGeometry(geometry);
}

void ReferenceScene::Impl::attach_instance(std::size_t i) {
  const Instance& instance = scene.instances[i];
  const auto mesh = static_cast<std::size_t>(instance.mesh);
  const bool instanced = can_be_instanced(instance.world_from_local);
  static const glm::mat4 kIdentity(1.0f);
  if (instanced) {
    world_normal_from_local[i] = glm::transpose(glm::inverse(glm::mat3(instance.world_from_local)));
  } else {
    world_normal_from_local[i] = normal_from_local(instance.world_from_local);
    world_meshes[i] =
        build(scene.meshes[mesh], world_positions(scene.meshes[mesh], instance.world_from_local),
              is_mirrored(instance.world_from_local), world_parts[i]);
  }
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, instanced ? meshes[mesh].get() : world_meshes[i].get());
  const glm::mat4& matrix = instanced ? instance.world_from_local : kIdentity;
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &matrix[0][0]);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(top.get(), geometry, static_cast<unsigned>(i));
  rtcReleaseGeometry(geometry);
}

void ReferenceScene::Impl::build_top() {
  top = new_scene();
  world_normal_from_local.resize(scene.instances.size());
  world_parts.resize(scene.instances.size());
  world_meshes.resize(scene.instances.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) attach_instance(i);
  rtcCommitScene(top.get());
  RTCBounds bounds{};
  rtcGetSceneBounds(top.get(), &bounds);
  const glm::vec3 extent(bounds.upper_x - bounds.lower_x, bounds.upper_y - bounds.lower_y,
                         bounds.upper_z - bounds.lower_z);
  // Hit points are off their surface by about 1e-6 of the scene; ten times that is invisible.
  if (const float diagonal_m = glm::length(extent); std::isfinite(diagonal_m))
    shadow_offset_m = 1e-5f * diagonal_m;
}

ReferenceScene::ReferenceScene(const Scene& scene, AlphaLookup alpha, int jobs)
    : impl_(std::make_unique<Impl>(scene, std::move(alpha), jobs)) {}
ReferenceScene::~ReferenceScene() = default;

const Scene& ReferenceScene::scene() const { return impl_->scene; }

Visibility ReferenceScene::trace(const Ray& ray, bool with_blend) const {
  Context context{{}, with_blend ? RayKind::camera : RayKind::camera_without_blend};
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRayHit query{};
  query.ray = embree_ray(ray);
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->top.get(), &context.embree, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  Visibility hit;
  hit.instance = query.hit.instID[0];
  hit.part = query.hit.geomID;
  const Instance& instance = impl_->scene.instances[hit.instance];
  const std::vector<PartData>& own = impl_->world_parts[hit.instance];
  const PartData& part =
      own.empty() ? impl_->parts[static_cast<std::size_t>(instance.mesh)][hit.part] : own[hit.part];
  hit.primitive = part.first_primitive + query.hit.primID;
  hit.t = query.ray.tfar;
  hit.u = query.hit.u;
  hit.v = query.hit.v;
  const glm::vec3 face(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
  const glm::vec3 normal = own.empty()          ? impl_->world_normal_from_local[hit.instance] * face
                           : part.turned_around ? -face
                                                : face;
  hit.front_face = glm::dot(ray.direction, normal) < 0.0f;
  return hit;
}

SurfaceHit ReferenceScene::surface(const Visibility& hit, const PixelRay& pixel) const {
  return interpolate_surface(impl_->scene, hit, pixel, impl_->world_normal_from_local[hit.instance]);
}

bool ReferenceScene::Impl::unoccluded(glm::vec3 from, glm::vec3 direction, float t_max) const {
  const float largest = std::max({std::abs(from.x), std::abs(from.y), std::abs(from.z)});
  const float offset_m = shadow_offset_m + 4.0f * std::numeric_limits<float>::epsilon() * largest;
  Context context{{}, RayKind::shadow};
  rtcInitIntersectContext(&context.embree);
  const float offset_t = offset_m / glm::length(direction);
  RTCRay ray = embree_ray({from, direction, offset_t, t_max - offset_t});
  if (!(ray.tfar > ray.tnear)) return true;
  rtcOccluded1(top.get(), &context.embree, &ray);
  return ray.tfar >= 0.0f;  // Embree answers "occluded" with minus infinity
}

bool ReferenceScene::visible(glm::vec3 from, glm::vec3 to) const {
  return impl_->unoccluded(from, to - from, 1.0f);
}

bool ReferenceScene::sees_sky(glm::vec3 from, glm::vec3 direction) const {
  return impl_->unoccluded(from, direction, std::numeric_limits<float>::infinity());
}

}  // namespace hwsim::pipeline
