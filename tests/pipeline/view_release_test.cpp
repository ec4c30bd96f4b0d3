// A file's bytes go back to the system when all that refers to them has been copied, and no sooner.
#include "pipeline/gltf/view_release.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/gltf/gltf_loader.h"
#include "tests/pipeline/scene_glb.h"

namespace hwsim::pipeline::gltf {
namespace {

constexpr std::size_t kViewBytes = 2 * ViewRelease::kMinBytes;

/// A buffer of `views` views side by side, an accessor for each, and primitives with the positions named.
Source source_of(int views, const std::vector<int>& positions) {
  Source source;
  source.model.buffers.resize(1);
  source.model.buffers[0].data.assign(static_cast<std::size_t>(views) * kViewBytes, 7);
  for (int i = 0; i < views; ++i) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = static_cast<std::size_t>(i) * kViewBytes;
    view.byteLength = kViewBytes;
    source.model.bufferViews.push_back(view);
    tinygltf::Accessor accessor;
    accessor.bufferView = i;
    source.model.accessors.push_back(accessor);
  }
  source.model.meshes.resize(1);
  for (const int accessor : positions) {
    tinygltf::Primitive primitive;
    primitive.attributes["POSITION"] = accessor;
    source.model.meshes[0].primitives.push_back(primitive);
  }
  return source;
}

std::size_t bytes_left(const Source& source, int view) {
  const auto& data = source.model.buffers[0].data;
  const auto begin = data.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(view) * kViewBytes);
  return static_cast<std::size_t>(std::count(begin, begin + static_cast<std::ptrdiff_t>(kViewBytes), 7));
}

TEST(ViewRelease, AViewGoesWithItsLastUse) {
  Source source = source_of(2, {0, 0, 1});
  ViewRelease views(source);
  views.copied(0);
  EXPECT_EQ(bytes_left(source, 0), kViewBytes) << "another primitive refers to it";
  views.copied(0);
  EXPECT_LT(bytes_left(source, 0), 8192u) << "all but the pages at its ends";
  EXPECT_GE(views.released_bytes() + 8192, kViewBytes);
  EXPECT_EQ(bytes_left(source, 1), kViewBytes);
}

TEST(ViewRelease, SharedBytesStay) {
  Source source = source_of(3, {0, 1, 2});
  source.model.bufferViews[1].byteOffset = kViewBytes / 2;  // reaches into the first
  ViewRelease views(source);
  views.copied(0);
  EXPECT_EQ(bytes_left(source, 0), kViewBytes);
  views.copied(1);
  EXPECT_LT(bytes_left(source, 0), kViewBytes / 2 + 8192) << "what the second reaches goes with it";
}

TEST(ViewRelease, ImagesAndSkinsKeepTheirs) {
  Source source = source_of(2, {0, 1});
  EncodedImage image;
  image.bytes = std::span<const std::uint8_t>(source.model.buffers[0].data).subspan(100, 50);
  source.images.push_back(image);
  SkinSpec skin;
  skin.inverse_bind_matrices = 1;
  source.skins.push_back(skin);
  ViewRelease views(source);
  views.copied(0);
  views.copied(1);
  EXPECT_EQ(views.released_bytes(), 0u);
}

TEST(ViewRelease, ALargeSceneLoadsTheSame) {
  // Two primitives of one large set of vertices, each with indices of its own: what is copied first is needed
  // again.
  constexpr std::uint32_t kSide = 400;
  std::vector<float> positions, normals;
  std::vector<std::uint32_t> first, second;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    positions.insert(positions.end(), {static_cast<float>(i % kSide), static_cast<float>(i / kSide), 0.0f});
    normals.insert(normals.end(), {0.0f, 0.0f, 1.0f});
    if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
    first.insert(first.end(), {i, i + 1, i + kSide});
    second.insert(second.end(), {i + 1, i + kSide + 1, i + kSide});
  }
  test::GlbBuilder glb;
  glb.add_attribute("POSITION", positions, "VEC3", 3);
  glb.add_attribute("NORMAL", normals, "VEC3", 3);
  glb.primitive()["indices"] = glb.add_accessor<std::uint32_t>(first, 5125, "SCALAR", 1);
  nlohmann::json other = glb.primitive();
  other["indices"] = glb.add_accessor<std::uint32_t>(second, 5125, "SCALAR", 1);
  glb.root["meshes"][0]["primitives"].push_back(other);
  glb.root["meshes"].push_back(glb.root["meshes"][0]);
  glb.root["nodes"].push_back({{"mesh", 1}});
  glb.root["scenes"][0]["nodes"].push_back(1);
  const Scene scene = load_glb(glb.bytes(), "large", {});
  ASSERT_EQ(scene.meshes.size(), 2u);
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_EQ(mesh.positions.size(), positions.size() / 3);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      ASSERT_EQ(mesh.positions[i].x, positions[3 * i]);
      ASSERT_EQ(mesh.positions[i].y, positions[3 * i + 1]);
      ASSERT_EQ(mesh.normals[i].z, 1.0f);
    }
    ASSERT_EQ(mesh.indices.size(), first.size() + second.size());
    EXPECT_TRUE(std::equal(first.begin(), first.end(), mesh.indices.begin()));
    EXPECT_TRUE(std::equal(second.rbegin(), second.rend(), mesh.indices.rbegin()));
  }
}

}  // namespace
}  // namespace hwsim::pipeline::gltf
