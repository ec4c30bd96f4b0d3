#pragma once
// The papers' tables (configs/published/*.csv) and what hwsim makes of each row: a cell of the fit, a number
// that is only compared, or a row left out with its reason. Which run stands for a row is data too
// (configs/published/mapping/*.csv).
#include <string>
#include <string_view>
#include <vector>

namespace hwsim::cost_models {

/// A row as printed. The columns are those of configs/published/README.md.
struct PublishedRow {
  std::string table;  ///< the file, without ".csv"
  int line = 0;       ///< line of the file
  std::string document, gpu, resolution, scene, view, technique, msaa, surfaces, lighting, pass, quantity;
  std::string printed;  ///< the value, digits kept
  double value = 0.0;   ///< the text as a number; 0 where it is none
  std::string note;
  std::string id() const;  ///< "agaa_table1:12"
};

/// A run that stands for rows: everything that a work trace depends on. What its settings mean is known to
/// whoever makes the trace.
struct RunSpec {
  std::string scene;  ///< "sponza_hall", or a generator with parameters
  std::string camera;
  std::string technique;  ///< "sbaa_top:n=2,msaa=8"
  std::string gpu;
  int width_px = 0, height_px = 0;
  std::string settings;  ///< "scene.lights=simple scene.shadows=false": as `--set` takes them
  std::string unlit;     ///< those of the same run without its added lights; empty where it has none
  std::string to_string() const;
  friend auto operator<=>(const RunSpec&, const RunSpec&) = default;
};

/// "sbaa_top" from "sbaa_top:n=2,msaa=8": what the registry calls it.
std::string technique_id(std::string_view technique);

/// The run without its added lights; `unlit` must not be empty.
RunSpec without_lights(const RunSpec& run);

/// What is done with a row.
enum class RowUse {
  fitted,    ///< a time that the fit and the error figures use
  checked,   ///< another renderer's time: predicted and compared, never fitted
  derived,   ///< follows from fitted rows (a sum, a ratio, printed twice): predicted and shown only
  count,     ///< shaded samples or memory: compared with the run's own counts
  excluded,  ///< contradicted by its own paper, or not a number
  claim      ///< a sentence of the text, not a measurement
};
std::string_view row_use_name(RowUse use);

/// A row with the run that stands for it.
struct Cell {
  PublishedRow row;
  RowUse use = RowUse::claim;
  std::string reason;      ///< why it is not fitted; empty for fitted rows
  double published = 0.0;  ///< in `unit`: percentages are made absolute with the row that they refer to
  std::string unit;        ///< ms, samples, mib
  RunSpec run;             ///< meaningful where has_run
  bool has_run = false;
  std::string scene_group;  ///< what shares a scene's load: the stand-in, all its views and lights
  std::string passes;  ///< trace passes that count: names and "prefix*", "!name" takes away, blanks between
  double present_us = 0.0;  ///< what the row's frame contains beside them
  double repeat = 1.0;      ///< times that the paper's program ran these passes for one frame
  double rate = 1.0;        ///< samples a pixel of the row, for rate extrapolation
};

/// Rows of every table, in the order of files and lines. Throws InputError for damaged files, and M010 for
/// values, resolutions and rates that are no numbers in their range ("NA" is read as 0), quantities that are
/// not known, and units that are not the quantity's.
std::vector<PublishedRow> load_published(const std::string& published_dir);

/// Uses and runs of all rows. Throws InputError M001 for mapping rules that match no row, M002 for a time
/// that no rule maps to a run or that has no value, and M010 for numbers of the mapping outside of their
/// range.
std::vector<Cell> map_rows(const std::vector<PublishedRow>& rows, const std::string& published_dir);

/// Whether a pass of a trace is one of those that `patterns` names.
bool pass_matches(std::string_view patterns, std::string_view pass);

}  // namespace hwsim::cost_models
