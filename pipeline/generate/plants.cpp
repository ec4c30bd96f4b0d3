#include "pipeline/generate/plants.h"

#include <algorithm>
#include <cmath>

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

struct Twig {
  dvec3 from, to;
};

struct TreeBuilder {
  MeshSurface& wood;
  Pcg& random;
  int levels;
  std::vector<Twig> twigs;

  void grow(const dvec3& start, const dvec3& heading, double length, double radius, int level) {
    constexpr int kPieces = 4;
    std::vector<dvec3> path = {start};
    dvec3 direction = heading;
    for (int i = 0; i < kPieces; ++i) {
      path.push_back(path.back() + direction * (length / kPieces));
      direction = unit(direction + random_direction(random) * (level == 0 ? 0.12 : 0.25) + dvec3(0, 0.12, 0));
    }
    add_tube(wood, path, radius, std::max(3, 9 - 2 * level), false);
    if (level == levels) {
      for (int i = 1; i < kPieces; ++i)
        twigs.push_back({path[static_cast<std::size_t>(i)], path[static_cast<std::size_t>(i + 1)]});
      return;
    }
    const int children = 5 + random.below(3);
    for (int i = 0; i < children; ++i) {
      const double t = kPieces * (level == 0 ? 0.45 : 0.3) +
                       kPieces * (level == 0 ? 0.55 : 0.7) * (i + random.uniform(0.2, 0.8)) / children;
      const int piece = std::min(static_cast<int>(t), kPieces - 1);
      const dvec3 &a = path[static_cast<std::size_t>(piece)], &b = path[static_cast<std::size_t>(piece + 1)];
      // Around the branch by the golden angle, so that no two lie above each other.
      const double turn = 2.399963 * i + random.uniform(-0.3, 0.3);
      const dvec3 side =
          unit(glm::cross(heading, std::abs(heading.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
      const dvec3 other = glm::cross(side, heading);
      const dvec3 out = side * exact_cos(turn) + other * exact_sin(turn);
      grow(a + (b - a) * (t - piece), unit(heading * 0.55 + out), length * random.uniform(0.45, 0.6),
           radius * 0.5, level + 1);
    }
  }
};

}  // namespace

dvec3 random_direction(Pcg& random) {
  const double y = random.uniform(-1.0, 1.0), turn = random.uniform(0.0, 2.0 * kPi);
  const double r = std::sqrt(1.0 - y * y);
  return {r * exact_cos(turn), y, r * exact_sin(turn)};
}

void add_card(MeshSurface& s, const dvec3& foot, const dvec3& up, const dvec3& across) {
  const glm::vec3 normal(unit(glm::cross(across, up)));
  const auto first = static_cast<std::uint32_t>(s.positions.size());
  const dvec3 half = across * 0.5;
  for (const dvec3& p : {foot - half, foot + half, foot + half + up, foot - half + up}) {
    s.positions.emplace_back(p);
    s.normals.push_back(normal);
  }
  for (const glm::vec2 uv : {glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0), glm::vec2(0, 0)})
    s.uvs.push_back(uv);
  s.indices.insert(s.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
}

void add_tree(MeshSurface& wood, MeshSurface& leaves, Pcg& random, const TreeShape& shape) {
  TreeBuilder builder{wood, random, shape.branch_levels, {}};
  builder.grow({}, {0, 1, 0}, shape.height_m * 0.62, shape.trunk_radius_m, 0);
  for (int i = 0; i < shape.cards; ++i) {
    const Twig& twig =
        builder.twigs[static_cast<std::size_t>(random.below(static_cast<int>(builder.twigs.size())))];
    const dvec3 foot = twig.from + (twig.to - twig.from) * random.uniform(0.0, 1.0);
    const dvec3 up = unit(unit(twig.to - twig.from) + random_direction(random) * 0.9);
    const dvec3 across = unit(glm::cross(up, random_direction(random)));
    const double size = shape.card_m * random.uniform(0.7, 1.2);
    add_card(leaves, foot, up * size, across * size);
  }
}

void add_bush(MeshSurface& leaves, Pcg& random, double radius_m, int cards, double card_m) {
  for (int i = 0; i < cards; ++i) {
    dvec3 out = random_direction(random);
    out.y = std::abs(out.y) * 0.9;
    const dvec3 foot = out * (radius_m * random.uniform(0.35, 0.95));
    const dvec3 up = unit(out + random_direction(random) * 0.8 + dvec3(0, 0.3, 0));
    const dvec3 across = unit(glm::cross(up, random_direction(random)));
    const double size = card_m * random.uniform(0.7, 1.2);
    add_card(leaves, foot, up * size, across * size);
  }
}

void add_tuft(MeshSurface& leaves, Pcg& random, int cards, double height_m) {
  for (int i = 0; i < cards; ++i) {
    const double turn = random.uniform(0.0, 2.0 * kPi);
    const dvec3 across(exact_cos(turn), 0.0, exact_sin(turn));
    const dvec3 lean = glm::cross(across, dvec3(0, 1, 0)) * random.uniform(0.1, 0.6);
    const double height = height_m * random.uniform(0.7, 1.1);
    add_card(leaves, lean * (0.2 * height), (dvec3(0, 1, 0) + lean) * height, across * height);
  }
}

}  // namespace hwsim::pipeline::generate
