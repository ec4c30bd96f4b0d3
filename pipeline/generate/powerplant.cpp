// Pipes, beams and railings in many thin, long pieces: a stand-in for CAD models of plants. The defaults hold
// the shaded samples of SBAA's POWERPLANT (Table 3).
#include <algorithm>
#include <cmath>

#include "pipeline/generate/exact_math.h"
#include "pipeline/generate/registry.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

struct Plant {
  double width = 30.0, depth = 20.0, level_height = 4.0;
  int levels = 3;
};

enum LookIndex { kSteel, kPipe, kHotPipe, kRail, kConcrete, kTank };

void add_beam(MeshSurface& s, const dvec3& low, const dvec3& size, double flange) {
  // Two flanges and a web, along the longest side.
  const bool vertical = size.y > size.x && size.y > size.z;
  const dvec3 high = low + size;
  const double t = flange * 0.15;
  if (vertical) {
    add_box(s, low, {high.x, high.y, low.z + t});
    add_box(s, {low.x, low.y, high.z - t}, high);
    add_box(s, {0.5 * (low.x + high.x - t), low.y, low.z + t},
            {0.5 * (low.x + high.x + t), high.y, high.z - t});
    return;
  }
  const bool along_x = size.x > size.z;
  add_box(s, low, {high.x, low.y + t, high.z});
  add_box(s, {low.x, high.y - t, low.z}, high);
  if (along_x)
    add_box(s, {low.x, low.y + t, 0.5 * (low.z + high.z - t)},
            {high.x, high.y - t, 0.5 * (low.z + high.z + t)});
  else
    add_box(s, {0.5 * (low.x + high.x - t), low.y + t, low.z},
            {0.5 * (low.x + high.x + t), high.y - t, high.z});
}

void add_frame(MeshSurface& s, const Plant& plant) {
  constexpr double kBay = 5.0, kSize = 0.3;
  for (double x = 0; x <= plant.width; x += kBay)
    for (double z = 0; z <= plant.depth; z += kBay)
      add_beam(s, {x, 0, z}, {kSize, plant.levels * plant.level_height, kSize}, kSize);
  for (int level = 1; level <= plant.levels; ++level) {
    const double y = level * plant.level_height - kSize;
    for (double z = 0; z <= plant.depth; z += kBay)
      add_beam(s, {0, y, z}, {plant.width, kSize, kSize}, kSize);
    for (double x = 0; x <= plant.width; x += kBay)
      add_beam(s, {x, y, 0}, {kSize, kSize, plant.depth}, kSize);
  }
}

void add_grating(MeshSurface& s, const Plant& plant, int level, double pitch) {
  const double y = level * plant.level_height, z0 = 0.35 * plant.depth;
  for (double x = 0; x < plant.width; x += pitch)
    add_box(s, {x, y, z0}, {x + 0.008, y + 0.03, z0 + 0.15 * plant.depth});
}

void add_railing(MeshSurface& s, const Plant& plant, int level) {
  const double y = level * plant.level_height;
  for (const double z : {0.35 * plant.depth, 0.5 * plant.depth}) {
    for (const double height : {0.4, 0.75, 1.1})
      add_tube(s, {{0, y + height, z}, {plant.width, y + height, z}}, 0.018, 8, true);
    for (double x = 0; x <= plant.width; x += 1.25) add_tube(s, {{x, y, z}, {x, y + 1.1, z}}, 0.02, 8, true);
  }
}

dvec3 axis_vector(int axis, double length) {
  dvec3 v(0.0);
  v[axis] = length;
  return v;
}

// A walk of axis-parallel runs joined by rounded elbows, kept inside the building.
std::vector<dvec3> pipe_path(Pcg& random, const Plant& plant, int runs, double bend) {
  const dvec3 high(plant.width, plant.levels * plant.level_height, plant.depth);
  dvec3 at{random.uniform(0, high.x), random.uniform(0.3, high.y),
           random.uniform(0, high.z)};  // braces: in this order
  std::vector<dvec3> path = {at};
  int axis = random.below(3);
  dvec3 direction(0.0);
  for (int run = 0; run < runs; ++run) {
    const dvec3 old_direction = direction;
    direction = axis_vector(axis, at[axis] > 0.5 * high[axis] ? -1.0 : 1.0);
    if (run > 0)
      for (int step = 1; step <= 6; ++step) {  // a quarter circle
        const double angle = 0.5 * kPi * step / 6;
        path.push_back(at + old_direction * (bend * exact_sin(angle)) +
                       direction * (bend * (1.0 - exact_cos(angle))));
      }
    at = path.back() + direction * random.uniform(0.5, 0.45 * high[axis]);
    path.push_back(at);
    axis = (axis + 1 + random.below(2)) % 3;
  }
  return path;
}

void add_pipes(Model& model, Pcg& random, const Plant& plant, const Parameters& p) {
  for (int i = 0; i < p.count("pipes"); ++i) {
    const double radius = random.uniform(0.02, 0.16);
    const bool hot = random.below(4) == 0;
    MeshSurface& s = model.pieces[hot ? kHotPipe : kPipe].surface;
    const std::vector<dvec3> path = pipe_path(random, plant, 2 + random.below(5), 2.0 * radius);
    add_tube(s, path, radius, p.count("sides"), true);
    add_tube(s, {path.front(), path.front() + unit(path[1] - path[0]) * 0.04}, radius * 1.5, p.count("sides"),
             true);
  }
}

void add_tanks(MeshSurface& s, Pcg& random, const Plant& plant, int sides) {
  for (int i = 0; i < 5; ++i) {
    const double radius = random.uniform(0.8, 1.4), height = random.uniform(2.0, 3.4);
    std::vector<glm::dvec2> profile = {{radius, 0.0}, {radius, height}};
    for (int step = 1; step <= 10; ++step) {
      const double angle = 0.5 * kPi * step / 10;
      profile.push_back({radius * exact_cos(angle), height + 0.4 * radius * exact_sin(angle)});
    }
    add_lathe(s, {3.0 + 6.0 * i, 0.0, 0.75 * plant.depth + random.uniform(-1, 1)}, profile, 3 * sides);
  }
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  Plant plant;
  plant.levels = p.count("levels");
  Blueprint out;
  out.looks = {{.name = "steel", .color = {0.35, 0.37, 0.4}, .roughness = 0.5},
               {.name = "pipe", .color = {0.6, 0.62, 0.65}, .metallic = 0.8, .roughness = 0.35},
               {.name = "hot pipe", .color = {0.6, 0.2, 0.1}, .roughness = 0.5},
               {.name = "railing", .color = {0.8, 0.65, 0.1}, .roughness = 0.5},
               {.name = "concrete", .color = {0.45, 0.44, 0.42}, .roughness = 1.0},
               {.name = "tank", .color = {0.75, 0.76, 0.78}, .metallic = 0.6, .roughness = 0.3}};
  Model model{"plant", {}};
  for (int look = kSteel; look <= kTank; ++look) model.pieces.push_back({MeshSurface{}, look});
  add_panel(model.pieces[kConcrete].surface, {-10, 0, plant.depth + 20}, {plant.width + 20, 0, 0},
            {0, 0, -plant.depth - 30}, 30, 30);
  add_frame(model.pieces[kSteel].surface, plant);
  for (int level = 1; level <= plant.levels; ++level) {
    add_grating(model.pieces[kSteel].surface, plant, level, p.number("grating_m"));
    add_railing(model.pieces[kRail].surface, plant, level);
  }
  add_pipes(model, random, plant, p);
  add_tanks(model.pieces[kTank].surface, random, plant, p.count("sides"));
  out.models.push_back(std::move(model));
  out.placements.push_back({});
  out.eye = {plant.width * 0.25, 6.2, plant.depth + 9.0};
  out.target = {plant.width * 0.55, 5.0, plant.depth * 0.4};
  out.fov_y_rad = p.fov_y_rad();
  return out;
}

}  // namespace

Generator powerplant() {
  return {{"powerplant",
           "pipes, beams, gratings and railings: thin, long triangles",
           {{"pipes", 400, 0, 10000, "number of pipes"},
            {"sides", 16, 3, 64, "sides of a pipe's cross-section"},
            {"levels", 3, 1, 20, "levels of the steel frame"},
            {"grating_m", 0.05, 0.01, 5, "pitch of the gratings' bars in meters"},
            fov_parameter(20),
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
