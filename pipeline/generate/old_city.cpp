// A stand-in for AGAA's Old City: a street with thin railings, furniture in front of cafes, and trees of
// alpha-tested leaves.
#include <algorithm>

#include "pipeline/generate/house.h"
#include "pipeline/generate/ironwork.h"
#include "pipeline/generate/plants.h"
#include "pipeline/generate/registry.h"
#include "pipeline/generate/textures.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

constexpr double kStreetHalf = 5.5, kWalk = 2.8;
constexpr int kHouseModels = 6, kTreeModels = 3;
enum LookIndex {
  kPlaster,  // three tones
  kStone = kPlaster + 3,
  kPaving,
  kGreenWood,
  kBrownWood,
  kGlass,
  kIron,
  kRoof,
  kRedCloth,
  kCreamCloth,
  kBark,
  kLeaves,
  kLamp
};
enum TextureIndex { kPlasterTexture, kPavingTexture = 3, kBarkTexture, kLeafTexture };

std::vector<Look> all_looks() {
  std::vector<Look> looks;
  for (int i = 0; i < 3; ++i)
    looks.push_back(
        {.name = "plaster " + std::to_string(i), .color = {1, 1, 1}, .roughness = 0.95, .texture = i});
  looks.push_back({.name = "stone", .color = {0.6, 0.56, 0.48}, .roughness = 0.9});
  looks.push_back(
      {.name = "paving", .color = {0.75, 0.72, 0.7}, .roughness = 0.8, .texture = kPavingTexture});
  looks.push_back({.name = "green wood", .color = {0.08, 0.2, 0.14}, .roughness = 0.6, .double_sided = true});
  looks.push_back({.name = "brown wood", .color = {0.3, 0.17, 0.08}, .roughness = 0.55});
  looks.push_back({.name = "glass", .color = {0.05, 0.07, 0.09}, .roughness = 0.15});
  looks.push_back({.name = "iron", .color = {0.05, 0.05, 0.055}, .metallic = 0.6, .roughness = 0.4});
  looks.push_back({.name = "roof tiles", .color = {0.5, 0.19, 0.1}, .roughness = 0.85});
  looks.push_back({.name = "red cloth", .color = {0.55, 0.07, 0.06}, .roughness = 0.9, .double_sided = true});
  looks.push_back(
      {.name = "cream cloth", .color = {0.8, 0.73, 0.55}, .roughness = 0.9, .double_sided = true});
  looks.push_back({.name = "bark", .color = {1, 1, 1}, .roughness = 0.95, .texture = kBarkTexture});
  looks.push_back({.name = "leaves",
                   .color = {1, 1, 1},
                   .roughness = 0.7,
                   .double_sided = true,
                   .texture = kLeafTexture,
                   .alpha_test = true});
  looks.push_back({.name = "lamp", .color = {0.9, 0.85, 0.7}, .roughness = 0.2});
  return looks;
}

Model ground_model(double length) {
  Model out{"ground", {{MeshSurface{}, kPaving}, {MeshSurface{}, kStone}}};
  MeshSurface &paving = out.pieces[0].surface, &stone = out.pieces[1].surface;
  const double wide = kStreetHalf + kWalk + 12.0;
  add_panel(paving, {-wide, 0, 14}, {2 * wide, 0, 0}, {0, 0, -length - 30}, 40, 80, 0.4);
  for (const double side : {-1.0, 1.0}) {
    const double curb = side * kStreetHalf, house = side * (kStreetHalf + kWalk);
    add_box(stone, {std::min(curb, house), -0.1, -length}, {std::max(curb, house), 0.12, 12}, 0.5);
  }
  return out;
}

Model parasol_model(int sides, int cloth) {
  Model out{"parasol", {{MeshSurface{}, kBrownWood}, {MeshSurface{}, cloth}}};
  add_tube(out.pieces[0].surface, {{0, 0, 0}, {0, 2.7, 0}}, 0.025, 2 * sides, true);
  constexpr int kRibs = 8;
  add_grid(out.pieces[1].surface, 4 * kRibs, 6, true, false, [&](double u, double v) {
    const double sag = 1.0 - 0.12 * v * (1.0 - exact_cos(2 * kPi * kRibs * u)) * 0.5;
    const double r = 1.5 * v * sag, turn = 2 * kPi * u;
    return dvec3(r * exact_cos(turn), 2.65 - 0.5 * v * v, r * exact_sin(turn));
  });
  for (int i = 0; i < kRibs; ++i) {
    const double turn = 2 * kPi * i / kRibs;
    add_tube(out.pieces[0].surface, {{0, 2.1, 0}, {0.75 * exact_cos(turn), 2.5, 0.75 * exact_sin(turn)}},
             0.008, sides, false);
  }
  return out;
}

Model lamp_model(int sides) {
  Model out{"lamp post", {{MeshSurface{}, kIron}, {MeshSurface{}, kLamp}}};
  MeshSurface& iron = out.pieces[0].surface;
  add_lathe(iron, {},
            {{0.16, 0}, {0.16, 0.25}, {0.08, 0.4}, {0.06, 0.9}, {0.085, 0.95}, {0.05, 1.0}, {0.035, 3.2}},
            2 * sides);
  for (const double side : {-1.0, 1.0}) {
    add_scroll(iron, {0, 2.75, 0}, {side, 0, 0}, {0, 1, 0}, 0.45, 0.014, 20, sides);
    const dvec3 at(side * 0.5, 2.9, 0);
    add_tube(iron, {{0, 3.15, 0}, {side * 0.3, 3.3, 0}, at + dvec3(0, 0.34, 0)}, 0.016, sides, true);
    add_lathe(out.pieces[1].surface, at, {{0.05, 0}, {0.12, 0.1}, {0.12, 0.2}, {0.03, 0.32}}, 2 * sides);
    add_lathe(iron, at, {{0.16, 0.19}, {0.13, 0.24}, {0.0, 0.36}}, 2 * sides);
  }
  return out;
}

Model cafe_set_model(int sides, double bar_radius_m) {
  Model out{"cafe set", {{MeshSurface{}, kIron}, {MeshSurface{}, kBrownWood}, {MeshSurface{}, kStone}}};
  add_table(out.pieces[0].surface, out.pieces[2].surface, 0.42, sides);
  MeshSurface iron, seat;
  add_chair(iron, seat, bar_radius_m, sides);
  for (int i = 0; i < 4; ++i) {
    const double turn = 0.5 * kPi * i + 0.35;
    const dvec3 at(-0.72 * exact_sin(turn), 0, -0.72 * exact_cos(turn));
    add_turned(out.pieces[0].surface, iron, turn, at);
    add_turned(out.pieces[1].surface, seat, turn, at);
  }
  return out;
}

Model tree_model(Pcg& random, int cards) {
  Model out{"tree", {{MeshSurface{}, kBark}, {MeshSurface{}, kLeaves}, {MeshSurface{}, kStone}}};
  add_tree(out.pieces[0].surface, out.pieces[1].surface, random,
           {.height_m = 6.5, .trunk_radius_m = 0.13, .branch_levels = 2, .cards = cards, .card_m = 0.42});
  return out;
}

Model flower_pot_model(Pcg& random, int sides) {
  Model out{"pot", {{MeshSurface{}, kRoof}, {MeshSurface{}, kLeaves}}};
  add_lathe(out.pieces[0].surface, {},
            {{0.2, 0}, {0.3, 0.42}, {0.34, 0.42}, {0.34, 0.5}, {0.29, 0.5}, {0.28, 0.42}}, 3 * sides);
  MeshSurface bush;
  add_bush(bush, random, 0.4, 60, 0.22);
  add_turned(out.pieces[1].surface, bush, 0.0, {0, 0.45, 0});
  return out;
}

struct CityModels {
  int ground = 0, first_house = 1, fence = 0, lamp = 0, cafe = 0, parasol = 0, tree = 0, pot = 0;
};

void place_side(Blueprint& out, Pcg& random, const CityModels& models, const std::vector<double>& widths,
                double side, double length) {
  const double front = side * (kStreetHalf + kWalk), turn = -side * kPi / 2;
  double z = 8.0;
  while (z > -length) {
    const int house = random.below(kHouseModels);
    const double width = widths[static_cast<std::size_t>(house)];
    out.placements.push_back({models.first_house + house, {front, 0, z - width / 2}, turn});
    z -= width + (random.below(4) == 0 ? 0.6 : 0.0);
  }
  for (double at = 3.0; at > -length; at -= 9.0) {
    const double curb = side * (kStreetHalf + 0.55);
    out.placements.push_back(
        {models.tree + random.below(kTreeModels), {curb, 0.12, at}, random.uniform(0, 6)});
    out.placements.push_back({models.lamp, {curb, 0.12, at - 4.5}, kPi / 2});
    out.placements.push_back({models.pot, {side * (kStreetHalf + kWalk - 0.4), 0.12, at - 2.0}, 0.0});
  }
  if (side > 0) return;
  for (double at = -2.0; at > -length; at -= 6.0)  // along the curb, with gaps
    out.placements.push_back({models.fence, {-kStreetHalf - 0.1, 0.12, at}, kPi / 2});
}

void place_cafes(Blueprint& out, Pcg& random, const CityModels& models, int tables) {
  for (int i = 0; i < tables; ++i) {
    const int row = i / 2;
    const dvec3 at{(i % 2 == 0 ? 2.3 : 4.6) + random.uniform(-0.2, 0.2), 0.0,  // braces: in this order
                   1.2 - 2.6 * row + random.uniform(-0.25, 0.25)};
    out.placements.push_back({models.cafe, at, random.uniform(0.0, 6.0)});
    if (random.below(3) == 0) out.placements.push_back({models.parasol + random.below(2), at, 0.0});
  }
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const int sides = p.count("sides");
  const double length = p.number("length_m");
  Blueprint out;
  for (const dvec3 color : {dvec3(0.82, 0.7, 0.48), dvec3(0.75, 0.52, 0.4), dvec3(0.8, 0.77, 0.68)})
    out.textures.push_back(mottled_png(random, 128, color, 0.12));
  out.textures.push_back(brick_png(random, 128));
  out.textures.push_back(mottled_png(random, 64, {0.3, 0.22, 0.15}, 0.35));
  out.textures.push_back(leaves_png(random, 128, 9, 0.2, {0.25, 0.42, 0.12}));
  out.looks = all_looks();
  CityModels models;
  out.models.push_back(ground_model(length));
  std::vector<double> widths;
  for (int i = 0; i < kHouseModels; ++i) {
    HouseShape shape;
    shape.bays = 2 + random.below(3);
    shape.floors = 3 + random.below(2);
    shape.bay_m = random.uniform(2.2, 2.7);
    shape.shutter_slats = p.count("slats");
    shape.bars_per_m = p.number("bars_per_m");
    shape.sides = sides;
    shape.looks = {kPlaster + random.below(3),
                   kStone,
                   random.below(2) == 0 ? kGreenWood : kBrownWood,
                   kGlass,
                   kIron,
                   kRoof,
                   random.below(2) == 0 ? kRedCloth : kCreamCloth};
    widths.push_back(shape.bays * shape.bay_m);
    out.models.push_back(house_model(random, shape));
  }
  const auto add = [&](Model model) {
    out.models.push_back(std::move(model));
    return static_cast<int>(out.models.size()) - 1;
  };
  Model fence{"fence", {{MeshSurface{}, kIron}}};
  add_railing(fence.pieces[0].surface, {-2.2, 0, 0}, {2.2, 0, 0},
              {0.95, p.number("bars_per_m"), 0.009, sides, true, true});
  models.fence = add(std::move(fence));
  models.lamp = add(lamp_model(sides));
  models.cafe = add(cafe_set_model(sides, 0.011));
  models.parasol = add(parasol_model(sides, kRedCloth));
  add(parasol_model(sides, kCreamCloth));
  models.tree = add(tree_model(random, p.count("leaf_cards")));
  for (int i = 1; i < kTreeModels; ++i) add(tree_model(random, p.count("leaf_cards")));
  models.pot = add(flower_pot_model(random, sides));
  out.placements.push_back({models.ground, {}, 0.0});
  for (const double side : {-1.0, 1.0}) place_side(out, random, models, widths, side, length);
  // A house closes the end of the street.
  for (int i = -1; i <= 1; ++i)
    out.placements.push_back({models.first_house + i + 1, {9.0 * i, 0, -length - 4.0}, 0.0});
  place_cafes(out, random, models, p.count("tables"));
  out.eye = {0.3, 1.75, 6.5};
  out.target = {0.6, 2.3, -10.0};
  out.sun_direction = {-0.75, -1.0, -0.35};
  return out;
}

}  // namespace

Generator old_city() {
  return {{"old_city",
           "street of houses with railings, cafe furniture and alpha-tested trees",
           {{"length_m", 45, 10, 500, "length of the street in meters"},
            {"tables", 12, 0, 200, "cafe tables, four chairs each"},
            {"leaf_cards", 1500, 1, 100000, "alpha-tested cards of leaves on a tree"},
            {"bars_per_m", 9, 1, 100, "bars in a meter of railing"},
            {"slats", 14, 1, 100, "slats of a shutter"},
            {"sides", 6, 3, 32, "sides of an iron bar's cross-section"},
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
