#include "pipeline/scene/mip_chain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pipeline/image/image.h"

namespace hwsim::pipeline {
namespace {

// 16 bits of linear light: the darkest sRGB code is 1/12.92/255 = 19.9 of these steps wide.
struct SrgbTables {
  std::array<std::uint16_t, 256> linear_of_code{};
  std::vector<std::uint8_t> code_of_linear = std::vector<std::uint8_t>(65536);

  SrgbTables() {
    for (std::size_t i = 0; i < 256; ++i)
      linear_of_code[i] = static_cast<std::uint16_t>(
          std::lround(65535.0f * linear_from_srgb(static_cast<float>(i) / 255.0f)));
    // Half way between the neighbors' light is where the nearest code changes, up to the curve inside one
    // step.
    std::size_t code = 0;
    for (std::size_t linear = 0; linear < code_of_linear.size(); ++linear) {
      while (code < 255 && 2 * linear > std::size_t{linear_of_code[code]} + linear_of_code[code + 1]) ++code;
      code_of_linear[linear] = static_cast<std::uint8_t>(code);
    }
  }
};

const SrgbTables& srgb_tables() {
  static const SrgbTables tables;  // constant data, 66 KB
  return tables;
}

using Linear = std::array<std::uint64_t, 4>;  // r, g, b in 0..65535, alpha in 0..255, times a weight

class Reducer {
 public:
  explicit Reducer(bool srgb) : tables_(srgb ? &srgb_tables() : nullptr) {}

  MipLevel half(const MipLevel& from) const {
    MipLevel to;
    to.width = std::max(1, from.width / 2);
    to.height = std::max(1, from.height / 2);
    to.texels.resize(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height));
    const bool even = from.width % 2 == 0 && from.height % 2 == 0;
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x)
        to.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) +
                  static_cast<std::size_t>(x)] =
            even ? mean_of_four(from, x, y) : mean_of_area(from, to, x, y);
    return to;
  }

 private:
  std::uint32_t light(std::uint32_t code) const { return tables_ ? tables_->linear_of_code[code] : code; }
  std::uint32_t code(std::uint64_t light) const {
    return tables_ ? tables_->code_of_linear[light] : static_cast<std::uint32_t>(light);
  }

  std::uint32_t mean_of_four(const MipLevel& from, int x, int y) const {
    const std::size_t width = static_cast<std::size_t>(from.width);
    const std::uint32_t* row =
        &from.texels[2 * static_cast<std::size_t>(y) * width + 2 * static_cast<std::size_t>(x)];
    const std::array<std::uint32_t, 4> texel = {row[0], row[1], row[width], row[width + 1]};
    std::uint32_t r = 2, g = 2, b = 2, a = 2;  // rounds to nearest after the shift
    for (const std::uint32_t t : texel) {
      r += light(t & 255);
      g += light((t >> 8) & 255);
      b += light((t >> 16) & 255);
      a += t >> 24;
    }
    return code(r >> 2) | code(g >> 2) << 8 | code(b >> 2) << 16 | (a >> 2) << 24;
  }

  // Sides in units of 1/to.width and 1/to.height of a source texel, so that weights are whole numbers.
  std::uint32_t mean_of_area(const MipLevel& from, const MipLevel& to, int x, int y) const {
    const std::int64_t x0 = std::int64_t{x} * from.width, x1 = x0 + from.width;
    const std::int64_t y0 = std::int64_t{y} * from.height, y1 = y0 + from.height;
    Linear sum{};
    for (std::int64_t sy = y0 / to.height; sy * to.height < y1; ++sy) {
      const std::int64_t wy = std::min(y1, (sy + 1) * to.height) - std::max(y0, sy * to.height);
      for (std::int64_t sx = x0 / to.width; sx * to.width < x1; ++sx) {
        const std::int64_t wx = std::min(x1, (sx + 1) * to.width) - std::max(x0, sx * to.width);
        const std::uint32_t t = from.texels[static_cast<std::size_t>(sy * from.width + sx)];
        const auto weight = static_cast<std::uint64_t>(wx * wy);
        sum[0] += weight * light(t & 255);
        sum[1] += weight * light((t >> 8) & 255);
        sum[2] += weight * light((t >> 16) & 255);
        sum[3] += weight * (t >> 24);
      }
    }
    const auto total = static_cast<std::uint64_t>(from.width) * static_cast<std::uint64_t>(from.height);
    for (std::uint64_t& s : sum) s = (s + total / 2) / total;
    return code(sum[0]) | code(sum[1]) << 8 | code(sum[2]) << 16 | static_cast<std::uint32_t>(sum[3]) << 24;
  }

  const SrgbTables* tables_;
};

}  // namespace

std::vector<MipLevel> mip_chain(int width, int height, std::vector<std::uint32_t> texels, bool srgb) {
  std::vector<MipLevel> levels;
  levels.push_back({width, height, std::move(texels)});
  const Reducer reducer(srgb);
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(reducer.half(levels.back()));
  return levels;
}

}  // namespace hwsim::pipeline
