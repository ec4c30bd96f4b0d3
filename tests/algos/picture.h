#pragma once
// Pictures of 8-bit codes, and filters applied to them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include "algos/techniques.h"
#include "pipeline/emulate/emulator.h"

namespace hwsim::test {

using Rgb = std::array<float, 3>;  ///< codes / 255

struct Picture {
  int width = 0, height = 0;
  std::vector<std::array<int, 3>> codes;

  Picture(int w, int h, std::array<int, 3> fill = {0, 0, 0})
      : width(w), height(h), codes(static_cast<std::size_t>(w * h), fill) {}
  std::array<int, 3>& at(int x, int y) { return codes[static_cast<std::size_t>(y * width + x)]; }
  const std::array<int, 3>& at(int x, int y) const { return codes[static_cast<std::size_t>(y * width + x)]; }
  /// Clamped to the picture.
  Rgb color(int x, int y) const {
    const auto& c = at(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1));
    return {static_cast<float>(c[0]) * (1.0f / 255.0f), static_cast<float>(c[1]) * (1.0f / 255.0f),
            static_cast<float>(c[2]) * (1.0f / 255.0f)};
  }
  friend bool operator==(const Picture&, const Picture&) = default;
};

inline Picture transposed(const Picture& p) {
  Picture t(p.height, p.width);
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) t.at(y, x) = p.at(x, y);
  return t;
}

inline Picture gray(int width, int height, int (*code)(int x, int y)) {
  Picture p(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) p.at(x, y).fill(code(x, y));
  return p;
}

/// Colored noise: a third of the pixels random, in patches of constant color.
inline Picture noise(int width, int height, std::uint32_t seed) {
  Picture p(width, height);
  const auto next = [&] {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<int>(seed >> 24);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool fresh = next() < 85 || x == 0;
      for (auto& c : p.at(x, y)) c = fresh ? next() : 0;
      if (!fresh) p.at(x, y) = p.at(x - 1, y);
    }
  return p;
}

/// Straight edges of many slopes, circles and one-pixel lines: what filters are for.
inline Picture shapes(int width, int height) {
  Picture p(width, height, {40, 60, 80});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int cell = (y / 24) * 8 + x / 24, u = x % 24 - 12, v = y % 24 - 12;
      const int rise = cell % 9 - 4, run = 2 + cell % 5;
      if (cell % 4 == 3 ? u * u + v * v < 81 : u * rise + v * run > 0)
        p.at(x, y) = {230, 200, 160 - 3 * (cell % 8)};
      if (cell % 6 == 5 && u == v / 2) p.at(x, y) = {250, 250, 250};
    }
  return p;
}

struct Filtered {
  Picture picture;
  WorkTrace trace;
};

inline algos::FrameRequest image_request(const Picture& picture) {
  auto raw = std::make_shared<pipeline::RawImage>();
  raw->width = picture.width;
  raw->height = picture.height;
  for (const auto& c : picture.codes)
    raw->texels.push_back(static_cast<std::uint32_t>(c[0] | c[1] << 8 | c[2] << 16) | 0xff000000u);
  pipeline::Scene scene;
  scene.name = "picture";
  algos::FrameRequest request;
  request.scene = std::make_shared<const pipeline::Scene>(std::move(scene));
  request.image = raw;
  return request;
}

inline Filtered filter(const Picture& picture, const std::string& technique) {
  const algos::FrameRequest request = image_request(picture);
  const pipeline::FrameGraph graph = algos::build_frame(algos::parse_technique(technique), request);
  pipeline::Emulation e = pipeline::emulate(graph, request.features, request.functional, {});
  Filtered result{Picture(picture.width, picture.height), std::move(e.trace)};
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c)
        result.picture.at(x, y)[static_cast<std::size_t>(c)] =
            static_cast<int>(std::lround(255.0f * pipeline::srgb_from_linear(e.color.at(x, y)[c])));
  return result;
}

/// Pixels of which a channel differs by more than `codes`.
inline int count_differences(const Picture& a, const Picture& b, int codes = 0) {
  int count = 0;
  for (std::size_t i = 0; i < a.codes.size(); ++i) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(a.codes[i][c] - b.codes[i][c]));
    count += most > codes ? 1 : 0;
  }
  return count;
}

}  // namespace hwsim::test
