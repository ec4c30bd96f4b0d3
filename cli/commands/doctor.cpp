#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "lab/base/build_info.h"
#include "lab/base/files.h"
#include "lab/base/table.h"
#include "lab/point/simulate.h"
#include "lab/store/cache.h"
#include "pipeline/image/image_io.h"

namespace hwsim::cli {
namespace {

namespace fs = std::filesystem;

/// One triangle in front of the default camera: positions (-1,-1,0), (1,-1,0), (0,1,0), and nothing else.
constexpr const char* kTriangleGltf = R"({
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]
})";

/// Removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(fs::temp_directory_path() / fmt::format("hwsim-doctor-{}", getpid())) {
    fs::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

void require(bool holds, const std::string& what) {
  if (!holds) throw InternalError(what);
}

std::string check_configs() {
  const std::string directory = gpu_directory();
  const std::vector<std::string> ids = list_gpus(directory);
  require(!ids.empty(), "no GPU files in " + directory);
  for (const std::string& id : ids) load_gpu(id, {}, {}, directory);
  return fmt::format("{} GPUs in {}", ids.size(), directory);
}

/// A gradient through the PNG module and back: half a step of 8 bits is the only loss.
std::string check_images(const TemporaryFolder& folder) {
  pipeline::Image image(64, 4);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      image.at(x, y) = glm::vec4(glm::vec3(pipeline::linear_from_srgb(static_cast<float>(x) / 63.0f)), 1.0f);
  const std::string path = folder.file("gradient.png");
  pipeline::write_image(image, path);
  const pipeline::Image back = pipeline::read_image(path);
  require(back.width == image.width && back.height == image.height, "an image came back in another size");
  float worst = 0.0f;
  for (size_t i = 0; i < image.pixels.size(); ++i)
    worst = std::max(worst, std::abs(pipeline::srgb_from_linear(back.pixels[i].y) -
                                     pipeline::srgb_from_linear(image.pixels[i].y)));
  require(worst <= 0.5f / 255.0f + 1e-5f, fmt::format("a PNG round trip is off by {}", worst));
  return fmt::format("PNG round trip, worst error {:.4f}", worst);
}

std::string check_cache() {
  const fs::path folder = cache_directory(CacheFolder::scenes);
  std::error_code error;
  fs::create_directories(folder, error);
  const std::string probe = (folder / fmt::format("doctor-{}", getpid())).string();
  write_file(probe, "probe");
  fs::remove(probe, error);
  return folder.parent_path().string();
}

/// The whole way, small: a scene, a technique, every invariant, the same bytes on one thread and on two.
std::string check_simulation(const TemporaryFolder& folder, Log& log) {
  const std::string path = folder.file("triangle.gltf");
  write_file(path, kTriangleGltf);
  RunOptions options;
  options.view.scene = path;
  options.view.resolution = Resolution{64, 64};
  options.techniques = {"none"};
  const RunPlan plan = plan_of(options);
  SceneView scene(plan.view, log);
  std::vector<std::vector<glm::vec4>> images;
  std::uint64_t samples = 0;
  for (const int jobs : {1, 2}) {
    TraceStore store({.jobs = jobs, .disk = false}, log);
    const PointResult point =
        Simulator(plan, scene, nullptr, store).run(plan.techniques.front(), plan.gpus.front(), nullptr);
    images.push_back(point.emulation->color.pixels);
    samples = total(point.emulation->trace).stats.samples_passed;
    require(point.timing.time_ns > 0.0, "a frame takes no time");
  }
  require(samples > 0, "the triangle was not drawn");
  require(images[0] == images[1], "one thread and two give different images");
  return fmt::format("one triangle, {} samples, invariants hold", samples);
}

}  // namespace

ExitStatus doctor(const DoctorOptions& options, Context& context) {
  const TemporaryFolder folder;
  CommonOptions silent;
  silent.verbosity = -1;
  Log quiet(silent, context.terminal);  // notes on the test's own triangle
  const std::vector<std::pair<std::string, std::function<std::string()>>> checks = {
      {"program",
       [] {
         return fmt::format("{} at {}, {}", build_info().version, build_info().commit, build_info().compiler);
       }},
      {"configs", check_configs},
      {"images", [&] { return check_images(folder); }},
      {"cache", check_cache},
      {"simulation", [&] { return check_simulation(folder, quiet); }}};
  Table table{{{"check", "check"}, {"state", "state"}, {"ms", "ms", true}, {"detail", "detail"}}, {}};
  ExitStatus status = ExitStatus::done;
  for (const auto& [name, check] : checks) {
    const auto start = std::chrono::steady_clock::now();
    std::string state = "ok", detail;
    try {
      detail = check();
    } catch (const InputError& error) {
      state = "failed";
      detail = error.what();
      for (const Diagnostic& diagnostic : error.diagnostics()) context.log.report(diagnostic);
    } catch (const std::exception& error) {
      state = "failed";
      detail = error.what();
    }
    if (state == "failed") status = ExitStatus::run_failed;
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    table.rows.push_back({name, state, Real{ms, 1}, detail});
  }
  print({.table = table}, options.common);
  return status;
}

}  // namespace hwsim::cli
