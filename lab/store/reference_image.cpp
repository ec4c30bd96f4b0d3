#include "lab/store/reference_image.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "algos/base/reference_frame.h"
#include "algos/source_digest.h"
#include "lab/base/files.h"
#include "pipeline/image/image_io.h"

namespace hwsim::lab {
namespace {

/// Everything that the image depends on.
std::string reference_key(const SceneView& scene, int samples) {
  return fmt::format("{}|{}|{}|{}|{}", algos::reference_digest(), scene.summary().content_hash,
                     scene.camera(), key_text(scene.plan(), kReference), samples);
}

}  // namespace

ReferenceImage make_reference(SceneView& scene, int samples, int jobs, const Cache& cache,
                              const ProgressFunction& progress) {
  const auto start = std::chrono::steady_clock::now();
  const std::filesystem::path folder = cache.directory(CacheFolder::references);
  const std::string path = (folder / (hash_hex(reference_key(scene, samples)) + ".exr")).string();
  std::error_code error;
  ReferenceImage result;
  result.samples = samples;
  result.from_cache = std::filesystem::exists(path, error);
  if (!result.from_cache) {
    const algos::FrameRequest request = scene.frame_request();
    algos::ReferenceFrameOptions options;
    options.samples = samples;
    options.jobs = jobs;
    options.shadows = scene.plan().reference_shadows == "rays" ? algos::ReferenceShadows::rays
                                                               : algos::ReferenceShadows::map;
    options.progress = [&progress](double share) { progress(share, "reference"); };
    std::filesystem::create_directories(folder, error);
    pipeline::write_image(algos::render_reference_frame(request, options), path);
  }
  // Read back even when it is new: the file has half floats, and every run must compare with the same image.
  result.image = pipeline::read_image(path);
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace hwsim::lab
