#pragma once
// What the command line says, as plain data. Filled by arguments.cpp, the only file that knows CLI11.
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "lab/request/request.h"
#include "lab/results/run_directory.h"

namespace hwsim::cli {
using namespace lab;  // the program is the lab's front

enum class When { automatic, always, never };
enum class Format { table, csv, json, md };

/// `--format csv` (standard output) or `--format csv=passes.csv`.
struct FormatRequest {
  Format format = Format::table;
  std::string file;  ///< empty: standard output
};

/// Flags of every command.
struct CommonOptions {
  std::vector<FormatRequest> formats;  ///< empty: a table on standard output
  int verbosity = 0;                   ///< -1 quiet, 1 verbose
  When color = When::automatic;
  When progress = When::automatic;
  int jobs = 1;
};

/// What is drawn, before any technique.
struct ViewOptions {
  std::string scene;
  std::optional<Resolution> resolution;
  std::optional<std::string> camera;  ///< a name or an index
  std::optional<int> point_lights;
  std::optional<double> exposure;
  std::optional<std::string> reference_shadows;
  bool no_shadows = false;
  std::vector<std::string> sets;  ///< "path=value"
};

struct RunOptions {
  CommonOptions common;
  ViewOptions view;
  OutPlace out;
  std::vector<std::string> techniques, gpus, overlays;
  std::optional<std::string> engine;
  std::optional<int> reference_samples;
  bool no_image = false;
  bool no_cache = false;
};

/// One scene's results side by side, or results of earlier runs.
struct CompareOptions : RunOptions {
  std::vector<std::string> inputs;  ///< a scene, or folders of results
  std::vector<std::string> what_ifs, vary;
  bool zip = false;
  bool counters = false;
};

/// Why a frame takes its time.
struct ExplainOptions : RunOptions {
  bool all = false;  ///< parameters without influence too
};

/// Techniques under a budget.
struct RankOptions : RunOptions {
  std::string budget;  ///< "aa_ms<=1.5, extra_mib<=192"
};

/// Many points in a database.
struct SweepOptions : RunOptions {
  std::vector<std::string> vary;
  bool zip = false;
  std::optional<std::string> sample;  ///< "lhs:64"
  std::uint64_t seed = 1;
  std::string database = "sweep.sqlite";
  bool resume = false;
  bool dry_run = false;
  std::optional<std::string> shard;  ///< "1/4"
  std::vector<std::string> merge;
};

struct ReferenceOptions {
  CommonOptions common;
  ViewOptions view;
  OutPlace out;
  int samples = 64;
};

struct ListOptions {
  CommonOptions common;
  std::string what;
};

struct ShowOptions {
  CommonOptions common;
  std::string name;
  bool origin = false;
  std::vector<std::string> overlays, sets;
};

struct SceneCheckOptions {
  CommonOptions common;
  std::vector<std::string> scenes;
};

struct ConfigOptions {
  enum class Action { check, show, schema, diff };
  CommonOptions common;
  Action action = Action::check;
  std::vector<std::string> names;
  bool origin = false;
  std::vector<std::string> overlays, sets;
};

struct DoctorOptions {
  CommonOptions common;
};

struct HelpOptions {
  CommonOptions common;
  std::string topic;
};

struct CacheOptions {
  CommonOptions common;
  bool prune = false;
  bool all = false;
  int older_than_days = 30;
  std::optional<std::uint32_t>
      keep_mib;  ///< instead of the age: the least recently used go until so much is left
  bool dry_run = false;
};

/// `fit` and `validate`.
struct FitOptions {
  CommonOptions common;
  OutPlace out;                     ///< fit: the folder of calibrated GPUs
  std::vector<std::string> papers;  ///< empty: all
  int starts = 10;
  bool dry_run = false;
};
struct ValidateOptions : FitOptions {};

struct ReproduceOptions {
  CommonOptions common;
  std::string paper;
  std::string out;  ///< folder for the pictures; empty: none
  bool dry_run = false;
};

struct CompletionOptions {
  CommonOptions common;
  std::string shell;
};

/// Text to print and nothing to do: --help and --version.
struct PrintText {
  std::string text;
};

using Command =
    std::variant<PrintText, RunOptions, ExplainOptions, RankOptions, CompareOptions, SweepOptions,
                 ReferenceOptions, ListOptions, ShowOptions, SceneCheckOptions, ConfigOptions, DoctorOptions,
                 HelpOptions, CacheOptions, FitOptions, ValidateOptions, ReproduceOptions, CompletionOptions>;

}  // namespace hwsim::cli
