#include "pipeline/image/image_io.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "hwsim/base/diagnostics.h"
#include "pipeline/base/file_io.h"
#include "pipeline/image/image_signature.h"
#include "pipeline/image/make_png.h"
#include "pipeline/image/module_loader.h"

namespace hwsim::pipeline {
namespace {

using testing::make_png;
using Bytes = std::vector<std::uint8_t>;

std::string code_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.diagnostics().front().code;
  }
  return "no error";
}

std::string decode_code(const Bytes& bytes) {
  return code_of([&] { decode_image(bytes, "textures[0]"); });
}

TEST(DecodeImage, KeepsColorWhereAlphaIsLow) {
  const RawImage image = decode_image(make_png({2, 1, 8, 6}, {200, 100, 50, 0, 10, 20, 30, 128}), "png");
  ASSERT_EQ(image.width, 2);
  ASSERT_EQ(image.height, 1);
  EXPECT_EQ(image.texels[0], 0x003264C8u);
  EXPECT_EQ(image.texels[1], 0x801E140Au);
}

TEST(DecodeImage, PutsRowZeroOnTop) {
  const RawImage image = decode_image(make_png({1, 2, 8, 2}, {1, 2, 3, 4, 5, 6}), "png");
  EXPECT_EQ(image.texels, (std::vector<std::uint32_t>{0xFF030201u, 0xFF060504u}));
}

TEST(DecodeImage, ExpandsGrayAndGrayWithAlpha) {
  EXPECT_EQ(decode_image(make_png({1, 1, 8, 0}, {77}), "gray").texels[0], 0xFF4D4D4Du);
  EXPECT_EQ(decode_image(make_png({1, 1, 8, 4}, {77, 3}), "gray").texels[0], 0x034D4D4Du);
  EXPECT_EQ(decode_image(make_png({8, 1, 1, 0}, {0x80}), "one bit").texels[0], 0xFFFFFFFFu);
  EXPECT_EQ(decode_image(make_png({8, 1, 1, 0}, {0x80}), "one bit").texels[1], 0xFF000000u);
}

TEST(DecodeImage, RoundsSixteenBitsToEight) {
  const RawImage image = decode_image(make_png({1, 1, 16, 2}, {0x80, 0x80, 0xFF, 0xFF, 0x00, 0xFF}), "deep");
  EXPECT_EQ(image.texels[0], 0xFF01FF80u);
}

TEST(DecodeImage, ReadsJpeg) {
  const RawImage image = decode_image(testing::two_color_jpeg(), "jpeg");
  ASSERT_EQ(image.width, 16);
  ASSERT_EQ(image.height, 8);
  const auto near = [&](std::size_t texel, int r, int g, int b) {
    const std::uint32_t t = image.texels[texel];
    EXPECT_NEAR(static_cast<int>(t & 255), r, 6);
    EXPECT_NEAR(static_cast<int>(t >> 8 & 255), g, 6);
    EXPECT_NEAR(static_cast<int>(t >> 16 & 255), b, 6);
    EXPECT_EQ(t >> 24, 255u);
  };
  near(16 * 4 + 1, 200, 100, 20);
  near(16 * 4 + 14, 40, 100, 220);
}

TEST(DecodeImage, NamesTheImageThatIsBad) {
  try {
    decode_image(Bytes{1, 2, 3}, "images[3]");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().front().place.file, "images[3]");
    EXPECT_EQ(error.diagnostics().front().code, "I006");
  }
  EXPECT_EQ(decode_code({}), "I006");
}

TEST(DecodeImage, RejectsFilesCutOffAtEveryLength) {
  const Bytes png = make_png({3, 3, 8, 2}, Bytes(27, 99)), jpeg = testing::two_color_jpeg();
  for (std::size_t size = 0; size < png.size(); ++size)
    EXPECT_NE(decode_code(Bytes(png.begin(), png.begin() + static_cast<std::ptrdiff_t>(size))), "no error")
        << size;
  for (std::size_t size = 0; size < jpeg.size() - 1; ++size)
    EXPECT_NE(decode_code(Bytes(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(size))), "no error")
        << size;
}

TEST(DecodeImage, NeverCrashesOnChangedBytes) {
  for (Bytes bytes : {make_png({3, 3, 8, 6}, Bytes(36, 99)), testing::two_color_jpeg()})
    for (std::size_t at = 0; at < bytes.size(); ++at)
      for (const int change : {0xFF, 0x80, 0x01}) {
        Bytes changed = bytes;
        changed[at] = static_cast<std::uint8_t>(changed[at] ^ change);
        const std::string code = decode_code(changed);
        EXPECT_TRUE(code == "no error" || code[0] == 'I') << code;
      }
}

TEST(DecodeImage, RejectsAbsurdSizes) {
  EXPECT_EQ(decode_code(make_png({20000, 20000, 8, 0}, Bytes(20000, 0))), "I003");
  try {  // the size is allowed, but the data cannot fill it: found before 1 GiB is allocated
    decode_image(make_png({16384, 16384, 8, 0}, Bytes(16384, 0)), "png");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("too short for the size that it claims"), std::string::npos);
  }
  EXPECT_EQ(decode_code(make_png({0, 1, 8, 0}, {0})), "I002");
}

// One byte in a million was enough for a second of unpacking.
TEST(DecodeImage, RejectsDataThatItsSizeCannotUse) {
  EXPECT_EQ(decode_code(make_png({4, 4, 8, 0}, Bytes(200'000, 7))), "I002");
  Bytes scans = {0xFF, 0xD8};
  for (int i = 0; i < 300; ++i) scans.insert(scans.end(), {0xFF, 0xDA, 0, 2, 7});
  scans.insert(scans.end(), {0xFF, 0xD9});
  EXPECT_EQ(jpeg_scans(scans), 300u);
  EXPECT_EQ(jpeg_scans(testing::two_color_jpeg()), 1u);
}

TEST(DecodeImage, APipeIsNoFile) {
  const std::string pipe = testing::scratch_folder("pipe") + "/x.png";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(read_image(pipe), InputError) << "it would be waited for";
}

TEST(JpegIsComplete, SkipsStuffedBytesAndThumbnails) {
  EXPECT_TRUE(jpeg_is_complete(Bytes{0xFF, 0xD8, 0xFF, 0xDA, 0, 2, 7, 0xFF, 0, 0xFF, 0xD9}));
  EXPECT_FALSE(jpeg_is_complete(Bytes{0xFF, 0xD8, 0xFF, 0xE1, 0, 4, 0xFF, 0xD9, 0xFF, 0xDA, 0, 2, 7}));
  EXPECT_FALSE(jpeg_is_complete(Bytes{0xFF, 0xD8, 0xFF}));
}

TEST(WriteImage, RoundTripsThroughExrWithinHalfPrecision) {
  const std::string path = testing::scratch_folder("exr") + "/a.exr";
  Image image(5, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = {0.1f * static_cast<float>(i), 1e-3f, 1e6f, 0.25f};
  write_image(image, path);
  const Image back = read_image(path);
  ASSERT_EQ(back.width, 5);
  ASSERT_EQ(back.height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    EXPECT_NEAR(back.pixels[i].x, image.pixels[i].x, image.pixels[i].x / 2048);
    EXPECT_NEAR(back.pixels[i].y, 1e-3f, 1e-6f);
    EXPECT_EQ(back.pixels[i].z, 65504.0f);  // saturated, not infinite
    EXPECT_EQ(back.pixels[i].w, 1.0f);
  }
}

TEST(WriteImage, EncodesPngAsSrgbAndDropsAlpha) {
  const std::string path = testing::scratch_folder("png") + "/a.png";
  Image image(256, 1);
  for (int x = 0; x < 256; ++x)
    image.at(x, 0) = glm::vec4(linear_from_srgb(static_cast<float>(x) / 255.0f), 2, -1, 0);
  image.at(0, 0).x = std::numeric_limits<float>::quiet_NaN();
  write_image(image, path);
  const RawImage raw = decode_image(read_file(path, "X", 1 << 20), path);
  for (std::size_t x = 0; x < 256; ++x) EXPECT_EQ(raw.texels[x], 0xFF00FF00u | static_cast<std::uint32_t>(x));
  const Image back = read_image(path);
  EXPECT_NEAR(back.at(128, 0).x, image.at(128, 0).x, 1e-5f);
}

TEST(WriteImage, LeavesNothingElseInTheFolderAndGivesTheSameBytesAgain) {
  const std::string folder = testing::scratch_folder("twice");
  const Image image(7, 5, glm::vec4(0.3f));
  for (const char* name : {"/a.png", "/b.png", "/a.exr", "/b.exr", "/a.png"})
    write_image(image, folder + name);
  EXPECT_EQ(read_file(folder + "/a.png", "X", 1 << 20), read_file(folder + "/b.png", "X", 1 << 20));
  EXPECT_EQ(read_file(folder + "/a.exr", "X", 1 << 20), read_file(folder + "/b.exr", "X", 1 << 20));
  const std::filesystem::directory_iterator files(folder);
  EXPECT_EQ(std::distance(begin(files), end(files)), 4);
}

TEST(WriteImage, SaysWhatIsWrongWithTheTarget) {
  const Image image(1, 1);
  EXPECT_EQ(code_of([&] { write_image(image, "/nonexistent/a.png"); }), "I005");
  EXPECT_EQ(code_of([&] { write_image(image, "a.bmp"); }), "I006");
  EXPECT_EQ(code_of([&] { write_image(Image(), "a.png"); }), "I005");
  const std::string folder = testing::scratch_folder("target");
  std::filesystem::create_directories(folder + "/taken.png/full");
  EXPECT_EQ(code_of([&] { write_image(image, folder + "/taken.png"); }), "I005");
  const std::filesystem::directory_iterator files(folder);
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);  // the temporary file is gone
}

TEST(ReadImage, SaysWhenTheFileIsMissingOrAFolder) {
  EXPECT_EQ(code_of([] { read_image("/nonexistent.png"); }), "I004");
  EXPECT_EQ(code_of([] { read_image("/"); }), "I004");
}

TEST(ImageModule, IsLookedForInTheFolderThatTheUserNamesFirst) {
  ::setenv("HWSIM_MODULE_DIR", "/chosen", 1);
  EXPECT_EQ(image_module_paths().front(), "/chosen/libhwsim_image_io.so");
  EXPECT_GE(image_module_paths().size(), 5u);
  EXPECT_EQ(image_module_paths().back(), "libhwsim_image_io.so") << "the loader looks for it last";
  ::unsetenv("HWSIM_MODULE_DIR");
  EXPECT_NE(image_module_paths().front(), "/chosen/libhwsim_image_io.so");
}

TEST(ImageModule, SaysWhatWasWrongWithEachPlaceAndHowToGoOn) {
  const std::string not_a_library = testing::scratch_folder("module") + "/libhwsim_image_io.so";
  write_file_atomically(not_a_library, "X", Bytes{1, 2, 3});
  try {
    open_image_module({"/nonexistent/libhwsim_image_io.so", not_a_library});
    FAIL();
  } catch (const InputError& error) {
    const Diagnostic& d = error.diagnostics().front();
    EXPECT_EQ(d.code, "I001");
    ASSERT_EQ(d.notes.size(), 2u);
    EXPECT_NE(d.notes[0].find("not at /nonexistent"), std::string::npos);
    EXPECT_NE(d.notes[1].find(not_a_library), std::string::npos);
    EXPECT_NE(d.help.find("HWSIM_MODULE_DIR"), std::string::npos);
  }
}

}  // namespace
}  // namespace hwsim::pipeline
