// Pictures are written on a thread of their own: the same files as one after the other, and no failure is
// lost.
#include "lab/results/picture_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "lab/base/files.h"

namespace hwsim::lab {
namespace {

pipeline::Image gradient(float step) {
  pipeline::Image image(40, 30);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = glm::vec4(step * static_cast<float>(i), 0.5f, 0.1f, 1.0f);
  return image;
}

PointResult point_of(float step) {
  auto emulation = std::make_shared<pipeline::Emulation>();
  emulation->color = gradient(step);
  emulation->shading_heat = gradient(100.0f * step);
  PointResult point;
  point.emulation = std::move(emulation);
  point.flip_map = std::make_shared<const pipeline::Image>(gradient(0.5f * step));
  return point;
}

constexpr int kPoints = 6;

void write_points(const std::string& folder, int jobs, const ReferenceImage& reference) {
  PictureWriter writer(jobs);
  for (int i = 0; i < kPoints; ++i) {
    const std::string place = folder + "/" + std::to_string(i);
    std::filesystem::create_directories(place);
    writer.write(place, point_of(0.001f * static_cast<float>(i)), &reference);
  }
  writer.finish();
}

TEST(PictureWriter, WritesTheSameFilesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  ReferenceImage reference;
  reference.image = gradient(0.002f);
  write_points(folder.file("one"), 1, reference);
  write_points(folder.file("three"), 3, reference);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.file("one"))) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const auto twin = folder.path() / "three" / std::filesystem::relative(entry.path(), folder.file("one"));
    EXPECT_EQ(read_file(entry.path()), read_file(twin)) << twin;
  }
  EXPECT_EQ(files, 7u * kPoints);
}

TEST(PictureWriter, TellsOfAFailureAtTheEndAtLatest) {
  for (const int jobs : {1, 3}) {
    PictureWriter writer(jobs);
    EXPECT_THROW(
        {
          writer.write("/nonexistent/folder", point_of(0.1f), nullptr);
          writer.finish();
        },
        InputError);
  }
}

TEST(PictureWriter, MayGoWithoutWritingWhatWaits) {
  const TemporaryFolder folder;
  PictureWriter writer(3);
  writer.write(folder.path().string(), point_of(0.1f), nullptr);
}

}  // namespace
}  // namespace hwsim::lab
