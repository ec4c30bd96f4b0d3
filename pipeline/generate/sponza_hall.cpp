// A stand-in for Sponza: an open court between colonnades on two floors, with arches, curtains and brick
// walls. The defaults hold the shaded samples of SBAA's SPONZA (Table 3).
#include <algorithm>
#include <cmath>

#include "pipeline/generate/exact_math.h"
#include "pipeline/generate/registry.h"
#include "pipeline/generate/textures.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec2;
using glm::dvec3;

constexpr double kBay = 3.0, kCourtHalf = 3.0, kAisle = 2.8, kFloorHeight = 5.0, kUpperHeight = 4.0;
constexpr double kColumnRadius = 0.3, kWall = 0.6;
enum LookIndex { kFloorLook, kBrickLook, kStoneLook, kRedCloth, kGreenCloth, kBlueCloth };
enum ModelIndex {
  kShellModel,
  kColumnModel,
  kArchModel,
  kUpperArchModel,
  kBalusterModel,
  kCurtainModel,
  kCurtainModels = 2
};

Model column_model(int detail) {
  std::vector<dvec2> profile = {{0.42, 0.0}, {0.42, 0.15}, {0.36, 0.2}, {0.38, 0.27}, {kColumnRadius, 0.32}};
  for (int i = 1; i <= detail; ++i) {  // the shaft swells a little (entasis)
    const double t = static_cast<double>(i) / detail;
    profile.push_back({kColumnRadius * (1.0 - 0.15 * t * t), 0.32 + 2.4 * t});
  }
  for (const dvec2 p :
       {dvec2(0.28, 2.76), dvec2(0.28, 2.82), dvec2(0.34, 2.9), dvec2(0.42, 3.0), dvec2(0.42, 3.1)})
    profile.push_back(p);
  Model out{"column", {{MeshSurface{}, kStoneLook}}};
  add_lathe(out.pieces[0].surface, {}, profile, 2 * detail);
  return out;
}

// Between two columns, along x, from height 3.1: half a ring, and the wall above it up to `top`.
Model arch_model(int detail, double top) {
  Model out{"arch", {{MeshSurface{}, kStoneLook}, {MeshSurface{}, kBrickLook}}};
  constexpr double kSpring = 3.1, kRadius = 0.5 * kBay - kColumnRadius, kHalf = 0.5 * kBay;
  const double apex = std::min(top - kSpring - 0.05, kRadius);
  const auto on_arch = [&](int i) {
    const double angle = kPi * i / (2 * detail);
    return dvec3(-kRadius * exact_cos(angle), kSpring + apex * exact_sin(angle), 0.0);
  };
  for (int i = 0; i < 2 * detail; ++i) {
    const dvec3 a = on_arch(i), b = on_arch(i + 1), front(0, 0, kWall / 2);
    const auto at_top = [&](const dvec3& p) { return dvec3(p.x, top, p.z); };
    add_quad(out.pieces[0].surface, a - front, b - front, b + front, a + front);
    add_quad(out.pieces[1].surface, a + front, b + front, at_top(b) + front, at_top(a) + front, 0.5);
    add_quad(out.pieces[1].surface, b - front, a - front, at_top(a) - front, at_top(b) - front, 0.5);
  }
  for (const double side : {-1.0, 1.0})
    add_box(out.pieces[1].surface, {std::min(side * kRadius, side * kHalf), kSpring, -kWall / 2},
            {std::max(side * kRadius, side * kHalf), top, kWall / 2}, 0.5);
  return out;
}

Model baluster_model(int detail) {
  std::vector<dvec2> profile;
  for (int i = 0; i <= detail; ++i) {
    const double t = static_cast<double>(i) / detail;
    profile.push_back({0.05 + 0.025 * exact_sin(2.0 * kPi * t + 4.4), 0.8 * t});
  }
  Model out{"baluster", {{MeshSurface{}, kStoneLook}}};
  add_lathe(out.pieces[0].surface, {}, profile, std::max(6, detail));
  return out;
}

Model curtain_model(int detail, int look, double phase) {
  Model out{"curtain", {{MeshSurface{}, look}}};
  const double width = kBay - 2.2 * kColumnRadius;
  add_grid(out.pieces[0].surface, 3 * detail, 4 * detail, false, false, [&](double u, double v) {
    const double folds = exact_sin(2.0 * kPi * 6.0 * u + phase + 0.7 * exact_sin(3.0 * v + phase));
    return dvec3((u - 0.5) * width, 0.8 + 2.9 * v, (0.04 + 0.09 * (1.0 - v)) * folds);
  });
  return out;
}

// Floors, outer walls and cornices; x runs from 0 to the hall's length, the court lies between z = -3 and 3.
Model shell_model(int bays, int detail) {
  Model out{"shell", {{MeshSurface{}, kFloorLook}, {MeshSurface{}, kBrickLook}, {MeshSurface{}, kStoneLook}}};
  MeshSurface &floor = out.pieces[0].surface, &brick = out.pieces[1].surface, &stone = out.pieces[2].surface;
  const double length = bays * kBay, outer = kCourtHalf + kAisle, height = kFloorHeight + kUpperHeight;
  add_panel(floor, {0, 0, outer}, {length, 0, 0}, {0, 0, -2 * outer}, bays * detail, 4 * detail, 0.5);
  for (const double side : {-1.0, 1.0}) {
    const dvec3 along(side * length, 0, 0);  // so that the walls face the court
    const dvec3 corner(side > 0 ? 0 : length, 0, -side * outer);
    add_panel(brick, corner, along, {0, height, 0}, bays * detail, 3 * detail, 0.5);
    const double z0 = side > 0 ? kCourtHalf - kWall / 2 : -outer,
                 z1 = side > 0 ? outer : -kCourtHalf + kWall / 2;
    add_box(stone, {0, kFloorHeight - 0.25, z0}, {length, kFloorHeight, z1});
    add_box(stone, {0, height - 0.2, z0}, {length, height, z1});
    const double rail = side * (kCourtHalf - 0.1);
    add_box(stone, {0, kFloorHeight + 0.8, rail - 0.09}, {length, kFloorHeight + 0.9, rail + 0.09});
  }
  add_panel(brick, {0, 0, outer}, {0, 0, -2 * outer}, {0, height, 0}, 4 * detail, 3 * detail, 0.5);
  add_panel(brick, {length, 0, -outer}, {0, 0, 2 * outer}, {0, height, 0}, 4 * detail, 3 * detail, 0.5);
  return out;
}

void place_side(Blueprint& out, Pcg& random, int bays, double z, int balusters) {
  for (int bay = 0; bay <= bays; ++bay)
    for (const double floor : {0.0, kFloorHeight})
      out.placements.push_back({kColumnModel, {bay * kBay, floor, z}, 0.0});
  for (int bay = 0; bay < bays; ++bay) {
    const double middle = (bay + 0.5) * kBay;
    out.placements.push_back({kArchModel, {middle, 0, z}, 0.0});
    out.placements.push_back({kUpperArchModel, {middle, kFloorHeight, z}, 0.0});
    if (random.below(3) != 0)
      out.placements.push_back({kCurtainModel + random.below(kCurtainModels), {middle, 0, z}, 0.0});
    for (int i = 0; i < balusters; ++i)
      out.placements.push_back(
          {kBalusterModel,
           {bay * kBay + kBay * (i + 0.5) / balusters, kFloorHeight, z > 0 ? z - 0.1 : z + 0.1},
           0.0});
  }
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const int bays = p.count("bays"), detail = p.count("detail");
  Blueprint out;
  out.textures = {checker_png(random, 128), brick_png(random, 128)};
  out.looks = {{.name = "floor", .color = {1, 1, 1}, .roughness = 0.4, .texture = 0},
               {.name = "brick", .color = {1, 1, 1}, .roughness = 0.9, .texture = 1},
               {.name = "stone", .color = {0.66, 0.61, 0.52}, .roughness = 0.8},
               {.name = "red cloth", .color = {0.5, 0.06, 0.05}, .roughness = 0.9, .double_sided = true},
               {.name = "green cloth", .color = {0.08, 0.3, 0.1}, .roughness = 0.9, .double_sided = true},
               {.name = "blue cloth", .color = {0.06, 0.12, 0.4}, .roughness = 0.9, .double_sided = true}};
  out.models = {shell_model(bays, detail), column_model(detail), arch_model(detail, kFloorHeight - 0.25),
                arch_model(detail, kUpperHeight - 0.2), baluster_model(std::max(3, detail / 2))};
  const int first_cloth = random.below(3);
  for (int i = 0; i < kCurtainModels; ++i)
    out.models.push_back(curtain_model(detail, kRedCloth + (first_cloth + i) % 3, random.uniform(0, 6)));
  out.placements.push_back({kShellModel, {}, 0.0});
  for (const double z : {-kCourtHalf, kCourtHalf}) place_side(out, random, bays, z, p.count("balusters"));
  out.eye = {1.2, 1.8, 0.8};
  out.target = {bays * kBay, 3.0, -0.6};
  out.sun_direction = {0.35, -1.0, 0.28};
  out.fov_y_rad = p.fov_y_rad();
  return out;
}

}  // namespace

Generator sponza_hall() {
  return {{"sponza_hall",
           "court between two-storey colonnades with arches, curtains and textured walls",
           {{"bays", 20, 1, 200, "bays along the hall, 3 m each"},
            {"detail", 16, 3, 100, "segments of round and cloth parts"},
            {"balusters", 18, 0, 30, "balusters in a bay of the upper floor"},
            fov_parameter(30),
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
