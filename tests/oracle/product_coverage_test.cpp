// The product's rasterizer against exact arithmetic: set-up, bounds, tile tests and fine masks, on every
// vector target. HWSIM_ORACLE_TRIANGLES sets the number of triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "oracle/exact_coverage.h"
#include "oracle/random_triangles.h"
#include "pipeline/raster/triangle.h"
#include "pipeline/state/sample_pattern.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "oracle/product_coverage_test.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/raster/coverage-inl.h"

#ifndef HWSIM_PRODUCT_COVERAGE_WINDOW_
#define HWSIM_PRODUCT_COVERAGE_WINDOW_
namespace hwsim::oracle {

/// The part of the screen that is compared; `bits`: of each pixel, bit s is sample s.
struct CoverageWindow {
  static constexpr int kSizePx = 24;
  int x = 0, y = 0;  ///< multiples of 8
  std::array<std::uint32_t, kSizePx * kSizePx> bits{};
};

struct SampleBounds {
  int min_x = 0, min_y = 0, max_x = 0, max_y = 0;
};

}  // namespace hwsim::oracle
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::oracle::HWY_NAMESPACE {
namespace product = pipeline::HWY_NAMESPACE;

void add_tile(const product::SampleMasks& masks, std::size_t samples, int x, int y, CoverageWindow& window) {
  for (int lane = 0; lane < pipeline::kBlockLanes; ++lane)
    for (std::size_t s = 0; s < samples; ++s)
      if ((masks.lanes[s] >> lane & 1) != 0)
        window.bits[static_cast<std::size_t>((y + pipeline::lane_y(lane)) * CoverageWindow::kSizePx + x +
                                             pipeline::lane_x(lane))] |= 1u << s;
}

// The tiles of the window within the triangle's bounds, as the emulator walks them.
void rasterize(const pipeline::RasterTriangle& t, std::span<const pipeline::SamplePosition> positions,
               const SampleBounds& b, CoverageWindow& window) {
  const product::SampleGrid grid(positions, b.min_x, b.min_y, b.max_x, b.max_y);
  product::TileCoverage coverage(t, grid);
  const int left = std::max<int>(t.min_x, window.x) & ~7, top = std::max<int>(t.min_y, window.y) & ~7;
  const int right = std::min<int>(t.max_x, window.x + CoverageWindow::kSizePx - 1);
  const int bottom = std::min<int>(t.max_y, window.y + CoverageWindow::kSizePx - 1);
  product::SampleMasks masks;
  for (int y = top; y <= bottom; y += 8) {
    for (int x = left; x <= right; x += 8) {
      if (!coverage.reaches(x, y)) continue;
      std::fill(std::begin(masks.lanes), std::end(masks.lanes), ~std::uint64_t{0});
      if (!coverage.covers_whole_tile()) coverage.masks(masks);
      add_tile(masks, positions.size(), x - window.x, y - window.y, window);
    }
  }
}

}  // namespace hwsim::oracle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::oracle {
HWY_EXPORT(rasterize);

namespace {

constexpr int kSampleCounts[] = {1, 2, 4, 8, 16, 32};
constexpr int kSize = CoverageWindow::kSizePx;

SampleBounds bounds_of(std::span<const pipeline::SamplePosition> positions) {
  SampleBounds b{7, 7, -8, -8};
  for (const pipeline::SamplePosition p : positions) {
    b.min_x = std::min<int>(b.min_x, p.x);
    b.max_x = std::max<int>(b.max_x, p.x);
    b.min_y = std::min<int>(b.min_y, p.y);
    b.max_y = std::max<int>(b.max_y, p.y);
  }
  return b;
}

std::uint64_t triangle_count() {
  const char* text = std::getenv("HWSIM_ORACLE_TRIANGLES");
  return text == nullptr ? 300000 : std::strtoull(text, nullptr, 10);
}

// Around a window at (0, 0). Coordinates stay within what the product's guard band leaves.
class Triangles {
 public:
  explicit Triangles(std::uint32_t seed) : generator_(kSize, kSize, seed), random_(seed) {}

  std::vector<FixedTriangle> next() {
    std::vector<FixedTriangle> all = generator_.fan(7);
    const auto add = [&](const std::vector<FixedTriangle>& more) {
      all.insert(all.end(), more.begin(), more.end());
    };
    add(generator_.partition(20));
    for (const TriangleKind kind : kAllTriangleKinds)
      if (kind != TriangleKind::guard_band) add(generator_.make(kind, kind == TriangleKind::large ? 5 : 20));
    for (int i = 0; i < 5; ++i) all.push_back(huge());
    return all;
  }
  int between(int low, int high) {  // small ranges: the bias is of no concern
    return low + static_cast<int>(random_() % static_cast<std::uint32_t>(high - low + 1));
  }

 private:
  FixedTriangle huge() {
    constexpr int low = pipeline::kGuardBandMinPx * 256, high = pipeline::kGuardBandMaxPx * 256;
    FixedTriangle t;
    for (FixedVertex& v : t.vertices) v = {between(low, high), between(low, high), 0.5f};
    const int extremes = between(0, 3);  // vertices on the band's corners make the largest edge functions
    for (int i = 0; i < extremes; ++i)
      t.vertices[static_cast<std::size_t>(i)] = {between(0, 1) != 0 ? low : high,
                                                 between(0, 1) != 0 ? low : high, 0.5f};
    return t;
  }

  TriangleGenerator generator_;
  std::mt19937 random_;
};

bool in_guard_band(const FixedTriangle& t) {
  return std::all_of(t.vertices.begin(), t.vertices.end(), [](const FixedVertex& v) {
    return std::min(v.x, v.y) >= pipeline::kGuardBandMinPx * 256 &&
           std::max(v.x, v.y) <= pipeline::kGuardBandMaxPx * 256;
  });
}

/// One triangle at one sample count, by exact arithmetic and by the product.
class Comparison {
 public:
  Comparison(const FixedTriangle& triangle, int samples, int x, int y, int width_px, int height_px)
      : positions_(pipeline::standard_sample_positions(samples)), bounds_(bounds_of(positions_)) {
    exact_.x = x;
    exact_.y = y;
    for (int py = 0; py < std::min(kSize, height_px - y); ++py)
      for (int px = 0; px < std::min(kSize, width_px - x); ++px) set_exact(triangle, px, py);
    inside_x_ = std::min(kSize, width_px - x);
    inside_y_ = std::min(kSize, height_px - y);
    set_up(triangle, width_px, height_px);
  }

  std::size_t differences() const {
    CoverageWindow window;
    window.x = exact_.x;
    window.y = exact_.y;
    if (drawn_) HWY_DYNAMIC_DISPATCH(rasterize)(t_, positions_, bounds_, window);
    std::size_t count = 0;
    for (int y = 0; y < inside_y_; ++y)
      for (int x = 0; x < inside_x_; ++x) {
        const auto i = static_cast<std::size_t>(y * kSize + x);
        count += static_cast<std::size_t>(__builtin_popcount(window.bits[i] ^ exact_.bits[i]));
      }
    return count;
  }
  std::uint64_t covered() const {
    std::uint64_t count = 0;
    for (const std::uint32_t bits : exact_.bits)
      count += static_cast<std::uint64_t>(__builtin_popcount(bits));
    return count;
  }

 private:
  void set_exact(const FixedTriangle& triangle, int px, int py) {
    std::uint32_t bits = 0;
    for (std::size_t s = 0; s < positions_.size(); ++s) {
      const std::int64_t x = std::int64_t{exact_.x + px} * 256 + 128 + positions_[s].x * 16;
      const std::int64_t y = std::int64_t{exact_.y + py} * 256 + 128 + positions_[s].y * 16;
      bits |= covers(triangle, x, y) ? 1u << s : 0u;
    }
    exact_.bits[static_cast<std::size_t>(py * kSize + px)] = bits;
  }

  void set_up(const FixedTriangle& triangle, int width_px, int height_px) {
    pipeline::ScreenVertex v[3];
    for (std::size_t i = 0; i < 3; ++i) v[i] = {triangle.vertices[i].x, triangle.vertices[i].y, 0.5f, 1.0f};
    pipeline::SetupRules rules;
    rules.width_px = width_px;
    rules.height_px = height_px;
    rules.sample_min_x = bounds_.min_x;
    rules.sample_min_y = bounds_.min_y;
    rules.sample_max_x = bounds_.max_x;
    rules.sample_max_y = bounds_.max_y;
    drawn_ = pipeline::set_up_triangle(v, rules, t_) == pipeline::SetupResult::drawn;
  }

  std::span<const pipeline::SamplePosition> positions_;
  SampleBounds bounds_;
  CoverageWindow exact_;
  int inside_x_ = 0, inside_y_ = 0;
  pipeline::RasterTriangle t_;
  bool drawn_ = false;
};

FixedTriangle moved(FixedTriangle t, int x_px, int y_px) {
  for (FixedVertex& v : t.vertices) {
    v.x += x_px * 256;
    v.y += y_px * 256;
  }
  return t;
}

TEST(ProductCoverage, HasTheOraclesSamplePositions) {
  for (const int samples : {1, 2, 4, 8, 16}) {
    const auto expected = standard_offsets(samples);
    const auto positions = pipeline::standard_sample_positions(samples);
    ASSERT_EQ(positions.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(positions[i].x, expected[i].x) << samples;
      EXPECT_EQ(positions[i].y, expected[i].y) << samples;
    }
  }
}

TEST(ProductCoverage, EqualsExactCoverageInEverySample) {
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  const std::uint64_t wanted = triangle_count();
  std::uint64_t done = 0, differing = 0, covered = 0;
  for (std::uint32_t seed = 1; done < wanted && differing == 0; ++seed) {
    Triangles triangles(seed);
    for (const FixedTriangle& triangle : triangles.next()) {
      // Anywhere on the largest target, or at its origin with the window cut by the viewport.
      const bool far = triangles.between(0, 1) != 0;
      const int x = far ? 8 * triangles.between(0, 2000) : 0, y = far ? 8 * triangles.between(0, 2000) : 0;
      const FixedTriangle placed = moved(triangle, x, y);
      const FixedTriangle& drawn = in_guard_band(placed) ? placed : triangle;
      if (!in_guard_band(drawn)) continue;
      const int width = far ? 16384 : triangles.between(1, kSize),
                height = far ? 16384 : triangles.between(1, kSize);
      const int samples = kSampleCounts[done++ % std::size(kSampleCounts)];
      const Comparison comparison(drawn, samples, x, y, width, height);
      covered += comparison.covered();
      for (const std::int64_t target : targets) {
        hwy::SetSupportedTargetsForTest(target);
        differing += comparison.differences();
        hwy::SetSupportedTargetsForTest(0);
        ASSERT_EQ(differing, 0u) << hwy::TargetName(target) << ", " << samples << " samples, seed " << seed
                                 << ", (" << drawn.vertices[0].x << ", " << drawn.vertices[0].y << ") ("
                                 << drawn.vertices[1].x << ", " << drawn.vertices[1].y << ") ("
                                 << drawn.vertices[2].x << ", " << drawn.vertices[2].y << ")";
      }
    }
  }
  EXPECT_GE(done, wanted);
  EXPECT_GT(covered, done * 20);  // the triangles are where they can be seen
  std::printf("[     note ] %llu triangles on %zu vector targets, %llu covered samples, %llu differences\n",
              static_cast<unsigned long long>(done), targets.size(), static_cast<unsigned long long>(covered),
              static_cast<unsigned long long>(differing));
}

}  // namespace
}  // namespace hwsim::oracle
#endif
