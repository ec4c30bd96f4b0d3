// The texture unit against a sampler in double precision, written from the rules of OpenGL 4.6, section 8.14.
#include "pipeline/texture/texture_sampler-inl.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipeline/image/image.h"
#include "pipeline/simd/scalar_lane-inl.h"
#include "support/frames.h"

namespace hwsim::pipeline {
namespace {
using namespace HWY_NAMESPACE;  // the scalar lane of the static target

using Product = TextureSampler<ScalarF, ScalarI, ScalarM>;
using Color = std::array<double, 4>;

/// One coordinate pair with its derivatives for a pixel's step.
struct Footprint {
  double u, v, du_dx = 0, dv_dx = 0, du_dy = 0, dv_dy = 0;
};

class Oracle {
 public:
  explicit Oracle(const Texture& texture, const Sampler& sampler) : texture_(texture), s_(sampler) {}

  Color sample(const Footprint& f) const {
    const double w = texture_.levels[0].width, h = texture_.levels[0].height;
    const double x = std::hypot(f.du_dx * w, f.dv_dx * h), y = std::hypot(f.du_dy * w, f.dv_dy * h);
    const double major = std::max(x, y), minor = std::max(std::min(x, y), 1e-6);
    if (s_.max_anisotropy <= 1) return isotropic(f.u, f.v, std::log2(std::max(major, 1e-30)));
    const double probes =
        std::max(1.0, std::floor(std::min(std::max(major, 1e-6) / minor, 1.0 * s_.max_anisotropy) + 0.999));
    const double au = x > y ? f.du_dx : f.du_dy, av = x > y ? f.dv_dx : f.dv_dy;
    Color sum{};
    for (int i = 0; i < static_cast<int>(probes); ++i) {
      const double at = (i + 0.5) / probes - 0.5;
      const Color c = isotropic(f.u + au * at, f.v + av * at, std::log2(std::max(major, 1e-30) / probes));
      for (std::size_t k = 0; k < 4; ++k) sum[k] += c[k] / probes;
    }
    return sum;
  }

 private:
  Color isotropic(double u, double v, double lod) const {
    const double top = static_cast<double>(texture_.levels.size()) - 1;
    const Filter filter = lod <= 0 ? s_.mag : s_.min;
    const double clamped = std::clamp(lod, 0.0, top);
    if (s_.mip == MipFilter::none) return level(u, v, 0, filter);
    if (s_.mip == MipFilter::nearest) return level(u, v, static_cast<std::size_t>(clamped + 0.5), filter);
    const auto fine = static_cast<std::size_t>(clamped),
               coarse = std::min(fine + 1, static_cast<std::size_t>(top));
    return mix(level(u, v, fine, filter), level(u, v, coarse, filter), clamped - static_cast<double>(fine));
  }

  Color level(double u, double v, std::size_t level, Filter filter) const {
    const MipLevel& mip = texture_.levels[level];
    const double x = u * mip.width, y = v * mip.height;
    if (filter == Filter::nearest) return texel(mip, std::floor(x), std::floor(y));
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5), fx = x - 0.5 - left,
                 fy = y - 0.5 - top;
    return mix(mix(texel(mip, left, top), texel(mip, left + 1, top), fx),
               mix(texel(mip, left, top + 1), texel(mip, left + 1, top + 1), fx), fy);
  }

  static Color mix(const Color& a, const Color& b, double t) {
    Color c;
    for (std::size_t k = 0; k < 4; ++k) c[k] = a[k] * (1 - t) + b[k] * t;
    return c;
  }

  // -1: the border.
  static int wrap(double coordinate, int size, Wrap mode) {
    const auto i = static_cast<long>(coordinate);
    const long twice = ((i % (2L * size)) + 2L * size) % (2L * size);
    switch (mode) {
      case Wrap::repeat:
        return static_cast<int>(((i % size) + size) % size);
      case Wrap::mirrored_repeat:
        return static_cast<int>(twice < size ? twice : 2L * size - 1 - twice);
      case Wrap::clamp_to_edge:
        return static_cast<int>(std::clamp(i, 0L, size - 1L));
      default:
        return i < 0 || i >= size ? -1 : static_cast<int>(i);
    }
  }

  Color texel(const MipLevel& mip, double x, double y) const {
    const int xi = wrap(x, mip.width, s_.wrap_u), yi = wrap(y, mip.height, s_.wrap_v);
    if (xi < 0 || yi < 0) return {s_.border_color.x, s_.border_color.y, s_.border_color.z, s_.border_color.w};
    const std::uint32_t code = mip.texels[static_cast<std::size_t>(yi) * static_cast<std::size_t>(mip.width) +
                                          static_cast<std::size_t>(xi)];
    Color c;
    for (std::size_t k = 0; k < 4; ++k) {
      const double v = (code >> (8 * k) & 255) / 255.0;
      const bool curve = texture_.srgb && k < 3;
      c[k] = !curve ? v : v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    return c;
  }

  const Texture& texture_;
  const Sampler& s_;
};

Texture noise(int width, int height, bool srgb, std::mt19937& random) {
  Texture texture;
  texture.srgb = srgb;
  for (int w = width, h = height;;
       w = std::max(1, w / 2), h = std::max(1, h / 2)) {  // levels that share nothing
    MipLevel level{w, h, {}};
    for (int i = 0; i < w * h; ++i) level.texels.push_back(static_cast<std::uint32_t>(random()));
    texture.levels.push_back(std::move(level));
    if (w == 1 && h == 1) return texture;
  }
}

struct Case {
  Sampler sampler;
  std::string name;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Wrap wrap : {Wrap::repeat, Wrap::clamp_to_edge, Wrap::mirrored_repeat, Wrap::clamp_to_border})
    for (const Filter mag : {Filter::nearest, Filter::linear})
      for (const Filter min : {Filter::nearest, Filter::linear})
        for (const MipFilter mip : {MipFilter::none, MipFilter::nearest, MipFilter::linear})
          for (const int anisotropy : {1, 2, 16}) {
            Sampler s{mag,
                      min,
                      mip,
                      wrap,
                      wrap == Wrap::repeat ? Wrap::clamp_to_edge : wrap,
                      anisotropy,
                      {0.1f, 0.7f, 0.3f, 0.9f}};
            all.push_back({s, "wrap " + std::to_string(static_cast<int>(wrap)) + " mag " +
                                  std::to_string(static_cast<int>(mag)) + " min " +
                                  std::to_string(static_cast<int>(min)) + " mip " +
                                  std::to_string(static_cast<int>(mip)) + " anisotropy " +
                                  std::to_string(anisotropy)});
          }
  return all;
}

Color product_sample(const TextureView& view, const Footprint& f) {
  const auto lane = [](double x) { return ScalarF(static_cast<float>(x)); };
  std::uint64_t probes = 0;
  const auto c =
      Product(view, nullptr, ScalarM{true})
          .sample(lane(f.u), lane(f.v), lane(f.du_dx), lane(f.dv_dx), lane(f.du_dy), lane(f.dv_dy), probes);
  return {c.x.v, c.y.v, c.z.v, c.w.v};
}

// A choice (a texel, a level, a number of probes) that falls on a boundary may go either way: the result must
// be that of the footprint as given, or of one that differs by less than float arithmetic does.
bool agrees(const Oracle& oracle, const Footprint& f, const Color& found) {
  for (int i = 0; i < 27; ++i) {
    const double d = 4e-7;
    const double scale = 1 + d * (i / 9 - 1);
    const Footprint near{
        f.u + d * (i % 3 - 1), f.v + d * (i / 3 % 3 - 1), f.du_dx * scale, f.dv_dx * scale, f.du_dy, f.dv_dy};
    const Color c = oracle.sample(near);
    double worst = 0;
    for (std::size_t k = 0; k < 4; ++k) worst = std::max(worst, std::fabs(c[k] - found[k]));
    if (worst < 2e-4) return true;  // coordinates up to 3 at 64 texels, in floats
  }
  return false;
}

TEST(TextureSampler, FiltersAsTheRulesSay) {
  std::mt19937 random(11);
  const auto unit = [&] { return static_cast<double>(random() >> 8) * 0x1p-24; };
  std::uint64_t checked = 0, differing = 0;
  for (const bool srgb : {false, true})
    for (const auto& [width, height] : {std::pair{64, 16}, std::pair{13, 27}, std::pair{1, 8}})
      for (const Case& c : cases()) {
        Scene scene = test::clip_space_scene({}, {});
        scene.textures = {noise(width, height, srgb, random)};
        scene.samplers = {c.sampler};
        const TextureStore store(scene);
        const TextureView& view = *store.view({0, 0, 0});
        const Oracle oracle(scene.textures[0], c.sampler);
        for (int i = 0; i < 60; ++i) {
          // Derivatives from an eighth of a texel to all of the texture.
          const double size = std::exp2(-3.0 - std::log2(width) + unit() * (std::log2(width) + 3)),
                       turn = unit() * 6.28;
          const double ratio = i % 3 == 0 ? 1 : std::exp2(-5 * unit());
          // Products are rounded to floats first, so that both see the same numbers.
          const auto f32 = [](double x) { return static_cast<double>(static_cast<float>(x)); };
          const Footprint f{f32(unit() * 5 - 2),
                            f32(unit() * 5 - 2),
                            f32(size * std::cos(turn)),
                            f32(size * std::sin(turn)),
                            f32(-size * ratio * std::sin(turn)),
                            f32(size * ratio * std::cos(turn))};
          ++checked;
          const Color found = product_sample(view, f);
          if (agrees(oracle, f, found)) continue;
          if (++differing < 8)
            ADD_FAILURE() << c.name << ", " << width << "x" << height << " at (" << f.u << ", " << f.v
                          << ") found " << found[0];
        }
      }
  EXPECT_EQ(differing, 0u);
  std::printf("[     note ] %llu samples, %llu differ\n", static_cast<unsigned long long>(checked),
              static_cast<unsigned long long>(differing));
}

}  // namespace
}  // namespace hwsim::pipeline
