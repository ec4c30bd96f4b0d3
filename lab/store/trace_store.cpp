#include "lab/store/trace_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "algos/source_digest.h"
#include "hwsim/base/byte_codec.h"
#include "hwsim/trace/trace_file.h"
#include "lab/request/request.h"

namespace hwsim::lab {
namespace {

using pipeline::Emulation;
using pipeline::Image;

constexpr std::string_view kFrameKind = "frame", kImageKind = "image";
constexpr std::uint64_t kFrameVersion = 1, kImageVersion = 1;
constexpr std::size_t kKeptFrames = 4;  // 30 MB each at 1280x720
constexpr std::size_t kChannels = 4;

std::vector<std::uint8_t> encode_frame(const std::string& key, const Emulation& emulation) {
  ByteWriter out;
  out.text(key);  // two keys with one hash are told apart
  out.count(emulation.skipped.size());
  for (const auto& [name, count] : emulation.skipped) {
    out.text(name);
    out.count(count);
  }
  out.raw(encode_trace(emulation.trace));
  return seal(kFrameKind, kFrameVersion, out.take());
}

void decode_frame(std::span<const std::uint8_t> bytes, const std::string& key, Emulation& emulation) {
  const auto payload = open_seal(kFrameKind, kFrameVersion, bytes);
  ByteReader in(payload);
  if (in.text() != key) throw DamagedBytes("it belongs to other work");
  for (std::size_t i = in.elements(); i > 0; --i) {
    std::string name = in.text();
    emulation.skipped[std::move(name)] = in.count();
  }
  DecodedTrace decoded = decode_trace(in.rest());
  if (!decoded.trace) throw DamagedBytes(decoded.damage);
  emulation.trace = std::move(*decoded.trace);
}

/// Channel by channel; one that is the same everywhere (alpha, unused ones of the heat map) takes one value.
void write_image(ByteWriter& out, const Image& image) {
  out.count(static_cast<std::uint64_t>(image.width));
  out.count(static_cast<std::uint64_t>(image.height));
  std::vector<float> plane(image.pixels.size());
  for (glm::length_t c = 0; c < static_cast<glm::length_t>(kChannels); ++c) {
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = image.pixels[i][c];
    const bool constant = std::all_of(plane.begin(), plane.end(), [&](const float& value) {
      return std::memcmp(&value, plane.data(), sizeof value) == 0;
    });
    out.count(constant ? 1 : 0);
    const std::size_t stored = constant ? std::min<std::size_t>(1, plane.size()) : plane.size();
    out.raw({reinterpret_cast<const std::uint8_t*>(plane.data()), stored * sizeof(float)});
  }
}

Image read_image(ByteReader& in) {
  const std::uint64_t width = in.count(), height = in.count();
  constexpr std::uint64_t kMaxSide = 1 << 16;
  if (width > kMaxSide || height > kMaxSide) throw DamagedBytes("an image is too large");
  Image image(static_cast<int>(width), static_cast<int>(height));
  const std::size_t pixels = image.pixels.size();
  std::vector<float> plane(pixels);
  for (glm::length_t c = 0; c < static_cast<glm::length_t>(kChannels); ++c) {
    const bool constant = in.count() != 0;
    const std::size_t stored = constant ? std::min<std::size_t>(1, pixels) : pixels;
    const auto bytes = in.raw(stored * sizeof(float));
    std::memcpy(plane.data(), bytes.data(), bytes.size());
    for (std::size_t i = 0; i < pixels; ++i) image.pixels[i][c] = plane[constant ? 0 : i];
  }
  return image;
}

std::vector<std::uint8_t> encode_images(const std::string& key, const Emulation& emulation) {
  ByteWriter out;
  out.text(key);
  write_image(out, emulation.color);
  write_image(out, emulation.shading_heat);
  return seal(kImageKind, kImageVersion, out.take());
}

void decode_images(std::span<const std::uint8_t> bytes, const std::string& key, Emulation& emulation) {
  ByteReader in(open_seal(kImageKind, kImageVersion, bytes));
  if (in.text() != key) throw DamagedBytes("it belongs to other work");
  emulation.color = read_image(in);
  emulation.shading_heat = read_image(in);
  in.expect_end();
}

std::string key_of(const std::string& work) {
  return fmt::format("{}|{:016x}|{}", algos::source_digest(), trace_version(), work);
}

}  // namespace

std::string TraceStore::frame_path(const std::string& key) const {
  return cache_.path(CacheFolder::traces, key, ".trace");
}
std::string TraceStore::image_path(const std::string& key) const {
  return cache_.path(CacheFolder::traces, key, ".image");
}

std::string TraceStore::work_text(const SceneView& scene, const algos::TechniqueChoice& technique,
                                  const GpuConfig& gpu, const FrameNeeds& needs) {
  return fmt::format("scene {} camera {} {}|{}|gpu {}|skip {}", scene.summary().content_hash, scene.camera(),
                     key_text(scene.plan(), kWork), technique_text(technique, true), functional_hash(gpu),
                     skip_text(needs.skip));
}

EmulatedFrame TraceStore::frame(SceneView& scene, const algos::TechniqueChoice& technique,
                                const GpuConfig& gpu, const FrameNeeds& needs,
                                const ProgressFunction& progress) {
  std::string key = key_of(work_text(scene, technique, gpu, needs));
  EmulatedFrame result{in_memory(key, needs.image), true, true};
  if (result.emulation) return result;
  result.in_memory = false;
  if (options_.disk) result.emulation = on_disk(key, scene, needs.image);
  if (!result.emulation) {
    result = {emulate(scene, technique, gpu, needs, progress), false, false};
    key = key_of(work_text(scene, technique, gpu, needs));  // the file may have changed before it was loaded
    if (options_.disk) cache_.write(frame_path(key), encode_frame(key, *result.emulation), observer_);
    if (options_.disk && needs.image)
      cache_.write(image_path(key), encode_images(key, *result.emulation), observer_);
  }
  keep(key, result.emulation);
  return result;
}

bool TraceStore::holds(const SceneView& scene, const algos::TechniqueChoice& technique, const GpuConfig& gpu,
                       const FrameNeeds& needs) const {
  return in_memory(key_of(work_text(scene, technique, gpu, needs)), needs.image) != nullptr;
}

std::shared_ptr<const Emulation> TraceStore::in_memory(const std::string& key, bool image) const {
  for (const Kept& kept : kept_)
    if (kept.key == key && !(image && kept.emulation->color.pixels.empty())) return kept.emulation;
  return nullptr;
}

std::shared_ptr<const Emulation> TraceStore::on_disk(const std::string& key, const SceneView& scene,
                                                     bool image) {
  const auto start = std::chrono::steady_clock::now();
  auto emulation = std::make_shared<Emulation>();
  std::vector<std::string> paths = {frame_path(key)};
  if (image) paths.push_back(image_path(key));
  for (const std::string& path : paths) try {
      const auto bytes = read_cached(path);
      if (!bytes) return nullptr;
      path == paths.front() ? decode_frame(*bytes, key, *emulation) : decode_images(*bytes, key, *emulation);
    } catch (const DamagedBytes& damage) {
      note_damage(observer_, path, damage.what());
      return nullptr;
    }
  for (const std::string& path : paths) mark_used(path);
  emulation->trace.scene = scene.summary().name;  // another file with the same content is the same work
  emulation->wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return emulation;
}

std::shared_ptr<const Emulation> TraceStore::emulate(SceneView& scene,
                                                     const algos::TechniqueChoice& technique,
                                                     const GpuConfig& gpu, const FrameNeeds& needs,
                                                     const ProgressFunction& progress) {
  algos::FrameRequest request = scene.frame_request();
  request.features = gpu.features;
  request.functional = gpu.functional;
  const pipeline::FrameGraph graph = algos::build_frame(technique, request);
  pipeline::EmulationOptions options;
  options.jobs = options_.jobs;
  options.skip = needs.skip;
  options.progress = progress;
  Emulation emulation = pipeline::emulate(graph, gpu.features, gpu.functional, options);
  emulation.trace.technique = technique_text(technique);
  emulation.trace.technique_counters = algos::technique_counter_ids();
  return std::make_shared<const Emulation>(std::move(emulation));
}

void TraceStore::keep(const std::string& key, std::shared_ptr<const Emulation> emulation) {
  std::erase_if(kept_, [&](const Kept& kept) { return kept.key == key; });
  kept_.push_back({key, std::move(emulation)});
  if (kept_.size() > kKeptFrames) kept_.erase(kept_.begin());
}

}  // namespace hwsim::lab
