#include "pipeline/generate/surface.h"

#include <cmath>

#include "pipeline/generate/exact_math.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec2;
using glm::dvec3;

double distance(const dvec3& a, const dvec3& b) {
  const dvec3 d = b - a;
  return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

std::uint32_t add_vertex(MeshSurface& s, const dvec3& position, const dvec3& normal, const dvec2& uv) {
  s.positions.emplace_back(position);
  s.normals.emplace_back(normal);
  s.uvs.emplace_back(uv);
  return static_cast<std::uint32_t>(s.positions.size() - 1);
}

// Quads between rows of a vertex grid that begins at `base`, with `columns` vertices a row.
void add_grid_indices(MeshSurface& s, std::uint32_t base, int rows, int columns, bool wrap_rows,
                      bool wrap_columns) {
  const int row_quads = wrap_rows ? rows : rows - 1, column_quads = wrap_columns ? columns : columns - 1;
  const auto at = [&](int r, int c) {
    return base + static_cast<std::uint32_t>((r % rows) * columns + c % columns);
  };
  for (int r = 0; r < row_quads; ++r)
    for (int c = 0; c < column_quads; ++c) {
      const std::uint32_t a = at(r, c), b = at(r, c + 1), d = at(r + 1, c), e = at(r + 1, c + 1);
      s.indices.insert(s.indices.end(), {a, b, e, a, e, d});
    }
}

struct Ring {
  dvec3 tangent, side, up;
};

// Frames carried along the path without turning about it (projecting the last side onto the next plane).
std::vector<Ring> rings_along(const std::vector<dvec3>& path) {
  std::vector<Ring> rings(path.size());
  dvec3 side(0.0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const dvec3 tangent = unit(path[i + 1 < path.size() ? i + 1 : i] - path[i > 0 ? i - 1 : i]);
    if (i == 0) side = std::abs(tangent.y) < 0.8 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    side = unit(side - tangent * glm::dot(side, tangent));
    rings[i] = {tangent, side, glm::cross(tangent, side)};
  }
  return rings;
}

dvec3 around(const Ring& ring, int i, int sides) {
  const double angle = 2.0 * kPi * i / sides;
  return ring.side * exact_cos(angle) + ring.up * exact_sin(angle);
}

void add_cap(MeshSurface& s, const dvec3& center, const Ring& ring, double radius, int sides,
             double direction) {
  const dvec3 normal = ring.tangent * direction;
  const std::uint32_t middle = add_vertex(s, center, normal, dvec2(0.5));
  for (int i = 0; i < sides; ++i) add_vertex(s, center + around(ring, i, sides) * radius, normal, dvec2(0.5));
  for (int i = 0; i < sides; ++i) {
    const std::uint32_t a = middle + 1 + static_cast<std::uint32_t>(i);
    const std::uint32_t b = middle + 1 + static_cast<std::uint32_t>((i + 1) % sides);
    s.indices.insert(s.indices.end(), {middle, direction > 0 ? a : b, direction > 0 ? b : a});
  }
}

}  // namespace

void add_quad(MeshSurface& s, const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d,
              double uv_per_m) {
  const dvec3 normal = unit(glm::cross(b - a, d - a));
  const double u = distance(a, b) * uv_per_m, v = distance(a, d) * uv_per_m;
  const std::uint32_t first = add_vertex(s, a, normal, {0, v});
  add_vertex(s, b, normal, {u, v});
  add_vertex(s, c, normal, {u, 0});
  add_vertex(s, d, normal, {0, 0});
  s.indices.insert(s.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
}

void add_triangle(MeshSurface& s, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 normal = unit(glm::cross(b - a, c - a));
  const std::uint32_t first = add_vertex(s, a, normal, {0, 1});
  add_vertex(s, b, normal, {1, 1});
  add_vertex(s, c, normal, {0.5, 0});
  s.indices.insert(s.indices.end(), {first, first + 1, first + 2});
}

void add_box(MeshSurface& s, const dvec3& l, const dvec3& h, double uv_per_m) {
  add_quad(s, {l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z}, uv_per_m);
  add_quad(s, {h.x, l.y, l.z}, {l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z}, uv_per_m);
  add_quad(s, {h.x, l.y, h.z}, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}, uv_per_m);
  add_quad(s, {l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z}, uv_per_m);
  add_quad(s, {l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z}, uv_per_m);
  add_quad(s, {l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z}, uv_per_m);
}

void add_panel(MeshSurface& s, const dvec3& corner, const dvec3& side_u, const dvec3& side_v, int nu, int nv,
               double uv_per_m) {
  const dvec3 normal = unit(glm::cross(side_u, side_v));
  const double length_u = distance(dvec3(0), side_u), length_v = distance(dvec3(0), side_v);
  const auto base = static_cast<std::uint32_t>(s.positions.size());
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) {
      const double u = static_cast<double>(i) / nu, v = static_cast<double>(j) / nv;
      add_vertex(s, corner + side_u * u + side_v * v, normal,
                 dvec2(u * length_u, (1 - v) * length_v) * uv_per_m);
    }
  add_grid_indices(s, base, nv + 1, nu + 1, false, false);
}

void add_tube(MeshSurface& s, const std::vector<dvec3>& path, double radius, int sides, bool caps) {
  const std::vector<Ring> rings = rings_along(path);
  const auto base = static_cast<std::uint32_t>(s.positions.size());
  for (std::size_t r = 0; r < path.size(); ++r)
    for (int i = 0; i < sides; ++i) {
      const dvec3 outward = around(rings[r], i, sides);
      add_vertex(s, path[r] + outward * radius, outward,
                 {static_cast<double>(i) / sides, static_cast<double>(r)});
    }
  add_grid_indices(s, base, static_cast<int>(path.size()), sides, false, true);
  if (!caps) return;
  add_cap(s, path.front(), rings.front(), radius, sides, -1.0);
  add_cap(s, path.back(), rings.back(), radius, sides, 1.0);
}

void add_wire(MeshSurface& s, const std::vector<dvec3>& path, double radius, int sides) {
  const std::vector<Ring> rings = rings_along(path);
  const auto base = static_cast<std::uint32_t>(s.positions.size());
  for (std::size_t r = 0; r < path.size(); ++r)
    for (int i = 0; i < sides; ++i) {
      add_vertex(s, path[r], around(rings[r], i, sides),
                 {static_cast<double>(i) / sides, static_cast<double>(r)});
      s.tangents.emplace_back(glm::vec3(rings[r].tangent), 1.0f);
      s.radius.push_back(static_cast<float>(radius));
    }
  add_grid_indices(s, base, static_cast<int>(path.size()), sides, false, true);
}

void add_lathe(MeshSurface& s, const dvec3& foot, const std::vector<dvec2>& profile, int sides) {
  const auto base = static_cast<std::uint32_t>(s.positions.size());
  for (std::size_t r = 0; r < profile.size(); ++r) {
    const dvec2 along = profile[r + 1 < profile.size() ? r + 1 : r] - profile[r > 0 ? r - 1 : r];
    for (int i = 0; i <= sides; ++i) {
      const double angle = -2.0 * kPi * (i % sides) / sides;  // downward: outside is counterclockwise
      const double x = exact_cos(angle), z = exact_sin(angle);
      add_vertex(s, foot + dvec3(x * profile[r].x, profile[r].y, z * profile[r].x),
                 unit({x * along.y, -along.x, z * along.y}), {2.0 * i / sides, profile[r].y});
    }
  }
  add_grid_indices(s, base, static_cast<int>(profile.size()), sides + 1, false, false);
}

void add_grid(MeshSurface& s, int nu, int nv, bool closed_u, bool closed_v,
              const std::function<dvec3(double, double)>& point) {
  const int columns = closed_u ? nu : nu + 1, rows = closed_v ? nv : nv + 1;
  const auto base = static_cast<std::uint32_t>(s.positions.size());
  const std::size_t first_index = s.indices.size();
  std::vector<dvec3> exact;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double u = static_cast<double>(i) / nu, v = static_cast<double>(j) / nv;
      exact.push_back(point(u, v));
      add_vertex(s, exact.back(), dvec3(0), {u, v});
    }
  add_grid_indices(s, base, rows, columns, closed_v, closed_u);
  std::vector<dvec3> sums(exact.size(), dvec3(0.0));
  for (std::size_t i = first_index; i < s.indices.size(); i += 3) {
    const std::uint32_t a = s.indices[i] - base, b = s.indices[i + 1] - base, c = s.indices[i + 2] - base;
    const dvec3 normal = glm::cross(exact[b] - exact[a], exact[c] - exact[a]);
    for (const std::uint32_t corner : {a, b, c}) sums[corner] += normal;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) s.normals[base + i] = glm::vec3(unit(sums[i]));
}

void add_turned(MeshSurface& s, const MeshSurface& part, double turn_rad, const dvec3& offset) {
  const double c = exact_cos(turn_rad), d = exact_sin(turn_rad);
  const auto turned = [&](const dvec3& v) { return dvec3(c * v.x + d * v.z, v.y, c * v.z - d * v.x); };
  const auto base = static_cast<std::uint32_t>(s.positions.size());
  for (const glm::vec3& p : part.positions) s.positions.emplace_back(turned(dvec3(p)) + offset);
  for (const glm::vec3& n : part.normals) s.normals.emplace_back(turned(dvec3(n)));
  s.uvs.insert(s.uvs.end(), part.uvs.begin(), part.uvs.end());
  for (const std::uint32_t i : part.indices) s.indices.push_back(base + i);
}

}  // namespace hwsim::pipeline::generate
