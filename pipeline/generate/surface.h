#pragma once
// Triangles under construction, and the shapes that the generators are made of. Lengths in meters.
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace hwsim::pipeline::generate {

struct MeshSurface {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  std::vector<glm::vec4> tangents;  ///< wires only
  std::vector<float> radius;        ///< wires only
  std::vector<std::uint32_t> indices;
};

/// Corners counterclockwise seen from outside; texture coordinates in meters times uv_per_m.
void add_quad(MeshSurface& s, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
              const glm::dvec3& d, double uv_per_m = 1.0);

void add_triangle(MeshSurface& s, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

void add_box(MeshSurface& s, const glm::dvec3& low, const glm::dvec3& high, double uv_per_m = 1.0);

/// A flat rectangle at `corner` spanned by two sides, cut into nu x nv quads (dense floors and walls).
void add_panel(MeshSurface& s, const glm::dvec3& corner, const glm::dvec3& side_u, const glm::dvec3& side_v,
               int nu, int nv, double uv_per_m = 1.0);

/// A round pipe along a path, `sides` around, smooth normals, closed by flat caps if wanted.
void add_tube(MeshSurface& s, const std::vector<glm::dvec3>& path, double radius, int sides, bool caps);

/// The same as a wire: positions on the center line, outward normals, the axis as tangent, and _HWSIM_RADIUS.
void add_wire(MeshSurface& s, const std::vector<glm::dvec3>& path, double radius, int sides);

/// A profile of (radius, height) turned around the y axis through `foot`.
void add_lathe(MeshSurface& s, const glm::dvec3& foot, const std::vector<glm::dvec2>& profile, int sides);

/// point(u, v) on a grid of nu x nv quads over [0,1]^2 with smooth normals from the triangles around a
/// vertex; closed directions are joined.
void add_grid(MeshSurface& s, int nu, int nv, bool closed_u, bool closed_v,
              const std::function<glm::dvec3(double u, double v)>& point);

/// A copy of `part`, turned about the y axis as Placement does, then moved.
void add_turned(MeshSurface& s, const MeshSurface& part, double turn_rad, const glm::dvec3& offset);

}  // namespace hwsim::pipeline::generate
