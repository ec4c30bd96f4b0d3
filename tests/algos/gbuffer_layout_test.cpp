// Footprints of deferred frames against SBAA's Table 2 and the layouts' own bytes, and what the layouts keep.
#include <gtest/gtest.h>

#include <cstdio>

#include "algos/base/shaders/gbuffer_layouts.h"
#include "algos/sbaa_frames.h"
#include "pipeline/image/metrics.h"

namespace hwsim::test {
namespace {

double allocated_mib(const std::string& technique, int width, int height) {
  const auto scene = share(clip_space_scene({}, {}));
  const auto graph = build_graph(technique, scene, width, height);
  return static_cast<double>(pipeline::compile(graph, features_for(32), FunctionalConfig{}).allocated_bytes) /
         (1024.0 * 1024.0);
}

std::string printed(double mib) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f", mib);
  return text;
}

// SBAA, Table 2, row MBytes: 1280x720, to the printed digit.
TEST(Memory, IsThatOfThePublishedTable) {
  const std::pair<const char*, const char*> cells[] = {
      {"deferred_simple_complex:layout=gb_sbaa40,samples=4", "144.1"},
      {"deferred_simple_complex:layout=gb_lauritzen,lighting=compute,samples=4", "144.1"},
      {"sbaa_top:n=2,msaa=4", "80.9"},
      {"sbaa_merge:n=2,msaa=4", "94.9"},
      {"deferred_simple_complex:layout=gb_sbaa40,samples=8", "284.8"},
      {"deferred_simple_complex:layout=gb_lauritzen,lighting=compute,samples=8", "284.8"},
      {"sbaa_top:n=2,msaa=8", "98.4"},
      {"sbaa_top:n=3,msaa=8", "128.3"},
      {"sbaa_merge:n=2,msaa=8", "126.6"},
      {"sbaa_merge:n=3,msaa=8", "156.4"}};
  for (const auto& [technique, mbytes] : cells)
    EXPECT_EQ(printed(allocated_mib(technique, 1280, 720)), mbytes) << technique;
}

TEST(Memory, OfAPixelIsThatOfTheLayout) {
  const auto bytes = [](const std::string& technique) {
    return allocated_mib(technique, 256, 256) * 1024 * 1024 / (256 * 256);
  };
  for (const int samples : {2, 4, 8, 16, 32}) {
    const std::string n = std::to_string(samples);
    EXPECT_EQ(bytes("deferred:layout=gb_sbaa40,samples=" + n), 40 * samples + 4);
    EXPECT_EQ(bytes("deferred:layout=gb_lauritzen,samples=" + n), (16 + 8 + 8) * samples + 4);
    EXPECT_EQ(bytes("deferred:layout=gb_20,samples=" + n), (20 + 4) * samples + 4);
    EXPECT_EQ(bytes("deferred:layout=gb_agaa16,samples=" + n), (16 + 4) * samples + 4);
    for (const int slots : {1, 2}) {
      const int surface = samples > 8 ? 4 : 2;
      EXPECT_EQ(bytes("sbaa_top:n=" + std::to_string(slots) + ",msaa=" + n),
                5 * samples + (32 + surface) * slots + 4);
      EXPECT_EQ(bytes("sbaa_merge:n=" + std::to_string(slots) + ",msaa=" + n),
                9 * samples + (32 + surface) * slots + 4);
    }
  }
  EXPECT_EQ(bytes("deferred:layout=gb_lauritzen,samples=1"), 16 + 4 + 8 + 4);
}

TEST(GBufferLayout, HasTheBytesOfItsName) {
  const int expected[] = {24, 36, 16, 20, 20};  // without lit color; lauritzen: depth with stencil in 8 bytes
  for (std::size_t i = 0; i < algos::gbuffer_layouts().size(); ++i)
    EXPECT_EQ(algos::gbuffer_sample_bytes(algos::gbuffer_layouts()[i], 8), expected[i])
        << algos::gbuffer_layouts()[i].id;
  std::string choices;
  for (const algos::GBufferLayout& layout : algos::gbuffer_layouts())
    choices += (choices.empty() ? "" : "|") + std::string(layout.id);
  EXPECT_EQ(choices, algos::kLayoutChoices);
}

// All layouts light the same surfaces; what they round differs by little.
TEST(GBufferLayout, ChangesTheImageLittle) {
  const auto scene = generated_scene("sponza_hall");
  const auto color = [&](const std::string& technique) {
    return run_graph(build_graph(technique, scene, 96, 54, true)).color;
  };
  for (const std::string technique :
       {"deferred:", "deferred_simple_complex:compare_all=on,normal_dot_min=0.999999,",
        "deferred_simple_complex:lighting=compute,"}) {
    const auto reference = color(technique + "layout=gb_lauritzen");
    for (const char* layout : {"gb_sbaa40", "gb_agaa16", "gb_20"}) {
      const auto image = color(technique + "layout=" + layout);
      double sum = 0.0;
      for (std::size_t i = 0; i < image.pixels.size(); ++i)
        sum += code_difference(image.pixels[i], reference.pixels[i]);
      EXPECT_LT(sum / static_cast<double>(image.pixels.size()), 1.0) << technique << layout;
    }
  }
}

// Triangles of a few pixels on a curved surface: outside of them normals point beyond the surface. A deferred
// frame lights the same samples as a forward one, and shows the same.
TEST(GBufferLayout, AttributesAreTakenInsideThePrimitive) {
  const auto scene = generated_scene("dragon");
  const auto color = [&](const char* technique) {
    return run_graph(build_graph(technique, scene, 160, 90)).color;
  };
  const auto truth = color("ssaa16x");
  const auto psnr_db = [&](const char* technique) {
    return pipeline::compare(color(technique), truth).psnr_db;
  };
  const double forward = psnr_db("msaa8x");
  EXPECT_GT(psnr_db("deferred"), forward - 1.0);
  EXPECT_LT(psnr_db("deferred:centroid=off"), forward - 3.0);
  for (const std::string sbaa : {"sbaa_top", "sbaa_merge"})
    EXPECT_GT(psnr_db((sbaa + ":n=4").c_str()), psnr_db((sbaa + ":n=4,centroid=off").c_str()) + 1.0) << sbaa;
}

std::uint64_t lit_samples(const std::string& technique, std::shared_ptr<const pipeline::Scene> scene) {
  return total(run_graph(build_graph(technique, std::move(scene), 160, 90)).trace)
      .technique[algos::BaseCounters::lit_samples];
}

// A tilted wall that fills the screen has no complex pixel by any layout's criteria
// (docs/techniques/deferred.md#simple-and-complex).
TEST(SimpleComplex, FindsAWallSimpleInEveryLayout) {
  std::vector<glm::vec3> corners;
  add_grid(corners, {-60, -40, -31}, {120, 0, 17}, {0, 80, 6}, 1);
  const auto scene = share(faceted_scene(corners));
  for (const algos::GBufferLayout& layout : algos::gbuffer_layouts())
    for (const char* lighting : {"stencil", "compute"}) {
      if (layout.depth_multisampled == Format::d32_float && lighting == std::string("stencil")) continue;
      EXPECT_EQ(lit_samples("deferred_simple_complex:lighting=" + std::string(lighting) +
                                ",layout=" + std::string(layout.id),
                            scene),
                160u * 90u)
          << layout.id << ", " << lighting;
    }
}

// The tiles' samples go to the image at once, as in Lauritzen's program: no pass brings them to a
// multisampled target, which is in memory all the same. Both ways of lighting show the same picture.
TEST(SimpleComplex, TilesAreResolvedFromTheirBuffer) {
  const auto scene = generated_scene("sponza_hall");
  const pipeline::FrameGraph graph =
      build_graph("deferred_simple_complex:lighting=compute,samples=4", scene, 160, 90);
  std::vector<std::string> names;
  for (const pipeline::Pass& pass : graph.passes()) {
    names.push_back(pass.name);
    for (const pipeline::ImageId target : pass.color) EXPECT_NE(graph.image(target).name, "lit") << pass.name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"clear", "gbuffer", "light_tiles", "resolve"}));
  EXPECT_TRUE(image_named(graph, "lit"));
  const auto by_tiles = run_graph(graph).color;
  const auto by_stencil = run_graph(build_graph("deferred_simple_complex:samples=4", scene, 160, 90)).color;
  for (std::size_t i = 0; i < by_tiles.pixels.size(); ++i)
    ASSERT_LE(code_difference(by_tiles.pixels[i], by_stencil.pixels[i]), 1.5) << i;
}

/// 32 samples on a GPU that has as many, or eight and multicast.
pipeline::Emulation of_32_samples(const std::string& technique, int native) {
  algos::FrameRequest request;
  request.scene = generated_scene("dragon");
  request.width_px = 96;
  request.height_px = 54;
  request.features = every_feature(native);
  pipeline::EmulationOptions options;
  options.jobs = 2;
  const auto graph = algos::build_frame(algos::parse_technique(technique + "samples=32"), request);
  return pipeline::emulate(graph, request.features, FunctionalConfig{}, options);
}

// Four layers of eight samples have the picture of 32 native ones, but for where a partly covered pixel takes
// its attributes: at one sample of 32, or at one of each layer. Vertices are shaded once. With stencil each
// layer is classified by itself, so that a simple pixel is lit once a layer; tiles see all samples.
TEST(SimpleComplex, LayersOfEightSamplesAreNativeSamples) {
  const std::string reference = "deferred_simple_complex:z_scale=0,normal_dot_min=1,";
  for (const std::string& technique :
       {std::string("deferred:"), reference, reference + "lighting=compute,"}) {
    const pipeline::Emulation native = of_32_samples(technique, 32), layers = of_32_samples(technique, 8);
    double most = 0.0;
    for (std::size_t i = 0; i < native.color.pixels.size(); ++i)
      most = std::max(most, code_difference(native.color.pixels[i], layers.color.pixels[i]));
    EXPECT_LE(most, 2.5) << technique;
    const PassCounters a = total(native.trace), b = total(layers.trace);
    // The layers are averaged by one more triangle.
    EXPECT_LE(b.stats.vertex_shader_invocations, a.stats.vertex_shader_invocations + 3) << technique;
    const std::uint64_t lit_native = a.technique[algos::BaseCounters::lit_samples],
                        lit_layers = b.technique[algos::BaseCounters::lit_samples];
    if (technique == reference) {
      EXPECT_GT(lit_layers, lit_native);
      EXPECT_LE(lit_layers, lit_native + 3u * 96u * 54u);
    } else {
      EXPECT_EQ(lit_layers, lit_native) << technique;
    }
  }
}

// Shaded = pixels + (N - 1) complex ones; stricter criteria find more of them.
TEST(SimpleComplex, CriteriaDecideWhatIsShaded) {
  const auto scene = generated_scene("sponza_hall");
  const auto lit = [&](const std::string& more) {
    return lit_samples("deferred_simple_complex:layout=gb_sbaa40" + more, scene);
  };
  const std::uint64_t plain = lit(""), strict = lit(",normal_dot_min=0.999999,compare_all=on");
  EXPECT_EQ((plain - 160 * 90) % 7, 0u);
  EXPECT_EQ(plain, lit(",lighting=compute"));
  EXPECT_GT(strict, plain);
  EXPECT_GT(lit(",compare_all=on"), plain);
  EXPECT_GT(plain, lit(",z_scale=1000"));
  EXPECT_EQ(lit_samples("deferred:layout=gb_sbaa40", scene), 160u * 90u * 8u);
}

}  // namespace
}  // namespace hwsim::test
