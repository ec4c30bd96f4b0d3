#include "lab/studies/sweep_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "algos/rooms.h"
#include "hwsim/base/units_of_measure.h"
#include "lab/base/messages.h"

namespace hwsim::lab {
namespace {

std::string settings_json(const std::vector<Assignment>& settings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Assignment& set : settings) json[set.path] = set.value;
  return json.dump();
}

std::int64_t signed_count(std::uint64_t count) { return static_cast<std::int64_t>(count); }

}  // namespace

SweepStore::SweepStore(const std::string& path, SweepAccess access)
    : path_(path), writes_(access != SweepAccess::look), database_(open_sweep(path, access)) {}

SweepStore::~SweepStore() {
  // One file, with nothing beside it, can be copied and read anywhere. Where another process still uses the
  // database, that one closes it.
  statements_.clear();
  if (writes_) database_.try_execute("PRAGMA busy_timeout=0; PRAGMA journal_mode=DELETE");
}

void SweepStore::remember(const std::string& key, const std::string& value) {
  Database::Statement(database_, "INSERT OR REPLACE INTO sweep VALUES (?, ?)")
      .bind(1, key)
      .bind(2, value)
      .run();
}

Database::Statement& SweepStore::prepared(const char* sql) {
  const auto found = statements_.find(sql);
  return found != statements_.end()
             ? found->second
             : statements_.emplace(sql, Database::Statement(database_, sql)).first->second;
}

void SweepStore::add(std::size_t count, const std::function<SweepPoint(std::size_t)>& point_at) {
  Database::Transaction transaction(database_);
  database_.execute("UPDATE point SET state = 'interrupted' WHERE state = 'running'");
  Database::Statement insert(database_,
                             "INSERT INTO point (id, number, scene, technique, gpu, engine, width_px, "
                             "height_px, settings, run_file, gpu_file, state) VALUES "
                             "(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, 'pending') ON CONFLICT (id) DO UPDATE SET "
                             "number = excluded.number");
  for (std::size_t i = 0; i < count; ++i) {
    const SweepPoint point = point_at(i);
    insert.bind(1, point.id)
        .bind(2, point.number)
        .bind(3, point.scene)
        .bind(4, point.technique)
        .bind(5, point.gpu)
        .bind(6, point.engine)
        .bind(7, std::int64_t{point.resolution.width_px})
        .bind(8, std::int64_t{point.resolution.height_px})
        .bind(9, settings_json(point.settings))
        .bind(10, point.run_file)
        .bind(11, point.gpu_file)
        .run();
  }
  transaction.commit();
}

std::string SweepStore::state_of(const std::string& id) {
  Database::Statement& select = prepared("SELECT state FROM point WHERE id = ?");
  std::string state = select.bind(1, id).step() ? select.text(0) : "";
  select.reset();  // or it would keep its view of the database
  return state;
}

void SweepStore::set_state(const std::string& id, const std::string& state, const std::string& message) {
  prepared("UPDATE point SET state = ?, message = ? WHERE id = ?")
      .bind(1, state)
      .bind(2, message)
      .bind(3, id)
      .run();
}

void SweepStore::start(const std::string& id) { set_state(id, "running", ""); }
void SweepStore::fail(const std::string& id, const std::string& message) { set_state(id, "failed", message); }

void SweepStore::finish(std::span<const FinishedPoint> points) {
  Database::Transaction transaction(database_);
  for (const FinishedPoint& point : points) finish(point.id, point.result);
  transaction.commit();
}

void SweepStore::finish(const std::string& id, const PointResult& result) {
  const FrameTiming& timing = result.timing;
  const auto dram_mb = [](const StreamBytes& bytes) {
    return (bytes.total_read() + bytes.total_write()) / kBytesPerMb;
  };
  Database::Statement& update = prepared(
      "UPDATE point SET state = 'done', message = '', time_ms = ?, lo_ms = ?, hi_ms = ?, support = ?, "
      "limiter = "
      "?, dram_mb = ?, memory_mib = ?, shaded_samples = ?, from_cache = ? WHERE id = ?");
  update.bind(1, timing.time_ns / kNsPerMs).bind_null(2).bind_null(3).bind(4, support_name(timing.support));
  if (timing.interval_ns)
    update.bind(2, (*timing.interval_ns)[0] / kNsPerMs).bind(3, (*timing.interval_ns)[1] / kNsPerMs);
  update.bind(5, timing.passes.empty() ? "" : unit_name(slowest_pass(timing).limiter))
      .bind(6, dram_mb(timing.dram_bytes))
      .bind(7, static_cast<double>(result.emulation->trace.peak_memory_bytes) / kBytesPerMib)
      .bind(8, signed_count(algos::shaded_samples(result.emulation->trace)))
      .bind(9, std::int64_t{result.from_cache})
      .bind(10, id)
      .run();
  prepared("DELETE FROM pass WHERE point_id = ?").bind(1, id).run();
  Database::Statement& insert = prepared("INSERT INTO pass VALUES (?, ?, ?, ?, ?, ?, ?)");
  std::int64_t ordinal = 0;
  for (const PassTiming& pass : timing.passes)
    insert.bind(1, id)
        .bind(2, ordinal++)
        .bind(3, pass.name)
        .bind(4, pass_kind_name(pass.kind))
        .bind(5, pass.time_ns / kNsPerMs)
        .bind(6, unit_name(pass.limiter))
        .bind(7, dram_mb(pass.dram_bytes))
        .run();
}

namespace {

/// Copies the rows of one table that belong to a point.
class RowCopier {
 public:
  RowCopier(Database& from, Database& to, const std::string& table, const std::vector<std::string>& columns)
      : columns_(static_cast<int>(columns.size())),
        select_(from,
                fmt::format("SELECT {} FROM {} WHERE {} = ?", fmt::join(columns, ", "), table, columns[0])),
        insert_(to, fmt::format("INSERT INTO {} ({}) VALUES ({})", table, fmt::join(columns, ", "),
                                fmt::join(std::vector<std::string>(columns.size(), "?"), ", "))) {}

  void copy(const std::string& point_id) {
    select_.bind(1, point_id);
    while (select_.step()) {
      for (int i = 0; i < columns_; ++i) insert_.bind(i + 1, select_, i);
      insert_.run();
    }
    select_.reset();
  }

 private:
  int columns_;
  Database::Statement select_, insert_;
};

}  // namespace

std::size_t SweepStore::merge(const std::string& path) {
  Database other = open_sweep(path, SweepAccess::look);
  std::size_t taken = 0;
  Database::Transaction transaction(database_);
  RowCopier points(other, database_, "point",
                   {"id",       "number",     "scene",          "technique", "gpu",      "engine",
                    "width_px", "height_px",  "settings",       "run_file",  "gpu_file", "state",
                    "message",  "time_ms",    "lo_ms",          "hi_ms",     "support",  "limiter",
                    "dram_mb",  "memory_mib", "shaded_samples", "from_cache"});
  RowCopier passes(other, database_, "pass",
                   {"point_id", "ordinal", "name", "kind", "time_ms", "limiter", "dram_mb"});
  Database::Statement all(other, "SELECT id, state FROM point");
  while (all.step()) {
    const std::string id = all.text(0), here = state_of(id);
    if (here == "done" || (!here.empty() && all.text(1) != "done")) continue;
    Database::Statement(database_, "DELETE FROM pass WHERE point_id = ?").bind(1, id).run();
    Database::Statement(database_, "DELETE FROM point WHERE id = ?").bind(1, id).run();
    points.copy(id);
    passes.copy(id);
    if (all.text(1) == "done") ++taken;
  }
  transaction.commit();
  return taken;
}

std::map<std::string, std::size_t> SweepStore::states() {
  std::map<std::string, std::size_t> counts;
  Database::Statement select(database_, "SELECT state, count(*) FROM point GROUP BY state");
  while (select.step()) counts[select.text(0)] = static_cast<std::size_t>(select.integer(1));
  return counts;
}

namespace {

std::vector<Column> point_columns() {
  return {{"number", "#", true},
          {"point_id", "point"},
          {"scene", "scene"},
          {"technique", "technique"},
          {"gpu", "GPU"},
          {"width_px", "width", true},
          {"height_px", "height", true},
          {"state", "state"},
          {"time_ms", "ms", true},
          {"lo_ms", "lo", true},
          {"hi_ms", "hi", true},
          {"support", "support"},
          {"limiter", "limiter"},
          {"dram_mb", "DRAM MB", true},
          {"memory_mib", "memory MiB", true},
          {"shaded_samples", "shaded samples", true},
          {"message", "message"}};
}

constexpr const char* kSelectPoints =
    "SELECT number, id, scene, technique, gpu, width_px, height_px, state, time_ms, lo_ms, hi_ms, support, "
    "limiter, dram_mb, memory_mib, shaded_samples, message, settings FROM point ORDER BY number, id";
constexpr int kSettings = 17;                 ///< column of the statement above
constexpr std::ptrdiff_t kSettingsPlace = 7;  ///< where they stand in the table

std::vector<TableCell> point_row(const Database::Statement& point) {
  std::vector<TableCell> row;
  const auto count = [&](int column) {
    if (point.real(column))
      row.emplace_back(static_cast<std::uint64_t>(point.integer(column)));
    else
      row.emplace_back(NotApplicable{});
  };
  const auto text = [&](int column) {
    const std::string value = point.text(column);
    if (value.empty())
      row.emplace_back(NotApplicable{});
    else
      row.emplace_back(value);
  };
  const auto real = [&](int column, int decimals) {
    if (const auto value = point.real(column))
      row.emplace_back(Real{*value, decimals});
    else
      row.emplace_back(NotApplicable{});
  };
  count(0);
  for (const int column : {1, 2, 3, 4}) text(column);
  for (const int column : {5, 6}) count(column);
  text(7);
  for (const int column : {8, 9, 10}) real(column, 4);
  for (const int column : {11, 12}) text(column);
  real(13, 2);
  real(14, 1);
  count(15);
  text(16);
  return row;
}

nlohmann::ordered_json settings_of(const Database::Statement& point, const std::string& path) {
  auto settings = nlohmann::ordered_json::parse(point.text(kSettings), nullptr, false);
  if (!settings.is_object())
    hwsim::lab::fail("U021", "`" + path + "` is damaged: the settings of a point are no object");
  return settings;
}

/// Everything that is varied at some point, in order of appearance.
std::vector<std::string> varied_paths(Database& database, const std::string& path) {
  std::vector<std::string> varied;
  Database::Statement select(database, kSelectPoints);
  while (select.step()) {
    const nlohmann::ordered_json settings = settings_of(select, path);
    for (const auto& [key, value] : settings.items())
      if (std::ranges::find(varied, key) == varied.end()) varied.push_back(key);
  }
  return varied;
}

}  // namespace

RowSource SweepStore::points() {
  const std::vector<std::string> varied = varied_paths(database_, path_);
  RowSource rows{point_columns(), {}};
  for (std::size_t k = 0; k < varied.size(); ++k)
    rows.columns.insert(rows.columns.begin() + kSettingsPlace + static_cast<std::ptrdiff_t>(k),
                        {varied[k], varied[k], true});
  rows.each = [this, varied](const TakeRow& take) {
    Database::Statement select(database_, kSelectPoints);
    while (select.step()) {
      const nlohmann::ordered_json settings = settings_of(select, path_);
      std::vector<TableCell> cells;
      for (const std::string& key : varied) {
        const auto found = settings.find(key);
        cells.push_back(found == settings.end() ? TableCell{NotApplicable{}}
                                                : TableCell{found->get<std::string>()});
      }
      std::vector<TableCell> row = point_row(select);
      row.insert(row.begin() + kSettingsPlace, cells.begin(), cells.end());
      take(row);
    }
  };
  return rows;
}

RowSource sweep_rows(const std::string& path) {
  const auto store = std::make_shared<SweepStore>(path, SweepAccess::look);
  RowSource rows = store->points();
  rows.each = [store, each = rows.each](const TakeRow& take) { each(take); };
  return rows;
}

}  // namespace hwsim::lab
