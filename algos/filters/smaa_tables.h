#pragma once
// SMAA's tables, generated (docs/techniques/filters.md#smaa): areas under re-vectorized edges, and lengths of
// searches.
#include <glm/glm.hpp>
#include <memory>

#include "pipeline/image/image_io.h"

namespace hwsim::algos {

/// The areas of a pixel below (x) and above (y) the line through an edge of `before` + `after` + 1 pixels,
/// that lies `before` pixels from its start. Codes of what crosses at the ends: 0, 1 (above), 3 (below), 4
/// (both).
glm::dvec2 straight_area(int before, int after, int code_start, int code_end);

/// The areas of a diagonal of 45 degrees; codes 0 to 3.
glm::dvec2 diagonal_area(int before, int after, int code_start, int code_end);

/// 160x560 RG8: 16x16 texels by square roots of the distances for each pair of codes, from x = 80 on 20x20
/// texels for those of diagonals. Rows from 80 on are for sub-pixel offsets of temporal variants, and zero.
std::shared_ptr<const pipeline::RawImage> smaa_area_table();

/// 64x16 R8: how many of the two pixels of a search's last fetch still belong to the edge, times 127.
std::shared_ptr<const pipeline::RawImage> smaa_search_table();

}  // namespace hwsim::algos
