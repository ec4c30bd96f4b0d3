// Whole frames: emulation and prediction of each technique on each scene, with every skip and with none, in
// one run.
//   frame_benchmark [--size=WIDTHxHEIGHT] [--jobs=N] [--runs=N] [--scenes=A,B] [--techniques=A,B] [--skips]
// prints a table: seconds (best of the runs), fragments a second, gain of all skips (with --skips also of
// each: time without it / time with it), peak memory.
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>

#include "hwsim/engines/timing.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/image/metrics.h"
#include "study_input.h"

namespace hwsim::benchmarks {
namespace {

struct Options {
  int width_px = 1280, height_px = 720, jobs = 2, runs = 3;
  bool each_skip = false;
  std::string scenes = "sponza_hall,dragon,metal,old_city,grass,powerplant,car_body,fur_ball,foliage,bamboo";
  std::string techniques =
      "none,msaa8x,csaa,eqaa,ssaa16x,deferred_simple_complex,sbaa_top,sbaa_merge,agaa,sss_gs,sss_cs,sss_ppll,"
      "wire_aa+msaa4x,fxaa,axaa,smaa,cmaa,mlaa";
};

constexpr std::size_t kSkipCount = pipeline::kSkips.size();

struct Row {
  double seconds = 1e30, queue_ms = 1e30;
  double fragments = 0.0;
  std::array<double, kSkipCount + 1> seconds_without;  ///< each skip, and all of them
};

/// The documented GTX 980 with every feature that a technique may ask for, as `queue` times it.
GpuConfig every_gpu() { return study_gpu("gtx980", {"coverage-samples"}); }

/// The options without one skip, or without all of them.
pipeline::EmulationOptions without(std::size_t skip, int jobs) {
  pipeline::EmulationOptions options;
  options.jobs = jobs;
  for (std::size_t i = 0; i < kSkipCount; ++i)
    if (skip == i || skip == kSkipCount) options.skip.*pipeline::kSkips[i].flag = false;
  return options;
}

/// The best of the runs, which alternate, so that whatever else the machine does meets all of them.
Row measure(const pipeline::FrameGraph& graph, const GpuConfig& gpu, const Options& o) {
  Row row;
  row.seconds_without.fill(1e30);
  const auto emulate = [&](const pipeline::EmulationOptions& options, double& best) {
    const auto start = std::chrono::steady_clock::now();
    pipeline::Emulation emulation = pipeline::emulate(graph, gpu.features, gpu.functional, options);
    best = std::min(best, seconds_since(start));
    return std::move(emulation.trace);
  };
  pipeline::EmulationOptions options;
  options.jobs = o.jobs;
  for (int i = 0; i < o.runs; ++i) {
    const WorkTrace trace = emulate(options, row.seconds);
    const auto start = std::chrono::steady_clock::now();
    time_frame(trace, gpu, Engine::queue);
    row.queue_ms = std::min(row.queue_ms, 1e3 * seconds_since(start));
    const PassCounters all = total(trace);
    row.fragments =
        static_cast<double>(all.stats.fragment_shader_invocations + all.stats.compute_shader_invocations);
    for (std::size_t skip = o.each_skip ? 0 : kSkipCount; skip <= kSkipCount; ++skip)
      emulate(without(skip, o.jobs), row.seconds_without[skip]);
  }
  return row;
}

void print_head(const Options& o) {
  std::string head = "| scene | technique | s a frame | `queue` ms | Mfragments/s | all skips |";
  std::string line = "|---|---|---|---|---|---|";
  for (std::size_t i = 0; o.each_skip && i < kSkipCount; ++i) {
    head += " " + std::string(pipeline::kSkips[i].name) + " |";
    line += "---|";
  }
  std::printf("%s\n%s\n", head.c_str(), line.c_str());
}

void print(const Row& row, const std::string& scene, const std::string& technique, const Options& o) {
  std::printf("| %s | %s | %.3f | %.2f | %.2f | %.2f |", scene.c_str(), technique.c_str(), row.seconds,
              row.queue_ms, row.fragments / row.seconds * 1e-6,
              row.seconds_without[kSkipCount] / row.seconds);
  for (std::size_t i = 0; o.each_skip && i < kSkipCount; ++i)
    std::printf(" %.2f |", row.seconds_without[i] / row.seconds);
  std::printf("\n");
  std::fflush(stdout);
}

/// Two images of a frame's size compared (PSNR, SSIM, FLIP), beside emulating the frame by `none` on one
/// thread.
void print_comparison(const std::string& scene_name, const GpuConfig& gpu, const Options& o) {
  const pipeline::FrameGraph graph =
      study_frame(open_study({.scene = scene_name, .resolution = {o.width_px, o.height_px}}), "none", gpu);
  double frame_s = 1e30, compare_s = 1e30;
  for (int i = 0; i < o.runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const pipeline::Emulation emulation = pipeline::emulate(graph, gpu.features, gpu.functional, {});
    frame_s = std::min(frame_s, seconds_since(start));
    pipeline::Image other = emulation.color;
    for (auto& pixel : other.pixels) pixel = pixel * 0.9f;
    const auto compared = std::chrono::steady_clock::now();
    pipeline::compare(other, emulation.color);
    compare_s = std::min(compare_s, seconds_since(compared));
  }
  std::printf("\ncomparing two images: %.2f s, %.2f times `none` of %s on one thread\n", compare_s,
              compare_s / frame_s, scene_name.c_str());
}

double peak_gib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / (1024.0 * 1024.0);
}

int run(const Options& o) {
  print_head(o);
  const GpuConfig gpu = every_gpu();
  for (const std::string& name : split_list(o.scenes)) {
    const algos::FrameRequest request = open_study({.scene = name, .resolution = {o.width_px, o.height_px}});
    for (const std::string& technique : split_list(o.techniques))
      print(measure(study_frame(request, technique, gpu), gpu, o), name, technique, o);
  }
  print_comparison(split_list(o.scenes).front(), gpu, o);
  std::printf("\npeak memory of the process: %.2f GiB; %d threads, %dx%d, best of %d\n", peak_gib(), o.jobs,
              o.width_px, o.height_px, o.runs);
  return 0;
}

bool parse(const char* argument, Options& o) {
  const auto text = [&](const char* name, std::string& value) {
    const std::size_t length = std::strlen(name);
    if (std::strncmp(argument, name, length) != 0) return false;
    value = argument + length;
    return true;
  };
  if (std::strcmp(argument, "--skips") == 0) return o.each_skip = true;
  return text("--scenes=", o.scenes) || text("--techniques=", o.techniques) ||
         std::sscanf(argument, "--size=%dx%d", &o.width_px, &o.height_px) == 2 ||
         std::sscanf(argument, "--jobs=%d", &o.jobs) == 1 || std::sscanf(argument, "--runs=%d", &o.runs) == 1;
}

}  // namespace
}  // namespace hwsim::benchmarks

int main(int argc, char** argv) try {
  hwsim::benchmarks::Options o;
  for (int i = 1; i < argc; ++i)
    if (!hwsim::benchmarks::parse(argv[i], o)) {
      std::fprintf(stderr,
                   "usage: frame_benchmark [--size=WIDTHxHEIGHT] [--jobs=N] [--runs=N] [--scenes=A,B] "
                   "[--techniques=A,B] [--skips]\n");
      return 2;
    }
  return hwsim::benchmarks::run(o);
} catch (const hwsim::InputError& error) {
  return hwsim::benchmarks::report(error);
}
