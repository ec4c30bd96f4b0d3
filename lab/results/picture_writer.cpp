#include "lab/results/picture_writer.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "lab/results/picture_text.h"
#include "pipeline/base/file_io.h"
#include "pipeline/image/heat_map.h"
#include "pipeline/image/image_bytes.h"
#include "pipeline/image/metrics.h"
#include "pipeline/image/png_file.h"

namespace hwsim::lab {
namespace {

using Bytes = std::vector<std::uint8_t>;
using pipeline::Image;

constexpr std::size_t kMostWaiting = 12;  // a point has about seven

void write_picture(const std::string& path, const Bytes& bytes) {
  pipeline::write_file_atomically(path, "I005", bytes);
}

float largest(const Image& values) {
  float result = 0.0f;
  for (const glm::vec4& pixel : values.pixels) result = std::max(result, pixel.x);
  return result;
}

/// The map's colors are meant as displayed; the PNG writer encodes.
Image heat_picture(const Image& values, float full_scale) {
  Image picture(values.width, values.height, glm::vec4(1.0f));
  const auto color_of = [&](float value) {
    const glm::vec3 shown = pipeline::magma(value / full_scale);
    return glm::vec4(pipeline::linear_from_srgb(shown.x), pipeline::linear_from_srgb(shown.y),
                     pipeline::linear_from_srgb(shown.z), 1.0f);
  };
  float last = 0.0f;  // counts come again
  glm::vec4 color = color_of(last);
  for (std::size_t i = 0; i < values.pixels.size(); ++i) {
    if (values.pixels[i].x != last) color = color_of(last = values.pixels[i].x);
    picture.pixels[i] = color;
  }
  return picture;
}

Bytes shading_picture(const Image& heat) {
  const float hottest = std::max(1.0f, largest(heat));
  return pipeline::encode_png(
      with_scale(heat_picture(heat, hottest), static_cast<double>(hottest), "shader invocations a pixel"));
}

void write_heat(const std::string& path, const Image& values, float full_scale) {
  write_picture(path,
                pipeline::encode_png(values.width, values.height, pipeline::heat_map(values, full_scale)));
}

}  // namespace

struct PictureWriter::EncodedReference {
  explicit EncodedReference(const Image& its_image) : image(its_image) {}
  const Image& image;
  std::once_flag png_once, exr_once;
  Bytes png_bytes, exr_bytes;
  const Bytes& png() {
    std::call_once(png_once, [this] { png_bytes = pipeline::encode_png(image); });
    return png_bytes;
  }
  const Bytes& exr() {
    std::call_once(exr_once, [this] { exr_bytes = pipeline::encode_exr(image); });
    return exr_bytes;
  }
};

PictureWriter::PictureWriter(int jobs) {
  if (jobs > 1) thread_ = std::thread([this] { work(); });
}

PictureWriter::~PictureWriter() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PictureWriter::write(const std::string& folder, const PointResult& point,
                          const ReferenceImage* reference) {
  const auto emulation = point.emulation;
  add([=] { write_picture(folder + "/color.png", pipeline::encode_png(emulation->color)); });
  add([=] { write_picture(folder + "/color.exr", pipeline::encode_exr(emulation->color)); });
  add([=] { write_picture(folder + "/heat_shading.png", shading_picture(emulation->shading_heat)); });
  if (!reference) return;
  if (!reference_ || &reference_->image != &reference->image)
    reference_ = std::make_shared<EncodedReference>(reference->image);
  const auto encoded = reference_;
  add([=] { write_picture(folder + "/reference.png", encoded->png()); });
  add([=] { write_picture(folder + "/reference.exr", encoded->exr()); });
  const auto flip = point.flip_map;
  add([=] { write_heat(folder + "/flip.png", *flip, 1.0f); });
  add([=] { write_picture(folder + "/flip.exr", pipeline::encode_exr(*flip)); });
}

void PictureWriter::add(Task task) {
  if (!thread_.joinable()) return task();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < kMostWaiting || failure_; });
  if (failure_) std::rethrow_exception(failure_);
  waiting_.push_back(std::move(task));
  lock.unlock();
  changed_.notify_all();
}

void PictureWriter::finish() {
  std::unique_lock lock(mutex_);
  while (run_one(lock)) continue;
  changed_.wait(lock, [this] { return running_ == 0; });
  if (failure_) std::rethrow_exception(failure_);
}

void PictureWriter::work() {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    run_one(lock);
  }
}

/// The first that waits; after a failure none.
bool PictureWriter::run_one(std::unique_lock<std::mutex>& lock) {
  if (failure_) waiting_.clear();
  if (waiting_.empty()) return false;
  const Task task = std::move(waiting_.front());
  waiting_.pop_front();
  ++running_;
  lock.unlock();
  std::exception_ptr failure;
  try {
    task();
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  --running_;
  if (failure && !failure_) failure_ = failure;
  changed_.notify_all();
  return true;
}

}  // namespace hwsim::lab
