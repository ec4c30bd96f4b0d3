// AGAA against closed forms and against itself on other paths (docs/techniques/agaa.md#memory,
// docs/techniques/agaa.md#tests).
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "algos/agaa/layout.h"
#include "algos/agaa/shaders/counters.h"
#include "algos/agaa_frames.h"

namespace hwsim::test {
namespace {
using algos::AggregateLayout;
using algos::LayoutChoice;
using algos::MaskStore;

int bits_of(float channel) {
  return __builtin_popcount(static_cast<unsigned>(std::lround(channel * 255.0f)));
}

// ---- 4.11: memory ----

/// Bytes a pixel of an AGAA frame without its output.
double bytes_per_pixel(const std::string& technique, const GpuFeatures& features) {
  const Shot run{share(patches({{-1, 1, 0}})), technique, features};
  const pipeline::FrameGraph graph = build(run);
  std::uint64_t bytes = 0;
  for (const pipeline::ImageDesc& image : graph.images())
    if (image.name != "output") bytes += pipeline::allocated_bytes(image);
  return static_cast<double>(bytes) / (kWidth * kHeight);
}

TEST(AgaaMemory, IsThePapersAtEveryRate) {
  const GpuFeatures native = native_features();
  EXPECT_EQ(bytes_per_pixel("agaa:c=2,msaa=8", native), 81.0);  // reference 128: -36.7 %
  EXPECT_EQ(bytes_per_pixel("agaa:c=2,msaa=8,agg_bytes=20", native), 89.0);
  EXPECT_EQ(bytes_per_pixel("agaa:c=2,msaa=16,agg_bytes=16", native), 130.0);  // 256
  EXPECT_EQ(bytes_per_pixel("agaa:c=2,msaa=16", native), 132.0);
  EXPECT_EQ(bytes_per_pixel("agaa:c=2,msaa=32", native), 234.0);  // 512: -54.3 %
  EXPECT_EQ(bytes_per_pixel("agaa:c=2,msaa=32,agg_bytes=20", native), 236.0);
  // c * A + 6N + N * bits / 8; the percentages of docs/techniques/agaa.md#memory are of 16 N.
  const double percent_8x[] = {-50.0, -36.7, -23.4, -10.9}, percent_32x[] = {-58.8, -54.3, -49.8, -46.1};
  for (const int c : {1, 2, 4}) {
    const std::string text = "agaa:c=" + std::to_string(c) + ",msaa=";
    EXPECT_NEAR(100.0 * (bytes_per_pixel(text + "8", native) / 128.0 - 1.0), percent_8x[c - 1], 0.06);
    EXPECT_NEAR(100.0 * (bytes_per_pixel(text + "32", native) / 512.0 - 1.0), percent_32x[c - 1], 0.06);
  }
  // Three aggregates take four color samples.
  EXPECT_EQ(bytes_per_pixel("agaa:c=3,msaa=8", native), bytes_per_pixel("agaa:c=4,msaa=8", native));
}

TEST(AgaaMemory, LayersKeepARecordEach) {
  // 2 * 16 * 4 + 192 + 4, and the merged records 2 * 19.
  EXPECT_EQ(bytes_per_pixel("agaa:c=2,msaa=32", test_features()), 324.0 + 38.0);
}

TEST(AgaaMemory, LobesHaveTheirSizes) {
  const auto bytes = [](algos::Ndf ndf) {
    LayoutChoice choice;
    choice.ndf = ndf;
    return algos::make_layout(choice).bytes();
  };
  EXPECT_EQ(bytes(algos::Ndf::toksvig), 16);
  EXPECT_EQ(bytes(algos::Ndf::lean), 20);  // 10 in place of 6
  EXPECT_EQ(bytes(algos::Ndf::sggx), 22);  // 12 in place of 6
}

// ---- 4.13 ----

// Two planes at right angles in one aggregate, of matte and of shiny material. Pure Lambert light of a lobe
// is wider the further apart the normals are, and nothing else: the first pass's normals of the samples tell
// the same spread as a mean of unit normals that is stored, however rough the material is.
TEST(Agaa, SamplesNormalsFilterDiffuseLightAsStoredOnesDo) {
  for (const float roughness : {0.3f, 0.9f}) {
    // A roof whose ridge runs through a column of pixels.
    pipeline::Scene scene =
        patches({{-5, 0.02f, -4.518f, {0.7f, 0.4f, 0.2f}, 0.9f}, {0.02f, 5, 0, {0.2f, 0.4f, 0.7f}, -0.9f}});
    for (pipeline::Material& m : scene.materials) m.roughness = roughness;
    const auto shared = share(std::move(scene));
    const auto image = [&](const char* filter) {
      return render({shared, std::string("agaa:c=1,diffuse_filter=") + filter}).color;
    };
    const pipeline::Image stored = image("geometric"), samples = image("samples");
    EXPECT_LT(largest_difference(stored, samples), 0.008f) << roughness;  // two steps of 8 bits
    EXPECT_GT(largest_difference(stored, image("off")), 0.02f) << roughness;
  }
}

TEST(Agaa, OnePlaneIsOneAggregateAndOneFragmentsShading) {
  const auto scene = share(patches({{-5, 5, 0, {0.7f, 0.4f, 0.2f}}}));
  const Shot run{scene, "agaa:k_mode=footprint,diffuse_filter=off,gloss=folded"};
  const pipeline::Emulation e = render(run);
  const PassCounters n = total(e.trace);
  const auto pixels = static_cast<std::uint64_t>(kWidth * kHeight);
  EXPECT_EQ(n.technique[algos::AgaaCounters::agaa_aggregates], pixels);
  EXPECT_EQ(total(pass_named(e.trace, "shade")).technique[algos::BaseCounters::lit_samples], pixels);
  const Planes chroma = planes_of(run, "aggregate_chroma");
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      EXPECT_EQ(bits_of(chroma.at(x, y, 0).w), 8);
      EXPECT_EQ(bits_of(chroma.at(x, y, 1).w), 0);
    }
  // Per-pixel shading of the same attributes; both round to 8 bits, the aggregate's albedo to 10.
  EXPECT_LT(largest_difference(e.color, render({scene, "none"}).color), 3.0f / 255.0f);
}

TEST(Agaa, MasksAreDisjointAndHoldEverySampleThatIsNotSky) {
  for (const char* technique : {"agaa:c=2", "agaa:c=4", "agaa:c=3", "agaa:c=1", "agaa:c=2,msaa=4"}) {
    const auto scene = share(
        patches({{-5, 0.31f, 0}, {-0.77f, 0.05f, 0.4f}, {0.1f, 0.7f, -0.3f, {0.2f, 0.4f, 0.9f}, 2.0f}}));
    const Shot run{scene, technique};
    const Planes chroma = planes_of(run, "aggregate_chroma"), depth = planes_of(run, "depth");
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        unsigned all = 0, sum = 0, seen = 0;
        for (int a = 0; a < chroma.count; ++a) {
          const auto mask = static_cast<unsigned>(std::lround(chroma.at(x, y, a).w * 255.0f));
          all |= mask;
          sum += mask;
        }
        for (int s = 0; s < depth.count; ++s) seen |= (depth.at(x, y, s).x < 1.0f ? 1u : 0u) << s;
        ASSERT_EQ(all, sum) << technique;
        ASSERT_EQ(all, seen) << technique << " " << x << " " << y;
      }
  }
}

// Albedo alone varies: its mean, shaded, is the mean of the shaded.
TEST(Agaa, OneAggregateIsLinearInAlbedo) {
  const auto scene =
      share(patches({{-5, 0.013f, 0, {0.9f, 0.1f, 0.1f}}, {0.013f, 5, 0, {0.1f, 0.2f, 0.8f}}}));
  const pipeline::Emulation a = render({scene, "agaa:c=1,diffuse_filter=off"});
  const pipeline::Emulation b = render({scene, "deferred"});
  EXPECT_LT(largest_difference(a.color, b.color), 4.0f / 255.0f);
}

// Albedo and orientation vary together: one aggregate mixes them up, two do not.
TEST(Agaa, TwoAggregatesKeepCorrelatedAttributesApart) {
  const auto scene = share(
      patches({{-5, 0.013f, 0, {0.9f, 0.05f, 0.05f}, 0.0f}, {0.013f, 5, -0.2f, {0.05f, 0.05f, 0.9f}, 2.5f}}));
  const pipeline::Image reference = render({scene, "deferred"}).color;
  const float one = largest_difference(render({scene, "agaa:c=1,diffuse_filter=off"}).color, reference);
  const float two = largest_difference(render({scene, "agaa:c=2,diffuse_filter=off"}).color, reference);
  EXPECT_LT(two, 6.0f / 255.0f);
  EXPECT_GT(one, 2.0f * two);
}

// More aggregates come closer to lighting every sample.
TEST(Agaa, MoreAggregatesComeCloserToEverySample) {
  std::vector<Rectangle> list;
  for (int i = 0; i < 40; ++i) {
    const float left = -1.0f + 0.05f * static_cast<float>(i);
    list.push_back({left,
                    left + 0.03f,
                    0.2f * static_cast<float>(i % 3),
                    {0.2f * static_cast<float>(i % 5), 0.8f - 0.1f * static_cast<float>(i % 7), 0.4f},
                    static_cast<float>(i % 4) - 1.5f});
  }
  list.push_back({-5, 5, -0.5f});
  const auto scene = share(patches(list));
  const pipeline::Image reference = render({scene, "deferred"}).color;
  double last = 1e9;
  for (const char* c : {"1", "2", "4"}) {
    const pipeline::Image image = render({scene, std::string("agaa:t=0,diffuse_filter=off,c=") + c}).color;
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      for (int k = 0; k < 3; ++k) sum += std::pow(image.pixels[i][k] - reference.pixels[i][k], 2.0);
    EXPECT_LT(sum, last) << c;
    last = sum;
  }
}

// Three walls 2.5 m apart, each in a third of every pixel. A wall that only one sample of a pixel sees may
// join another; before, hardly any pixel had a third aggregate.
TEST(Agaa, ThreeWallsAreThreeAggregates) {
  std::vector<Rectangle> list;
  const float pixel = 0.03625f;  // wide, at distance 1
  for (int wall = 0; wall < 2; ++wall) {
    const float distance = 2.0f + 2.5f * static_cast<float>(wall);
    for (int i = -kWidth / 2; i < kWidth / 2; ++i) {
      const float left = static_cast<float>(i) * pixel * distance;
      list.push_back({left, left + pixel * distance * (wall == 0 ? 0.34f : 0.67f), 2.0f - distance,
                      wall == 0 ? glm::vec3(0.9f, 0.1f, 0.1f) : glm::vec3(0.1f, 0.8f, 0.1f),
                      wall == 0 ? 1.5f : -1.5f});
    }
  }
  list.push_back({-9, 9, -5.0f, {0.1f, 0.1f, 0.9f}});
  const auto scene = share(patches(list));
  const pipeline::Image reference = render({scene, "deferred"}).color;
  double last = 1e9;
  for (const std::uint64_t c : {2u, 3u}) {
    const pipeline::Emulation e = render({scene, "agaa:k_mode=footprint,c=" + std::to_string(c)});
    EXPECT_GT(total(e.trace).technique[algos::AgaaCounters::agaa_aggregates],
              c * kWidth * kHeight * 85 / 100);
    double sum = 0.0;
    for (std::size_t i = 0; i < e.color.pixels.size(); ++i)
      sum += std::pow(e.color.pixels[i].x - reference.pixels[i].x, 2.0);
    EXPECT_LT(sum, 0.5 * last) << c;
    last = sum;
  }
}

TEST(Agaa, CodesNameExistingAggregatesAndFollowTheDistance) {
  const auto scene = share(patches({{-5, 0.013f, 0}, {0.013f, 5, -0.6f, glm::vec3(0.3f)}}));
  for (const int c : {2, 4}) {
    const Planes codes = planes_of({scene, "agaa:c=" + std::to_string(c)}, "codes");
    const Planes depth = planes_of({scene, "agaa:c=" + std::to_string(c)}, "depth");
    const int bits = c == 2 ? 1 : 2;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const int word = static_cast<int>(codes.at(x, y, 0).x);
        int left = -1, right = -1;
        for (int s = 0; s < 8; ++s) {
          const int code = word >> (s * bits) & ((1 << bits) - 1);
          ASSERT_LT(code, c);
          // The two surfaces are more than half a meter apart: their samples never share a code.
          (depth.at(x, y, s).x < depth.at(0, y, 0).x + 1e-4f ? left : right) = code;
        }
        if (left >= 0 && right >= 0) {
          ASSERT_NE(left, right) << x << " " << y;
        }
      }
  }
}

// 4.14: with a large k surfaces join whatever lies between them, if their normals agree; with a small one
// each step in depth is two.
TEST(Agaa, KDecidesWhetherDistanceKeepsSurfacesApart) {
  const auto aggregates = [](const std::vector<Rectangle>& list, const char* k, const char* more = "") {
    const Shot shot{share(patches(list)), std::string("agaa:c=2,k=") + k + more};
    return total(render(shot).trace).technique[algos::AgaaCounters::agaa_aggregates];
  };
  const std::vector<Rectangle> parallel = {{-5, 0.02f, 0}, {0.02f, 5, -0.5f}};
  const std::vector<Rectangle> crossing = {{-5, 0.02f, -4.518f, glm::vec3(0.5f), 0.9f},
                                           {0.02f, 5, 0, glm::vec3(0.5f), -0.9f}};
  const std::uint64_t covered = aggregates(parallel, "10", ",t=1");
  EXPECT_EQ(aggregates(parallel, "10"), covered);
  EXPECT_EQ(aggregates(parallel, "1"), covered + kHeight);  // a column of pixels has both
  EXPECT_EQ(aggregates(crossing, "10"), aggregates(crossing, "10", ",t=1") + kHeight);
}

TEST(Agaa, AMeshDrawnTwiceIsTheMeshDrawnOnce) {
  const Rectangle a{-0.8f, 0.33f, 0, {0.8f, 0.3f, 0.1f}, 0.7f},
      b{-0.2f, 0.9f, 0.1f, {0.1f, 0.6f, 0.9f}, -0.4f};
  const auto once = share(patches({a, b})), twice = share(patches({a, b, a, b, a}));
  const pipeline::Emulation first = render({once, "agaa:c=2"}), second = render({twice, "agaa:c=2"});
  EXPECT_EQ(difference(first.color, second.color, "image"), "");
}

TEST(Agaa, DrawOrderChangesNothing) {
  const Rectangle a{-0.8f, 0.33f, 0, {0.8f, 0.3f, 0.1f}, 0.7f},
      b{-0.2f, 0.9f, 0.1f, {0.1f, 0.6f, 0.9f}, -0.4f}, c{0.3f, 0.5f, 0.3f, {0.9f, 0.9f, 0.2f}};
  const pipeline::Image x = render({share(patches({a, b, c})), "agaa:c=2"}).color;
  const pipeline::Image y = render({share(patches({c, b, a})), "agaa:c=2"}).color;
  EXPECT_LE(largest_difference(x, y), 2.5f / 255.0f);  // sums round in another order
}

// Flat colors and normals: where attributes are taken makes no difference, so layers and native samples
// agree.
TEST(Agaa, LayersOfEightSamplesAreNativeSamples) {
  const auto scene = share(patches({{-0.8f, 0.33f, 0, {0.8f, 0.3f, 0.1f}, 0.7f},
                                    {-0.2f, 0.9f, 0.1f, {0.1f, 0.6f, 0.9f}, -0.4f},
                                    {-0.6f, 0.6f, 0.5f, {0.9f, 0.9f, 0.2f}, 0.0f, 0.4f}}));
  const std::string technique = "agaa:c=4,msaa=32,plane_path=off,k_mode=footprint,footprint_px=32";
  const Shot layered{scene, technique}, native{scene, technique, native_features()};
  const Planes depth_a = planes_of(layered, "depth"), depth_b = planes_of(native, "depth");
  EXPECT_EQ(difference(depth_a.image, depth_b.image, "depth"), "");
  // Normals round to 8 bits, and a fragment of mixed codes is routed by its first sample, in each layer anew:
  // a few pixels may differ.
  const auto differing = [](const Planes& a, const Planes& b, int channel) {
    int count = 0;
    for (std::size_t i = 0; i < a.image.pixels.size(); ++i)
      count += a.image.pixels[i][channel] != b.image.pixels[i][channel] ? 1 : 0;
    return static_cast<double>(count) / static_cast<double>(a.image.pixels.size());
  };
  const Planes a = planes_of(layered, "codes"), b = planes_of(native, "codes");
  ASSERT_EQ(a.count, 4);
  EXPECT_LT(differing(a, b, 0), 0.01);
  for (const auto& [name, channel] : {std::pair("chroma", 3), std::pair("mask_1", 0), std::pair("mask_2", 1)})
    EXPECT_LT(differing(planes_of(layered, std::string("merged_") + name),
                        planes_of(native, std::string("aggregate_") + name), channel),
              0.03)
        << name;
  // A fragment of the native pass is one of each layer: their parts round apart.
  EXPECT_LT(largest_difference(render(layered).color, render(native).color), 12.0f / 255.0f);
}

TEST(Agaa, AtomicsAddUpWhatBlendingDoes) {
  GpuFeatures features = test_features();
  features.target_independent_raster = false;
  const auto scene = share(patches({{-0.8f, 0.33f, 0, {0.8f, 0.3f, 0.1f}, 0.7f}, {-0.2f, 0.9f, 0.1f}}));
  for (const char* technique :
       {"agaa:c=2", "agaa:c=3,ndf=sggx,brdf=ggx", "agaa:c=2,ndf=lean", "agaa:c=2,msaa=16"}) {
    const pipeline::Emulation blended = render({scene, technique}),
                              added = render({scene, technique, features});
    EXPECT_LT(largest_difference(blended.color, added.color), 5.0f / 255.0f) << technique;
    EXPECT_GT(total(pass_named(added.trace, "generate")).shader.atomic_lane_ops, 0u);
  }
  features.post_depth_coverage = false;
  try {
    render({scene, "agaa", features});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(error.diagnostics().front().help.find("gpu.features.post_depth_coverage"), std::string::npos);
  }
}

// Lobes of a flat patch are the material's own, whichever way they are kept.
TEST(Agaa, FlatLobesShineLikeTheMaterial) {
  const auto scene = share(patches({{-5, 5, 0, {0.2f, 0.2f, 0.2f}}}));
  const pipeline::Image forward = render({scene, "none"}).color;
  const pipeline::Image toksvig = render({scene, "agaa:diffuse_filter=off"}).color;
  const pipeline::Image lean = render({scene, "agaa:diffuse_filter=off,ndf=lean"}).color;
  EXPECT_LT(largest_difference(forward, toksvig), 3.0f / 255.0f);
  EXPECT_LT(largest_difference(forward, lean), 14.0f / 255.0f);  // a Gaussian for a power of a cosine
  const pipeline::Image ggx = render({scene, "agaa:diffuse_filter=off,brdf=ggx"}).color;
  const pipeline::Image sggx = render({scene, "agaa:diffuse_filter=off,brdf=ggx,ndf=sggx"}).color;
  EXPECT_LT(largest_difference(ggx, sggx), 20.0f / 255.0f);  // SGGX's diffuse light spreads by the roughness
}

// Nor does it take on color, or other light where it is rough, or where normals alone spread diffuse light.
TEST(Agaa, RoughFlatLobesAreTheMaterialsOwn) {
  pipeline::Scene rough = patches({{-5, 5, 0, {0.9f, 0.9f, 0.9f}}});
  rough.materials.front().roughness = 0.93f;  // exponent 0.67
  rough.materials.front().metallic = 0.5f;
  rough.ambient = glm::vec3(0.0f);  // the lobe alone
  const auto scene = share(std::move(rough));
  const pipeline::Image forward = render({scene, "none"}).color;
  EXPECT_LT(largest_difference(forward, render({scene, "agaa"}).color), 1.5f / 255.0f);
  EXPECT_LT(largest_difference(forward, render({scene, "agaa:ndf=sggx"}).color), 3.0f / 255.0f);
  const auto glossy = share(patches({{-5, 5, 0, {0.2f, 0.2f, 0.2f}}}));
  const pipeline::Image shiny = render({glossy, "none"}).color;
  EXPECT_LT(largest_difference(shiny, render({glossy, "agaa:ndf=sggx"}).color), 8.0f / 255.0f);
  EXPECT_LT(largest_difference(shiny, render({glossy, "agaa:ndf=lean"}).color), 8.0f / 255.0f);
}

// Neutral chroma is a whole code at each part of full weight, and read as that.
TEST(Agaa, GrayStaysGray) {
  const Shot shot{share(patches({{-0.81f, 0.13f, 0, glm::vec3(0.5f)}, {0.13f, 0.9f, 0.1f, glm::vec3(0.5f)}})),
                  "agaa"};
  const Planes chroma = planes_of(shot, "aggregate_chroma");
  const pipeline::Image image = render(shot).color;
  int partial = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      int samples = 0;
      for (int a = 0; a < chroma.count; ++a) {
        const glm::vec4& texel = chroma.at(x, y, a);
        const int own = bits_of(texel.w);
        EXPECT_EQ(std::lround(texel.x * 255.0f), 16 * own) << x << " " << y;
        EXPECT_EQ(std::lround(texel.y * 255.0f), 16 * own) << x << " " << y;
        partial += own % 8 != 0 ? 1 : 0;
        samples += own;
      }
      if (samples < 8) continue;  // the sky has a color
      EXPECT_EQ(image.at(x, y).x, image.at(x, y).y);
      EXPECT_EQ(image.at(x, y).x, image.at(x, y).z);
    }
  EXPECT_GT(partial, 10);
}

// Seen and lit along the mean normal of slats: the lobe's density there times what the material reflects in
// all, which does not grow with the normals' spread.
TEST(Agaa, SpreadNormalsReflectNoMoreLight) {
  pipeline::Scene scene = slats(0.8f);
  for (pipeline::Material& m : scene.materials) m.metallic = 1.0f;  // no diffuse light
  scene.lights.front().direction = glm::vec3(0.0f, 0.0f, -1.0f);
  scene.ambient = glm::vec3(0.0f);
  const Shot shot{share(std::move(scene)), "agaa:c=1"};
  const Planes shape = planes_of(shot, "aggregate_shape");
  const pipeline::Image image = render(shot).color;
  const float own = 2.0f / std::pow(0.5f, 4.0f) - 2.0f;
  int spread = 0;
  for (int x = kWidth / 2 - 4; x < kWidth / 2 + 4; ++x) {
    const glm::vec3 v(shape.at(x, kHeight / 2, 0));
    const float length = glm::length(v), exponent = length / (1.0f - length);
    if (exponent > 5.0f || v.z < 0.98f * length) continue;
    ++spread;
    const float expected =
        0.5f * 0.8f * (exponent + 1.0f) * (own + 8.0f) / (own + 1.0f) / (8.0f * 3.14159265f);
    EXPECT_NEAR(image.at(x, kHeight / 2).x, expected, 0.05f * expected) << x;
  }
  EXPECT_GT(spread, 0);
}

// Slats of two slopes: their common lobe is wider than that of either.
TEST(Agaa, MixedNormalsWidenTheLobe) {
  const Planes shape = planes_of({share(slats(0.6f)), "agaa:c=1"}, "aggregate_shape");
  const float own = 2.0f / std::pow(0.5f, 4.0f) - 2.0f, length = own / (own + 1.0f);  // roughness 1/2
  int mixed = 0;
  for (int x = 8; x < kWidth - 8; ++x) {
    const glm::vec3 v(shape.at(x, kHeight / 2, 0));
    EXPECT_LE(glm::length(v), length + 1e-3f);
    mixed += glm::length(v) < 0.95f * length ? 1 : 0;
  }
  EXPECT_GT(mixed, 10);
}

// Fragments whose samples have several codes go to the first one's aggregate: counted.
TEST(Agaa, CountsFragmentsWithSeveralCodes) {
  const auto split = share(patches({{-5, 5, -20, glm::vec3(0.5f), 4.0f}}));  // one plane, deep within a pixel
  const PassCounters n = total(render({split, "agaa:c=2,t=0.0001"}).trace);
  EXPECT_GT(n.technique[algos::AgaaCounters::agaa_mixed_code_fragments], 100u);
  EXPECT_GT(n.technique[algos::AgaaCounters::agaa_plane_split_pixels], 100u);
  const PassCounters whole = total(render({split, "agaa:c=2,k_mode=footprint,footprint_px=64"}).trace);
  // Those that are left see the plane edge on.
  EXPECT_LT(10 * whole.technique[algos::AgaaCounters::agaa_mixed_code_fragments],
            n.technique[algos::AgaaCounters::agaa_mixed_code_fragments]);
  EXPECT_LT(10 * whole.technique[algos::AgaaCounters::agaa_plane_split_pixels],
            n.technique[algos::AgaaCounters::agaa_plane_split_pixels]);
}

// Every option runs and gives finite pixels.
TEST(Agaa, EveryOptionRuns) {
  const auto scene = share(patches({{-0.8f, 0.33f, 0, {0.8f, 0.3f, 0.1f}, 0.7f}, {-0.2f, 0.9f, 0.1f}}));
  for (const char* options :
       {"diffuse_filter=geometric", "gloss=separate", "agg_float=on", "depth_moments=on", "light_variance=on",
        "mean_normal=raw", "seeds=sum2,c=4", "seeds=sum,c=3", "shadow_taps=3", "s_ref=500",
        "msaa=16,agg_bytes=16", "msaa=32,agg_bytes=20", "msaa=16,agg_bytes=16,ndf=sggx",
        "a2c_dither=off,centroid=off", "shadow_axis=places", "shadow_axis=places,light_variance=on"}) {
    const pipeline::Emulation e = render({scene, std::string("agaa:") + options});
    double sum = 0.0;
    for (const glm::vec4& p : e.color.pixels) sum += p.x + p.y + p.z;
    EXPECT_TRUE(std::isfinite(sum)) << options;
    EXPECT_GT(sum, 1.0) << options;
  }
}

}  // namespace
}  // namespace hwsim::test
