#include "pipeline/generate/textures.h"

#include <algorithm>
#include <cmath>

#include "pipeline/generate/png.h"

namespace hwsim::pipeline::generate {

std::uint32_t rgb(double r, double g, double b) {
  const auto byte = [](double v) {
    return static_cast<std::uint32_t>(std::clamp(v, 0.0, 1.0) * 255.0 + 0.5);
  };
  return byte(r) | byte(g) << 8 | byte(b) << 16;
}

std::vector<std::uint8_t> checker_png(Pcg& random, int size) {
  std::vector<std::uint32_t> texels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const bool dark = (x * 2 / size + y * 2 / size) % 2 == 1;
      const double grain = random.uniform(-0.05, 0.05);
      texels.push_back(dark ? rgb(0.42 + grain, 0.3 + grain, 0.25 + grain)
                            : rgb(0.78 + grain, 0.73 + grain, 0.65 + grain));
    }
  return encode_png(size, size, texels);
}

std::vector<std::uint8_t> brick_png(Pcg& random, int size) {
  constexpr int kRows = 8, kColumns = 4;
  double tone[kRows][kColumns];
  for (auto& row : tone)
    for (double& t : row) t = random.uniform(-0.1, 0.1);
  std::vector<std::uint32_t> texels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double v = static_cast<double>(y) * kRows / size;
      const int row = static_cast<int>(v);
      const double u = static_cast<double>(x) * kColumns / size + (row % 2) * 0.5;
      const int column = static_cast<int>(u) % kColumns;
      const double grain = random.uniform(-0.04, 0.04);
      const bool mortar = u - std::floor(u) < 0.05 || v - row < 0.1;
      const double t = tone[row][column] + grain;
      texels.push_back(mortar ? rgb(0.7 + grain, 0.68 + grain, 0.62 + grain)
                              : rgb(0.62 + t, 0.42 + t, 0.32 + t));
    }
  return encode_png(size, size, texels);
}

namespace {

// Smooth noise: a lattice of values, interpolated with a smoothstep; it repeats after `period` cells.
class Noise {
 public:
  Noise(Pcg& random, int period) : period_(period), values_(static_cast<std::size_t>(period * period)) {
    for (double& v : values_) v = random.uniform(-1.0, 1.0);
  }
  double at(double x, double y) const {
    const double fx = std::floor(x), fy = std::floor(y);
    const double u = smooth(x - fx), v = smooth(y - fy);
    const int i = static_cast<int>(fx), j = static_cast<int>(fy);
    const double low = value(i, j) * (1 - u) + value(i + 1, j) * u;
    const double high = value(i, j + 1) * (1 - u) + value(i + 1, j + 1) * u;
    return low * (1 - v) + high * v;
  }

 private:
  static double smooth(double t) { return t * t * (3.0 - 2.0 * t); }
  double value(int i, int j) const {
    return values_[static_cast<std::size_t>((j % period_) * period_ + i % period_)];
  }
  int period_;
  std::vector<double> values_;
};

}  // namespace

std::vector<std::uint8_t> mottled_png(Pcg& random, int size, const glm::dvec3& color, double contrast) {
  const Noise coarse(random, 8), fine(random, 32);
  std::vector<std::uint32_t> texels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double u = static_cast<double>(x) / size, v = static_cast<double>(y) / size;
      const double tone = 1.0 + contrast * (0.6 * coarse.at(8 * u, 8 * v) + 0.4 * fine.at(32 * u, 32 * v));
      texels.push_back(rgb(color.x * tone, color.y * tone, color.z * tone));
    }
  return encode_png(size, size, texels);
}

namespace {

struct Leaf {
  double x, y, cosine, sine, length, tone;
};

// Inside a pointed oval that begins at the leaf's foot; tells how near the mid-rib is (0: on it).
bool inside_leaf(const Leaf& leaf, double width_ratio, double x, double y, double& rib) {
  const double dx = x - leaf.x, dy = y - leaf.y;
  const double along = (dx * leaf.cosine + dy * leaf.sine) / leaf.length;
  const double across = (dy * leaf.cosine - dx * leaf.sine) / leaf.length;
  if (along <= 0.0 || along >= 1.0) return false;
  const double half = width_ratio * 4.0 * along * (1.0 - along) * (1.25 - 0.5 * along);
  rib = std::abs(across) / half;
  return rib < 1.0;
}

}  // namespace

std::vector<std::uint8_t> leaves_png(Pcg& random, int size, int leaves, double width_ratio,
                                     const glm::dvec3& color) {
  std::vector<Leaf> all;
  for (int i = 0; i < leaves; ++i) {
    // In pairs along a twig that rises through the middle; the last leaf ends it.
    const double t = (i / 2 + 0.5) / ((leaves + 1) / 2);
    const bool last = i + 1 == leaves;
    const double angle = last ? -kPi / 2 : -kPi / 2 + (i % 2 == 0 ? 1 : -1) * random.uniform(0.7, 1.2);
    const double length = random.uniform(0.32, 0.42) * (last ? 1.1 : 1.2 - 0.35 * t);
    all.push_back({0.5, last ? 0.4 : 0.98 - 0.62 * t, exact_cos(angle), exact_sin(angle), length,
                   random.uniform(-0.12, 0.12)});
  }
  std::vector<std::uint32_t> texels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double u = (x + 0.5) / size, v = (y + 0.5) / size;
      double alpha = std::abs(u - 0.5) < 0.012 && v > 0.35 ? 1.0 : 0.0, tone = -0.2, rib = 0.0;
      for (const Leaf& leaf : all)
        if (inside_leaf(leaf, width_ratio, u, v, rib)) {
          alpha = 1.0;
          tone = leaf.tone + (rib < 0.12 ? 0.2 : -0.12 * rib);
        }
      // Texels outside keep the leaf's color, so that filtering brings in no fringe.
      const double light = 1.0 + tone;
      texels.push_back(rgb(color.x * light, color.y * light, color.z * light) |
                       (alpha > 0.5 ? 0xff000000u : 0u));
    }
  return encode_png(size, size, texels, true);
}

}  // namespace hwsim::pipeline::generate
