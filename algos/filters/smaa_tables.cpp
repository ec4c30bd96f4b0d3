#include "algos/filters/smaa_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hwsim::algos {
namespace {

/// Areas below and above the segment from p to q within the pixel [x, x + 1].
glm::dvec2 area_under(glm::dvec2 p, glm::dvec2 q, double x) {
  const double left = std::max(p.x, x), right = std::min(q.x, x + 1.0);
  if (left >= right) return {0.0, 0.0};
  const auto at = [&](double t) { return p.y + (q.y - p.y) * (t - p.x) / (q.x - p.x); };
  const double y0 = at(left), y1 = at(right), width = right - left;
  glm::dvec2 area(0.0);
  const auto add = [&](double signed_area) {
    (signed_area < 0.0 ? area.x : area.y) += std::fabs(signed_area);
  };
  if (y0 * y1 >= 0.0) {
    add(0.5 * (y0 + y1) * width);
  } else {
    const double crossing = width * y0 / (y0 - y1);
    add(0.5 * y0 * crossing);
    add(0.5 * y1 * (width - crossing));
  }
  return area;
}

/// Short U shapes are blended less harshly: towards the square root, by up to 32 pixels.
glm::dvec2 smoothed(glm::dvec2 area, double length) {
  const glm::dvec2 soft = 0.5 * glm::sqrt(2.0 * area);
  return soft + (area - soft) * std::min(1.0, length / 32.0);
}

/// A half of the edge that rises (or falls) to a crossing at its start or end, and nothing else.
glm::dvec2 half_area(double height, bool at_start, double length, double x) {
  const glm::dvec2 middle(0.5 * length, 0.0);
  return at_start ? area_under({0.0, height}, middle, x) : area_under(middle, {length, height}, x);
}

// Lines of diagonals by codes: offsets of both ends from the diagonal's own ends; where there are two, their
// results are averaged.
struct DiagonalLine {
  glm::dvec2 start, end;
};
struct DiagonalLines {
  DiagonalLine first, second;
};
const std::array<std::array<DiagonalLines, 4>, 4>& diagonal_lines() {
  static const glm::dvec2 o(0, 0), r(1, 0), c(1, 1);
  static const std::array<std::array<DiagonalLines, 4>, 4> lines = {{
      // code at the start 0: by the code at the end
      {{{{c, c}, {r, r}}, {{o, c}, {r, c}}, {{o, r}, {r, r}}, {{o, c}, {r, r}}}},
      {{{{r, o}, {r, r}}, {{r, c}, {r, c}}, {{r, r}, {r, r}}, {{r, c}, {r, r}}}},
      {{{{c, o}, {c, r}}, {{c, c}, {c, c}}, {{c, r}, {c, r}}, {{c, c}, {c, r}}}},
      {{{{c, o}, {r, r}}, {{c, c}, {r, c}}, {{c, r}, {r, r}}, {{c, c}, {r, r}}}},
  }};
  return lines;
}

/// The share of a 30x30 grid over the unit pixel at `origin` that lies on the positive side of the line.
double covered(const DiagonalLine& line, double length, glm::dvec2 origin) {
  constexpr int kGrid = 30;
  const glm::dvec2 p = line.start, q = line.end + glm::dvec2(length);
  const glm::dvec2 middle = 0.5 * (p + q);
  int inside = 0;
  for (int y = 0; y < kGrid; ++y)
    for (int x = 0; x < kGrid; ++x) {
      const glm::dvec2 at = origin + glm::dvec2(x, y) / (kGrid - 1.0) - middle;
      inside += (q.y - p.y) * at.x + (p.x - q.x) * at.y > 0.0 ? 1 : 0;
    }
  return inside / static_cast<double>(kGrid * kGrid);
}

std::uint32_t texel(glm::dvec2 area) {
  return static_cast<std::uint32_t>(255.0 * area.x) | static_cast<std::uint32_t>(255.0 * area.y) << 8;
}

/// The texels (left to right, then down) of a fetch a quarter pixel to the left and an eighth up, in 1/32.
constexpr std::array<int, 4> kFetchWeights = {1, 3, 7, 21};

/// Which texels are set in a fetch of `sum` / 32; false: no combination gives it.
bool decode_fetch(int sum, std::array<bool, 4>& set) {
  for (std::size_t i = 4; i-- > 0;) {
    set[i] = sum >= kFetchWeights[i];
    if (set[i]) sum -= kFetchWeights[i];
  }
  return sum == 0;
}

using Fetch = std::array<bool, 4>;

std::uint32_t steps_back(const Fetch& across, const Fetch& line) {
  if (!line[3]) return 0;
  return line[2] && !across[1] && !across[3] ? 2 : 1;
}

std::uint32_t steps_on(const Fetch& across, const Fetch& line) {
  if (!line[3] || across[1] || across[3]) return 0;
  return line[2] && !across[0] && !across[2] ? 2 : 1;
}

}  // namespace

glm::dvec2 straight_area(int before, int after, int code_start, int code_end) {
  const double length = before + after + 1.0, x = before;
  const bool above_start = code_start == 1, below_start = code_start == 3;
  const bool above_end = code_end == 1, below_end = code_end == 3;
  const bool none_start = code_start == 0, none_end = code_end == 0;
  if (!above_start && !below_start && !above_end && !below_end) return {0.0, 0.0};
  if (none_end)
    return before <= after ? half_area(above_start ? 0.5 : -0.5, true, length, x) : glm::dvec2(0.0);
  if (none_start)
    return before >= after ? half_area(above_end ? 0.5 : -0.5, false, length, x) : glm::dvec2(0.0);
  if (code_start == code_end) {
    const double height = above_start ? 0.5 : -0.5;
    return smoothed(half_area(height, true, length, x), length) +
           smoothed(half_area(height, false, length, x), length);
  }
  const bool falls = above_start || below_end;  // a crossing on both sides takes the other end's shape
  return area_under({0.0, falls ? 0.5 : -0.5}, {length, falls ? -0.5 : 0.5}, x);
}

glm::dvec2 diagonal_area(int before, int after, int code_start, int code_end) {
  const DiagonalLines& lines =
      diagonal_lines()[static_cast<std::size_t>(code_start)][static_cast<std::size_t>(code_end)];
  const double length = before + after + 1.0, at = before;
  glm::dvec2 sum(0.0);
  for (const DiagonalLine& line : {lines.first, lines.second})
    sum +=
        glm::dvec2(1.0 - covered(line, length, {1.0 + at, at}), covered(line, length, {1.0 + at, 1.0 + at}));
  return 0.5 * sum;
}

std::shared_ptr<const pipeline::RawImage> smaa_area_table() {
  static const auto table = [] {
    constexpr int kWidth = 160, kHeight = 560, kStraight = 16, kDiagonal = 20;
    auto image = std::make_shared<pipeline::RawImage>();
    image->width = kWidth;
    image->height = kHeight;
    image->texels.resize(static_cast<std::size_t>(kWidth) * kHeight);
    const auto put = [&](int x, int y, glm::dvec2 area) {
      image->texels[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)] = texel(area);
    };
    for (const int start : {0, 1, 3, 4})
      for (const int end : {0, 1, 3, 4})
        for (int j = 0; j < kStraight; ++j)
          for (int i = 0; i < kStraight; ++i)
            put(kStraight * start + i, kStraight * end + j, straight_area(i * i, j * j, start, end));
    for (int start = 0; start < 4; ++start)
      for (int end = 0; end < 4; ++end)
        for (int j = 0; j < kDiagonal; ++j)
          for (int i = 0; i < kDiagonal; ++i)
            put(80 + kDiagonal * start + i, kDiagonal * end + j, diagonal_area(i, j, start, end));
    return image;
  }();
  return table;
}

std::shared_ptr<const pipeline::RawImage> smaa_search_table() {
  static const auto table = [] {
    constexpr int kWidth = 64, kHeight = 16, kHalf = 33;
    auto image = std::make_shared<pipeline::RawImage>();
    image->width = kWidth;
    image->height = kHeight;
    image->texels.resize(static_cast<std::size_t>(kWidth) * kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        Fetch across{}, line{};
        if (!decode_fetch(x % kHalf, across) || !decode_fetch(32 - y, line)) continue;
        image->texels[static_cast<std::size_t>(y * kWidth + x)] =
            127 * (x < kHalf ? steps_back(across, line) : steps_on(across, line));
      }
    return image;
  }();
  return table;
}

}  // namespace hwsim::algos
