// A stand-in for the UE3 FoliageMap of the AGAA paper: a wooded dell, whose leaves, ferns and grass are
// alpha-tested cards over geometric trunks, branches and rocks.
#include <algorithm>
#include <cmath>

#include "pipeline/generate/plants.h"
#include "pipeline/generate/png.h"
#include "pipeline/generate/registry.h"
#include "pipeline/generate/textures.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

constexpr int kTreeModels = 4, kBushModels = 3, kTuftModels = 4, kRockModels = 2;
enum LookIndex { kGround, kBark, kRock, kBroadLeaves, kNarrowLeaves, kGrass };

// The dell: a path winds along its bottom, banks rise on both sides.
double ground_height(double x, double z) {
  const double off = x - 1.5 * exact_sin(0.22 * z);
  const double bank = off * off / (off * off + 30.0);
  return 2.6 * bank + 0.18 * exact_sin(0.9 * x + 0.4 * z) * bank + 0.1 * exact_sin(0.5 * z - 0.7 * x);
}

// Grass on a card: blades that rise from the lower edge.
std::vector<std::uint8_t> grass_png(Pcg& random, int size) {
  struct Blade {
    double foot, lean, height, tone;
  };
  std::vector<Blade> blades;
  for (int i = 0; i < 26; ++i) {
    Blade b;
    b.foot = random.uniform(0.15, 0.85);
    b.lean = random.uniform(-0.3, 0.3);
    b.height = random.uniform(0.5, 0.98);
    b.tone = random.uniform(0.7, 1.2);
    blades.push_back(b);
  }
  std::vector<std::uint32_t> texels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double u = (x + 0.5) / size, up = 1.0 - (y + 0.5) / size;
      bool inside = false;
      double tone = 1.0;
      for (const Blade& b : blades) {
        const double t = up / b.height;
        if (t > 1.0 || std::abs(u - b.foot - b.lean * t * t) > 0.022 * (1.0 - t) + 0.004) continue;
        inside = true;
        tone = b.tone * (0.6 + 0.5 * t);
      }
      texels.push_back(rgb(0.3 * tone, 0.45 * tone, 0.12 * tone) | (inside ? 0xff000000u : 0u));
    }
  return encode_png(size, size, texels, true);
}

Model ground_model(double side) {
  Model out{"ground", {{MeshSurface{}, kGround}}};
  const int n = std::clamp(static_cast<int>(3 * side), 8, 400);
  MeshSurface& s = out.pieces[0].surface;
  add_grid(s, n, n, false, false, [&](double u, double v) {
    const double x = (u - 0.5) * side, z = (0.5 - v) * side;
    return dvec3(x, ground_height(x, z), z);
  });
  for (glm::vec2& uv : s.uvs) uv *= static_cast<float>(0.4 * side);
  return out;
}

Model rock_model(Pcg& random, int detail) {
  Model out{"rock", {{MeshSurface{}, kRock}}};
  const double a = random.uniform(0.0, 6.0), b = random.uniform(0.0, 6.0);
  add_grid(out.pieces[0].surface, 2 * detail, detail, true, false, [&](double u, double v) {
    const double turn = -2 * kPi * u, rise = kPi * (0.5 - v) * -1.0;
    const dvec3 n(exact_cos(turn) * exact_cos(rise), exact_sin(rise), exact_sin(turn) * exact_cos(rise));
    const double bump = 1.0 + 0.16 * exact_sin(3.1 * n.x + a) * exact_sin(2.7 * n.z + b) +
                        0.07 * exact_sin(9.0 * n.x + b) * exact_sin(8.0 * n.y + a) * exact_cos(7.0 * n.z);
    return dvec3(n.x * 0.6, n.y * 0.38, n.z * 0.5) * bump;
  });
  return out;
}

Model fern_model(Pcg& random, int cards) {
  Model out{"fern", {{MeshSurface{}, kNarrowLeaves}}};
  for (int i = 0; i < cards; ++i) {
    const double turn = 2.399963 * i, tilt = random.uniform(0.35, 0.9), length = random.uniform(0.45, 0.7);
    const dvec3 out_way(exact_cos(turn), 0, exact_sin(turn));
    const dvec3 up = unit(out_way + dvec3(0, tilt, 0)) * length;
    const dvec3 across = glm::cross(unit(up), unit(glm::cross(up, dvec3(0, 1, 0))));
    // Flat fronds: the card's width is level.
    add_card(out.pieces[0].surface, {}, up, unit(glm::cross(across, up)) * (0.7 * length));
  }
  return out;
}

struct Scatter {
  int model, variants, count;
  double min_from_path, max_from_path, min_scale, max_scale, sink_m;
};

// At random places beside the path, on the ground.
void scatter(Blueprint& out, Pcg& random, double side, const Scatter& what) {
  for (int i = 0; i < what.count; ++i) {
    const double z = random.uniform(-0.48, 0.48) * side;
    const double off = random.uniform(what.min_from_path, std::min(what.max_from_path, 0.45 * side));
    const double x = 1.5 * exact_sin(0.22 * z) + (random.below(2) == 0 ? off : -off);
    const int variant = random.below(what.variants);
    const double turn = random.uniform(0.0, 2 * kPi);
    out.placements.push_back({what.model + variant,
                              {x, ground_height(x, z) - what.sink_m, z},
                              turn,
                              random.uniform(what.min_scale, what.max_scale)});
  }
}

void add_plant_models(Blueprint& out, Pcg& random, const Parameters& p) {
  const int cards = p.count("leaf_cards");
  for (int i = 0; i < kTreeModels; ++i) {
    Model tree{"tree", {{MeshSurface{}, kBark}, {MeshSurface{}, i % 2 == 0 ? kBroadLeaves : kNarrowLeaves}}};
    add_tree(tree.pieces[0].surface, tree.pieces[1].surface, random,
             {.height_m = 7.5 + i,
              .trunk_radius_m = 0.16 + 0.02 * i,
              .branch_levels = 2,
              .cards = cards,
              .card_m = 0.6});
    out.models.push_back(std::move(tree));
  }
  for (int i = 0; i < kBushModels; ++i) {
    Model bush{"bush", {{MeshSurface{}, i == 1 ? kNarrowLeaves : kBroadLeaves}}};
    add_bush(bush.pieces[0].surface, random, 0.8, std::max(1, cards / 8), 0.38);
    out.models.push_back(std::move(bush));
  }
  for (int i = 0; i < kTuftModels; ++i) {
    Model tuft{"tuft", {{MeshSurface{}, kGrass}}};
    add_tuft(tuft.pieces[0].surface, random, 5, 0.38);
    out.models.push_back(std::move(tuft));
  }
  for (int i = 0; i < kRockModels; ++i) out.models.push_back(rock_model(random, 18));
  out.models.push_back(fern_model(random, 14));
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const double side = p.number("side_m");
  Blueprint out;
  out.textures = {
      mottled_png(random, 128, {0.3, 0.24, 0.13}, 0.4),    mottled_png(random, 64, {0.28, 0.22, 0.16}, 0.4),
      mottled_png(random, 64, {0.45, 0.44, 0.41}, 0.25),   leaves_png(random, 128, 9, 0.22, {0.24, 0.4, 0.1}),
      leaves_png(random, 128, 17, 0.1, {0.2, 0.37, 0.12}), grass_png(random, 128)};
  out.looks = {{.name = "ground", .color = {1, 1, 1}, .roughness = 1.0, .texture = 0},
               {.name = "bark", .color = {1, 1, 1}, .roughness = 0.95, .texture = 1},
               {.name = "rock", .color = {1, 1, 1}, .roughness = 0.85, .texture = 2}};
  for (int texture = 3; texture < 6; ++texture)
    out.looks.push_back({.name = texture == 3   ? "broad leaves"
                                 : texture == 4 ? "narrow leaves"
                                                : "grass",
                         .color = {1, 1, 1},
                         .roughness = 0.65,
                         .double_sided = true,
                         .texture = texture,
                         .alpha_test = true});
  out.models.push_back(ground_model(side));
  add_plant_models(out, random, p);
  out.placements.push_back({});
  const int bush = 1 + kTreeModels, tuft = bush + kBushModels, rock = tuft + kTuftModels,
            fern = rock + kRockModels;
  scatter(out, random, side, {1, kTreeModels, p.count("trees"), 3.6, 20.0, 0.8, 1.3, 0.05});
  scatter(out, random, side, {bush, kBushModels, p.count("bushes"), 1.6, 14.0, 0.6, 1.4, 0.1});
  scatter(out, random, side, {tuft, kTuftModels, p.count("tufts"), 0.5, 12.0, 0.7, 1.5, 0.02});
  scatter(out, random, side, {rock, kRockModels, p.count("bushes") / 4, 1.0, 9.0, 0.4, 1.8, 0.1});
  scatter(out, random, side, {fern, 1, p.count("bushes"), 0.9, 8.0, 0.7, 1.4, 0.0});
  const double eye_z = 0.4 * side;
  out.eye = {1.5 * exact_sin(0.22 * eye_z), 1.7 + ground_height(1.5 * exact_sin(0.22 * eye_z), eye_z), eye_z};
  out.target = {0.0, 1.9, eye_z - 12.0};
  out.sun_direction = {-0.55, -1.0, -0.5};
  out.sun_lux = 1.6;
  return out;
}

}  // namespace

Generator foliage() {
  return {{"foliage",
           "wooded dell with leaves, ferns and grass on alpha-tested cards",
           {{"side_m", 44, 8, 500, "side of the square ground in meters"},
            {"trees", 60, 0, 10000, "number of trees"},
            {"bushes", 120, 0, 20000, "number of bushes; there are as many ferns"},
            {"tufts", 2500, 0, 200000, "number of tufts of grass"},
            {"leaf_cards", 1600, 8, 100000, "cards of leaves on a tree; a bush has an eighth"},
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
