#include "pipeline/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "pipeline/base/parallel.h"
#include "pipeline/reference/camera_rays.h"

namespace hwsim::pipeline {
namespace {

constexpr std::size_t kBatchHits = 4096;  // 0.8 MB: stays in the second-level cache
constexpr int kMaxBlendLayers = 64;

const Camera& camera_of(const ReferenceScene& scene, const ReferenceOptions& options) {
  if (options.width <= 0 || options.height <= 0 || sample_count(options) <= 0)
    throw std::invalid_argument("reference: width, height and samples must be positive");
  return scene.scene().cameras.at(static_cast<std::size_t>(options.camera));
}

double radical_inverse(std::uint32_t index, std::uint32_t base) {
  double value = 0.0, digit = 1.0;
  for (; index > 0; index /= base) {
    digit /= base;
    value += digit * (index % base);
  }
  return value;
}

// Wellons' 32-bit mixer (lowbias32).
std::uint32_t mixed(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}

double unit_from_bits(std::uint32_t bits) { return bits / 4294967296.0; }

PixelRay scaled(PixelRay pixel, float footprint_scale) {
  for (glm::vec3* step : {&pixel.origin_dx, &pixel.origin_dy, &pixel.direction_dx, &pixel.direction_dy})
    *step *= footprint_scale;
  return pixel;
}

class Progress {
 public:
  explicit Progress(const ReferenceOptions& options) : report_(options.progress), rows_(options.height) {}
  void row_done() {
    if (!report_) return;
    const std::scoped_lock lock(mutex_);
    report_(static_cast<double>(++done_) / rows_);
  }

 private:
  const std::function<void(double)>& report_;
  int rows_, done_ = 0;
  std::mutex mutex_;
};

// Traces a row's samples, collects their hits, and shades them together.
class RowRenderer {
 public:
  RowRenderer(const ReferenceScene& scene, const ReferenceOptions& options, const ShadeBatch& shade,
              glm::vec4* row)
      : scene_(scene), options_(options), shade_(shade), row_(row) {}

  void add(int x, const PixelRay& pixel) {
    const std::size_t first = hits_.size();
    Ray ray = pixel.ray;
    for (int layer = 0; layer < kMaxBlendLayers; ++layer) {
      const Visibility hit = scene_.trace(ray);
      if (!hit) break;
      hits_.push_back(scene_.surface(hit, pixel));
      if (!is_blended(hits_.back())) break;
      ray.t_min = hit.t * (1.0f + 0x1p-20f);  // 8 units in the last place: past this surface
    }
    samples_.push_back({x, hits_.size() - first});
    if (hits_.size() >= kBatchHits) flush();
  }

  void flush() {
    colors_.assign(hits_.size(), glm::vec4(0.0f));
    if (!hits_.empty()) shade_(hits_, colors_);
    std::size_t at = 0;
    for (const Sample& sample : samples_) {
      row_[sample.x] += glm::vec4(composed(at, sample.hit_count), 1.0f);
      at += sample.hit_count;
    }
    hits_.clear();
    samples_.clear();
  }

 private:
  struct Sample {
    int x;
    std::size_t hit_count;
  };

  bool is_blended(const SurfaceHit& hit) const {
    return scene_.scene().materials[static_cast<std::size_t>(hit.material)].alpha_mode == AlphaMode::blend;
  }

  glm::vec3 composed(std::size_t first, std::size_t count) const {
    glm::vec3 color(0.0f);
    float transmitted = 1.0f;
    for (std::size_t i = first; i < first + count; ++i) {
      const float alpha = is_blended(hits_[i]) ? std::clamp(colors_[i].w, 0.0f, 1.0f) : 1.0f;
      color += transmitted * alpha * glm::vec3(colors_[i]);
      transmitted *= 1.0f - alpha;
    }
    return glm::min(color + transmitted * scene_.scene().background,
                    glm::vec3(options_.largest_sample_value));
  }

  const ReferenceScene& scene_;
  const ReferenceOptions& options_;
  const ShadeBatch& shade_;
  glm::vec4* row_;
  std::vector<SurfaceHit> hits_;
  std::vector<glm::vec4> colors_;
  std::vector<Sample> samples_;
};

}  // namespace

int sample_count(const ReferenceOptions& options) {
  return options.offsets_px.empty() ? options.samples : static_cast<int>(options.offsets_px.size());
}

std::vector<glm::vec2> sample_offsets(const ReferenceOptions& options, int x, int y) {
  if (!options.offsets_px.empty()) return options.offsets_px;
  const std::uint32_t seed = mixed(static_cast<std::uint32_t>(x) ^ mixed(static_cast<std::uint32_t>(y)));
  const double shift_x = unit_from_bits(seed), shift_y = unit_from_bits(mixed(seed + 1));
  const auto wrapped = [](double v) {
    return std::min(static_cast<float>(v - std::floor(v) - 0.5), 0.49999997f);
  };
  std::vector<glm::vec2> offsets;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(options.samples); ++i)
    offsets.emplace_back(wrapped(radical_inverse(i, 2) + shift_x), wrapped(radical_inverse(i, 3) + shift_y));
  return offsets;
}

std::vector<Visibility> trace_visibility(const ReferenceScene& scene, const ReferenceOptions& options,
                                         bool with_blend) {
  const CameraRays rays(camera_of(scene, options), options.width, options.height);
  const auto samples = static_cast<std::size_t>(sample_count(options)),
             width = static_cast<std::size_t>(options.width);
  std::vector<Visibility> seen(width * static_cast<std::size_t>(options.height) * samples);
  Progress progress(options);
  parallel_for(static_cast<std::size_t>(options.height), options.jobs, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    std::size_t at = row * width * samples;
    for (int x = 0; x < options.width; ++x)
      for (const glm::vec2 offset : sample_offsets(options, x, y))
        seen[at++] = scene.trace(rays.through(x + 0.5 + offset.x, y + 0.5 + offset.y).ray, with_blend);
    progress.row_done();
  });
  return seen;
}

Image render_reference(const ReferenceScene& scene, const ReferenceOptions& options,
                       const ShadeBatch& shade) {
  const CameraRays rays(camera_of(scene, options), options.width, options.height);
  Image image(options.width, options.height);
  Progress progress(options);
  const auto share = 1.0f / static_cast<float>(sample_count(options));
  parallel_for(static_cast<std::size_t>(options.height), options.jobs, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    RowRenderer renderer(scene, options, shade, &image.at(0, y));
    for (int x = 0; x < options.width; ++x)
      for (const glm::vec2 offset : sample_offsets(options, x, y))
        renderer.add(x,
                     scaled(rays.through(x + 0.5 + offset.x, y + 0.5 + offset.y), options.footprint_scale));
    renderer.flush();
    for (int x = 0; x < options.width; ++x)
      image.at(x, y) = glm::vec4(glm::vec3(image.at(x, y)) * share, 1.0f);
    progress.row_done();
  });
  return image;
}

}  // namespace hwsim::pipeline
