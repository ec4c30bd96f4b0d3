#include "lab/studies/self_check.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <functional>

#include "lab/base/build_info.h"
#include "pipeline/image/image_io.h"

namespace hwsim::lab {
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

void require(bool holds, const std::string& what) {
  if (!holds) throw InternalError(what);
}

std::string check_program() {
  return fmt::format("{} at {}, {}", build_info().version, build_info().commit, build_info().compiler);
}

std::string check_configs(const ConfigFolder& folder) {
  const std::string directory = folder.gpus();
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

std::string check_cache(const Cache& cache) {
  const fs::path folder = cache.directory(CacheFolder::scenes);
  std::error_code error;
  fs::create_directories(folder, error);
  const std::string probe = (folder / fmt::format("doctor-{}", getpid())).string();
  write_file(probe, "probe");
  fs::remove(probe, error);
  return cache.folder();
}

/// The whole way, small: a scene, a technique, every invariant, the same bytes on one thread and on two.
std::string check_simulation(const TemporaryFolder& folder, Session& session) {
  Request request;
  request.view.scene = folder.file("triangle.gltf");
  request.view.resolution = {64, 64};
  write_file(request.view.scene, kTriangleGltf);
  const RunPlan plan = make_plan(request, session.files());
  Observer silent;  // notes on the test's own triangle
  SceneView scene(plan.view, session.cache(), silent);
  std::vector<std::vector<glm::vec4>> images;
  std::uint64_t samples = 0;
  for (const int jobs : {1, 2}) {
    TraceStore store({.jobs = jobs, .disk = false}, session.cache(), silent);
    const PointResult point =
        Simulator(plan, scene, store).run(plan.techniques.front(), plan.gpus.front(), nullptr);
    images.push_back(point.emulation->color.pixels);
    samples = total(point.emulation->trace).stats.samples_passed;
    require(point.timing.time_ns > 0.0, "a frame takes no time");
  }
  require(samples > 0, "the triangle was not drawn");
  require(images[0] == images[1], "one thread and two give different images");
  return fmt::format("one triangle, {} samples, invariants hold", samples);
}

SelfCheck run_check(const std::string& name, const std::function<std::string()>& check) {
  SelfCheck result{.name = name};
  const auto start = std::chrono::steady_clock::now();
  try {
    result.detail = check();
  } catch (const InputError& error) {
    result.ok = false;
    result.detail = error.what();
    result.problems = error.diagnostics();
  } catch (const std::exception& error) {
    result.ok = false;
    result.detail = error.what();
  }
  result.wall_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace

std::vector<SelfCheck> check_itself(Session& session) {
  const TemporaryFolder folder;
  return {run_check("program", check_program),
          run_check("configs", [&] { return check_configs(session.files().folder()); }),
          run_check("images", [&] { return check_images(folder); }),
          run_check("cache", [&] { return check_cache(session.cache()); }),
          run_check("simulation", [&] { return check_simulation(folder, session); })};
}

Table self_check_table(const std::vector<SelfCheck>& checks) {
  Table table{{{"check", "check"}, {"state", "state"}, {"ms", "ms", true}, {"detail", "detail"}}, {}};
  for (const SelfCheck& check : checks)
    table.rows.push_back({check.name, check.ok ? "ok" : "failed", Real{check.wall_ms, 1}, check.detail});
  return table;
}

}  // namespace hwsim::lab
