#include "pipeline/gltf/vertices.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hwsim::pipeline::gltf {
namespace {

// In double: a product of two edges of 1e-30 m, or of 1e30 m, leaves float's range.
glm::dvec3 face_normal(const Vertices& v, const std::uint32_t* corner) {
  const glm::dvec3 a(v.positions[corner[0]]), b(v.positions[corner[1]]), c(v.positions[corner[2]]);
  return glm::cross(b - a, c - a);
}

bool normalize_into(const glm::dvec3& vector, glm::vec3& out) {
  const double length = std::sqrt(glm::dot(vector, vector));
  if (!(length > 0.0) || !std::isfinite(length)) return false;
  out = glm::vec3(vector / length);
  return true;
}

template <class T>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& indices) {
  if (values.empty()) return;
  std::vector<T> out(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) out[i] = values[indices[i]];
  values = std::move(out);
}

void gather_all(Vertices& v, const std::vector<std::uint32_t>& indices) {
  gather(v.positions, indices);
  gather(v.normals, indices);
  gather(v.tangents, indices);
  gather(v.colors, indices);
  gather(v.uv0, indices);
  gather(v.uv1, indices);
  gather(v.radius, indices);
}

glm::vec3 any_perpendicular(const glm::vec3& normal) {
  const glm::vec3 axis = std::abs(normal.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return glm::normalize(glm::cross(normal, axis));
}

double corner_angle(const glm::dvec3& to_next, const glm::dvec3& to_previous) {
  const double lengths = std::sqrt(glm::dot(to_next, to_next) * glm::dot(to_previous, to_previous));
  return lengths > 0.0 ? std::acos(std::clamp(glm::dot(to_next, to_previous) / lengths, -1.0, 1.0)) : 0.0;
}

struct TangentSum {
  glm::dvec3 direction{0.0};
  double handedness = 0.0;
};

void add_triangle_tangent(const Vertices& v, const std::vector<glm::vec2>& uv, const std::uint32_t* corner,
                          std::vector<TangentSum>& sums) {
  const glm::dvec3 e1(glm::dvec3(v.positions[corner[1]]) - glm::dvec3(v.positions[corner[0]]));
  const glm::dvec3 e2(glm::dvec3(v.positions[corner[2]]) - glm::dvec3(v.positions[corner[0]]));
  const glm::dvec2 d1(glm::dvec2(uv[corner[1]]) - glm::dvec2(uv[corner[0]]));
  const glm::dvec2 d2(glm::dvec2(uv[corner[2]]) - glm::dvec2(uv[corner[0]]));
  const double area = d1.x * d2.y - d2.x * d1.y;
  if (area == 0.0) return;
  const double sign = area > 0.0 ? 1.0 : -1.0;
  glm::vec3 tangent;
  if (!normalize_into((e1 * d2.y - e2 * d1.y) * sign, tangent)) return;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 here(v.positions[corner[i]]);
    const double weight = corner_angle(glm::dvec3(v.positions[corner[(i + 1) % 3]]) - here,
                                       glm::dvec3(v.positions[corner[(i + 2) % 3]]) - here);
    sums[corner[i]].direction += glm::dvec3(tangent) * weight;
    sums[corner[i]].handedness += sign * weight;
  }
}

glm::vec4 orthogonal_tangent(const glm::vec3& normal, const glm::dvec3& direction, double handedness) {
  const glm::dvec3 n(normal);
  glm::vec3 tangent;
  const glm::dvec3 projected = direction - n * glm::dot(n, direction);
  if (glm::dot(projected, projected) <= 1e-12 * glm::dot(direction, direction) ||
      !normalize_into(projected, tangent))
    tangent = any_perpendicular(normal);
  return glm::vec4(tangent, handedness < 0.0 ? -1.0f : 1.0f);
}

// Old vertices without the attribute, new ones without it: neutral values, only if either side has it.
template <class T>
void append_attribute(std::vector<T>& to, std::vector<T> from, std::size_t old_count, std::size_t added,
                      const T& neutral) {
  if (to.empty() && from.empty()) return;
  if (old_count == 0) {
    to = std::move(from);
    to.resize(added, neutral);
    return;
  }
  to.resize(old_count, neutral);
  to.insert(to.end(), from.begin(), from.end());
  to.resize(old_count + added, neutral);
}

}  // namespace

void split_flat(Vertices& v, std::vector<std::uint32_t>& indices) {
  std::vector<glm::vec3> normals(indices.size(), glm::vec3(0, 1, 0));
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    if (normalize_into(face_normal(v, &indices[i]), normals[i])) normals[i + 1] = normals[i + 2] = normals[i];
  v.tangents.clear();
  gather_all(v, indices);
  v.normals = std::move(normals);
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i);
}

void keep_used(Vertices& v, std::vector<std::uint32_t>& indices) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> place(v.positions.size(), kUnused), used;
  for (const std::uint32_t index : indices) place[index] = 0;
  for (std::uint32_t i = 0; i < place.size(); ++i) {
    if (place[i] == kUnused) continue;
    place[i] = static_cast<std::uint32_t>(used.size());
    used.push_back(i);
  }
  gather_all(v, used);
  for (std::uint32_t& index : indices) index = place[index];
}

std::size_t repair_normals(Vertices& v, const std::vector<std::uint32_t>& indices) {
  std::size_t wrong = 0;
  std::vector<std::uint32_t> zero;
  for (std::size_t i = 0; i < v.normals.size(); ++i) {
    const glm::dvec3 normal(v.normals[i]);
    const double length = std::sqrt(glm::dot(normal, normal));
    if (!(std::abs(length - 1.0) <= 0.01)) ++wrong;
    // Lengths within rounding stay as they are: a file's own bits are the better ones.
    if (std::abs(length - 1.0) > 1e-6 && !normalize_into(normal, v.normals[i]))
      zero.push_back(static_cast<std::uint32_t>(i));
  }
  if (zero.empty()) return wrong;
  std::vector<glm::dvec3> sums(v.normals.size(), glm::dvec3(0.0));
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) sums[indices[i + k]] += face_normal(v, &indices[i]);
  for (const std::uint32_t i : zero)
    if (!normalize_into(sums[i], v.normals[i])) v.normals[i] = glm::vec3(0, 1, 0);
  return wrong;
}

std::size_t repair_tangents(Vertices& v) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < v.tangents.size(); ++i) {
    glm::vec4& tangent = v.tangents[i];
    const glm::dvec3 direction(tangent.x, tangent.y, tangent.z);
    const double length = std::sqrt(glm::dot(direction, direction));
    if (std::abs(length - 1.0) <= 0.01 && std::abs(tangent.w) == 1.0f) {
      tangent = glm::vec4(glm::vec3(direction / length), tangent.w);
    } else {
      ++wrong;
      tangent = orthogonal_tangent(v.normals[i], direction, tangent.w);
    }
  }
  return wrong;
}

void generate_tangents(Vertices& v, const std::vector<std::uint32_t>& indices, int uv_set) {
  const std::vector<glm::vec2>& uv = uv_set == 1 ? v.uv1 : v.uv0;
  std::vector<TangentSum> sums(v.positions.size());
  for (std::size_t i = 0; i + 2 < indices.size() && !uv.empty(); i += 3)
    add_triangle_tangent(v, uv, &indices[i], sums);
  v.tangents.resize(v.positions.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
    v.tangents[i] = orthogonal_tangent(v.normals[i], sums[i].direction, sums[i].handedness);
}

void append_vertices(Mesh& mesh, Vertices v) {
  const std::size_t old_count = mesh.positions.size(), added = v.positions.size();
  append_attribute(mesh.positions, std::move(v.positions), old_count, added, glm::vec3(0.0f));
  append_attribute(mesh.normals, std::move(v.normals), old_count, added, glm::vec3(0, 1, 0));
  append_attribute(mesh.tangents, std::move(v.tangents), old_count, added, glm::vec4(1, 0, 0, 1));
  append_attribute(mesh.uv0, std::move(v.uv0), old_count, added, glm::vec2(0.0f));
  append_attribute(mesh.uv1, std::move(v.uv1), old_count, added, glm::vec2(0.0f));
  append_attribute(mesh.colors, std::move(v.colors), old_count, added, glm::vec4(1.0f));
  append_attribute(mesh.radius, std::move(v.radius), old_count, added, 0.0f);
}

}  // namespace hwsim::pipeline::gltf
