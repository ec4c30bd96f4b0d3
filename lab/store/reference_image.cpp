#include "lab/store/reference_image.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>

#include "algos/base/reference_frame.h"
#include "algos/source_digest.h"
#include "lab/store/image_codec.h"
#include "pipeline/base/sealed_file.h"

namespace hwsim::lab {
namespace {

/// Everything that the image depends on.
std::string reference_key(const SceneView& scene, int samples) {
  return fmt::format("{}|{}|{}|{}|{}", algos::reference_digest(), scene.summary().content_hash,
                     scene.camera(), key_text(scene.plan(), kReference), samples);
}

pipeline::SealKind reference_kind() { return {"truth", algos::reference_digest()}; }

/// None where there is none, or another one: two keys with one hash are told apart.
std::optional<pipeline::Image> on_disk(const std::string& path, const std::string& key, const Cache& cache,
                                       Observer& observer) {
  const auto bytes = cache.read(path, reference_kind(), observer);
  if (!bytes) return std::nullopt;
  try {
    ByteReader in(*bytes);
    if (in.text() != key) throw DamagedBytes("it belongs to another view");
    pipeline::Image image = decode_image(in);
    in.expect_end();
    return image;
  } catch (const DamagedBytes& damage) {
    note_damage(observer, path, damage.what());
    return std::nullopt;
  }
}

pipeline::Image trace_rays(SceneView& scene, int samples, int jobs, const ProgressFunction& progress) {
  algos::ReferenceFrameOptions options;
  options.samples = samples;
  options.jobs = jobs;
  options.shadows =
      scene.plan().reference_shadows == "rays" ? algos::ReferenceShadows::rays : algos::ReferenceShadows::map;
  options.progress = [&progress](double share) { progress(share, "reference"); };
  return algos::render_reference_frame(scene.frame_request(), options);
}

}  // namespace

std::optional<std::string> reference_title(const std::string& path, const Cache& cache) try {
  Observer silence;
  const auto bytes = cache.read(path, reference_kind(), silence);
  if (!bytes) return std::nullopt;
  ByteReader in(*bytes);
  const std::string key = in.text();
  const pipeline::Image image = decode_image(in);
  return fmt::format("{}x{}, {} samples a pixel", image.width, image.height, key.substr(key.rfind('|') + 1));
} catch (const DamagedBytes&) {
  return std::nullopt;
}

ReferenceImage make_reference(SceneView& scene, int samples, const ReferenceContext& context) {
  const auto start = std::chrono::steady_clock::now();
  const std::string key = reference_key(scene, samples);
  const std::string path = context.cache.path(CacheFolder::references, key, ".truth");
  ReferenceImage result;
  result.samples = samples;
  std::optional<pipeline::Image> kept = on_disk(path, key, context.cache, context.observer);
  result.from_cache = kept.has_value();
  if (kept) {
    result.image = std::move(*kept);
    mark_used(path);
  } else {
    result.image = trace_rays(scene, samples, context.jobs, context.progress);
    ByteWriter out;
    out.text(key);
    encode_image(out, result.image);
    context.cache.write(path, reference_kind(), out.take(), context.observer);
  }
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace hwsim::lab
