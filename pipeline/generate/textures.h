#pragma once
// Textures as PNG files, drawn texel by texel. Sides are powers of two, edges repeat.
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "pipeline/generate/exact_math.h"

namespace hwsim::pipeline::generate {

/// Components in [0, 1], clamped; r in the lowest byte.
std::uint32_t rgb(double r, double g, double b);

std::vector<std::uint8_t> checker_png(Pcg& random, int size);
std::vector<std::uint8_t> brick_png(Pcg& random, int size);

/// One color with smooth spots, darker and lighter by up to `contrast`: plaster, bark, soil.
std::vector<std::uint8_t> mottled_png(Pcg& random, int size, const glm::dvec3& color, double contrast);

/// A twig with leaves for alpha-tested cards; the twig's foot is in the middle of the lower edge.
/// `width_ratio`: a leaf's half width over its length.
std::vector<std::uint8_t> leaves_png(Pcg& random, int size, int leaves, double width_ratio,
                                     const glm::dvec3& color);

}  // namespace hwsim::pipeline::generate
