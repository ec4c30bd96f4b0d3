// Depth-only and Gouraud passes on random triangles and on a scene's triangles, with all counters on, and
// llvmpipe drawing the same triangles in the same run: the figures are the rates and their ratio.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "benchmarks/pass_programs.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/shade/mesh_vertex.h"
#include "study_input.h"
#ifdef HWSIM_HAVE_LLVMPIPE
#include "oracle/llvmpipe.h"
#endif

namespace hwsim::benchmarks {
namespace {
using namespace pipeline;

constexpr int kWidth = 1280, kHeight = 720, kJobs = 2;

struct Workload {
  std::string name;
  std::shared_ptr<Scene> scene;
  glm::mat4 clip_from_world{1.0f};
  CullMode cull = CullMode::none;
  std::uint64_t triangles = 0;
};

float next_random(std::uint64_t& state) {
  state = state * 6364136223846793005ull + 1442695040888963407ull;
  return static_cast<float>(state >> 40) * 0x1p-24f;
}

/// 10,000 triangles of 177 pixels on average: equilateral, turned at random, uniform over the screen and in
/// depth.
Workload random_triangles() {
  Workload w;
  w.name = "random_10k_177px";
  w.scene = std::make_shared<Scene>();
  Mesh mesh;
  std::uint64_t state = 1;
  const float radius = std::sqrt(177.0f * 4.0f / (3.0f * std::sqrt(3.0f)));
  for (std::uint32_t i = 0; i < 10000; ++i) {
    const float x = next_random(state) * kWidth, y = next_random(state) * kHeight, z = next_random(state);
    const float angle = next_random(state) * 6.2831853f;
    for (int k = 0; k < 3; ++k) {
      const float a = angle + static_cast<float>(k) * 2.0943951f;
      const float px = x + radius * std::cos(a), py = y + radius * std::sin(a);
      mesh.positions.emplace_back(2.0f * px / kWidth - 1.0f, 1.0f - 2.0f * py / kHeight, z);
      mesh.normals.emplace_back(k == 0 ? 1.0f : 0.0f, k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f);
      mesh.indices.push_back(3 * i + static_cast<std::uint32_t>(k));
    }
  }
  mesh.bounds_min = glm::vec3(-1.1f, -1.1f, 0.0f);
  mesh.bounds_max = glm::vec3(1.1f, 1.1f, 1.0f);
  mesh.parts.push_back({0, static_cast<std::uint32_t>(mesh.indices.size()), 0});
  mesh.vertex_bytes = 24;
  w.triangles = 10000;
  w.scene->meshes.push_back(std::move(mesh));
  w.scene->instances.push_back({});
  w.scene->materials.emplace_back();
  w.scene->samplers.emplace_back();
  w.scene->cameras.emplace_back();
  return w;
}

Workload scene_workload(const std::string& source) {
  Workload w;
  w.name = source.substr(source.find_last_of('/') + 1);
  w.scene = std::make_shared<Scene>(*open_study({.scene = source, .resolution = {kWidth, kHeight}}).scene);
  const Camera& camera = w.scene->cameras.front();
  w.clip_from_world = clip_from_view(camera, static_cast<float>(kWidth) / kHeight) * camera.view_from_world;
  w.cull = CullMode::back;
  for (Material& m : w.scene->materials) m.double_sided = false;
  w.triangles = stats(*w.scene).drawn_triangles;
  return w;
}

FrameGraph make_graph(const Workload& w, int samples, bool gouraud) {
  FrameGraph graph(w.scene, kWidth, kHeight);
  const ImageId depth = graph.add_image({"depth", Format::d24_unorm_s8, kWidth, kHeight, samples});
  const ImageId color = graph.add_image({"color", Format::rgba8_unorm, kWidth, kHeight, samples});
  const ImageId output =
      samples > 1 ? graph.add_image({"output", Format::rgba8_unorm, kWidth, kHeight, 1}) : color;
  graph.add_clear("clear", {depth, color});
  Pass& pass = graph.add_pass("draw", PassKind::draw);
  pass.samples = samples;
  pass.depth = depth;
  pass.keep = true;
  DrawBatch batch;
  batch.state.depth = {true, true, Compare::less};
  batch.state.raster.cull = w.cull;
  batch.vertex = gouraud ? &gouraud_vertex_program() : &mesh_position_program();
  batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{w.clip_from_world});
  if (gouraud) {
    pass.color = {color};
    batch.fragment = &gouraud_program();
    batch.fragment_uniforms = std::make_shared<int>(0);
  }
  for (int i = 0; i < static_cast<int>(w.scene->instances.size()); ++i)
    for (int p = 0;
         p <
         static_cast<int>(
             w.scene->meshes[static_cast<std::size_t>(w.scene->instances[static_cast<std::size_t>(i)].mesh)]
                 .parts.size());
         ++p)
      batch.draws.push_back({i, p});
  pass.batches.push_back(std::move(batch));
  if (samples > 1) graph.add_resolve("resolve", color, output);
  graph.set_output(output);
  return graph;
}

/// Seconds of the clear and the draw, as llvmpipe is timed.
double emulate_seconds(const FrameGraph& graph, std::uint64_t& pixels, double& cpu_seconds) {
  EmulationOptions options;
  options.jobs = kJobs;
  GpuFeatures features;
  const Emulation e = emulate(graph, features, FunctionalConfig{}, options);
  pixels = 0;
  cpu_seconds = 0.0;
  double seconds = 0.0;
  for (std::size_t i = 0; i < e.trace.passes.size(); ++i) {
    if (e.trace.passes[i].kind == PassKind::resolve) continue;
    seconds += e.pass_wall_s[i];
    cpu_seconds += e.pass_cpu_s[i];
    pixels += total(e.trace.passes[i]).raster.fragments;
  }
  return seconds;
}

#ifdef HWSIM_HAVE_LLVMPIPE
std::vector<oracle::ClipMesh> to_clip_meshes(const Workload& w) {
  std::vector<oracle::ClipMesh> out;
  for (const Instance& instance : w.scene->instances) {
    const Mesh& mesh = w.scene->meshes[static_cast<std::size_t>(instance.mesh)];
    oracle::ClipMesh m;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      m.positions.push_back({mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z, 1.0f});
      m.colors.push_back({mesh.normals[v].x, mesh.normals[v].y, mesh.normals[v].z});
    }
    m.indices = mesh.indices;
    const glm::mat4 clip = w.clip_from_world * instance.world_from_local;
    std::memcpy(m.clip_from_position.data(), &clip[0][0], sizeof(clip));
    out.push_back(std::move(m));
  }
  return out;
}
#endif

void compare_rates(benchmark::State& state, const Workload& w, int samples, bool gouraud) {
  const FrameGraph graph = make_graph(w, samples, gouraud);
  std::uint64_t pixels = 0;
  // The best of all runs on both sides: what the machine can do when nothing else runs on it.
  double seconds = 1e30, cpu_seconds = 0.0;
  for (auto _ : state) {
    double cpu = 0.0;
    const double s = emulate_seconds(graph, pixels, cpu);
    state.SetIterationTime(s);
    if (s < seconds) cpu_seconds = cpu;
    seconds = std::min(seconds, s);
  }
  state.counters["cores_used"] = cpu_seconds / seconds;
  state.counters["cpu_ms"] = 1e3 * cpu_seconds;
  state.counters["Mtri_per_s"] = static_cast<double>(w.triangles) / seconds * 1e-6;
  if (gouraud) state.counters["Mpixel_per_s"] = static_cast<double>(pixels) / seconds * 1e-6;
#ifdef HWSIM_HAVE_LLVMPIPE
  static std::string why_not;
  static const std::unique_ptr<oracle::Llvmpipe> llvmpipe = oracle::Llvmpipe::create(why_not);
  if (llvmpipe == nullptr) return;
  oracle::RenderSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.samples = samples;
  settings.depth_test = oracle::DepthTest::less;
  settings.cull = w.cull == CullMode::back ? oracle::Cull::back : oracle::Cull::none;
  const auto kind = gouraud ? oracle::DrawKind::gouraud : oracle::DrawKind::depth_only;
  const auto meshes = to_clip_meshes(w);
  double best = 1e30;
  for (int i = 0; i < 10; ++i) best = std::min(best, llvmpipe->draw_seconds(settings, kind, meshes));
  state.counters["llvmpipe_Mtri_per_s"] = static_cast<double>(w.triangles) / best * 1e-6;
  state.counters["times_llvmpipe"] = best / seconds;
#endif
}

void add(const std::shared_ptr<Workload>& w) {
  for (const bool gouraud : {false, true})
    for (const int samples : {1, 4, 8})
      benchmark::RegisterBenchmark(
          (w->name + (gouraud ? "/gouraud/" : "/depth/") + std::to_string(samples) + "x").c_str(),
          [w, samples, gouraud](benchmark::State& s) { compare_rates(s, *w, samples, gouraud); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace hwsim::benchmarks

/// Arguments that do not begin with a dash are scenes: files or generator names. Without any: the dragon
/// generator.
int main(int argc, char** argv) {
  using namespace hwsim::benchmarks;
  add(std::make_shared<Workload>(random_triangles()));
  bool any = false;
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] == '-') continue;
    add(std::make_shared<Workload>(scene_workload(argv[i])));
    any = true;
  }
  if (!any) add(std::make_shared<Workload>(scene_workload("dragon")));
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
