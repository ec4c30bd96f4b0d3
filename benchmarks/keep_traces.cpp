// Writes what the accuracy test reads: published.traces, the work of every run that a published row stands
// for, and fold_optima.csv, where each fit of a validation ends. Emulates what the cache does not have;
// minutes.
//   keep_traces [FOLDER] [--scenes=SCENES] [--jobs=N]
// With SCENES, a folder of scene files, also configs/external/work.traces, the work of the frames that
// `hwsim validate --external` is about; without FOLDER that alone. Before it writes, it checks that
// predictions from the file are those from the traces, bit by bit.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "algos/source_digest.h"
#include "cost_models/accuracy.h"
#include "cost_models/fold_optima.h"
#include "cost_models/kept_traces.h"
#include "cost_models/predictor.h"
#include "hwsim/base/byte_codec.h"
#include "lab/environment.h"
#include "lab/studies/external.h"
#include "lab/studies/published_runs.h"

namespace hwsim::benchmarks {
namespace {

namespace fs = std::filesystem;
using cost_models::Experiment;
using cost_models::KeptTraces;

/// Prints what is being emulated.
class Printer : public lab::Observer {
 public:
  void progress(double done_ratio, const std::string& what) override {
    std::printf("%3.0f %% %s\n", 100.0 * done_ratio, what.c_str());
    std::fflush(stdout);
  }
};

void write(const fs::path& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary);
  out << bytes;
  if (!out.flush()) throw std::runtime_error("`" + path.string() + "` cannot be written");
  std::printf("%s: %.2f MB\n", path.c_str(), 1e-6 * static_cast<double>(bytes.size()));
}

bool same_predictions(const Experiment& a, const Experiment& b, int jobs) {
  cost_models::Predictor of_a(a, jobs), of_b(b, jobs);
  of_a.evaluate(of_a.start(), true);
  of_b.evaluate(of_b.start(), true);
  for (std::size_t i = 0; i < a.cells.size(); ++i)
    if (of_a[i].ms != of_b[i].ms || of_a[i].gradient != of_b[i].gradient) return false;
  return a.cells.size() == b.cells.size() && a.not_run.size() == b.not_run.size();
}

int keep(const fs::path& folder, int jobs) {
  Printer printer;
  const lab::LabOptions from_environment = lab::options_of_environment();
  const lab::ConfigFolder configs(from_environment.config_folder);
  const lab::Cache cache(from_environment.cache_folder, from_environment.cache_limit_bytes);
  KeptTraces kept;
  kept.sources = algos::source_digest();
  const Experiment emulated = lab::load_experiment(
      lab::published_cells({}, configs),
      cost_models::keeping(lab::emulated_traces(jobs, cache, printer), kept), configs, printer);
  const std::vector<std::uint8_t> bytes = cost_models::encode_kept(kept);
  const Experiment read =
      lab::load_experiment(lab::published_cells({}, configs),
                           cost_models::source_of(cost_models::decode_kept(bytes)), configs, printer);
  if (!same_predictions(emulated, read, jobs)) {
    std::fprintf(stderr, "predictions from the file differ from those of the traces: nothing was written\n");
    return 1;
  }
  cost_models::FitOptions options;
  options.jobs = jobs;
  const auto progress = [&](std::size_t done, std::size_t all, const std::string& what) {
    printer.progress(static_cast<double>(done) / static_cast<double>(all), what);
  };
  const cost_models::Validation first = cost_models::validate(read, options, progress);
  // A fold whose fit stopped too early goes on from there.
  const cost_models::Validation validation = cost_models::validate(read, options, progress, first.optima);
  write(folder / "published.traces", std::string(bytes.begin(), bytes.end()));
  write(folder / "fold_optima.csv", cost_models::to_csv(validation.optima, read.parameters));
  for (const cost_models::Statement& s :
       cost_models::load_statements(configs.calibration() + "/accuracy.csv"))
    if (s.papers == "all")
      std::printf("%s of %s: %.4g, stated %g to %g\n", s.figure.c_str(), s.split.c_str(),
                  cost_models::measured(s, validation), s.low, s.high);
  return 0;
}

int keep_external(const std::string& scenes, int jobs) {
  Printer printer;
  lab::LabOptions options = lab::options_of_environment();
  options.jobs = jobs;
  lab::Session session(options, printer);
  KeptTraces kept;
  kept.sources = algos::source_digest();
  lab::validate_external(cost_models::keeping(lab::external_traces(scenes, session), kept), session);
  const std::vector<std::uint8_t> bytes = cost_models::encode_kept(kept);
  write(fs::path(session.files().folder().external()) / "work.traces",
        std::string(bytes.begin(), bytes.end()));
  return 0;
}

}  // namespace
}  // namespace hwsim::benchmarks

int main(int argc, char** argv) try {
  int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const char* folder = nullptr;
  std::string scenes;
  constexpr std::string_view kScenes = "--scenes=";
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]).starts_with(kScenes))
      scenes = argv[i] + kScenes.size();
    else if (std::sscanf(argv[i], "--jobs=%d", &jobs) != 1)
      folder = argv[i];
  }
  if ((folder == nullptr && scenes.empty()) || jobs < 1) {
    std::fprintf(stderr, "usage: keep_traces [FOLDER] [--scenes=SCENES] [--jobs=N]\n");
    return 2;
  }
  const int status = folder == nullptr ? 0 : hwsim::benchmarks::keep(folder, jobs);
  return status != 0 || scenes.empty() ? status : hwsim::benchmarks::keep_external(scenes, jobs);
} catch (const std::exception& error) {
  std::fprintf(stderr, "keep_traces: %s\n", error.what());
  return 1;
}
