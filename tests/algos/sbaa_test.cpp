// Surface based anti-aliasing against multisampled deferred shading, against another implementation of its
// analysis, and against scenes whose surfaces can be counted by hand (docs/techniques/sbaa.md#tests).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "algos/sbaa/shaders/counters.h"
#include "algos/sbaa_frames.h"

namespace hwsim::test {
namespace {
using pipeline::Image;

constexpr int kWidth = 112, kHeight = 63, kSamples = 8;

struct SurfaceSlot {
  int id = 0, count = 0;
  friend bool operator==(const SurfaceSlot&, const SurfaceSlot&) = default;
};

struct Sample {
  int id = 0;  ///< truncated
  bool drawn = false;
  glm::vec3 normal{0.0f};
  float z = 1.0f;
};

struct AnalysisRules {
  bool merge = false;
  int slots = 2;
  float cos_alpha = 0.0f, end_region = 0.25f;
};

/// docs/techniques/sbaa.md#analysis, written a pixel at a time; counts fallbacks.
std::vector<SurfaceSlot> analyze(const std::vector<Sample>& samples, const AnalysisRules& rules,
                                 std::uint64_t& fallbacks) {
  std::vector<SurfaceSlot> slots(static_cast<std::size_t>(rules.slots));
  std::vector<const Sample*> left;
  for (const Sample& s : samples)
    if (s.drawn) left.push_back(&s);
  for (SurfaceSlot& slot : slots) {
    if (left.empty()) break;
    const auto votes = [&](int id) {
      return std::count_if(left.begin(), left.end(), [&](const Sample* s) { return s->id == id; });
    };
    const Sample* reference = left.front();
    for (const Sample* s : left)
      if (votes(s->id) > votes(reference->id)) reference = s;
    const auto own = [&](const Sample* s) { return s->id == reference->id; };
    const auto aligned = [&](const Sample* s) {
      return own(s) || (rules.merge && glm::dot(reference->normal, s->normal) > rules.cos_alpha);
    };
    float low = 1e30f, high = -1e30f;
    for (const Sample* s : left) {
      if (!aligned(s)) continue;
      low = std::min(low, s->z);
      high = std::max(high, s->z);
    }
    const float end = (high - low) * rules.end_region;
    bool one_mode = low >= high;
    for (const Sample* s : left) one_mode |= aligned(s) && s->z >= low + end && s->z <= high - end;
    fallbacks += rules.merge && !one_mode ? 1 : 0;
    const auto taken = [&](const Sample* s) { return own(s) || (one_mode && aligned(s)); };
    slot = {reference->id, static_cast<int>(std::count_if(left.begin(), left.end(), taken))};
    std::erase_if(left, taken);
  }
  return slots;
}

std::vector<Sample> samples_at(const Image& ids, const Image& normals, const Image& depth, int x, int y,
                               int id_mask) {
  std::vector<Sample> all;
  const int samples = ids.width / kWidth;
  for (int s = 0; s < samples; ++s) {
    const int column = x * samples + s;
    const int code = static_cast<int>(ids.at(column, y).x);
    Sample sample;
    sample.drawn = code > id_mask;
    sample.id = code & id_mask;
    sample.normal = glm::vec3(normals.at(std::min(column, normals.width - 1), y));
    sample.z = depth.at(column, y).x;
    all.push_back(sample);
  }
  return all;
}

PassCounters frame_total(const pipeline::Emulation& e) { return total(e.trace); }

/// Slots of the emulated analysis, the background of slot 0 apart.
std::vector<SurfaceSlot> emulated_slots(const Image& surfaces, int x, int y, int slots, int unit,
                                        int& background) {
  std::vector<SurfaceSlot> all;
  for (int k = 0; k < slots; ++k) {
    const glm::vec4 texel = surfaces.at(x, y + k * kHeight);
    int count = static_cast<int>(texel.y);
    if (k == 0) {
      background = count / unit;
      count %= unit;
    }
    all.push_back({static_cast<int>(texel.x), count});
  }
  return all;
}

void compare_analysis(const std::string& technique, const AnalysisRules& rules, int samples, int id_bits,
                      const std::string& scene_spec) {
  SCOPED_TRACE(technique + " on " + scene_spec);
  const auto scene = generated_scene(scene_spec);
  const auto graph = build_graph(technique, scene, kWidth, kHeight);
  const Image ids = dump(graph, "primitive_id"), depth = dump(graph, "depth");
  const Image normals = rules.merge ? dump(graph, "normal") : Image(1, kHeight);
  const Image surfaces = dump(graph, "surfaces");
  const int unit = id_bits < 8 && samples <= 8 ? 16 : 256;
  std::uint64_t fallbacks = 0, emitted = 0, wrong = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto pixel = samples_at(ids, normals, depth, x, y, (1 << id_bits) - 1);
      const auto expected = analyze(pixel, rules, fallbacks);
      int background = 0;
      const auto found = emulated_slots(surfaces, x, y, rules.slots, unit, background);
      wrong += found != expected ? 1 : 0;
      int sum = background;
      for (const SurfaceSlot& slot : found) {
        sum += slot.count;
        emitted += slot.count > 0 ? 1 : 0;
      }
      ASSERT_LE(sum, samples);
      ASSERT_EQ(background,
                std::count_if(pixel.begin(), pixel.end(), [](const Sample& s) { return !s.drawn; }));
      if (rules.slots == samples) {
        ASSERT_EQ(sum, samples);
      }
    }
  }
  EXPECT_EQ(wrong, 0u);
  const PassCounters n = frame_total(run_graph(graph));
  EXPECT_EQ(n.technique[algos::SbaaCounters::slots_emitted_surfaces], emitted);
  EXPECT_EQ(n.technique[algos::SbaaCounters::merge_fallbacks_surfaces], fallbacks);
  EXPECT_EQ(n.technique[algos::SbaaCounters::slots_empty_surfaces],
            0u);  // EQUAL finds the bits of the first pass
  EXPECT_GT(emitted, 0u);
}

TEST(SbaaAnalysis, IsThatOfAnotherImplementation) {
  const float cosine = std::cos(0.19634954084936207f);
  for (const char* scene : {"sponza_hall", "grass:blades=4000"}) {
    compare_analysis("sbaa_top:n=2,msaa=4", {false, 2}, 4, 7, scene);
    compare_analysis("sbaa_top:n=8,msaa=8,id_bits=5", {false, 8}, 8, 5, scene);
    compare_analysis("sbaa_top:n=5,msaa=16,id_bits=9", {false, 5}, 16, 9, scene);
    compare_analysis("sbaa_merge:n=2,msaa=4", {true, 2, cosine}, 4, 7, scene);
    compare_analysis("sbaa_merge:n=3,msaa=8", {true, 3, cosine}, 8, 7, scene);
    compare_analysis("sbaa_merge:n=8,msaa=8,alpha=0.5,end_region=0.4", {true, 8, std::cos(0.5f), 0.4f}, 8, 7,
                     scene);
  }
}

/// Distinct primitives of a pixel's samples, and whether two of them share their low bits.
struct PixelPrimitives {
  int count = 0;
  bool alias = false;
};
PixelPrimitives primitives_at(const Image& ids, int x, int y, int low_mask) {
  const int samples = ids.width / kWidth;
  std::set<int> full, low;
  for (int s = 0; s < samples; ++s) {
    const int code = static_cast<int>(ids.at(x * samples + s, y).x);
    if (code == 0) continue;
    full.insert(code);
    low.insert(code & low_mask);
  }
  return {static_cast<int>(full.size()), full.size() != low.size()};
}

// Both average colors that were lit from the same 32 bytes; the reference rounds each to 8 bits first.
TEST(SbaaTop, EqualsMultisamplingWhereItKeepsEveryPrimitive) {
  for (const char* spec : {"sponza_hall", "grass:blades=4000"}) {
    const auto scene = generated_scene(spec);
    const Image reference =
        run_graph(build_graph("deferred:layout=gb_sbaa40", scene, kWidth, kHeight, true)).color;
    const Image ids = dump(build_graph("sbaa_top:id_bits=16", scene, kWidth, kHeight), "primitive_id");
    for (const int slots : {1, 2, 3, 8}) {
      const Image image =
          run_graph(build_graph("sbaa_top:n=" + std::to_string(slots), scene, kWidth, kHeight, true)).color;
      int compared = 0, differing = 0;
      double sum = 0.0, most = 0.0;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const PixelPrimitives p = primitives_at(ids, x, y, 127);
          if (p.count > slots || p.alias) continue;
          ++compared;
          const double d = code_difference(image.at(x, y), reference.at(x, y));
          most = std::max(most, d);
          sum += d;
          differing += d > 1.01 ? 1 : 0;
        }
      }
      EXPECT_GT(compared, slots == 8 ? kWidth * kHeight * 8 / 10 : kWidth * kHeight / 20) << spec;
      EXPECT_LE(most, 1.01) << spec << ", n = " << slots << ": " << differing << " of " << compared;
      EXPECT_LE(sum / compared, 0.4) << spec << ", n = " << slots;
    }
  }
}

TEST(SbaaTop, ErrorFallsWithMoreSurfaces) {
  const auto scene = generated_scene("grass:blades=4000");
  const Image reference = run_graph(build_graph("deferred:layout=gb_sbaa40", scene, kWidth, kHeight)).color;
  double last_rmse = 1e9, last_worst = 1e9;
  for (const int slots : {1, 2, 3, 4, 6, 8}) {
    const Image image =
        run_graph(build_graph("sbaa_top:id_bits=16,n=" + std::to_string(slots), scene, kWidth, kHeight))
            .color;
    double sum = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const double d = code_difference(image.pixels[i], reference.pixels[i]);
      sum += d * d;
      worst = std::max(worst, d);
    }
    const double rmse = std::sqrt(sum / static_cast<double>(image.pixels.size()));
    EXPECT_LE(rmse, last_rmse) << slots;
    EXPECT_LE(worst, 1.05 * last_worst) << slots;
    last_rmse = rmse;
    last_worst = worst;
  }
  EXPECT_LT(last_rmse, 0.7);  // what rounding leaves
}

// One plane in small triangles, tilted: every sample belongs to the first surface.
TEST(SbaaMerge, OfATessellatedPlaneIsOneSurface) {
  std::vector<glm::vec3> corners;
  add_grid(corners, {-30, -20, -21}, {60, 0, 7}, {0, 40, 3}, 200);
  const auto scene = share(faceted_scene(corners));
  const auto graph = build_graph("sbaa_merge:n=2", scene, kWidth, kHeight);
  const PassCounters n = frame_total(run_graph(graph));
  EXPECT_EQ(n.technique[algos::SbaaCounters::slots_emitted_surfaces],
            static_cast<std::uint64_t>(kWidth * kHeight));
  EXPECT_EQ(n.technique[algos::SbaaCounters::merge_fallbacks_surfaces], 0u);
  const Image surfaces = dump(graph, "surfaces");
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) ASSERT_EQ(surfaces.at(x, y).y, 8.0f) << x << ", " << y;
  const PassCounters top = frame_total(run_graph(build_graph("sbaa_top:n=2", scene, kWidth, kHeight)));
  EXPECT_GT(top.technique[algos::SbaaCounters::slots_emitted_second_surfaces],
            static_cast<std::uint64_t>(kWidth * kHeight / 2));
}

// Triangles whose normals differ pairwise by more than pi/16: nothing merges.
TEST(SbaaMerge, OfBladesIsTop) {
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 12; ++i) {  // tilts of 0.5 radians and turns of a twelfth
    const float turn = 0.5236f * static_cast<float>(i);
    const glm::vec3 across(std::cos(turn), std::sin(turn), 0.5f),
        along(-std::sin(turn), std::cos(turn), 0.3f);
    const glm::vec3 base(-4.0f + 0.7f * static_cast<float>(i), -2.0f, -8.0f - 0.1f * static_cast<float>(i));
    corners.insert(corners.end(), {base, base + across * 0.8f, base + along * 5.0f});
  }
  for (std::size_t i = 0; i < corners.size(); i += 3)
    for (std::size_t j = 0; j < i; j += 3) {
      const auto normal = [&](std::size_t t) {
        return glm::normalize(glm::cross(corners[t + 1] - corners[t], corners[t + 2] - corners[t]));
      };
      ASSERT_LT(std::fabs(glm::dot(normal(i), normal(j))), 0.980785f) << i / 3 << ", " << j / 3;
    }
  const auto scene = share(faceted_scene(corners));
  const auto top = run_graph(build_graph("sbaa_top:n=2", scene, kWidth, kHeight));
  const auto merge = run_graph(build_graph("sbaa_merge:n=2", scene, kWidth, kHeight));
  EXPECT_EQ(difference(top.color, merge.color, "image"), "");
  EXPECT_EQ(frame_total(top).technique[algos::BaseCounters::lit_samples],
            frame_total(merge).technique[algos::BaseCounters::lit_samples]);
  EXPECT_GT(frame_total(top).technique[algos::SbaaCounters::slots_emitted_second_surfaces], 0u);
}

// A near and a far plane with one normal: their samples lie at both ends of the depth range.
TEST(SbaaMerge, OfDistantParallelPlanesFallsBackToTop) {
  std::vector<glm::vec3> corners;
  corners = {{-90, -50, -60}, {90, -50, -60},  {0, 130, -60},    // far
             {-3, -3, -5},    {0.03f, -3, -5}, {0.41f, 7, -5}};  // near: a slanted edge through the screen
  const auto scene = share(faceted_scene(corners));
  const auto graph = build_graph("sbaa_merge:n=2", scene, kWidth, kHeight);
  const auto merge = run_graph(graph);
  const auto top = run_graph(build_graph("sbaa_top:n=2", scene, kWidth, kHeight));
  const PassCounters n = frame_total(merge);
  EXPECT_GT(n.technique[algos::SbaaCounters::merge_fallbacks_surfaces], static_cast<std::uint64_t>(kHeight));
  // Each edge pixel falls back once: what is left then is one plane, of one depth.
  EXPECT_EQ(n.technique[algos::SbaaCounters::merge_fallbacks_surfaces],
            n.technique[algos::SbaaCounters::slots_emitted_second_surfaces]);
  EXPECT_EQ(difference(top.color, merge.color, "image"), "");
}

TEST(SbaaMerge, PackingChangesBytesAlone) {
  const auto scene = generated_scene("sponza_hall");
  const auto plain = build_graph("sbaa_merge:n=3", scene, kWidth, kHeight, true);
  const auto packed = build_graph("sbaa_merge:n=3,pack_id_normal=on", scene, kWidth, kHeight, true);
  EXPECT_EQ(difference(run_graph(plain).color, run_graph(packed).color, "image"), "");
  const auto bytes = [](const pipeline::FrameGraph& g) {
    return pipeline::compile(g, features_for(32), FunctionalConfig{}).allocated_bytes;
  };
  EXPECT_EQ(bytes(plain) - bytes(packed), static_cast<std::uint64_t>(kWidth * kHeight * kSamples));
}

TEST(Sbaa, ShowsTheBackgroundWhereNothingIs) {
  const auto scene = share(faceted_scene({{-1, -1, -5}, {1, -1, -5}, {0.1f, 1, -5}}));
  const auto reference = run_graph(build_graph("deferred:layout=gb_sbaa40", scene, kWidth, kHeight));
  for (const char* technique :
       {"sbaa_top:n=1", "sbaa_merge:n=2", "sbaa_top:n=1,msaa=16", "sbaa_top:id_bits=9"}) {
    const auto e = run_graph(build_graph(technique, scene, kWidth, kHeight));
    EXPECT_EQ(e.color.at(0, 0), reference.color.at(0, 0)) << technique;
    if (std::string(technique).find("16") != std::string::npos) continue;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        ASSERT_LE(code_difference(e.color.at(x, y), reference.color.at(x, y)), 1.01)
            << technique << " " << x << ", " << y;
  }
  // Without its weight, edge pixels show the triangle alone.
  const auto ignored = run_graph(build_graph("sbaa_top:n=1,background=ignore", scene, kWidth, kHeight)).color;
  EXPECT_EQ(ignored.at(0, 0), reference.color.at(0, 0));
  int edges = 0;
  for (std::size_t i = 0; i < ignored.pixels.size(); ++i)
    edges += code_difference(ignored.pixels[i], reference.color.pixels[i]) > 4.0 ? 1 : 0;
  EXPECT_GT(edges, kHeight / 2);
}

pipeline::Emulation small_triangle(const std::string& technique) {
  const auto scene = share(faceted_scene({{-0.2f, -0.2f, -5}, {0.2f, -0.2f, -5}, {0.1f, 0.2f, -5}}));
  return run_graph(build_graph(technique, scene, 64, 64));
}

PassCounters counters_of(const pipeline::Emulation& e, const std::string& pass) {
  const auto at =
      std::ranges::find_if(e.trace.passes, [&](const PassWork& work) { return work.name == pass; });
  return at == e.trace.passes.end() ? PassCounters{} : total(*at);
}

// The analysis takes its first iteration everywhere: what it costs does not depend on what is covered. With
// empty_exit=on groups of empty pixels are left; the picture is the same.
TEST(SbaaAnalysis, CostsWhatItCostsWhereverNothingIs) {
  for (const std::string technique : {"sbaa_top:n=2", "sbaa_merge:n=2"}) {
    const auto all = small_triangle(technique), some = small_triangle(technique + ",empty_exit=on");
    EXPECT_TRUE(all.color.pixels == some.color.pixels);
    EXPECT_GT(counters_of(all, "analysis").shader.alu_lane_ops,
              counters_of(some, "analysis").shader.alu_lane_ops * 3 / 2)
        << technique;
  }
}

// The analysis writes surfaces and no record: these come from the G-buffer pass alone.
TEST(SbaaAnalysis, WritesTwoBytesASurfaceAndNoRecord) {
  const auto e = small_triangle("sbaa_top:n=2");
  EXPECT_EQ(counters_of(e, "analysis").mem.storage_write_bytes, 64u * 64u * 2u * 2u);
  EXPECT_EQ(counters_of(e, "analysis").shader.narrow_store_lane_ops, 64u * 64u * 2u);
}

// Without its G-buffer pass every chosen slot stays empty: skipped, and the pixel shows the background.
TEST(Sbaa, SkipsSlotsThatNothingWasWrittenTo) {
  const auto scene = share(faceted_scene({{-9, -9, -5}, {9, -9, -5}, {0.1f, 9, -5}}));
  pipeline::FrameGraph graph = build_graph("sbaa_top:n=2", scene, kWidth, kHeight);
  for (const pipeline::Pass& pass : graph.passes())
    if (pass.name == "gbuffer") const_cast<pipeline::Pass&>(pass).batches.clear();
  const auto e = run_graph(graph);
  const PassCounters n = frame_total(e);
  EXPECT_GT(n.technique[algos::SbaaCounters::slots_emitted_surfaces], 0u);
  EXPECT_EQ(n.technique[algos::SbaaCounters::slots_empty_surfaces],
            n.technique[algos::SbaaCounters::slots_emitted_surfaces]);
  for (const glm::vec4& p : e.color.pixels) ASSERT_EQ(p, e.color.at(0, 0));
}

// A mesh drawn twice at one place: the second draw has other numbers and fails LESS, but passes EQUAL. 128
// triangles apart, its numbers alias; it comes last in API order, so its record stays.
TEST(Sbaa, LastWriterOfASlotWinsAndIsCounted) {
  std::vector<glm::vec3> corners;
  add_grid(corners, {-9, -9, -8}, {18, 0, 0}, {0, 18, 0}, 8);  // 128 triangles
  pipeline::Scene scene = faceted_scene(corners);
  scene.materials.push_back(scene.materials.front());
  scene.materials[0].base_color = {1, 0, 0, 1};
  scene.materials[1].base_color = {0, 1, 0, 1};
  scene.meshes.push_back(scene.meshes.front());
  scene.meshes[1].parts[0].material = 1;
  scene.instances.push_back({1, glm::mat4(1.0f), "again"});
  const auto shared = share(std::move(scene));
  const auto e = run_graph(build_graph("sbaa_top:n=1", shared, kWidth, kHeight));
  EXPECT_EQ(frame_total(e).technique[algos::SbaaCounters::slot_conflicts_fragments],
            static_cast<std::uint64_t>(kWidth * kHeight));
  const auto clear = run_graph(build_graph("sbaa_top:n=1,id_bits=9", shared, kWidth, kHeight));
  EXPECT_EQ(frame_total(clear).technique[algos::SbaaCounters::slot_conflicts_fragments], 0u);
  for (const glm::vec4& p : e.color.pixels) ASSERT_GT(p.y, p.x);
  for (const glm::vec4& p : clear.color.pixels) ASSERT_GT(p.x, p.y);
}

// m numbers taken at random collide in b bits with probability 1 - prod(1 - i / 2^b)
// (docs/techniques/sbaa.md#numbers).
TEST(Sbaa, NumbersAliasAsOftenAsRandomOnes) {
  std::vector<glm::vec3> corners;
  std::uint32_t state = 1;
  const auto random = [&state] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) * 0x1p-24f;
  };
  for (int i = 0; i < 40000; ++i) {
    const glm::vec3 at(20.0f * random() - 10.0f, 12.0f * random() - 6.0f, -9.0f - random());
    for (int corner = 0; corner < 3; ++corner)
      corners.push_back(at + 0.12f * glm::vec3(random(), random(), random()));
  }
  const auto scene = share(faceted_scene(corners));
  const Image ids = dump(build_graph("sbaa_top:id_bits=16", scene, kWidth, kHeight), "primitive_id");
  for (const int bits : {4, 5, 6, 7}) {
    double expected = 0.0, found = 0.0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const PixelPrimitives p = primitives_at(ids, x, y, (1 << bits) - 1);
        double distinct = 1.0;
        for (int i = 1; i < p.count; ++i) distinct *= 1.0 - i / std::exp2(bits);
        expected += 1.0 - distinct;
        found += p.alias ? 1.0 : 0.0;
      }
    }
    EXPECT_GT(expected, 10.0);
    EXPECT_NEAR(found / expected, 1.0, 4.0 / std::sqrt(expected)) << bits << " bits: " << found << " pixels";
  }
}

TEST(Sbaa, ShorterRecordsKeepTheImageAndLongerOnesCostBytesAlone) {
  const auto scene = generated_scene("sponza_hall");
  const auto run = [&](const std::string& parameters) {
    return run_graph(build_graph("sbaa_top:n=2" + parameters, scene, kWidth, kHeight, true));
  };
  const auto full = run(""), longer = run(",record_bytes=48"), compact = run(",record_bytes=16");
  EXPECT_EQ(difference(full.color, longer.color, "image"), "");
  const auto written = [](const pipeline::Emulation& e) {
    return total(pass_named(e.trace, "gbuffer")).mem.storage_write_bytes;
  };
  EXPECT_EQ(written(full) * 3, written(longer) * 2);
  EXPECT_EQ(written(full), written(compact) * 2);
  double sum = 0.0;
  for (std::size_t i = 0; i < full.color.pixels.size(); ++i)
    sum += code_difference(full.color.pixels[i], compact.color.pixels[i]);
  EXPECT_LT(sum / static_cast<double>(full.color.pixels.size()), 0.5);
}

TEST(Sbaa, RefusesMoreSurfacesThanSamples) {
  EXPECT_THROW(build_graph("sbaa_top:n=5,msaa=4", generated_scene("wires"), 16, 16), InputError);
}

}  // namespace
}  // namespace hwsim::test
