#include "cost_models/published.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>

#include "cost_models/table_number.h"
#include "hwsim/base/csv.h"
#include "hwsim/base/diagnostics.h"

namespace hwsim::cost_models {
namespace {

namespace fs = std::filesystem;

/// The fields that rules test, by the names of the columns in mapping files.
std::string field(const PublishedRow& row, std::string_view column) {
  if (column == "document") return row.document;
  if (column == "table") return row.table;
  if (column == "gpu") return row.gpu;
  if (column == "scene") return row.scene;
  if (column == "view") return row.view;
  if (column == "technique") return row.technique;
  if (column == "msaa") return row.msaa;
  if (column == "surfaces") return row.surfaces;
  if (column == "lighting") return row.lighting;
  if (column == "pass") return row.pass;
  return row.quantity;
}

Diagnostic mapping_problem(const std::string& message, const std::string& path, int line) {
  Diagnostic problem{.code = "M001", .message = message};
  problem.place.file = path;
  problem.place.line = line;
  problem.place.column = 1;
  problem.help =
      "uses are fitted, checked, derived, count, excluded and claim; columns are those of the tables, * is "
      "anything";
  return problem;
}

constexpr NumberRange kPixels{1.0, 16384.0, true}, kRate{1.0, 64.0, true}, kRepeat{1.0, 1e6},
    kPresentUs{0.0, 1e6};

constexpr std::string_view kNotPrinted = "NA";

Diagnostic number_problem(const std::string& text, const std::string& column, const std::string& expected,
                          const CsvFile& file, std::size_t row) {
  Diagnostic problem{.code = "M010", .message = "`" + text + "` is no value of `" + column + "`"};
  problem.place.file = file.path;
  problem.place.line = file.lines[row];
  problem.place.column = 1;
  problem.help = "write " + expected;
  return problem;
}

/// A mapping file: its first `conditions` columns are matched with a row ("*" is anything), the others are
/// what the first matching line says.
class Rules {
 public:
  Rules(const std::string& path, std::size_t conditions)
      : file_(read_csv(path)), conditions_(conditions), used_(file_.rows.size(), false) {}

  /// The line for a row, or none.
  const std::vector<std::string>* find(const PublishedRow& row) {
    for (std::size_t i = 0; i < file_.rows.size(); ++i) {
      bool all = true;
      for (std::size_t c = 0; c < conditions_ && all; ++c)
        all = file_.rows[i][c] == "*" || file_.rows[i][c] == field(row, file_.header[c]);
      if (!all) continue;
      used_[i] = true;
      return &file_.rows[i];
    }
    return nullptr;
  }

  bool has(std::string_view column) const {
    return std::find(file_.header.begin(), file_.header.end(), column) != file_.header.end();
  }

  /// The text of a column in a line that `find` returned.
  const std::string& text(const std::vector<std::string>& line, std::string_view column) const {
    return line[file_.column(column)];
  }

  void check_numbers(std::string_view column, const NumberRange& range,
                     std::vector<Diagnostic>& problems) const {
    for (std::size_t i = 0; i < file_.rows.size(); ++i) {
      const std::string& text = file_.rows[i][file_.column(column)];
      if (!table_number(text, range))
        problems.push_back(number_problem(text, std::string(column), range_text(range), file_, i));
    }
  }

  /// After `check_numbers`.
  double number(const std::vector<std::string>& line, std::string_view column) const {
    return table_number(text(line, column)).value();
  }

  void report_unused(std::vector<Diagnostic>& problems) const {
    for (std::size_t i = 0; i < used_.size(); ++i)
      if (!used_[i])
        problems.push_back(mapping_problem(
            "this rule matches no published row, or only rows of earlier rules", file_.path, file_.lines[i]));
  }

 private:
  CsvFile file_;
  std::size_t conditions_;
  std::vector<bool> used_;
};

RowUse use_from_name(const std::string& name, const std::string& path) {
  for (const RowUse use :
       {RowUse::fitted, RowUse::checked, RowUse::derived, RowUse::count, RowUse::excluded, RowUse::claim})
    if (row_use_name(use) == name) return use;
  throw InputError(mapping_problem("`" + name + "` is no use of a row", path, 0));
}

std::string filled(std::string text, const PublishedRow& row) {
  for (const auto& [name, value] :
       {std::pair{std::string("{msaa}"), row.msaa}, std::pair{std::string("{surfaces}"), row.surfaces},
        std::pair{std::string("{lighting}"), row.lighting}})
    for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + value.size()))
      text.replace(at, name.size(), value);  // the value may hold the name again
  return text;
}

bool is_percent(const PublishedRow& row) { return row.quantity.starts_with("percent_change_"); }

/// Percentages refer to the row without surfaces of the same table, scene, rate and lighting.
const PublishedRow* reference_of(const PublishedRow& row, const std::vector<PublishedRow>& rows) {
  for (const PublishedRow& other : rows)
    if (other.table == row.table && other.scene == row.scene && other.msaa == row.msaa &&
        other.lighting == row.lighting && other.surfaces.empty() && !is_percent(other) &&
        other.pass == row.pass && (other.quantity == "memory_mbytes") == row.quantity.ends_with("memory"))
      return &other;
  return nullptr;
}

class Mapper {
 public:
  Mapper(const std::vector<PublishedRow>& rows, const fs::path& folder)
      : rows_(rows),
        folder_(folder),
        uses_((folder / "uses.csv").string(), 9),
        gpus_(read_csv((folder / "gpus.csv").string())),
        scenes_((folder / "scenes.csv").string(), 4),
        techniques_((folder / "techniques.csv").string(), 4),
        passes_((folder / "passes.csv").string(), 3) {
    techniques_.check_numbers("repeat", kRepeat, problems_);
    if (passes_.has("present_us")) passes_.check_numbers("present_us", kPresentUs, problems_);
    if (!problems_.empty()) throw InputError(problems_);
  }

  std::vector<Cell> run() {
    std::vector<Cell> cells;
    for (const PublishedRow& row : rows_) cells.push_back(cell(row));
    for (const Rules* rules : {&uses_, &scenes_, &techniques_, &passes_}) rules->report_unused(problems_);
    if (!problems_.empty()) throw InputError(problems_);
    return cells;
  }

 private:
  Cell cell(const PublishedRow& row) {
    Cell cell;
    cell.row = row;
    if (const auto* line = uses_.find(row)) {
      cell.use = use_from_name(uses_.text(*line, "use"), (folder_ / "uses.csv").string());
      cell.reason = uses_.text(*line, "reason");
    } else {
      cell.use = RowUse::excluded;
      cell.reason = "no rule in uses.csv";
    }
    set_value(cell);
    const std::string missing = cell.use == RowUse::claim ? "" : set_run(cell);
    cell.has_run = cell.use != RowUse::claim && missing.empty();
    const bool needs_value =
        cell.use == RowUse::fitted || cell.use == RowUse::checked || cell.use == RowUse::count;
    if (needs_value && row.printed == kNotPrinted)
      problems_.push_back({.code = "M002", .message = "row " + row.id() + " has no value to be fitted"});
    if (!cell.has_run && needs_value)
      problems_.push_back(
          {.code = "M002", .message = "row " + row.id() + " is mapped to no run: " + missing});
    return cell;
  }

  void set_value(Cell& cell) const {
    const PublishedRow& row = cell.row;
    cell.published = row.value;
    cell.unit = row.quantity == "shaded_samples" || row.quantity == "percent_change_shaded"  ? "samples"
                : row.quantity == "memory_mbytes" || row.quantity == "percent_change_memory" ? "mib"
                                                                                             : "ms";
    if (!is_percent(row)) return;
    if (const PublishedRow* reference = reference_of(row, rows_))
      cell.published = reference->value * (1.0 + row.value / 100.0);
  }

  /// Returns why there is none; empty where there is.
  std::string set_run(Cell& cell) {
    const PublishedRow& row = cell.row;
    const auto* scene = scenes_.find(row);
    const auto* technique = techniques_.find(row);
    const auto* pass = passes_.find(row);
    for (const auto& [found, file] :
         {std::pair{scene, "scenes.csv"}, {technique, "techniques.csv"}, {pass, "passes.csv"}})
      if (!found) return std::string("no line of mapping/") + file + " matches it";
    RunSpec& run = cell.run;
    run.scene = scenes_.text(*scene, "stand_in");
    run.camera = scenes_.text(*scene, "camera");
    run.settings = filled(scenes_.text(*scene, "settings"), row);
    run.unlit = scenes_.text(*scene, "unlit");
    run.technique = filled(techniques_.text(*technique, "template"), row);
    cell.repeat = techniques_.number(*technique, "repeat");
    for (const auto& line : gpus_.rows)
      if (line[0] == row.gpu) run.gpu = line[1];
    const auto x = row.resolution.find('x');
    if (run.gpu.empty()) return "no line of mapping/gpus.csv is `" + row.gpu + "`";
    if (x == std::string::npos) return "it has no resolution";
    run.width_px = static_cast<int>(table_number(row.resolution.substr(0, x)).value());
    run.height_px = static_cast<int>(table_number(row.resolution.substr(x + 1)).value());
    cell.scene_group = run.scene;
    cell.passes = passes_.text(*pass, "trace_passes");
    if (passes_.has("present_us")) cell.present_us = passes_.number(*pass, "present_us");
    cell.rate = table_number(row.msaa).value_or(1.0);
    return {};
  }

  const std::vector<PublishedRow>& rows_;
  fs::path folder_;
  Rules uses_;
  CsvFile gpus_;
  Rules scenes_, techniques_, passes_;
  std::vector<Diagnostic> problems_;
};

/// The values that a quantity may have. A time is positive: its logarithm is fitted.
NumberRange range_of(const std::string& quantity) {
  if (quantity == "claim") return {-1e12, 1e12};
  if (quantity.starts_with("percent_change_")) return {-99.99, 1e6};
  return {1e-9, 1e12};
}

/// Values are taken as they are printed: a quantity has one unit, and one that is not known would be taken
/// for milliseconds.
constexpr std::pair<std::string_view, std::string_view> kUnits[] = {{"time_ms", "ms"},
                                                                    {"fps", "fps"},
                                                                    {"memory_mbytes", "MB"},
                                                                    {"shaded_samples", "count"},
                                                                    {"triangles", "count"},
                                                                    {"speedup", "x"},
                                                                    {"percent_change_time", "%"},
                                                                    {"percent_change_memory", "%"},
                                                                    {"percent_change_shaded", "%"}};

void check_unit(const PublishedRow& row, const std::string& unit, const CsvFile& file, std::size_t at,
                std::vector<Diagnostic>& problems) {
  if (row.quantity == "claim") {  // a sentence's own
    if (unit.empty())
      problems.push_back(number_problem(unit, "unit", "what the document prints behind it", file, at));
    return;
  }
  std::string known = "claim";
  for (const auto& [quantity, its] : kUnits) {
    known += ", " + std::string(quantity);
    if (quantity != row.quantity) continue;
    if (unit != its)
      problems.push_back(number_problem(
          unit, "unit", "`" + std::string(its) + "`, the unit of `" + row.quantity + "`", file, at));
    return;
  }
  problems.push_back(number_problem(row.quantity, "quantity", "one of " + known, file, at));
}

bool is_resolution(std::string_view text) {
  const auto x = text.find('x');
  return x != std::string_view::npos && table_number(text.substr(0, x), kPixels) &&
         table_number(text.substr(x + 1), kPixels);
}

void check_numbers(const PublishedRow& row, const CsvFile& file, std::size_t at,
                   std::vector<Diagnostic>& problems) {
  const NumberRange range = range_of(row.quantity);
  if (row.printed != kNotPrinted && !table_number(row.printed, range))
    problems.push_back(number_problem(row.printed, "value", range_text(range) + ", or NA", file, at));
  if (!row.resolution.empty() && !is_resolution(row.resolution))
    problems.push_back(number_problem(row.resolution, "resolution", "WIDTHxHEIGHT, or nothing", file, at));
  if (!row.msaa.empty() && !table_number(row.msaa, kRate))
    problems.push_back(number_problem(row.msaa, "msaa", range_text(kRate) + ", or nothing", file, at));
  if (!row.surfaces.empty() && !table_number(row.surfaces, kRate))
    problems.push_back(
        number_problem(row.surfaces, "surfaces_or_aggregates", range_text(kRate) + ", or nothing", file, at));
}

PublishedRow read_row(const CsvFile& file, std::size_t at, std::vector<Diagnostic>& problems) {
  const auto text = [&](std::string_view column) { return file.rows[at][file.column(column)]; };
  PublishedRow row{fs::path(file.path).stem().string(),
                   file.lines[at],
                   text("document"),
                   text("gpu"),
                   text("resolution"),
                   text("scene"),
                   text("view"),
                   text("technique"),
                   text("msaa"),
                   text("surfaces_or_aggregates"),
                   text("lighting"),
                   text("pass"),
                   text("quantity"),
                   text("value"),
                   0.0,
                   text("note")};
  check_numbers(row, file, at, problems);
  check_unit(row, text("unit"), file, at, problems);
  row.value = table_number(row.printed).value_or(0.0);
  return row;
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

bool matches_one(std::string_view pattern, std::string_view pass) {
  if (pattern.ends_with('*')) return pass.starts_with(pattern.substr(0, pattern.size() - 1));
  return pattern == pass;
}

}  // namespace

std::string PublishedRow::id() const { return table + ":" + std::to_string(line); }

std::string RunSpec::to_string() const {
  return technique + " of " + scene + (camera == "0" ? "" : " (" + camera + ")") + " at " +
         std::to_string(width_px) + "x" + std::to_string(height_px) +
         (settings.empty() ? "" : ", " + settings) + ", on " + gpu;
}

std::string technique_id(std::string_view technique) {
  return std::string(technique.substr(0, technique.find(':')));
}

RunSpec without_lights(const RunSpec& run) {
  RunSpec unlit = run;
  unlit.settings.clear();
  for (const std::string& setting : words(run.settings)) {
    const std::string path = setting.substr(0, setting.find('='));
    std::string kept = setting;
    for (const std::string& other : words(run.unlit))
      if (other.substr(0, other.find('=')) == path) kept = other;
    unlit.settings += (unlit.settings.empty() ? "" : " ") + kept;
  }
  unlit.unlit.clear();
  return unlit;
}

std::string_view row_use_name(RowUse use) {
  switch (use) {
    case RowUse::fitted:
      return "fitted";
    case RowUse::checked:
      return "checked";
    case RowUse::derived:
      return "derived";
    case RowUse::count:
      return "count";
    case RowUse::excluded:
      return "excluded";
    case RowUse::claim:
      return "claim";
  }
  return "claim";
}

std::vector<PublishedRow> load_published(const std::string& published_dir) {
  std::set<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(published_dir, error))
    if (entry.path().extension() == ".csv") files.insert(entry.path());
  if (files.empty()) {
    Diagnostic none{.code = "U012", .message = "there are no published tables"};
    none.place.file = published_dir;
    none.help = "unset HWSIM_CONFIG_DIR to use the tables that came with hwsim, or copy `published` there";
    throw InputError(none);
  }
  std::vector<PublishedRow> rows;
  std::vector<Diagnostic> problems;
  for (const fs::path& path : files) {
    const CsvFile file = read_csv(path.string());
    for (std::size_t i = 0; i < file.rows.size(); ++i) rows.push_back(read_row(file, i, problems));
  }
  if (!problems.empty()) throw InputError(problems);
  return rows;
}

std::vector<Cell> map_rows(const std::vector<PublishedRow>& rows, const std::string& published_dir) {
  return Mapper(rows, fs::path(published_dir) / "mapping").run();
}

bool pass_matches(std::string_view patterns, std::string_view pass) {
  bool found = false;
  while (!patterns.empty()) {
    const auto blank = std::min(patterns.find(' '), patterns.size());
    const std::string_view pattern = patterns.substr(0, blank);
    if (pattern.starts_with('!')) {
      if (matches_one(pattern.substr(1), pass)) return false;
    } else {
      found = found || matches_one(pattern, pass);
    }
    patterns.remove_prefix(std::min(patterns.size(), blank + 1));
  }
  return found;
}

}  // namespace hwsim::cost_models
