#pragma once
// What the command line says, as plain data. Filled by arguments.cpp, the only file that knows CLI11.
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "lab/catalog/data_sheet.h"
#include "lab/request/request.h"
#include "lab/results/run_directory.h"
#include "lab/studies/optimize.h"

namespace hwsim::cli {
using namespace lab;  // the program is the lab's front

enum class When { automatic, always, never };
enum class OutputFormat { table, csv, json, md };

/// `--format csv` (standard output) or `--format csv=passes.csv`.
struct FormatRequest {
  OutputFormat format = OutputFormat::table;
  std::string file;  ///< empty: standard output
};

/// Flags of every command.
struct CommonArguments {
  std::vector<FormatRequest> formats;  ///< empty: a table on standard output
  bool force = false;                  ///< files of `formats` that exist are replaced
  int verbosity = 0;                   ///< -1 quiet, 1 verbose
  When color = When::automatic;
  When progress = When::automatic;
  int jobs = 1;
};

/// What is drawn, before any technique.
struct ViewArguments {
  std::string scene;
  std::optional<Resolution> resolution;
  std::optional<std::string> camera;  ///< a name or an index
  std::string camera_eye, camera_target,
      camera_fov;  ///< a camera that the scene does not hold; empty: none
  std::optional<int> point_lights;
  std::optional<int> anisotropy;
  std::optional<double> exposure;
  std::optional<std::string> reference_shadows;
  bool no_shadows = false;
  std::vector<std::string> sets;  ///< "path=value"
};

struct RunArguments {
  CommonArguments common;
  ViewArguments view;
  OutPlace out;
  std::vector<std::string> techniques, gpus, overlays;
  std::optional<std::string> engine;
  std::optional<int> reference_samples;
  bool no_image = false;
  bool no_cache = false;
  std::string report;  ///< file of an HTML page; empty: none
};

/// One scene's results side by side, or results of earlier runs.
struct CompareArguments : RunArguments {
  std::vector<std::string> inputs;  ///< a scene, or folders of results
  std::vector<std::string> what_ifs, vary;
  bool zip = false;
  bool counters = false;
  bool all = false;  ///< passes that do not change, too
};

/// Why a frame takes its time.
struct ExplainArguments : RunArguments {
  bool all = false;  ///< parameters without influence too
};

/// Techniques under a budget.
struct RankArguments : RunArguments {
  std::string budget;  ///< "aa_ms<=1.5, extra_mib<=192"
  std::string metric = "flip";
  bool edges = false;
  std::vector<std::string> vary;  ///< views
  bool zip = false;
};

/// Many points in a database.
struct SweepArguments : RunArguments {
  std::vector<std::string> vary;
  bool zip = false;
  std::optional<std::string> sample;  ///< "lhs:64"
  std::uint64_t seed = 1;
  std::string database = "sweep.sqlite";
  bool resume = false;
  bool dry_run = false;
  bool alone = false;
  std::string plan;                  ///< file of the plan; empty: none
  bool emulate_only = false;         ///< frames into the cache, no points
  bool rows = false;                 ///< every point in text, too, not what they show together
  std::optional<std::string> shard;  ///< "1/4"
  std::vector<std::string> merge;
};

/// The cheapest or the fastest GPU for some frames.
struct OptimizeArguments : RunArguments {
  std::vector<std::string> vary;  ///< views
  bool zip = false;
  std::string prices;  ///< a TOML file
  OptimizeGoal goal;
};

/// What was written by others of these, as one HTML page.
struct ReportArguments {
  CommonArguments common;
  std::vector<std::string> inputs;
  std::string file = "report.html";
  bool force = false;
};

struct ReferenceArguments {
  CommonArguments common;
  ViewArguments view;
  OutPlace out;
  int samples = 64;
};

struct ListArguments {
  CommonArguments common;
  std::string what;
};

struct ShowArguments {
  CommonArguments common;
  std::vector<std::string> words;  ///< NAME, or TYPE NAME
  bool origin = false;
  std::vector<std::string> overlays, sets;
};

struct SceneCheckArguments {
  CommonArguments common;
  std::vector<std::string> scenes;
};

struct ConfigArguments {
  enum class Action { check, show, schema, diff };
  CommonArguments common;
  Action action = Action::check;
  std::vector<std::string> names;
  bool origin = false;
  std::vector<std::string> overlays, sets;
};

/// A GPU file from the numbers of a data sheet.
struct GpuNewArguments {
  CommonArguments common;
  DataSheet sheet;
  std::string like, out;
  std::string l2, llc;  ///< sizes as written: "36M"
  bool force = false;
};

struct DoctorArguments {
  CommonArguments common;
};

struct HelpArguments {
  CommonArguments common;
  std::string topic;
};

struct CacheArguments {
  CommonArguments common;
  bool prune = false;
  bool all = false;
  int older_than_days = 30;
  std::optional<std::uint32_t>
      keep_mib;  ///< instead of the age: the least recently used go until so much is left
  bool dry_run = false;
};

/// `fit` and `validate`.
struct FitArguments {
  CommonArguments common;
  OutPlace out;                     ///< fit: the folder of calibrated GPUs
  std::vector<std::string> papers;  ///< empty: all
  int starts = 10;
  bool dry_run = false;
};
struct ValidateArguments : FitArguments {
  bool external = false;
  std::string scenes;  ///< folder of scene files; empty: kept work
};

struct ReproduceArguments {
  CommonArguments common;
  std::string paper;
  std::string report;  ///< file of an HTML page; empty: none
  bool dry_run = false;
};

struct CompletionArguments {
  CommonArguments common;
  std::string shell;
};

/// Text to print and nothing to do: --help and --version.
struct PrintText {
  std::string text;
};

using Command =
    std::variant<PrintText, RunArguments, ExplainArguments, RankArguments, CompareArguments, SweepArguments,
                 OptimizeArguments, ReportArguments, ReferenceArguments, ListArguments, ShowArguments,
                 SceneCheckArguments, ConfigArguments, DoctorArguments, HelpArguments, CacheArguments,
                 FitArguments, ValidateArguments, ReproduceArguments, CompletionArguments, GpuNewArguments>;

}  // namespace hwsim::cli
