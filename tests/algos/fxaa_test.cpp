// FXAA and AXAA against a scalar filter written from the text, and what they promise of edges, lines and
// work.
#include <gtest/gtest.h>

#include "algos/picture.h"
#include "hwsim/trace/counters.h"

namespace hwsim::test {
namespace {

/// docs/techniques/filters.md#fxaa, one pixel at a time, in the order in which the text has it.
class ScalarFxaa {
 public:
  ScalarFxaa(const Picture& p, std::vector<float> steps) : p_(p), steps_(std::move(steps)) {
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        const Rgb c = p.color(x, y);
        const float l = 0.299f * c[0] + 0.587f * c[1] + 0.114f * c[2];
        luma_.push_back(std::nearbyint(255.0f * l) * (1.0f / 255.0f));  // it is stored in 8 bits
      }
  }

  /// False where both directions are equally likely: rounding decides.
  bool decided = true;

  std::array<int, 3> at(int x, int y) {
    decided = true;
    const float m = l(x, y), n = l(x, y - 1), s = l(x, y + 1), w = l(x - 1, y), e = l(x + 1, y);
    const float top = std::max({m, n, s, w, e}), low = std::min({m, n, s, w, e}), range = top - low;
    if (range < std::max(0.0833f, top * 0.166f)) return p_.at(x, y);
    const float nw = l(x - 1, y - 1), ne = l(x + 1, y - 1), sw = l(x - 1, y + 1), se = l(x + 1, y + 1);
    const float eh = std::fabs(nw + sw - 2 * w) + 2 * std::fabs(n + s - 2 * m) + std::fabs(ne + se - 2 * e);
    const float ev = std::fabs(nw + ne - 2 * n) + 2 * std::fabs(w + e - 2 * m) + std::fabs(sw + se - 2 * s);
    decided = std::fabs(eh - ev) > 1e-5f;
    const bool horizontal = eh >= ev;
    const float a = horizontal ? n : w, b = horizontal ? s : e;
    const bool first = std::fabs(a - m) >= std::fabs(b - m);
    decided = decided && (std::fabs(std::fabs(a - m) - std::fabs(b - m)) > 1e-5f || a == b);
    const float side = first ? -1.0f : 1.0f, gradient = std::max(std::fabs(a - m), std::fabs(b - m)) / 4;
    const float average = ((first ? a : b) + m) / 2;
    const float blur =
        std::clamp(std::fabs((2 * (n + s + w + e) + nw + ne + sw + se) / 12 - m) / range, 0.0f, 1.0f);
    const float curve = (3 - 2 * blur) * blur * blur;

    float length[2] = {0, 0}, end[2] = {0, 0};
    bool done[2] = {false, false};
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      for (int way = 0; way < 2; ++way) {
        if (done[way]) continue;
        length[way] += steps_[i];
        if (i + 1 == steps_.size()) continue;  // the last move is not sampled
        const float along = way == 0 ? -length[way] : length[way];
        const float u = static_cast<float>(x), v = static_cast<float>(y);
        end[way] = horizontal ? bilinear(u + along, v + 0.5f * side) : bilinear(u + 0.5f * side, v + along);
        end[way] -= average;
      }
      for (int way = 0; way < 2; ++way) {
        done[way] = done[way] || std::fabs(end[way]) >= gradient;
        decided = decided && std::fabs(std::fabs(end[way]) - gradient) > 1e-6f;
      }
      if (done[0] && done[1]) break;
    }
    const int nearer = length[0] < length[1] ? 0 : 1;
    const bool good = (end[nearer] < 0) != (m - average < 0);
    float offset = good ? 0.5f - std::min(length[0], length[1]) / (length[0] + length[1]) : 0.0f;
    offset = side * std::max(offset, curve * curve * 0.75f);
    std::array<int, 3> result{};
    for (std::size_t c = 0; c < 3; ++c)
      result[c] = static_cast<int>(std::nearbyint(
          255.0f * (horizontal ? mix(p_.color(x, y)[c], p_.color(x, y + (offset < 0 ? -1 : 1))[c], offset)
                               : mix(p_.color(x, y)[c], p_.color(x + (offset < 0 ? -1 : 1), y)[c], offset))));
    return result;
  }

  /// In the cross around a pixel, the value next to the middle of its contrast, as a part of the contrast.
  float distance_to_middle(int x, int y) const {
    const std::array<float, 5> cross = {l(x, y), l(x, y - 1), l(x, y + 1), l(x - 1, y), l(x + 1, y)};
    const auto [low, high] = std::minmax_element(cross.begin(), cross.end());
    float nearest = 1.0f;
    for (const float value : cross)
      nearest = std::min(nearest, std::fabs(value - (*low + *high) / 2) / std::max(*high - *low, 1e-9f));
    return nearest;
  }

 private:
  static float mix(float own, float other, float offset) { return own + (other - own) * std::fabs(offset); }
  float l(int x, int y) const {
    return luma_[static_cast<std::size_t>(std::clamp(y, 0, p_.height - 1) * p_.width +
                                          std::clamp(x, 0, p_.width - 1))];
  }
  float bilinear(float x, float y) const {  // pixel centers are whole numbers here
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const float u = x - std::floor(x), v = y - std::floor(y);
    return (1 - v) * ((1 - u) * l(i, j) + u * l(i + 1, j)) +
           v * ((1 - u) * l(i, j + 1) + u * l(i + 1, j + 1));
  }

  const Picture& p_;
  std::vector<float> steps_;
  std::vector<float> luma_;
};

void expect_scalar(const Picture& p, const std::string& technique, const std::vector<float>& steps) {
  const Picture found = filter(p, technique).picture;
  ScalarFxaa oracle(p, steps);
  int undecided = 0, changed = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const auto expected = oracle.at(x, y);
      changed += expected != p.at(x, y) ? 1 : 0;
      if (!oracle.decided) {
        ++undecided;
        continue;
      }
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(found.at(x, y)[c], expected[c], 1) << technique << " at " << x << ", " << y;
    }
  EXPECT_GT(changed, p.width * p.height / 50);
  EXPECT_LT(undecided, p.width * p.height / 4);
}

TEST(Fxaa, IsTheFilterOfTheText) {
  for (const Picture& p : {shapes(192, 120), noise(96, 64, 1), noise(67, 43, 2)}) {
    expect_scalar(p, "fxaa", {1, 1.5f, 2, 4, 12});
    expect_scalar(p, "fxaa:preset=10", {1.5f, 3, 12});
    expect_scalar(p, "fxaa:preset=39", {1, 1, 1, 1, 1, 1.5f, 2, 2, 2, 2, 4, 8});
  }
}

TEST(Fxaa, DiscardChangesTheWorkAndNotTheImage) {
  const Picture p = shapes(192, 120);
  const Filtered whole = filter(p, "fxaa"), edges = filter(p, "fxaa:discard=on");
  EXPECT_EQ(whole.picture, edges.picture);
  EXPECT_LT(total(edges.trace.passes.back()).crop.written_samples,
            total(whole.trace.passes.back()).crop.written_samples / 2);
}

// Direct3D 11's path: two gathers and the color's load, then two loads at edges; else five loads and four.
TEST(Fxaa, GathersAreFewerRequestsForTheSameImage) {
  const Picture p = shapes(192, 120);
  constexpr std::uint64_t kPixels = 192 * 120;
  for (const std::string name : {"fxaa", "axaa", "fxaa:green_as_luma=on", "fxaa:discard=on"}) {
    const std::string with = name + (name.find(':') == std::string::npos ? ":" : ",");
    const Filtered gathers = filter(p, with + "gather=on"), loads = filter(p, with + "gather=off");
    EXPECT_EQ(gathers.picture, loads.picture) << name;
    EXPECT_EQ(filter(p, name).trace.passes.back().chunks.size(), gathers.trace.passes.back().chunks.size());
    const PassCounters g = total(gathers.trace.passes.back()), l = total(loads.trace.passes.back());
    EXPECT_EQ(g.tex.gathers, 2 * kPixels) << name;
    EXPECT_EQ(l.tex.gathers, 0u) << name;
    EXPECT_EQ(g.tex.bilinear_probes, l.tex.bilinear_probes) << name << ": the search is the same";
    const std::uint64_t center = name == "fxaa:discard=on" ? 0 : kPixels;
    const std::uint64_t edge_loads = g.tex.fetched_32bit_texels - center;
    EXPECT_GT(edge_loads, kPixels / 50) << name;
    EXPECT_EQ(l.tex.fetched_32bit_texels, 5 * kPixels + 2 * edge_loads) << name;
  }
}

TEST(Fxaa, TransposedPicturesGiveTransposedResults) {
  const Picture p = shapes(120, 120);
  const Picture once = filter(p, "fxaa").picture, twice = transposed(filter(transposed(p), "fxaa").picture);
  ScalarFxaa oracle(p, {1, 1.5f, 2, 4, 12});
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      oracle.at(x, y);
      if (oracle.decided) {
        ASSERT_EQ(once.at(x, y), twice.at(x, y)) << x << ", " << y;
      }
    }
}

TEST(Fxaa, StaysWithinTheNeighborhoodAndLeavesFaintRamps) {
  const Picture p = noise(96, 64, 3);
  const Picture f = filter(p, "fxaa").picture;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        int low = 255, high = 0;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const int code = static_cast<int>(std::lround(255.0f * p.color(x + dx, y + dy)[c]));
            low = std::min(low, code);
            high = std::max(high, code);
          }
        ASSERT_GE(f.at(x, y)[c], low);
        ASSERT_LE(f.at(x, y)[c], high);
      }
  const Picture ramp = gray(64, 32, [](int x, int) { return 60 + 3 * x; });
  EXPECT_EQ(filter(ramp, "fxaa").picture, ramp);
}

TEST(Fxaa, LongStaircasesGetLinearWeights) {
  // A step down every 8 pixels: the row above the edge fades in over half a step, up to one half.
  const Picture p = gray(128, 64, [](int x, int y) { return y > 8 + x / 8 ? 255 : 0; });
  const Picture f = filter(p, "fxaa:preset=39,subpix=0").picture;
  for (int step = 4; step < 12; ++step)
    for (int i = 0; i < 4; ++i) {
      // Along one row, from the corner on: 1/2 - (i + 1/2)/8 of the other color, as the ends are found to
      // half a pixel.
      const int x = 8 * step + i, y = 8 + step;
      const float weight = static_cast<float>(f.at(x, y)[0]) / 255.0f;
      EXPECT_NEAR(weight, 0.5f - (static_cast<float>(i) + 0.5f) / 8.0f, 0.13f) << i;
      if (i > 0) {
        EXPECT_LE(f.at(x, y)[0], f.at(x - 1, y)[0]);
      }
    }
}

const char* const kRulesOff = "axaa:skip_filtered=off,keep_thin_lines=off,adaptive_steps=off";

TEST(Axaa, WithoutItsRulesIsFxaaInImageAndWork) {
  for (const Picture& p : {shapes(192, 120), noise(96, 64, 4)}) {
    const Filtered fxaa = filter(p, "fxaa"), axaa = filter(p, kRulesOff);
    EXPECT_EQ(fxaa.picture, axaa.picture);
    const PassCounters a = total(fxaa.trace), b = total(axaa.trace);
    for (std::size_t i = 0; i < kCounterCount; ++i)
      EXPECT_EQ(values(a)[i], values(b)[i]) << counter_catalog()[i].id;
  }
}

TEST(Axaa, LeavesWhatIsFilteredAlready) {
  int left = 0;
  for (const Picture& p : {filter(shapes(192, 120), "fxaa").picture, noise(96, 64, 6)}) {
    const Picture fxaa = filter(p, "fxaa").picture;
    const Picture axaa = filter(p, "axaa:keep_thin_lines=off,adaptive_steps=off").picture;
    const ScalarFxaa oracle(p, {1, 1.5f, 2, 4, 12});
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        const float distance = oracle.distance_to_middle(x, y);
        if (std::fabs(distance - 0.1f) < 1e-4f) continue;
        ASSERT_EQ(axaa.at(x, y), distance < 0.1f ? p.at(x, y) : fxaa.at(x, y)) << x << ", " << y;
        left += distance < 0.1f && fxaa.at(x, y) != p.at(x, y) ? 1 : 0;
      }
  }
  EXPECT_GT(left, 20);
}

TEST(Axaa, LeavesThinLines) {
  const Picture line = gray(48, 48, [](int x, int y) { return x == 20 + y / 12 ? 230 : 30; });
  const Picture kept = filter(line, "axaa").picture, lost = filter(line, "axaa:keep_thin_lines=off").picture;
  for (int y = 0; y < 48; ++y) {
    EXPECT_EQ(kept.at(20 + y / 12, y), line.at(20 + y / 12, y)) << y;
  }
  EXPECT_GT(count_differences(lost, line), count_differences(kept, line));
}

TEST(Axaa, SearchesNoMoreThanFxaa) {
  for (const Picture& p : {shapes(192, 120), noise(96, 64, 5)})
    for (const char* technique :
         {"axaa", "axaa:axaa_metric=min", "axaa:skip_filtered=off,keep_thin_lines=off"}) {
      const Filtered fxaa = filter(p, "fxaa"), axaa = filter(p, technique);
      ASSERT_EQ(fxaa.trace.passes.size(), axaa.trace.passes.size());
      EXPECT_LT(total(axaa.trace).tex.requests, total(fxaa.trace).tex.requests) << technique;
      for (std::size_t chunk = 0; chunk < fxaa.trace.passes.back().chunks.size(); ++chunk)
        EXPECT_LE(axaa.trace.passes.back().chunks[chunk].tex.requests,
                  fxaa.trace.passes.back().chunks[chunk].tex.requests);
    }
}

TEST(Axaa, KeepsLongEdges) {
  const Picture p = gray(128, 64, [](int x, int y) { return y > 8 + x / 8 ? 255 : 0; });
  EXPECT_LT(count_differences(filter(p, "axaa").picture, filter(p, "fxaa").picture), 60);
  EXPECT_GT(count_differences(filter(p, "axaa").picture, p), 60);
}

}  // namespace
}  // namespace hwsim::test
