#include "pipeline/gltf/nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <optional>
#include <string>

namespace hwsim::pipeline::gltf {
namespace {

// An exporter's arithmetic leaves 0.9999999 where 1 is meant. More than that is a projection, which glTF has
// none of.
void make_affine(const Report& report, glm::dmat4& m, int node) {
  constexpr double kRounding = 1e-5;
  const glm::dvec4 row(m[0][3], m[1][3], m[2][3], m[3][3] - 1.0);
  for (int c = 0; c < 4; ++c) {
    const double column = std::max({1.0, std::abs(m[c][0]), std::abs(m[c][1]), std::abs(m[c][2])});
    if (!(std::abs(row[c]) <= kRounding * (c < 3 ? column : 1.0)))
      report.fail("S010",
                  element("nodes", static_cast<std::size_t>(node)) +
                      ".matrix is not affine: its last row must be 0 0 0 1",
                  "export the node with translation, rotation and scale, or an affine matrix");
    m[c][3] = c < 3 ? 0.0 : 1.0;
  }
}

glm::dmat4 local_matrix(const Report& report, const tinygltf::Node& node, int index) {
  glm::dmat4 m(1.0);
  if (node.matrix.size() == 16) {
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    make_affine(report, m, index);
    return m;
  }
  if (node.rotation.size() == 4) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (const double length = glm::length(q); length > 0.0) m = glm::mat4_cast(q / length);
  }
  for (int i = 0; i < 3; ++i) {
    const auto place = static_cast<std::size_t>(i);
    if (node.scale.size() == 3) m[i] *= node.scale[place];
    if (node.translation.size() == 3) m[3][i] = node.translation[place];
  }
  return m;
}

void check_matrix(const Report& report, const glm::dmat4& m, int node) {
  constexpr double kMax = 1e100;  // a product of three stays finite; what is drawn is looked at later
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!(std::abs(m[c][r]) <= kMax))
        report.fail("S010",
                    element("nodes", static_cast<std::size_t>(node)) +
                        "'s transformation is not finite or above 1e100",
                    "scale the scene down, or repair the node");
}

// Rotation and position without scale: a camera's or light's frame looks along -z.
struct Frame {
  glm::dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{0.0};
};

std::optional<Frame> frame_of(const glm::dmat4& m) {
  Frame f;
  f.origin = glm::dvec3(m[3]);
  // Tiny scales are as good as others: only their ratio counts.
  const glm::dmat3 linear(m);
  double largest = 0.0;
  for (int i = 0; i < 9; ++i) largest = std::max(largest, std::abs(linear[i / 3][i % 3]));
  if (!(largest > 0.0)) return std::nullopt;
  const double unit = largest < 1e-6 || largest > 1e6 ? 1.0 / largest : 1.0;
  const glm::dvec3 z = linear[2] * unit, y = linear[1] * unit;
  const glm::dvec3 x = glm::cross(y, z);
  if (!(glm::dot(z, z) > 1e-30) || !(glm::dot(x, x) > 1e-60)) return std::nullopt;
  f.z = glm::normalize(z);
  f.x = glm::normalize(x);
  f.y = glm::cross(f.z, f.x);
  return f;
}

glm::mat4 view_of(const Frame& f) {
  glm::dmat4 view(1.0);
  for (int i = 0; i < 3; ++i) {
    view[i][0] = f.x[i];
    view[i][1] = f.y[i];
    view[i][2] = f.z[i];
  }
  view[3] = glm::dvec4(-glm::dot(f.x, f.origin), -glm::dot(f.y, f.origin), -glm::dot(f.z, f.origin), 1.0);
  return glm::mat4(view);
}

constexpr double kBrightest = 1e30;

/// Values that no light has are brought into range, and said.
void note_odd_values(Report& report, const tinygltf::Light& light, const std::string& where, double unit) {
  const bool below_zero = light.intensity < 0.0 || std::any_of(light.color.begin(), light.color.end(),
                                                               [](double channel) { return channel < 0.0; });
  if (below_zero) report.warn("S113", "lights of less than nothing give none", where);
  if (light.intensity * unit > kBrightest)
    report.warn("S113", "lights beyond a float's range give less than they say", where);
  if (light.range < 0.0) report.warn("S113", "lights whose range is below zero reach everywhere", where);
  const tinygltf::SpotLight& cone = light.spot;
  const bool in_order = cone.innerConeAngle >= 0.0 && cone.innerConeAngle < cone.outerConeAngle &&
                        cone.outerConeAngle <= std::numbers::pi / 2 + 1e-6;
  if (light.type == "spot" && !in_order)
    report.warn("S113", "spot lights get an outer angle of at most a quarter turn, and an inner one below it",
                where);
}

std::optional<Light> light_of(Report& report, const tinygltf::Light& source, const Frame& frame,
                              const std::string& where, double units_per_m) {
  Light light;
  if (source.type == "directional") {
    light.kind = LightKind::directional;
  } else if (source.type == "point") {
    light.kind = LightKind::point;
  } else if (source.type == "spot") {
    light.kind = LightKind::spot;
  } else {
    report.warn("S113", "lights of an unknown type are left out", where);
    return std::nullopt;
  }
  // What arrives falls with the square of the distance, which grows with the units.
  const double unit = light.kind == LightKind::directional ? 1.0 : units_per_m * units_per_m;
  note_odd_values(report, source, where, unit);
  for (std::size_t i = 0; i < 3; ++i) {
    const double color = (i < source.color.size() ? source.color[i] : 1.0) * source.intensity;
    light.color[static_cast<int>(i)] = static_cast<float>(std::clamp(color * unit, 0.0, kBrightest));
  }
  light.position = glm::vec3(frame.origin);
  light.direction = glm::vec3(-frame.z);
  light.range_m = static_cast<float>(std::clamp(source.range * units_per_m, 0.0, 1e18));
  const double outer = std::clamp(source.spot.outerConeAngle, 1e-3, std::numbers::pi / 2);
  light.outer_cone_rad = static_cast<float>(outer);
  light.inner_cone_rad = static_cast<float>(std::clamp(source.spot.innerConeAngle, 0.0, outer * 0.999));
  return light;
}

/// Nothing where the camera's lengths leave float's range beside the scene's size. A far plane out there is
/// as good as one at the range's end.
std::optional<Camera> camera_of(const CameraSpec& source, const Frame& frame, double units_per_m) {
  constexpr double kLeast = 1e-30, kMost = 1e15, kFarthest = 1e18;
  const auto fits = [&](double length, double least) {
    return length * units_per_m >= least && length * units_per_m <= kMost;
  };
  if (!fits(source.near, source.orthographic ? 0.0 : kLeast) ||
      (source.orthographic &&
       !(fits(source.half_height, kLeast) && fits(source.half_height * source.aspect_ratio, kLeast))))
    return std::nullopt;
  Camera camera;
  camera.view_from_world = view_of(frame);
  camera.orthographic = source.orthographic;
  if (source.orthographic)
    camera.ortho_half_height_m = static_cast<float>(source.half_height * units_per_m);
  else
    camera.fov_y_rad = static_cast<float>(source.fov_y_rad);
  camera.aspect_ratio = static_cast<float>(source.aspect_ratio);
  camera.near_m = static_cast<float>(source.near * units_per_m);
  camera.far_m = static_cast<float>(std::min(source.far * units_per_m, kFarthest));
  return camera;
}

}  // namespace

std::vector<PlacedNode> walk_scene(Report& report, const tinygltf::Model& model) {
  const bool chosen = model.defaultScene >= 0;
  if (!chosen && model.scenes.size() > 1)
    report.note("S114", "the file has several scenes and names none: the first is drawn");
  const tinygltf::Scene& scene = model.scenes[chosen ? static_cast<std::size_t>(model.defaultScene) : 0];
  std::vector<PlacedNode> placed, stack;
  std::vector<bool> seen(model.nodes.size(), false);
  const auto push = [&](const std::vector<int>& children, const glm::dmat4& parent) {
    for (auto child = children.rbegin(); child != children.rend(); ++child) stack.push_back({*child, parent});
  };
  push(scene.nodes, glm::dmat4(1.0));
  // A stack of its own, not recursion: chains of nodes may be as long as the file.
  while (!stack.empty()) {
    PlacedNode next = stack.back();
    stack.pop_back();
    const auto index = static_cast<std::size_t>(next.node);
    if (seen[index])
      report.fail(
          "S011",
          element("nodes", index) + " is reached twice: the nodes form a cycle, or it has two parents",
          "glTF nodes must form trees; to draw a mesh twice, let two nodes refer to it");
    seen[index] = true;
    next.world_from_local = next.world_from_local * local_matrix(report, model.nodes[index], next.node);
    check_matrix(report, next.world_from_local, next.node);
    push(model.nodes[index].children, next.world_from_local);
    placed.push_back(next);
  }
  return placed;
}

glm::dmat4 matrix_above_meshes(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes) {
  std::vector<std::size_t> meshes(model.nodes.size(), 0);  // at and below each node
  std::size_t all = 0;
  for (auto placed = nodes.rbegin(); placed != nodes.rend(); ++placed) {  // children first
    const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(placed->node)];
    std::size_t& count = meshes[static_cast<std::size_t>(placed->node)];
    if (node.mesh >= 0) ++count, ++all;
    for (const int child : node.children) count += meshes[static_cast<std::size_t>(child)];
  }
  glm::dmat4 lowest(1.0);
  for (const PlacedNode& placed : nodes)
    if (all > 0 && meshes[static_cast<std::size_t>(placed.node)] == all &&
        model.nodes[static_cast<std::size_t>(placed.node)].mesh < 0)
      lowest = placed.world_from_local;
  return lowest;
}

std::vector<Light> build_lights(Report& report, const tinygltf::Model& model,
                                const std::vector<PlacedNode>& nodes, double units_per_m) {
  std::vector<Light> out;
  bool shadow_given = false;
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(placed.node)];
    const auto extension = node.extensions.find("KHR_lights_punctual");
    if (extension == node.extensions.end() || !extension->second.Has("light")) continue;
    const int index = extension->second.Get("light").GetNumberAsInt();
    if (index < 0 || static_cast<std::size_t>(index) >= model.lights.size()) continue;
    const std::string where = element("nodes", static_cast<std::size_t>(placed.node));
    // A point light has no direction: any frame will do.
    std::optional<Frame> frame = frame_of(placed.world_from_local);
    if (!frame) {
      report.warn("S113", "a light's node has a scale of zero: its direction is set to -z", where);
      frame = Frame{};
      frame->origin = glm::dvec3(placed.world_from_local[3]);
    }
    auto light = light_of(report, model.lights[static_cast<std::size_t>(index)], *frame, where, units_per_m);
    if (!light) continue;
    light->casts_shadow = light->kind == LightKind::directional && !shadow_given;
    shadow_given = shadow_given || light->casts_shadow;
    const std::string& own = model.lights[static_cast<std::size_t>(index)].name;
    light->name = !node.name.empty() ? node.name : !own.empty() ? own : where;
    out.push_back(std::move(*light));
  }
  return out;
}

std::vector<Camera> build_cameras(Report& report, const tinygltf::Model& model,
                                  const std::vector<CameraSpec>& specs, const std::vector<PlacedNode>& nodes,
                                  double units_per_m) {
  std::vector<Camera> out;
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(placed.node)];
    if (node.camera < 0) continue;
    const auto index = static_cast<std::size_t>(node.camera);
    const CameraSpec& spec = specs[index];
    if (!spec.fault.empty()) {
      report.warn("S115", "a camera is left out: " + spec.fault, element("cameras", index));
      continue;
    }
    const std::optional<Frame> frame = frame_of(placed.world_from_local);
    if (!frame) {
      report.warn("S115", "cameras on a node with a scale of zero are left out",
                  element("nodes", static_cast<std::size_t>(placed.node)));
      continue;
    }
    std::optional<Camera> camera = camera_of(spec, *frame, units_per_m);
    if (!camera) {
      report.warn("S115",
                  "a camera is left out: its planes or its height are beyond a float's range beside "
                  "the scene's size",
                  element("cameras", index));
      continue;
    }
    if (!spec.remark.empty()) report.warn("S115", spec.remark, element("cameras", index));
    out.push_back(std::move(*camera));
    out.back().name = !node.name.empty()   ? node.name
                      : !spec.name.empty() ? spec.name
                                           : element("cameras", index);
  }
  return out;
}

}  // namespace hwsim::pipeline::gltf
