#include "lab/store/scene_view.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <charconv>
#include <ctime>
#include <filesystem>
#include <optional>

#include "algos/source_digest.h"
#include "hwsim/base/byte_codec.h"
#include "hwsim/base/file_name.h"
#include "lab/base/messages.h"
#include "lab/base/scene_kinds.h"
#include "lab/request/image_input.h"
#include "lab/store/free_camera.h"
#include "pipeline/base/sealed_file.h"
#include "pipeline/generate/generator_digest.h"
#include "pipeline/open/scene_source.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kNsPerS = 1'000'000'000;
constexpr std::int64_t kSettledNs = kNsPerS / 10;  // far more than the tick of any file system's clock

/// Whatever writes to a file, or puts another in its place, changes one of these.
struct FileStamp {
  std::string path;
  std::int64_t bytes = -1;  ///< -1: there is no such file
  std::int64_t changed_ns = 0, written_ns = 0, inode = 0;
  bool operator==(const FileStamp&) const = default;
};

FileStamp stamp_of(const std::string& path) {
  FileStamp stamp{path};
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return stamp;
  stamp.bytes = status.st_size;
  stamp.changed_ns = status.st_ctim.tv_sec * kNsPerS + status.st_ctim.tv_nsec;
  stamp.written_ns = status.st_mtim.tv_sec * kNsPerS + status.st_mtim.tv_nsec;
  stamp.inode = static_cast<std::int64_t>(status.st_ino);
  return stamp;
}

std::int64_t now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return now.tv_sec * kNsPerS + now.tv_nsec;
}

void write_note(ByteWriter& out, const Diagnostic& note) {
  out.count(static_cast<std::uint64_t>(note.severity));
  for (const std::string* text :
       {&note.code, &note.message, &note.place.file, &note.place.line_text, &note.hint, &note.help})
    out.text(*text);
  for (const int number : {note.place.line, note.place.column, note.place.length}) out.integer(number);
  out.count(note.notes.size());
  for (const std::string& text : note.notes) out.text(text);
}

Diagnostic read_note(ByteReader& in) {
  Diagnostic note;
  const std::uint64_t severity = in.count();
  if (severity > static_cast<std::uint64_t>(Severity::error)) throw DamagedBytes("an unknown severity");
  note.severity = static_cast<Severity>(severity);
  for (std::string* text :
       {&note.code, &note.message, &note.place.file, &note.place.line_text, &note.hint, &note.help})
    *text = in.text();
  for (int* number : {&note.place.line, &note.place.column, &note.place.length})
    *number = static_cast<int>(in.integer());
  note.notes.resize(in.elements());
  for (std::string& text : note.notes) text = in.text();
  return note;
}

std::vector<std::uint8_t> encode(const SceneSummary& summary, const std::vector<FileStamp>& stamps) {
  ByteWriter out;
  out.count(stamps.size());
  for (const FileStamp& stamp : stamps) {
    out.text(stamp.path);
    for (const std::int64_t number : {stamp.bytes, stamp.changed_ns, stamp.written_ns, stamp.inode})
      out.integer(number);
  }
  out.text(summary.name);
  out.text(summary.content_hash);
  out.count(summary.cameras.size());
  for (const std::string& camera : summary.cameras) out.text(camera);
  out.count(summary.notes.size());
  for (const Diagnostic& note : summary.notes) write_note(out, note);
  out.count(summary.surfaces.size());
  for (const pipeline::SpecialSurface& surface : summary.surfaces) {
    out.text(surface.material);
    for (const bool trait :
         {surface.blended, surface.emissive, surface.colored_emission, surface.unlit, surface.occluded})
      out.count(trait ? 1 : 0);
  }
  out.count(summary.triangles);
  return out.take();
}

/// Nothing when a file has changed since.
std::optional<SceneSummary> decode(std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes);
  for (std::size_t files = in.elements(); files > 0; --files) {
    FileStamp stamp{in.text()};
    for (std::int64_t* number : {&stamp.bytes, &stamp.changed_ns, &stamp.written_ns, &stamp.inode})
      *number = in.integer();
    if (stamp != stamp_of(stamp.path)) return std::nullopt;
  }
  SceneSummary summary;
  summary.name = in.text();
  summary.content_hash = in.text();
  summary.cameras.resize(in.elements());
  for (std::string& camera : summary.cameras) camera = in.text();
  summary.notes.resize(in.elements());
  for (Diagnostic& note : summary.notes) note = read_note(in);
  summary.surfaces.resize(in.elements());
  for (pipeline::SpecialSurface& surface : summary.surfaces) {
    surface.material = in.text();
    for (bool* trait :
         {&surface.blended, &surface.emissive, &surface.colored_emission, &surface.unlit, &surface.occluded})
      *trait = in.count() != 0;
  }
  summary.triangles = in.count();
  in.expect_end();
  return summary;
}

/// A generated scene's file follows from its name and the generator's sources; a file is itself.
std::string summary_path(const View& view, const Cache& cache) {
  const std::string& scene = view.scene;
  const bool is_file = has_extension(scene, ".gltf") || has_extension(scene, ".glb");
  std::error_code error;
  const std::string name = is_file ? fs::absolute(scene, error).lexically_normal().string() : scene;
  return cache.path(CacheFolder::scenes,
                    fmt::format("{}|{}|{}|{}|{}", algos::source_digest(), pipeline::generator_digest(), name,
                                scene, view.exposure),
                    ".summary");
}

pipeline::SceneLoadOptions load_options(const View& view) {
  pipeline::SceneLoadOptions options;
  options.max_memory_bytes = static_cast<std::uint64_t>(view.memory_mib) << 20;
  options.exposure = view.exposure;
  options.max_anisotropy = view.anisotropy;
  options.alpha_test = view.alpha_test;
  return options;
}

int find_camera(const SceneSummary& scene, const std::string& text) {
  const auto count = static_cast<int>(scene.cameras.size());
  int index = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  for (int i = 0; i < count; ++i)
    if (scene.cameras[static_cast<size_t>(i)] == text) return i;
  if (error == std::errc() && end == text.data() + text.size() && index >= 0 && index < count) return index;
  fail("U009", fmt::format("scene `{}` has no camera `{}`", scene.name, text),
       did_you_mean(text, scene.cameras),
       fmt::format("cameras: index 0 to {}; names: {}", count - 1, fmt::join(scene.cameras, ", ")));
}

pipeline::SealKind summary_kind() { return {"summary 2", algos::source_digest()}; }

std::optional<SceneSummary> remembered_summary(const std::string& path, const Cache& cache,
                                               Observer& observer) {
  const auto bytes = cache.read(path, summary_kind(), observer);
  if (!bytes) return std::nullopt;
  try {
    return decode(*bytes);
  } catch (const DamagedBytes& damage) {
    note_damage(observer, path, damage.what());
    return std::nullopt;
  }
}

}  // namespace

std::string camera_name(const SceneSummary& scene, const std::string& camera) {
  return scene.cameras.empty() ? std::string()
                               : scene.cameras[static_cast<std::size_t>(find_camera(scene, camera))];
}

SceneView::SceneView(View plan, const Cache& cache, Observer& observer, SceneShelf* shelf)
    : plan_(std::move(plan)), cache_(cache), shelf_(shelf), free_camera_(free_camera(plan_.camera)) {
  if (is_image_file(plan_.scene)) {
    load_image();
    return;
  }
  const std::string path = summary_path(plan_, cache);
  if (auto known = remembered_summary(path, cache, observer)) {
    summary_ = std::move(*known);
  } else {
    const std::int64_t start_ns = now_ns();
    const bool shared = shelf_ && shelf_->find(load_text());
    load();
    std::vector<FileStamp> stamps;
    // A file written while it was read, or since another view read it, could differ from what its stamp says.
    bool settled = !shared;
    for (const std::string& file : scene_->files) {
      stamps.push_back(stamp_of(file));
      settled = settled && stamps.back().changed_ns < start_ns - kSettledNs;
    }
    if (settled) cache.write(path, summary_kind(), encode(summary_, stamps), observer);
  }
  camera_ = free_camera_ ? adopt_camera() : find_camera(summary_, plan_.camera);
  for (const Diagnostic& note : summary_.notes) observer.report(note);
}

/// The camera stands behind those of the scene. What is known of the scene says so: traces and references are
/// kept by its hash and the camera's index.
int SceneView::adopt_camera() {
  if (scene_) scene_ = std::make_shared<const pipeline::Scene>(with_camera(*scene_, *free_camera_));
  const auto index = static_cast<int>(summary_.cameras.size());
  summary_.cameras.push_back(free_camera_->name);
  summary_.content_hash += " " + free_camera_->name;
  return index;
}

std::string SceneView::load_text() const {
  return fmt::format("{} memory {} exposure {} anisotropy {} alpha_test {}", plan_.scene, plan_.memory_mib,
                     plan_.exposure, plan_.anisotropy, plan_.alpha_test);
}

void SceneView::release() {
  if (!image_) scene_.reset();
}

void SceneView::load() {
  std::shared_ptr<const pipeline::Scene> scene = shelf_ ? shelf_->find(load_text()) : nullptr;
  if (!scene)
    scene = std::make_shared<const pipeline::Scene>(opened_scene(plan_.scene, [&] {
      return pipeline::open_scene(plan_.scene, cache_.directory(CacheFolder::scenes), load_options(plan_));
    }));
  summary_ = {scene->name,
              scene->content_hash,
              {},
              scene->notes,
              pipeline::special_surfaces(*scene),
              pipeline::stats(*scene).drawn_triangles};
  for (const pipeline::Camera& camera : scene->cameras) summary_.cameras.push_back(camera.name);
  scene_ = std::move(scene);
  if (shelf_) shelf_->put(load_text(), scene_);
}

void SceneView::load_image() {
  const ImageInput input = read_image_input(plan_.scene);
  auto scene = std::make_shared<pipeline::Scene>();
  scene->name = fs::path(plan_.scene).stem().string();
  scene->content_hash = input.content_hash;
  summary_ = {scene->name, scene->content_hash, {}, {}, {}, 0};
  image_ = input.texels;
  plan_.resolution = {image_->width, image_->height};
  scene_ = std::move(scene);
}

const std::shared_ptr<const pipeline::Scene>& SceneView::scene() {
  if (scene_) return scene_;
  load();
  if (free_camera_) camera_ = adopt_camera();
  return scene_;
}

algos::FrameRequest SceneView::frame_request() {
  // All members by name, as in `describe`: a new one that is forgotten here does not compile.
  const auto& [scene_name, resolution, camera, point_lights, light_range, light_strength, light_range_from,
               light_range_to, light_box_x, light_box_y, light_box_z, light_seed, lights, shadows,
               shadow_map_px, metal_ambient, anisotropy, alpha_test, reference_shadows, exposure,
               memory_mib] = plan_;
  static_cast<void>(scene_name), static_cast<void>(camera);    // scene(), camera_
  static_cast<void>(anisotropy), static_cast<void>(exposure);  // load_options()
  static_cast<void>(alpha_test);
  static_cast<void>(memory_mib), static_cast<void>(reference_shadows);  // likewise, and elsewhere
  algos::FrameRequest request;
  request.scene = scene();
  request.width_px = resolution.width_px;
  request.height_px = resolution.height_px;
  request.camera = camera_;
  request.point_lights = point_lights;
  request.light_range = light_range;
  request.light_strength = light_strength;
  request.added = {{light_box_x, light_box_y, light_box_z}, light_range_from, light_range_to, light_seed};
  request.lights = light_profile_from_name(lights).value_or(algos::LightProfile::scene);
  request.shadows = shadows;
  request.shadow_map_px = shadow_map_px;
  request.metal_ambient = metal_ambient;
  request.image = image_;
  return request;
}

}  // namespace hwsim::lab
