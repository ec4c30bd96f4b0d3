// Run time against error of the timing engines: every scene x technique x GPU by roofline, queue and samples
// of the event-driven engine, against that engine on the whole passes; the gain of each skip of the emulator,
// and what replays cost.
//   engine_study OUT_DIR [WIDTHxHEIGHT [SCENE,... [TECHNIQUE,...]]]
// writes OUT_DIR/engines.csv, engines.md and costs.md; scripts/plots.py draws the first.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "hwsim/engines/timing.h"
#include "lab/store/trace_store.h"
#include "pipeline/emulate/emulator.h"
#include "study_input.h"
#include "study_report.h"

namespace hwsim::benchmarks {
namespace {

constexpr const char* kScenes =
    "sponza_hall,grass,powerplant,dragon,wires,text_page,old_city,foliage,car_body,fur_ball,bamboo,metal,"
    "grill";
constexpr const char* kTechniques =
    "none,ssaa4x,msaa4x,msaa8x,msaa16x,deferred,deferred_simple_complex,sbaa_top,sbaa_merge,agaa,sss_gs,sss_"
    "cs,"
    "sss_ppll,wire_aa+msaa4x,fxaa,axaa,smaa,cmaa,mlaa";
constexpr const char* kGpus[] = {"gtx470", "hd5870", "gtx980", "hd4600", "mali_g78mp20"};
constexpr double kSamples[] = {0.3, 0.1, 0.03};

struct Options {
  std::string out;
  int width = 320, height = 180;
  std::vector<std::string> scenes, techniques;

  lab::View view(const std::string& scene) const { return {.scene = scene, .resolution = {width, height}}; }
};

double milliseconds_since(std::chrono::steady_clock::time_point start) { return 1e3 * seconds_since(start); }

/// A scene's traces, kept where `hwsim run` keeps them. Work does not depend on what the engines vary, so all
/// GPUs get the trace of one whose features every technique can use.
class SceneTraces {
 public:
  SceneTraces(lab::View view, GpuConfig gpu)
      : scene_(std::move(view), cache_, silent_), gpu_(std::move(gpu)) {}

  WorkTrace of(const std::string& technique) {
    return store_.frame(scene_, algos::parse_technique(technique), gpu_, {}, nullptr).emulation->trace;
  }

 private:
  lab::Cache cache_ = study_cache();
  lab::Observer silent_;
  lab::SceneView scene_;
  GpuConfig gpu_;
  lab::TraceStore store_{{.jobs = 2, .disk = true}, cache_, silent_};
};

/// The shortest of a few runs, for engines that take less than a millisecond.
StudyRow time_row(const WorkTrace& trace, const GpuConfig& gpu, Engine engine, double sample, int runs) {
  StudyRow row;
  row.engine = std::string(engine_name(engine));
  if (engine == Engine::detailed && sample < 1.0) row.engine += " " + std::to_string(sample).substr(0, 4);
  row.wall_ms = 1e30;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    TimingOptions options;
    options.detailed_sample_ratio = sample;
    const FrameTiming timing = time_frame(trace, gpu, engine, options);
    row.wall_ms = std::min(row.wall_ms, milliseconds_since(start));
    row.time_ms = timing.time_ns * 1e-6;
    row.overhead_ms = 0.0;
    for (const PassTiming& pass : timing.passes) row.overhead_ms += pass.overhead_ns * 1e-6;
    row.dram_mb = (timing.dram_bytes.total_read() + timing.dram_bytes.total_write()) * 1e-6;
  }
  return row;
}

double error_pct(double value, double truth) { return truth > 0.0 ? 100.0 * (value / truth - 1.0) : 0.0; }

double fragments_of(const WorkTrace& trace) {
  const PassCounters all = total(trace);
  return static_cast<double>(all.stats.fragment_shader_invocations + all.stats.compute_shader_invocations);
}

std::vector<StudyRow> time_point(const WorkTrace& trace, const std::string& scene,
                                 const std::string& technique, const GpuConfig& gpu) {
  std::vector<StudyRow> point = {time_row(trace, gpu, Engine::detailed, 1.0, 1),
                                 time_row(trace, gpu, Engine::roofline, 1.0, 5),
                                 time_row(trace, gpu, Engine::queue, 1.0, 5)};
  for (const double sample : kSamples) point.push_back(time_row(trace, gpu, Engine::detailed, sample, 1));
  const StudyRow whole = point.front();
  for (StudyRow& row : point) {
    row.scene = scene;
    row.technique = technique;
    row.gpu = gpu.id;
    row.time_error_pct = error_pct(row.time_ms - row.overhead_ms, whole.time_ms - whole.overhead_ms);
    row.byte_error_pct = error_pct(row.dram_mb, whole.dram_mb);
    row.times_as_fast = whole.wall_ms / row.wall_ms;
    row.fragments = fragments_of(trace);
  }
  return point;
}

/// All GPUs, two at a time: run times are those of a machine with both threads at work.
void time_trace(const WorkTrace& trace, const std::string& scene, const std::string& technique,
                const std::vector<GpuConfig>& gpus, std::vector<StudyRow>& rows) {
  std::vector<std::vector<StudyRow>> points(gpus.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i; (i = next++) < gpus.size();) points[i] = time_point(trace, scene, technique, gpus[i]);
  };
  std::thread other(work);
  work();
  other.join();
  for (const std::vector<StudyRow>& point : points) rows.insert(rows.end(), point.begin(), point.end());
}

double emulation_ms(const pipeline::FrameGraph& graph, const GpuConfig& gpu,
                    const pipeline::EmulationOptions& options) {
  double best = 1e30;
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    pipeline::emulate(graph, gpu.features, gpu.functional, options);
    best = std::min(best, milliseconds_since(start));
  }
  return best;
}

/// Emulation with each skip off, with all off, and with exact reuse distances, against all skips on.
void study_skips(const Options& o, std::ostream& out) {
  const GpuConfig gpu = study_gpu("gtx980");
  const pipeline::FrameGraph graph = study_frame(open_study(o.view(o.scenes.front())), "msaa4x", gpu);
  pipeline::EmulationOptions options;
  const double base = emulation_ms(graph, gpu, options);
  out << "| emulation of " << o.scenes.front() << " msaa4x, " << o.width << "x" << o.height
      << " | ms, one thread | / all skips on |\n|---|---|---|\n| all skips on | " << base << " | 1 |\n";
  const auto report = [&](std::string_view name, const pipeline::EmulationOptions& changed) {
    const double ms = emulation_ms(graph, gpu, changed);
    out << "| " << name << " | " << ms << " | " << ms / base << " |\n";
  };
  pipeline::EmulationOptions none = options;
  for (const pipeline::SkipInfo& s : pipeline::kSkips) {
    pipeline::EmulationOptions changed = options;
    changed.skip.*s.flag = none.skip.*s.flag = false;
    report("without " + std::string(s.name), changed);
  }
  report("without any", none);
  options.exact_reuse = true;
  report("reuse distances of all blocks", options);
}

/// What replays of a cached trace cost.
void study_replays(const WorkTrace& trace, std::ostream& out) {
  constexpr int kConfigs = 1000;
  GpuConfig gpu = study_gpu("gtx980");
  for (const Engine engine : {Engine::roofline, Engine::queue}) {
    const auto start = std::chrono::steady_clock::now();
    double sum = 0.0;
    for (int i = 0; i < kConfigs; ++i) {
      gpu.l2_size_kib = 256.0 + i;
      sum += time_frame(trace, gpu, engine).time_ns;
    }
    const double seconds = milliseconds_since(start) * 1e-3;
    out << "\n1000 configurations by " << engine_name(engine) << ": " << seconds << " s, " << seconds
        << " ms a frame (mean frame " << sum / kConfigs * 1e-6 << " ms)\n";
  }
  const auto start = std::chrono::steady_clock::now();
  time_frame(trace, gpu, Engine::detailed);
  out << "\ndetailed: " << fragments_of(trace) / milliseconds_since(start) << " thousand fragments a second ("
      << fragments_of(trace) << " fragments)\n";
}

template <class Write>
void save(const std::string& path, const Write& write) {
  std::ofstream out(path);
  write(out);
}

int run(const Options& o) {
  std::filesystem::create_directories(o.out);
  const GpuConfig features = study_gpu("gtx980");
  std::vector<GpuConfig> gpus;
  for (const char* id : kGpus) gpus.push_back(study_gpu(id));
  std::vector<StudyRow> rows;
  for (const std::string& scene : o.scenes) {
    SceneTraces traces(o.view(scene), features);
    for (const std::string& technique : o.techniques) {
      const WorkTrace trace = traces.of(technique);
      time_trace(trace, scene, technique, gpus, rows);
      std::fprintf(stderr, "%s %s\n", scene.c_str(), technique.c_str());
      save(o.out + "/engines.csv", [&](std::ostream& out) { write_csv(rows, out); });
    }
  }
  save(o.out + "/engines.md", [&](std::ostream& out) { write_table(rows, out); });
  save(o.out + "/costs.md", [&](std::ostream& out) {
    study_skips(o, out);
    study_replays(SceneTraces(o.view(o.scenes.front()), features).of("msaa8x"), out);
  });
  for (const char* part : {"/engines.md", "/costs.md"})
    std::printf("%s\n", (std::ostringstream() << std::ifstream(o.out + part).rdbuf()).str().c_str());
  return 0;
}

}  // namespace
}  // namespace hwsim::benchmarks

int main(int argc, char** argv) try {
  hwsim::benchmarks::Options o;
  o.scenes = hwsim::benchmarks::split_list(argc > 3 ? argv[3] : hwsim::benchmarks::kScenes);
  o.techniques = hwsim::benchmarks::split_list(argc > 4 ? argv[4] : hwsim::benchmarks::kTechniques);
  if (argc < 2 || (argc > 2 && std::sscanf(argv[2], "%dx%d", &o.width, &o.height) != 2)) {
    std::fprintf(stderr, "usage: engine_study OUT_DIR [WIDTHxHEIGHT [SCENE,... [TECHNIQUE,...]]]\n");
    return 2;
  }
  o.out = argv[1];
  return hwsim::benchmarks::run(o);
} catch (const hwsim::InputError& error) {
  return hwsim::benchmarks::report(error);
}
