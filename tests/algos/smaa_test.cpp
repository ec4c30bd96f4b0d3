// SMAA against a scalar filter that walks pixel by pixel, and its tables against their symmetries.
#include <gtest/gtest.h>

#include <tuple>
#include "algos/picture.h"

#include "algos/filters/smaa_tables.h"

namespace hwsim::test {
namespace {

struct Weights {
  float r = 0, g = 0, b = 0, a = 0;
};

/// docs/techniques/filters.md#smaa: edges as booleans, searches as walks, areas by formula through the
/// table's texels.
class ScalarSmaa {
 public:
  ScalarSmaa(const Picture& p, float threshold, int steps, int diagonal_steps, float corner)
      : p_(p), steps_(steps), diagonal_steps_(diagonal_steps), corner_(corner) {
    const auto pixels = static_cast<std::size_t>(p.width * p.height);
    left_.resize(pixels);
    top_.resize(pixels);
    weights_.resize(pixels);
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) find_edges(x, y, threshold);
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) weights_[index(x, y)] = find_weights(x, y);
  }

  std::array<int, 3> at(int x, int y) const {
    const Weights own = w(x, y);
    const float right = w(x + 1, y).a, bottom = w(x, y + 1).g, top = own.r, left = own.b;
    if (right + bottom + top + left < 1e-5f) return p_.at(x, y);
    const bool across = std::max(right, left) > std::max(bottom, top);
    const float on = across ? right : bottom, back = across ? left : top;
    std::array<int, 3> result{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto linear = [&](int dx, int dy) {
        return pipeline::linear_from_srgb(p_.color(x + dx, y + dy)[c]);
      };
      const float own_color = linear(0, 0);
      const float next = across ? linear(1, 0) : linear(0, 1),
                  previous = across ? linear(-1, 0) : linear(0, -1);
      const float mixed =
          (on * (own_color + (next - own_color) * on) + back * (own_color + (previous - own_color) * back)) /
          (on + back);
      result[c] = static_cast<int>(std::lround(255.0f * pipeline::srgb_from_linear(mixed)));
    }
    return result;
  }

  Weights w(int x, int y) const {
    return weights_[index(std::clamp(x, 0, p_.width - 1), std::clamp(y, 0, p_.height - 1))];
  }

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * p_.width + x); }
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < p_.width && y < p_.height; }
  // Clamped, as the texture unit does it.
  bool R(int x, int y) const {
    return left_[index(std::clamp(x, 0, p_.width - 1), std::clamp(y, 0, p_.height - 1))] != 0;
  }
  bool G(int x, int y) const {
    return top_[index(std::clamp(x, 0, p_.width - 1), std::clamp(y, 0, p_.height - 1))] != 0;
  }

  void find_edges(int x, int y, float threshold) {
    const auto l = [&](int dx, int dy) {
      const Rgb c = p_.color(x + dx, y + dy);
      return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
    };
    const float dl = std::fabs(l(0, 0) - l(-1, 0)), dt = std::fabs(l(0, 0) - l(0, -1));
    const float most = std::max({dl, dt, std::fabs(l(0, 0) - l(1, 0)), std::fabs(l(0, 0) - l(0, 1)),
                                 std::fabs(l(-1, 0) - l(-2, 0)), std::fabs(l(0, -1) - l(0, -2))});
    left_[index(x, y)] = dl >= threshold && 2 * dl >= most;
    top_[index(x, y)] = dt >= threshold && 2 * dt >= most;
  }

  static float stored(double area) { return std::floor(static_cast<float>(255.0 * area)) / 255.0f; }
  static float rounded(float weight) { return std::nearbyint(255.0f * weight) / 255.0f; }

  /// The table between its texels, which hold squares of distances.
  static std::pair<float, float> lookup(int before, int after, int e1, int e2) {
    const float u = std::sqrt(static_cast<float>(before)), v = std::sqrt(static_cast<float>(after));
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    float r = 0, g = 0;
    for (int dj = 0; dj < 2; ++dj)
      for (int di = 0; di < 2; ++di) {
        const float share = (di ? u - std::floor(u) : 1 - (u - std::floor(u))) *
                            (dj ? v - std::floor(v) : 1 - (v - std::floor(v)));
        if (share == 0) continue;
        const int ii = std::min(i + di, 15), jj = std::min(j + dj, 15);
        const glm::dvec2 area = algos::straight_area(ii * ii, jj * jj, e1, e2);
        r += share * stored(area.x);
        g += share * stored(area.y);
      }
    return {r, g};
  }

  /// `G` and `R` exchange their parts for edges on the left.
  template <class Along, class Across>
  std::pair<float, float> straight(Along along, Across across) const {
    int before = 0, after = 0;
    while (before < 2 * steps_ - 1 && !across(-before, 0) && !across(-before, -1) && along(-before - 1))
      ++before;
    while (after < 2 * steps_ && !across(after + 1, 0) && !across(after + 1, -1) && along(after + 1)) ++after;
    const auto code = [&](int at) {
      return 3 * static_cast<int>(across(at, 0)) + static_cast<int>(across(at, -1));
    };
    auto [r, g] = lookup(before, after, code(-before), code(after + 1));
    if (corner_ >= 0) {
      const float share = (1 - corner_) / (before == after ? 2.0f : 1.0f);
      const float s = after >= before ? share : 0, e = before >= after ? share : 0;
      const auto crossing = [&](int at, int down) { return across(at, down) ? 1.0f : 0.0f; };
      r *= std::clamp(1 - s * crossing(-before, 1) - e * crossing(after + 1, 1), 0.0f, 1.0f);
      g *= std::clamp(1 - s * crossing(-before, -2) - e * crossing(after + 1, -2), 0.0f, 1.0f);
    }
    return {r, g};
  }

  struct Walk {
    int steps = 0;
    bool found = true;
    bool end = false;
  };
  template <class Both>
  Walk walk(int x, int y, int dx, int dy, Both both) const {
    for (int k = 1; k <= diagonal_steps_; ++k)
      if (!both(x + k * dx, y + k * dy)) return {k - 1, true, G(x + k * dx, y + k * dy)};
    return {diagonal_steps_ - 1, false, true};
  }

  void add_diagonals(int x, int y, Weights& out) const {
    const auto add = [&](const Walk& a, const Walk& b, int c1, int c2, bool swap) {
      if (a.steps + b.steps <= 2) return;
      const glm::dvec2 area = algos::diagonal_area(a.steps, b.steps, a.found ? c1 : 0, b.found ? c2 : 0);
      out.r += stored(swap ? area.y : area.x);
      out.g += stored(swap ? area.x : area.y);
    };
    const auto rising = [&](int u, int v) { return R(u, v) && G(u, v); };
    Walk a, b = walk(x, y, 1, -1, rising);
    if (R(x, y)) a = walk(x, y, -1, 1, rising), a.steps += a.end;
    add(a, b, 2 * G(x - a.steps - 1, y + a.steps) + R(x - a.steps, y + a.steps),
        2 * G(x + b.steps + 1, y - b.steps) + R(x + b.steps + 1, y - b.steps - 1), false);
    const auto falling = [&](int u, int v) { return G(u, v) && R(u + 1, v); };
    a = walk(x, y, -1, -1, falling);
    b = Walk{};
    if (R(x + 1, y)) b = walk(x, y, 1, 1, falling), b.steps += b.end;
    add(a, b, 2 * G(x - a.steps - 1, y - a.steps) + R(x - a.steps, y - a.steps - 1),
        2 * G(x + b.steps + 1, y + b.steps) + R(x + b.steps + 1, y + b.steps), true);
  }

  Weights find_weights(int x, int y) const {
    Weights out;
    bool left = R(x, y);
    if (G(x, y)) {
      if (diagonal_steps_ > 0) add_diagonals(x, y, out);
      if (out.r == 0 && out.g == 0)
        std::tie(out.r, out.g) =
            straight([&](int i) { return G(x + i, y); }, [&](int i, int j) { return R(x + i, y + j); });
      else
        left = false;
    }
    if (left)
      std::tie(out.b, out.a) =
          straight([&](int i) { return R(x, y + i); }, [&](int i, int j) { return G(x + j, y + i); });
    return {rounded(out.r), rounded(out.g), rounded(out.b), rounded(out.a)};
  }

  const Picture& p_;
  int steps_, diagonal_steps_;
  float corner_;
  std::vector<char> left_, top_;
  std::vector<Weights> weights_;
};

void expect_scalar(const Picture& p, const std::string& technique, const ScalarSmaa& oracle, int margin) {
  const Picture found = filter(p, technique).picture;
  int changed = 0, wrong = 0;
  for (int y = margin; y < p.height - margin; ++y)
    for (int x = margin; x < p.width - margin; ++x) {
      const auto expected = oracle.at(x, y);
      changed += expected != p.at(x, y) ? 1 : 0;
      int most = 0;
      for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(found.at(x, y)[c] - expected[c]));
      // A weight that is rounded the other way is two codes in the dark.
      if (most > 2 && ++wrong <= 5)
        ADD_FAILURE() << technique << " at " << x << ", " << y << ": " << found.at(x, y)[0] << " instead of "
                      << expected[0];
    }
  EXPECT_EQ(wrong, 0) << technique;
  EXPECT_GT(changed, p.width * p.height / 50);
}

TEST(Smaa, IsTheFilterOfTheText) {
  for (const Picture& p : {shapes(192, 120), noise(96, 64, 11), noise(67, 43, 12)}) {
    expect_scalar(p, "smaa:preset=low", ScalarSmaa(p, 0.15f, 4, 0, -1), 0);
    expect_scalar(p, "smaa:preset=medium", ScalarSmaa(p, 0.1f, 8, 0, -1), 0);
    expect_scalar(p, "smaa", ScalarSmaa(p, 0.1f, 16, 8, 0.25f), 0);
    expect_scalar(p, "smaa:preset=ultra", ScalarSmaa(p, 0.05f, 32, 16, 0.25f), 0);
  }
}

TEST(Smaa, PixelsWithoutWeightsStayBitIdentical) {
  const Picture p = shapes(192, 120);
  const Picture f = filter(p, "smaa").picture;
  const ScalarSmaa oracle(p, 0.1f, 16, 8, 0.25f);
  int stayed = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const Weights own = oracle.w(x, y);
      EXPECT_LE(own.r + own.g, 1.0f);
      if (own.r + own.b + oracle.w(x + 1, y).a + oracle.w(x, y + 1).g > 0) continue;
      ++stayed;
      ASSERT_EQ(f.at(x, y), p.at(x, y));
    }
  EXPECT_GT(stayed, p.width * p.height / 2);
}

TEST(Smaa, StencilKeepsWeightsToEdges) {
  const Picture p = shapes(192, 120);
  const Filtered f = filter(p, "smaa");
  const auto pass = [&](const std::string& name) {
    for (const PassWork& work : f.trace.passes)
      if (work.name == name) return total(work);
    return PassCounters{};
  };
  const PassCounters edges = pass("smaa_edges"), weights = pass("smaa_weights");
  const auto pixels = static_cast<std::uint64_t>(p.width * p.height);
  EXPECT_EQ(edges.ps.invocations, pixels);
  EXPECT_EQ(weights.raster.fragments, pixels - edges.ps.discarded_invocations);
  EXPECT_EQ(pass("smaa_blend").ps.invocations, pixels);
}

TEST(Smaa, TakesTheMemoryOfItsTable) {
  const Picture p(64, 32, {9, 9, 9});
  const pipeline::FrameGraph graph = algos::build_frame(algos::parse_technique("smaa"), image_request(p));
  std::uint64_t bytes = 0;
  for (const pipeline::ImageDesc& image : graph.images()) bytes += pipeline::allocated_bytes(image);
  EXPECT_EQ(bytes,
            64u * 32u * (4 + 4 + 2 + 4 + 1) + 179200u + 1024u);  // in, out, edges, weights, stencil, tables
}

TEST(SmaaTables, MirroredEdgesHaveMirroredAreas) {
  for (const int e1 : {0, 1, 3, 4})
    for (const int e2 : {0, 1, 3, 4})
      for (int before = 0; before < 20; ++before)
        for (int after = 0; after < 20; ++after) {
          const glm::dvec2 a = algos::straight_area(before, after, e1, e2);
          const glm::dvec2 b = algos::straight_area(after, before, e2, e1);
          ASSERT_NEAR(a.x, b.x, 1e-12);
          ASSERT_NEAR(a.y, b.y, 1e-12);
          EXPECT_LE(std::max(a.x, a.y), 0.5);
          // Upside down: 1 and 3 exchange, and so do the areas.
          const auto turned = [](int e) { return e == 1 ? 3 : e == 3 ? 1 : e; };
          const glm::dvec2 c = algos::straight_area(before, after, turned(e1), turned(e2));
          ASSERT_NEAR(a.x, c.y, 1e-12);
        }
}

TEST(SmaaTables, ZPatternsConserveEnergy) {
  for (int length = 1; length < 40; ++length) {
    glm::dvec2 sum(0.0);
    for (int i = 0; i < length; ++i) sum += algos::straight_area(i, length - 1 - i, 1, 3);
    EXPECT_NEAR(sum.x, length / 8.0, 1e-12);
    EXPECT_NEAR(sum.y, length / 8.0, 1e-12);
  }
}

TEST(SmaaTables, SearchTableSaysWhatAWalkFinds) {
  const auto table = algos::smaa_search_table();
  int counts[3] = {0, 0, 0};
  for (const std::uint32_t texel : table->texels) counts[texel / 127]++;
  EXPECT_GT(counts[1], 5);
  EXPECT_GT(counts[2], 5);
  EXPECT_EQ(table->texels[0], 127u * 2u);  // nothing crosses, both pixels go on
}

}  // namespace
}  // namespace hwsim::test
