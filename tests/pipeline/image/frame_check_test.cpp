#include "pipeline/image/frame_check.h"

#include <gtest/gtest.h>

namespace hwsim::pipeline {
namespace {

constexpr glm::vec3 kSky{0.2f, 0.3f, 0.45f};

// Ten pixels: some of the sky, the rest of this color.
Image picture(int sky, const glm::vec3& color) {
  Image image(10, 1);
  for (int x = 0; x < 10; ++x) image.at(x, 0) = glm::vec4(x < sky ? kSky : color, 1.0f);
  return image;
}

std::string code_of(const Image& image) {
  const auto found = check_frame(image, kSky);
  if (found.empty()) return "";
  EXPECT_EQ(found.front().severity, Severity::warning);
  EXPECT_FALSE(found.front().help.empty());
  return found.front().code;
}

TEST(FrameCheck, WarnsOfEmptyWhiteAndBlackPictures) {
  EXPECT_EQ(code_of(picture(10, {})), "P001");
  EXPECT_EQ(code_of(picture(8, glm::vec3(1.0f))), "P002");
  EXPECT_EQ(code_of(picture(8, glm::vec3(40.0f))), "P002");
  EXPECT_EQ(code_of(picture(8, glm::vec3(0.0f))), "P003");
  EXPECT_EQ(code_of(picture(0, glm::vec3(0.0003f))), "P003");
}

TEST(FrameCheck, LeavesOtherPicturesAlone) {
  EXPECT_EQ(code_of(picture(9, {0.5f, 0.1f, 0.0f})), "");
  EXPECT_EQ(code_of(picture(0, {0.9f, 0.92f, 0.85f})), "");  // paper
  EXPECT_EQ(code_of(picture(0, {1.0f, 1.0f, 0.5f})), "");    // bright, not white
  Image half = picture(0, glm::vec3(1.0f));
  for (int x = 0; x < 5; ++x) half.at(x, 0) = {0.3f, 0.3f, 0.3f, 1.0f};
  EXPECT_EQ(code_of(half), "");
}

TEST(FrameCheck, SharesAreOfWhatIsDrawn) {
  const FrameLook look = look_at(picture(6, glm::vec3(1.0f)), kSky);
  EXPECT_DOUBLE_EQ(look.drawn, 0.4);
  EXPECT_DOUBLE_EQ(look.white, 1.0);
  EXPECT_DOUBLE_EQ(look.black, 0.0);
}

}  // namespace
}  // namespace hwsim::pipeline
