#include "pipeline/memory/coverage_map.h"

#include <stdexcept>

#include "pipeline/state/sample_pattern.h"

namespace hwsim::pipeline {
namespace {

CoverageLayout make_layout(int samples, int positions) {
  const std::vector<SamplePosition> at = coverage_positions(samples, positions);
  CoverageLayout layout{.samples = samples, .positions = positions};
  for (std::size_t q = 0; q < at.size(); ++q) {
    const auto distance2 = [&](std::size_t k) {
      const int dx = at[q].x - at[k].x, dy = at[q].y - at[k].y;
      return dx * dx + dy * dy;
    };
    std::uint8_t& nearest = layout.nearest_sample[q];
    for (std::uint8_t k = 1; k < samples; ++k)
      if (distance2(k) < distance2(nearest)) nearest = k;
  }
  return layout;
}

}  // namespace

const CoverageLayout& coverage_layout(int samples, int positions) {
  static const std::array<CoverageLayout, 5> kLayouts = {
      make_layout(2, 4), make_layout(4, 8), make_layout(4, 16), make_layout(8, 16), make_layout(8, 32)};
  for (const CoverageLayout& layout : kLayouts)
    if (layout.samples == samples && layout.positions == positions) return layout;
  throw std::invalid_argument("no coverage map of such samples and positions");
}

}  // namespace hwsim::pipeline
