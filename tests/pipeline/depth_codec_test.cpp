// Packing a depth tile and unpacking it gives every sample back, bit for bit: on every tile of the scenes,
// and on random tiles (HWSIM_RANDOM_TILES sets how many; 10,000,000 is the figure of docs/verification.md).
// The packer's scalar arithmetic is another implementation than the vector code that wrote the planes.
#include "pipeline/memory/depth_codec.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "pipeline/open/scene_source.h"
#include "support/frames.h"
#include "support/places.h"

namespace hwsim::pipeline {
namespace {

using FormCounts = std::array<std::uint64_t, kDepthTileForms>;

/// The bytes that docs/compression.md#depth gives each form, with 20 for a plane.
std::size_t bytes_of(DepthTileForm form, const GpuImage& image) {
  const auto samples = static_cast<std::size_t>(image.samples * kBlockLanes);
  switch (form) {
    case DepthTileForm::clear:
      return 0;
    case DepthTileForm::one_plane:
      return 20;
    case DepthTileForm::two_planes:
      return 40 + samples / 8;
    case DepthTileForm::four_planes:
      return 80 + samples / 4;
    case DepthTileForm::offset_6:
      return 8 + samples * 7 / 8;
    case DepthTileForm::offset_14:
      return 8 + samples * 15 / 8;
    case DepthTileForm::raw:
      return samples * (image.format == Format::d16_unorm ? 2 : 4);
  }
  return 0;
}

/// Tiles that differ after a round trip; `expanded` holds the same tiles as samples.
std::uint64_t differing_tiles(const GpuImage& image, const GpuImage& expanded, FormCounts& forms) {
  std::vector<std::uint32_t> values(image.block_words());
  std::uint64_t differing = 0;
  for (int block = 0; block < image.blocks_x * image.blocks_y; ++block) {
    const PackedDepthTile packed = pack_depth_tile(image, block);
    forms[static_cast<std::size_t>(packed.form)] += 1;
    EXPECT_EQ(packed.bytes.size(), bytes_of(packed.form, image));
    unpack_depth_tile(image, block, packed, values);
    differing += std::equal(values.begin(), values.end(), expanded.block(block)) ? 0 : 1;
  }
  return differing;
}

struct DepthSetup {
  std::shared_ptr<const Scene> scene;
  int samples;
  Format format;
};

std::uint64_t round_trip(const DepthSetup& setup, FormCounts& forms) {
  constexpr int kWidth = 321, kHeight = 181;  // tiles that the image's border cuts
  test::SampleFrame frame(setup.scene, kWidth, kHeight, setup.samples, Format::r32_float, setup.format);
  const Camera& camera = setup.scene->cameras.front();
  DrawBatch batch =
      frame.all_draws(mesh_position_program(), nullptr,
                      clip_from_view(camera, static_cast<float>(kWidth) / kHeight) * camera.view_from_world);
  batch.state.depth = {true, true, Compare::less};
  frame.draw("depth", {batch}, false);
  std::uint64_t differing = 0, inspected = 0;
  EmulationOptions options;
  options.inspect = [&](const Pass& pass, std::span<const GpuImage* const> images) {
    if (pass.name != "depth") return;
    GpuImage expanded = *images[static_cast<std::size_t>(pass.depth.index)];
    expanded.use_all(1);
    differing += differing_tiles(*images[static_cast<std::size_t>(pass.depth.index)], expanded, forms);
    ++inspected;
  };
  frame.run(options);
  EXPECT_EQ(inspected, 1u);
  return differing;
}

TEST(DepthCodec, RoundTripIsExactOnEveryTileOfEveryScene) {
  std::vector<std::string> scenes;
  for (const GeneratorInfo& generator : generators()) scenes.push_back(generator.name);
  for (const char* file : {"dragon_small.glb", "sponza.glb"})
    if (const std::string path = hwsim::test::shared_dir() + "/scenes/" + file; std::filesystem::exists(path))
      scenes.push_back(path);
  FormCounts forms{};
  for (const std::string& name : scenes) {
    const auto scene = test::share(open_scene(name, hwsim::test::binary_dir() + "/test_scenes"));
    for (const DepthSetup& setup :
         {DepthSetup{scene, 8, Format::d24_unorm_s8}, DepthSetup{scene, 1, Format::d32_float},
          DepthSetup{scene, 4, Format::d16_unorm}})
      EXPECT_EQ(round_trip(setup, forms), 0u) << name << ", " << setup.samples << " samples";
  }
  for (std::size_t form = 0; form < forms.size(); ++form) {
    std::printf("[     note ] form %zu: %llu tiles\n", form, static_cast<unsigned long long>(forms[form]));
    EXPECT_GT(forms[form], 0u) << "no scene has a tile of form " << form;
  }
}

float random_slope(std::mt19937& random) {
  const int exponent = static_cast<int>(random() % 24) - 26;
  return std::ldexp(static_cast<float>(static_cast<int>(random() % 65536) - 32768) / 32768.0f, exponent);
}

/// Up to four planes of any slope, each with a random share of the samples.
void fill_random_tile(GpuImage& image, std::mt19937& random) {
  const auto count = static_cast<int>(random() % kMaxDepthPlanes) + 1;
  image.plane_count[0] = static_cast<std::uint8_t>(count);
  for (int p = 0; p < count; ++p)
    image.tile_planes(0)[p] = {
        {static_cast<float>(random() % 65536) / 65535.0f, random_slope(random), random_slope(random)},
        static_cast<float>(random() % 24000) - 8000.0f,
        static_cast<float>(random() % 24000) - 8000.0f,
        0,
        0};
  for (int s = 0; s < image.samples; ++s) {
    std::uint64_t left = ~std::uint64_t{0};
    for (int p = 0; p < count; ++p) {
      const std::uint64_t some = (std::uint64_t{random()} << 32 | random()) & left;
      image.tile_plane_lanes(0)[p * image.samples + s] = p + 1 == count ? left : some;
      left &= ~some;
    }
  }
}

TEST(DepthCodec, RoundTripIsExactOnRandomTiles) {
  const char* wanted = std::getenv("HWSIM_RANDOM_TILES");
  const std::uint64_t tiles = wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 100000;
  std::mt19937 random(1);
  std::uint64_t differing = 0;
  FormCounts forms{};
  std::vector<GpuImage> images;
  for (const Format format : {Format::d16_unorm, Format::d24_unorm_s8, Format::d32_float})
    for (const int samples : {1, 2, 4, 8}) images.emplace_back(format, kBlockPx, kBlockPx, samples);
  for (GpuImage& image : images) {
    const auto positions = standard_sample_positions(image.samples);
    image.plane_positions.assign(positions.begin(), positions.end());
  }
  std::vector<std::uint32_t> values, expanded;
  for (std::uint64_t i = 0; i < tiles; ++i) {
    GpuImage& image = images[i % images.size()];
    fill_random_tile(image, random);
    const PackedDepthTile packed = pack_depth_tile(image, 0);
    forms[static_cast<std::size_t>(packed.form)] += 1;
    values.resize(image.block_words());
    unpack_depth_tile(image, 0, packed, values);
    expand_depth_tile(image, 0);
    differing += std::equal(values.begin(), values.end(), image.block(0)) ? 0 : 1;
    const PackedDepthTile samples = pack_depth_tile(image, 0);  // the same tile without its planes
    forms[static_cast<std::size_t>(samples.form)] += 1;
    unpack_depth_tile(image, 0, samples, values);
    differing += std::equal(values.begin(), values.end(), image.block(0)) ? 0 : 1;
  }
  EXPECT_EQ(differing, 0u) << "of " << tiles << " tiles";
  for (std::size_t form = 1; form < forms.size(); ++form) EXPECT_GT(forms[form], 0u) << "form " << form;
}

}  // namespace
}  // namespace hwsim::pipeline
