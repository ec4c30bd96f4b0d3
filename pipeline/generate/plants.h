#pragma once
// Trees, bushes and tufts of leaf cards, for generated scenes.
#include "pipeline/generate/exact_math.h"
#include "pipeline/generate/surface.h"

namespace hwsim::pipeline::generate {

glm::dvec3 random_direction(Pcg& random);

/// A quad with the whole texture: its lower edge is centered at `foot`.
void add_card(MeshSurface& s, const glm::dvec3& foot, const glm::dvec3& up, const glm::dvec3& across);

struct TreeShape {
  double height_m = 6.0;
  double trunk_radius_m = 0.14;
  int branch_levels = 2;  ///< generations of branches on branches; the trunk is not one
  int cards = 600;        ///< with leaves, two triangles each
  double card_m = 0.35;   ///< length of a card
};

/// Stands at the origin.
void add_tree(MeshSurface& wood, MeshSurface& leaves, Pcg& random, const TreeShape& shape);

/// A round bush of cards around the origin, whose lower half is cut off.
void add_bush(MeshSurface& leaves, Pcg& random, double radius_m, int cards, double card_m);

/// Cards that lean outward from one foot.
void add_tuft(MeshSurface& leaves, Pcg& random, int cards, double height_m);

}  // namespace hwsim::pipeline::generate
