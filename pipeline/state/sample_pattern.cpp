#include "pipeline/state/sample_pattern.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace hwsim::pipeline {
namespace {
using P = SamplePosition;
constexpr std::array<P, 1> k1 = {{{0, 0}}};
constexpr std::array<P, 2> k2 = {{{4, 4}, {-4, -4}}};
constexpr std::array<P, 4> k4 = {{{-2, -6}, {6, -2}, {-6, 2}, {2, 6}}};
constexpr std::array<P, 8> k8 = {{{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}}};
constexpr std::array<P, 16> k16 = {{{1, 1},
                                    {-1, -3},
                                    {-3, 2},
                                    {4, -1},
                                    {-5, -2},
                                    {2, 5},
                                    {5, 3},
                                    {3, -5},
                                    {-2, 6},
                                    {0, -7},
                                    {-4, -6},
                                    {-6, 4},
                                    {-8, 0},
                                    {7, -4},
                                    {6, 7},
                                    {-7, -8}}};

// Layer l = (i, j) of four 8x passes samples at base + (8 i, 8 j), base being the 8x pattern squeezed into
// the top left quarter (docs/techniques/forward.md#multicast).
constexpr std::array<P, 32> make_32() {
  std::array<P, 32> positions{};
  for (int layer = 0; layer < 4; ++layer) {
    for (int s = 0; s < 8; ++s) {
      const int x = (k8[static_cast<std::size_t>(s)].x + 7) / 2 - 8 + 8 * (layer & 1);
      const int y = (k8[static_cast<std::size_t>(s)].y + 7) / 2 - 8 + 8 * (layer >> 1);
      positions[static_cast<std::size_t>(layer * 8 + s)] = {static_cast<std::int8_t>(x),
                                                            static_cast<std::int8_t>(y)};
    }
  }
  return positions;
}
constexpr std::array<P, 32> k32 = make_32();

constexpr std::array<std::uint8_t, 32> from_the_center() {
  std::array<std::uint8_t, 32> order{};
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint8_t>(i);
  const auto key = [](std::uint8_t i) { return std::pair(k32[i].x * k32[i].x + k32[i].y * k32[i].y, i); };
  std::sort(order.begin(), order.end(), [&](std::uint8_t a, std::uint8_t b) { return key(a) < key(b); });
  return order;
}
constexpr std::array<std::uint8_t, 32> kFromTheCenter32 = from_the_center();
}  // namespace

std::span<const SamplePosition> standard_sample_positions(int samples) {
  switch (samples) {
    case 1:
      return k1;
    case 2:
      return k2;
    case 4:
      return k4;
    case 8:
      return k8;
    case 16:
      return k16;
    case 32:
      return k32;
    default:
      throw std::invalid_argument("no standard pattern of " + std::to_string(samples) + " samples");
  }
}

CentroidRule standard_centroid(int samples) {
  const std::span<const std::uint8_t> order(kFromTheCenter32);
  return {standard_sample_positions(samples), samples == 32 ? order : std::span<const std::uint8_t>()};
}

std::vector<SamplePosition> coverage_positions(int samples, int positions) {
  // Positions of the larger pattern that the samples' own pattern stands for: one a sample, with the least
  // sum of squared distances.
  constexpr std::uint32_t k2Of4 = 0x9, k4Of8 = 0x5c, k4Of16 = 0xc28, k8Of16 = 0x3c66, k8Of32 = 0x23029011;
  const std::uint32_t replaced = samples == 2 && positions == 4    ? k2Of4
                                 : samples == 4 && positions == 8  ? k4Of8
                                 : samples == 4 && positions == 16 ? k4Of16
                                 : samples == 8 && positions == 16 ? k8Of16
                                 : samples == 8 && positions == 32 ? k8Of32
                                                                   : 0;
  if (replaced == 0)
    throw std::invalid_argument("no pattern of " + std::to_string(samples) + " samples among " +
                                std::to_string(positions) + " positions");
  const std::span<const SamplePosition> own = standard_sample_positions(samples);
  std::vector<SamplePosition> all(own.begin(), own.end());
  for (std::uint32_t i = 0; const P p : standard_sample_positions(positions))
    if ((replaced >> i++ & 1u) == 0) all.push_back(p);
  return all;
}

// Layers shade at their pixels' centers, so a layer's samples lie around it: squeezed into one half, all
// layers shaded up to half a pixel right of and below what they sampled, and textures moved by a quarter of a
// pixel.
MulticastPattern multicast_pattern(int samples) {
  MulticastPattern pattern;
  for (const P p : k8) {
    const auto squeezed = [](int v) { return static_cast<std::int8_t>((v + 7) / 2 - 4); };
    pattern.positions.push_back({squeezed(p.x), samples == 32 ? squeezed(p.y) : p.y});
  }
  switch (samples) {
    case 16:  // the left half, and the right one a sixteenth higher: 16 rooks
      pattern.viewports = {{64, 0}, {-64, 16}};
      return pattern;
    case 32:
      pattern.viewports = {{64, 64}, {-64, 64}, {64, -64}, {-64, -64}};
      return pattern;
    default:
      throw std::invalid_argument("no multicast pattern of " + std::to_string(samples) + " samples");
  }
}

std::vector<SamplePosition> effective_positions(const MulticastPattern& pattern) {
  std::vector<SamplePosition> all;
  for (const ViewportShift shift : pattern.viewports)
    for (const P p : pattern.positions)
      all.push_back(
          {static_cast<std::int8_t>(p.x - shift.x / 16), static_cast<std::int8_t>(p.y - shift.y / 16)});
  return all;
}

}  // namespace hwsim::pipeline
