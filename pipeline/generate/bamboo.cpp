// A stand-in for the Bamboo scene of the AGAA paper: a grove of jointed culms with geometric leaves.
#include <algorithm>
#include <cmath>

#include "pipeline/generate/plants.h"
#include "pipeline/generate/registry.h"
#include "pipeline/generate/textures.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

constexpr int kCulmModels = 6;
enum LookIndex { kSoil, kCulm, kOldCulm, kLeaf, kYellowLeaf };

struct Culm {
  double height, radius, lean_x, lean_z;
  int joints;
};

dvec3 axis_at(const Culm& culm, double t) {
  return {culm.lean_x * t * t, culm.height * t * (1.0 - 0.06 * t), culm.lean_z * t * t};
}

double radius_at(const Culm& culm, double t) { return culm.radius * (1.0 - 0.75 * t); }

// Joints swell; between them the culm is a straight pipe.
void add_culm(MeshSurface& s, const Culm& culm, int sides) {
  constexpr double kRing[] = {0.0, 0.03, 0.06, 0.09, 0.5};
  constexpr double kSwell[] = {1.0, 1.16, 1.02, 0.97, 0.98};
  const int rows = 5 * culm.joints;
  add_grid(s, sides, rows, true, false, [&](double u, double v) {
    const int row = std::min(static_cast<int>(v * rows + 0.5), rows);
    const double t = (row / 5 + (row == rows ? 0.0 : kRing[row % 5])) / culm.joints;
    const double r = radius_at(culm, t) * (row == rows ? 0.5 : kSwell[row % 5]), turn = -2 * kPi * u;
    return axis_at(culm, t) + dvec3(r * exact_cos(turn), 0.0, r * exact_sin(turn));
  });
}

// A lance-shaped blade, folded along its rib: four triangles.
void add_leaf(MeshSurface& s, const dvec3& foot, const dvec3& along, const dvec3& across, double fold) {
  const dvec3 down = unit(glm::cross(along, across)) * fold;
  const dvec3 middle = foot + along * 0.4, tip = foot + along;
  for (const double side : {-1.0, 1.0}) {
    const dvec3 edge = middle + across * (0.5 * side) + down;
    if (side > 0) {
      add_triangle(s, foot, edge, middle);
      add_triangle(s, middle, edge, tip);
    } else {
      add_triangle(s, foot, middle, edge);
      add_triangle(s, middle, tip, edge);
    }
  }
}

// Twigs leave the joints of the upper part in turn to both sides and carry leaves in fans.
void add_leaves(Model& model, Pcg& random, const Culm& culm, int leaves, int sides) {
  MeshSurface& wood = model.pieces[0].surface;
  const int first = culm.joints / 4, fans = std::max(1, leaves / 5);
  for (int fan = 0; fan < fans; ++fan) {
    const double t = (first + random.below(culm.joints - first) + 0.02) / culm.joints;
    const double turn = random.uniform(0.0, 2 * kPi);
    const dvec3 out{exact_cos(turn), random.uniform(0.1, 0.7), exact_sin(turn)};
    const double length = culm.height * random.uniform(0.03, 0.13) * (1.3 - t);
    const dvec3 start = axis_at(culm, t), end = start + unit(out) * length - dvec3(0, 0.15 * length, 0);
    if (fan % 2 == 0)
      add_tube(wood, {start, (start + end) * 0.5 + dvec3(0, 0.06 * length, 0), end}, 0.004,
               std::max(3, sides / 3), false);
    for (int i = 0; i < 5; ++i) {
      const dvec3 way = unit(unit(end - start) + random_direction(random) * 0.9 + dvec3(0, -0.5, 0));
      const dvec3 across = unit(glm::cross(way, random_direction(random)));
      const double size = random.uniform(0.12, 0.26);
      MeshSurface& s = model.pieces[random.below(12) == 0 ? 2 : 1].surface;
      add_leaf(s, end - unit(end - start) * (0.03 * i), way * size, across * (0.13 * size), 0.02 * size);
    }
  }
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const double side = p.number("side_m");
  const int sides = p.count("sides");
  Blueprint out;
  out.textures = {mottled_png(random, 128, {0.34, 0.27, 0.15}, 0.4)};
  out.looks = {{.name = "soil", .color = {1, 1, 1}, .roughness = 1.0, .texture = 0},
               {.name = "culm", .color = {0.24, 0.42, 0.12}, .roughness = 0.4},
               {.name = "old culm", .color = {0.5, 0.45, 0.2}, .roughness = 0.45},
               {.name = "leaf", .color = {0.2, 0.45, 0.08}, .roughness = 0.5, .double_sided = true},
               {.name = "yellow leaf", .color = {0.6, 0.55, 0.12}, .roughness = 0.55, .double_sided = true}};
  Model ground{"ground", {{MeshSurface{}, kSoil}, {MeshSurface{}, kYellowLeaf}}};
  add_panel(ground.pieces[0].surface, {-side, 0, side}, {2 * side, 0, 0}, {0, 0, -2 * side}, 40, 40, 0.4);
  for (int i = 0; i < p.count("fallen_leaves"); ++i) {
    const dvec3 at{random.uniform(-0.5, 0.5) * side, 0.012, random.uniform(-0.5, 0.5) * side};
    const double turn = random.uniform(0.0, 2 * kPi);
    const dvec3 along(0.16 * exact_cos(turn), random.uniform(-0.02, 0.04), 0.16 * exact_sin(turn));
    add_leaf(ground.pieces[1].surface, at, along, unit(glm::cross(dvec3(0, 1, 0), along)) * 0.022, 0.003);
  }
  out.models.push_back(std::move(ground));
  for (int i = 0; i < kCulmModels; ++i) {
    const Culm culm{random.uniform(7.0, 11.0), random.uniform(0.035, 0.06), random.uniform(-0.7, 0.7),
                    random.uniform(-0.7, 0.7), 20 + random.below(8)};
    Model model{
        "culm",
        {{MeshSurface{}, i == 0 ? kOldCulm : kCulm}, {MeshSurface{}, kLeaf}, {MeshSurface{}, kYellowLeaf}}};
    add_culm(model.pieces[0].surface, culm, sides);
    add_leaves(model, random, culm, p.count("leaves"), sides);
    out.models.push_back(std::move(model));
  }
  out.placements.push_back({});
  for (int i = 0; i < p.count("culms"); ++i) {
    const double z = random.uniform(-0.5, 0.42) * side, x = random.uniform(-0.5, 0.5) * side;
    const double clear = 0.5 + 0.06 * (0.5 * side - z);  // a way in, that narrows
    out.placements.push_back({1 + random.below(kCulmModels),
                              {x < 0 ? x - clear : x + clear, 0.0, z},
                              random.uniform(0.0, 2 * kPi),
                              random.uniform(0.75, 1.15)});
  }
  out.eye = {0.2, 1.65, 0.5 * side};
  out.target = {0.0, 2.1, 0.0};
  out.sun_direction = {-0.5, -1.0, -0.3};
  return out;
}

}  // namespace

Generator bamboo() {
  return {{"bamboo",
           "grove of jointed culms with geometric leaves",
           {{"culms", 210, 1, 20000, "number of culms"},
            {"leaves", 800, 5, 100000, "leaves of a culm, four triangles each"},
            {"fallen_leaves", 6000, 0, 1000000, "leaves on the ground"},
            {"sides", 10, 3, 64, "sides of a culm's cross-section"},
            {"side_m", 20, 5, 500, "side of the square grove in meters"},
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
