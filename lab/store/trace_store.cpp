#include "lab/store/trace_store.h"
#include "lab/store/image_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>

#include "algos/rooms.h"
#include "algos/source_digest.h"
#include "hwsim/base/byte_codec.h"
#include "hwsim/trace/trace_file.h"
#include "lab/base/internal_error.h"
#include "lab/request/request.h"
#include "pipeline/base/sealed_file.h"
#include "pipeline/graph/validate.h"

namespace hwsim::lab {
namespace {

using pipeline::Emulation;
using pipeline::Image;

constexpr std::size_t kKeptFrames = 4;  // 30 MB each at 1280x720

std::vector<std::uint8_t> encode_frame(const std::string& key, const Emulation& emulation) {
  ByteWriter out;
  out.text(key);  // two keys with one hash are told apart
  out.count(emulation.skipped.size());
  for (const auto& [name, count] : emulation.skipped) {
    out.text(name);
    out.count(count);
  }
  out.raw(encode_trace(emulation.trace));
  return out.take();
}

void decode_frame(std::span<const std::uint8_t> bytes, const std::string& key, Emulation& emulation) {
  ByteReader in(bytes);
  if (in.text() != key) throw DamagedBytes("it belongs to other work");
  for (std::size_t i = in.elements(); i > 0; --i) {
    std::string name = in.text();
    emulation.skipped[std::move(name)] = in.count();
  }
  DecodedTrace decoded = decode_trace(in.rest());
  if (!decoded.trace) throw DamagedBytes(decoded.damage);
  emulation.trace = std::move(*decoded.trace);
}

std::vector<std::uint8_t> encode_images(const std::string& key, const Emulation& emulation) {
  ByteWriter out;
  out.text(key);
  encode_image(out, emulation.color);
  encode_image(out, emulation.shading_heat);
  return out.take();
}

void decode_images(std::span<const std::uint8_t> bytes, const std::string& key, Emulation& emulation) {
  ByteReader in(bytes);
  if (in.text() != key) throw DamagedBytes("it belongs to other work");
  emulation.color = decode_image(in);
  emulation.shading_heat = decode_image(in);
  in.expect_end();
}

std::string trace_key(const std::string& work) {
  return fmt::format("{}|{:016x}|{}", algos::source_digest(), trace_version(), work);
}

pipeline::FrameGraph graph_of(SceneView& scene, const algos::TechniqueChoice& technique,
                              const GpuConfig& gpu) {
  algos::FrameRequest request = scene.frame_request();
  request.features = gpu.features;
  request.functional = gpu.functional;
  return algos::build_frame(technique, request);
}

pipeline::SealKind frame_kind() { return {"frame", algos::source_digest()}; }
pipeline::SealKind image_kind() { return {"image", algos::source_digest()}; }

/// The laws that counters keep. Throws InternalError with all that are broken: such work is neither timed nor
/// kept.
void check_counts(const WorkTrace& trace) {
  std::string violations;
  for (const PassWork& pass : trace.passes)
    for (const CounterViolation& v : algos::broken_laws(total(pass)))
      violations += fmt::format("\n  pass {}: {} ({} against {})", pass.name, v.law, v.left, v.right);
  if (!violations.empty())
    throw InternalError(fmt::format("technique {} violates invariants:{}", trace.technique, violations));
}

}  // namespace

std::optional<std::string> frame_title(const std::string& path, const Cache& cache) try {
  Observer silence;
  const auto bytes = cache.read(path, frame_kind(), silence);
  if (!bytes) return std::nullopt;
  Emulation emulation;
  decode_frame(*bytes, ByteReader(*bytes).text(), emulation);
  const WorkTrace& trace = emulation.trace;
  return fmt::format("{} of {}, {}x{}", trace.technique, trace.scene, trace.width_px, trace.height_px);
} catch (const DamagedBytes&) {
  return std::nullopt;
}

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
  std::string key = trace_key(work_text(scene, technique, gpu, needs));
  EmulatedFrame result{in_memory(key, needs.image), true};
  if (result.emulation) return result;
  if (options_.disk) result.emulation = on_disk(key, scene, needs.image);
  if (result.emulation) check_counts(result.emulation->trace);
  if (!result.emulation) {
    result = {emulate(scene, technique, gpu, needs, progress), false};
    check_counts(result.emulation->trace);
    key =
        trace_key(work_text(scene, technique, gpu, needs));  // the file may have changed before it was loaded
    if (options_.disk)
      cache_.write(frame_path(key), frame_kind(), encode_frame(key, *result.emulation), observer_);
    if (options_.disk && needs.image)
      cache_.write(image_path(key), image_kind(), encode_images(key, *result.emulation), observer_);
  }
  keep(key, result.emulation);
  return result;
}

void TraceStore::expect(SceneView& scene, std::span<const WantedFrame> frames, const FrameNeeds& needs) {
  memo_.clear();
  if (options_.shared_passes_bytes == 0) return;
  std::map<std::string, WantedFrame> seen;
  std::vector<WantedFrame> emulated;
  for (const WantedFrame& frame : frames) {
    const std::string key = trace_key(work_text(scene, *frame.technique, *frame.gpu, needs));
    if (in_memory(key, needs.image) || !seen.emplace(key, frame).second) continue;
    std::error_code error;
    const bool on_disk = options_.disk && std::filesystem::exists(frame_path(key), error) &&
                         (!needs.image || std::filesystem::exists(image_path(key), error));
    if (!on_disk) emulated.push_back(frame);
  }
  if (emulated.size() < 2) return;
  pipeline::EmulationOptions options;
  options.skip = needs.skip;
  for (const WantedFrame& frame : emulated) try {
      memo_.expect(graph_of(scene, *frame.technique, *frame.gpu), frame.gpu->features, frame.gpu->functional,
                   options);
    } catch (const InputError&) {
      continue;  // it cannot run, which frame() says
    }
}

bool TraceStore::holds(const SceneView& scene, const algos::TechniqueChoice& technique, const GpuConfig& gpu,
                       const FrameNeeds& needs) const {
  return in_memory(trace_key(work_text(scene, technique, gpu, needs)), needs.image) != nullptr;
}

bool TraceStore::is_kept(const SceneView& scene, const algos::TechniqueChoice& technique,
                         const GpuConfig& gpu, const FrameNeeds& needs) const {
  const std::string key = trace_key(work_text(scene, technique, gpu, needs));
  if (in_memory(key, needs.image)) return true;
  std::error_code error;
  return options_.disk && std::filesystem::exists(frame_path(key), error) &&
         (!needs.image || std::filesystem::exists(image_path(key), error));
}

std::vector<Diagnostic> TraceStore::problems(SceneView& scene, const algos::TechniqueChoice& technique,
                                             const GpuConfig& gpu, const FrameNeeds& needs) const try {
  const std::string key = trace_key(work_text(scene, technique, gpu, needs));
  std::error_code error;
  if (in_memory(key, false) || (options_.disk && std::filesystem::exists(frame_path(key), error))) return {};
  return pipeline::validate(graph_of(scene, technique, gpu), gpu.features, gpu.functional);
} catch (const InputError& error) {
  return error.diagnostics();
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
      const bool is_frame = path == paths.front();
      const auto bytes = cache_.read(path, is_frame ? frame_kind() : image_kind(), observer_);
      if (!bytes) return nullptr;
      is_frame ? decode_frame(*bytes, key, *emulation) : decode_images(*bytes, key, *emulation);
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
  const pipeline::FrameGraph graph = graph_of(scene, technique, gpu);
  pipeline::EmulationOptions options;
  options.jobs = options_.jobs;
  options.skip = needs.skip;
  options.progress = progress;
  options.memo = &memo_;
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
