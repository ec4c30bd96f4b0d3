// OpenEXR files whose channels are not just R, G and B.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "pipeline/image/image_io.h"
#include "tests/pipeline/image/make_png.h"

namespace hwsim::pipeline {
namespace {

enum class Type : std::uint8_t { whole, half, real };  // as OpenEXR numbers them

// An uncompressed file of one pixel; channel names must be sorted, as OpenEXR wants them. Channel i holds
// (i + 1) / 8, or i + 1 in whole numbers.
class ExrBytes {
 public:
  explicit ExrBytes(const std::vector<std::string>& channels, std::vector<Type> types = {}) {
    types.resize(channels.size(), Type::real);
    for (const std::uint32_t v : {20000630u, 2u}) word(v);
    std::vector<std::uint8_t> list;
    std::swap(list, bytes_);
    std::uint32_t line_bytes = 0;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      text(channels[i]);
      for (const std::uint32_t v : {static_cast<std::uint32_t>(types[i]), 0u, 1u, 1u})
        word(v);  // every pixel
      line_bytes += types[i] == Type::half ? 2 : 4;
    }
    bytes_.push_back(0);
    std::swap(list, bytes_);
    attribute("channels", "chlist", list);
    attribute("compression", "compression", {0});
    attribute("dataWindow", "box2i", std::vector<std::uint8_t>(16, 0));
    attribute("displayWindow", "box2i", std::vector<std::uint8_t>(16, 0));
    attribute("lineOrder", "lineOrder", {0});
    attribute("pixelAspectRatio", "float", {0, 0, 0x80, 0x3f});
    attribute("screenWindowCenter", "v2f", std::vector<std::uint8_t>(8, 0));
    attribute("screenWindowWidth", "float", {0, 0, 0x80, 0x3f});
    bytes_.push_back(0);
    word(static_cast<std::uint32_t>(bytes_.size() + 8));  // where the only line lies
    word(0);
    word(0);
    word(line_bytes);
    for (std::size_t i = 0; i < channels.size(); ++i) value(static_cast<std::uint32_t>(i + 1), types[i]);
  }

  std::string write(const std::string& path) const {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes_.data()), static_cast<std::streamsize>(bytes_.size()));
    return path;
  }

 private:
  void value(std::uint32_t i, Type type) {
    const auto real = std::bit_cast<std::uint32_t>(static_cast<float>(i) / 8.0f);
    if (type == Type::half) {  // a float's exponent and the head of its mantissa
      const std::uint32_t half = ((real >> 23) - 112) << 10 | (real >> 13 & 0x3ff);
      bytes_.push_back(static_cast<std::uint8_t>(half));
      bytes_.push_back(static_cast<std::uint8_t>(half >> 8));
    } else {
      word(type == Type::whole ? i : real);
    }
  }
  void word(std::uint32_t v) {
    for (int shift = 0; shift < 32; shift += 8) bytes_.push_back(static_cast<std::uint8_t>(v >> shift));
  }
  void text(const std::string& s) {
    bytes_.insert(bytes_.end(), s.begin(), s.end());
    bytes_.push_back(0);
  }
  void attribute(const std::string& name, const std::string& type, const std::vector<std::uint8_t>& value) {
    text(name);
    text(type);
    word(static_cast<std::uint32_t>(value.size()));
    bytes_.insert(bytes_.end(), value.begin(), value.end());
  }

  std::vector<std::uint8_t> bytes_;
};

TEST(ExrChannels, AreFoundByName) {
  const std::string path = testing::scratch_folder("exr_channels") + "/a.exr";
  const auto pixel_of = [&](const std::vector<std::string>& channels) {
    return read_image(ExrBytes(channels).write(path)).pixels.at(0);
  };
  EXPECT_EQ(pixel_of({"B", "G", "R"}), glm::vec4(0.375f, 0.25f, 0.125f, 1));
  EXPECT_EQ(pixel_of({"A", "B", "G", "R"}), glm::vec4(0.5f, 0.375f, 0.25f, 0.125f));
  EXPECT_EQ(pixel_of({"G", "R"}), glm::vec4(0.25f, 0.125f, 0, 1));
  EXPECT_EQ(pixel_of({"B"}), glm::vec4(0, 0, 0.125f, 1));
  EXPECT_EQ(pixel_of({"Y"}), glm::vec4(0.125f, 0.125f, 0.125f, 1));
  EXPECT_EQ(pixel_of({"AlbedoX", "B", "Depth", "G", "R", "Z"}), glm::vec4(0.625f, 0.5f, 0.25f, 1));
  EXPECT_EQ(pixel_of({"beauty.B", "beauty.G", "beauty.R", "depth.Z"}), glm::vec4(0.375f, 0.25f, 0.125f, 1));
}

TEST(ExrChannels, MayBeOfAnyType) {
  const std::string path = testing::scratch_folder("exr_types") + "/a.exr";
  const auto pixel_of = [&](const std::vector<std::string>& channels, const std::vector<Type>& types) {
    return read_image(ExrBytes(channels, types).write(path)).pixels.at(0);
  };
  EXPECT_EQ(pixel_of({"B", "G", "R"}, {Type::whole, Type::whole, Type::whole}), glm::vec4(3, 2, 1, 1));
  EXPECT_EQ(pixel_of({"A", "B", "G", "R"}, {Type::whole, Type::half, Type::whole, Type::real}),
            glm::vec4(0.5f, 3, 0.25f, 1));
  EXPECT_EQ(pixel_of({"Y"}, {Type::whole}), glm::vec4(1, 1, 1, 1));
  EXPECT_EQ(pixel_of({"Y"}, {Type::half}), glm::vec4(0.125f, 0.125f, 0.125f, 1));
  EXPECT_EQ(pixel_of({"B", "G", "R", "id"}, {Type::half, Type::half, Type::half, Type::whole}),
            glm::vec4(0.375f, 0.25f, 0.125f, 1));
}

TEST(ExrChannels, AreListedWhereNoneIsAColor) {
  const std::string path = testing::scratch_folder("exr_depth") + "/a.exr";
  try {
    read_image(ExrBytes({"Z", "id"}).write(path));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("none of its channels (Z, id) is R, G, B or Y"), std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace hwsim::pipeline
