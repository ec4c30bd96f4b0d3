#include "lab/studies/sweep_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hwsim/engines/timing.h"
#include "lab/base/messages.h"
#include "lab/request/request.h"

namespace hwsim::lab {
namespace {

constexpr double kMaxTimeMs = 1e12, kMaxMegabytes = 1e12, kMaxCount = 9e18;
constexpr std::array kSupports = {Support::calibrated, Support::interpolated, Support::extrapolated,
                                  Support::uncalibrated};
constexpr std::array kStates = {"pending", "running", "interrupted", "done", "failed"};

bool is_support(const std::string& name) {
  return std::ranges::any_of(kSupports, [&](Support support) { return support_name(support) == name; });
}

/// One column of `point`, as the table shows it and as a row must have it.
struct PointColumn {
  enum class Type { text, state, support, count, real };
  const char* name;
  const char* id;
  const char* title;
  Type type = Type::text;
  double high = 0.0;  ///< the largest count or real
  int decimals = 0;
  bool may_be_missing = false;
  double low = 0.0;  ///< the smallest
};

using enum PointColumn::Type;
constexpr std::array kPointColumns = {
    PointColumn{"number", "number", "#", count, kMaxCount},
    PointColumn{"id", "point_id", "point"},
    PointColumn{"scene", "scene", "scene"},
    PointColumn{"technique", "technique", "technique"},
    PointColumn{"gpu", "gpu", "GPU"},
    PointColumn{"width_px", "width_px", "width", count, kMaxSidePx, 0, false, 1.0},
    PointColumn{"height_px", "height_px", "height", count, kMaxSidePx, 0, false, 1.0},
    PointColumn{"state", "state", "state", state},
    PointColumn{"time_ms", "time_ms", "ms", real, kMaxTimeMs, 4, true},
    PointColumn{"lo_ms", "lo_ms", "lo", real, kMaxTimeMs, 4, true},
    PointColumn{"hi_ms", "hi_ms", "hi", real, kMaxTimeMs, 4, true},
    PointColumn{"support", "support", "support", support, 0, 0, true},
    PointColumn{"limiter", "limiter", "limiter", text, 0, 0, true},
    PointColumn{"dram_mb", "dram_mb", "DRAM MB", real, kMaxMegabytes, 2, true},
    PointColumn{"memory_mib", "memory_mib", "memory MiB", real, kMaxMegabytes, 1, true},
    PointColumn{"shaded_samples", "shaded_samples", "shaded samples", count, kMaxCount, 0, true},
    PointColumn{"flip_mean", "flip_mean", "FLIP", real, 1.0, 4, true},
    PointColumn{"psnr_db", "psnr_db", "PSNR dB", real, 1e3, 2, true},
    PointColumn{"ssim", "ssim", "SSIM", real, 1.0, 4, true, -1.0},
    PointColumn{"message", "message", "message"}};
constexpr int kId = 1, kScene = 2, kSettings = kPointColumns.size();
constexpr std::ptrdiff_t kErrors = 16, kErrorColumns = 3;  ///< where the errors of images stand
constexpr std::ptrdiff_t kSettingsPlace = 7;               ///< where what is varied stands in the table

std::string select_points() {
  std::string names;
  for (const PointColumn& column : kPointColumns) names += std::string(column.name) + ", ";
  return "SELECT " + names + "settings FROM point ORDER BY number, id";
}

using NamedTexts = std::vector<std::pair<std::string, std::string>>;

/// Reads one row after another of `SELECT ... FROM point`.
class PointReader {
 public:
  PointReader(Database& database, const std::string& path)
      : path_(path), select_(database, select_points()) {}

  bool step() { return select_.step(); }

  std::vector<TableCell> row() const {
    std::vector<TableCell> cells;
    for (std::size_t i = 0; i < kPointColumns.size(); ++i)
      cells.push_back(cell(kPointColumns[i], static_cast<int>(i)));
    if (select_.text(kState) == "done" && std::holds_alternative<NotApplicable>(cells[kTime]))
      damaged("is done and has no `time_ms`");
    const std::optional<double> low = select_.real(kTime + 1), high = select_.real(kTime + 2);
    const double time = select_.real(kTime).value_or(0.0);
    if (low.has_value() != high.has_value() || (low && !(*low <= time && time <= *high)))
      damaged("has an interval that does not hold its `time_ms`");
    return cells;
  }

  /// What is varied and its values, in the order in which the sweep named them.
  NamedTexts settings() const {
    NamedTexts texts;
    const auto json = nlohmann::ordered_json::parse(select_.text(kSettings), nullptr, false);
    bool valid = json.is_object();
    if (valid)
      for (const auto& [key, value] : json.items()) {
        valid = valid && value.is_string();
        if (valid) texts.emplace_back(key, value.get<std::string>());
      }
    if (!valid) damaged("has settings that are no object of texts");
    return texts;
  }

 private:
  static constexpr int kState = 7, kTime = 8;

  [[noreturn]] void damaged(const std::string& what) const {
    hwsim::lab::fail("U021", fmt::format("`{}` is damaged: point `{}` {}", path_, select_.text(kId), what),
                     "", "a copy of the database, or `--force` to compute all points anew");
  }

  TableCell cell(const PointColumn& column, int place) const {
    const bool is_text = column.type == text || column.type == state || column.type == support;
    const bool is_number = select_.is_number(place);
    const double number = select_.real(place).value_or(0.0);
    const std::int64_t whole = select_.integer(place);
    const std::string value = select_.text(place);
    if (value.empty()) {
      if (column.type != text && !column.may_be_missing) damaged(fmt::format("has no `{}`", column.name));
      return NotApplicable{};
    }
    if (is_text) {
      const bool known = column.type == state     ? std::ranges::find(kStates, value) != kStates.end()
                         : column.type == support ? is_support(value)
                                                  : true;
      if (is_number || !known) damaged(fmt::format("has `{}` {}, which no sweep writes", column.name, value));
      return value;
    }
    if (!is_number || !(number >= column.low && number <= column.high) ||
        (column.type == count && number != std::floor(number)))
      damaged(fmt::format("has `{}` {}, must be a {} from {} to {}", column.name, value,
                          column.type == count ? "whole number" : "number", column.low, column.high));
    if (column.type == count) return static_cast<std::uint64_t>(whole);
    return Real{number, column.decimals};
  }

  std::string path_;
  Database::Statement select_;
};

/// What stands in a column of every sweep.
bool has_own_column(const std::string& path) { return path == "gpu" || path == "scene"; }

/// Everything else that is varied at some point, in order of appearance.
std::vector<std::string> varied_paths(Database& database, const std::string& path) {
  std::vector<std::string> varied;
  PointReader points(database, path);
  while (points.step())
    for (const auto& [key, value] : points.settings())
      if (!has_own_column(key) && std::ranges::find(varied, key) == varied.end()) varied.push_back(key);
  return varied;
}

/// Whether an image was compared with its reference at some point.
bool has_errors(Database& database) {
  Database::Statement select(database, "SELECT 1 FROM point WHERE flip_mean IS NOT NULL LIMIT 1");
  return select.step();
}

/// Without the columns of errors where no point has one, then with what is varied.
template <class Cell>
void arrange(std::vector<Cell>& cells, bool with_errors, const std::vector<Cell>& varied) {
  const auto errors = cells.begin() + kErrors;
  if (!with_errors) cells.erase(errors, errors + kErrorColumns);
  cells.insert(cells.begin() + kSettingsPlace, varied.begin(), varied.end());
}

std::vector<Column> columns_with(const std::vector<std::string>& varied, bool with_errors) {
  std::vector<Column> columns;
  for (const PointColumn& column : kPointColumns)
    columns.push_back({column.id, column.title, column.type == count || column.type == real});
  std::vector<Column> settings;
  for (const std::string& key : varied) settings.push_back({key, key, true});
  arrange(columns, with_errors, settings);
  return columns;
}

}  // namespace

RowSource point_rows(Database& database, const std::string& path) {
  const std::vector<std::string> varied = varied_paths(database, path);
  const bool with_errors = has_errors(database);
  return {
      columns_with(varied, with_errors), [&database, path, varied, with_errors](const TakeRow& take) {
        PointReader points(database, path);
        while (points.step()) {
          std::vector<TableCell> row = points.row(), cells;
          const NamedTexts settings = points.settings();
          const auto scene = std::ranges::find(settings, "scene", &NamedTexts::value_type::first);
          if (scene != settings.end()) row[kScene] = scene->second;  // a name may be that of several files
          for (const std::string& key : varied) {
            const auto found = std::ranges::find(settings, key, &NamedTexts::value_type::first);
            cells.push_back(found == settings.end() ? TableCell{NotApplicable{}} : TableCell{found->second});
          }
          arrange(row, with_errors, cells);
          take(row);
        }
      }};
}

void require_valid_rows(Database& database, const std::string& path) {
  PointReader points(database, path);
  while (points.step()) {
    points.row();
    points.settings();
  }
  Database::Statement passes(
      database,
      fmt::format(
          "SELECT point_id FROM pass WHERE typeof(ordinal) != 'integer' OR typeof(time_ms) != 'real' OR "
          "typeof(dram_mb) != 'real' OR NOT (ordinal >= 0 AND time_ms BETWEEN 0 AND {} AND dram_mb "
          "BETWEEN 0 AND {}) LIMIT 1",
          kMaxTimeMs, kMaxMegabytes));
  if (passes.step())
    fail("U021",
         "`" + path + "` is damaged: a pass of point `" + passes.text(0) + "` is none that a sweep writes",
         "", "a copy of the database, or `--force` to compute all points anew");
}

}  // namespace hwsim::lab
