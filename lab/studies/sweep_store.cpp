#include "lab/studies/sweep_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "algos/rooms.h"
#include "hwsim/base/units_of_measure.h"
#include "lab/base/messages.h"

namespace hwsim::lab {
namespace {

// Raised when a column changes its meaning; columns are only added otherwise.
constexpr const char* kSchemaVersion = "1";

constexpr const char* kSchema = R"(
CREATE TABLE IF NOT EXISTS sweep (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS point (
  id TEXT PRIMARY KEY, number INTEGER NOT NULL, scene TEXT NOT NULL, technique TEXT NOT NULL,
  gpu TEXT NOT NULL, engine TEXT NOT NULL, width_px INTEGER NOT NULL, height_px INTEGER NOT NULL,
  settings TEXT NOT NULL, run_file TEXT NOT NULL, gpu_file TEXT NOT NULL,
  state TEXT NOT NULL, message TEXT NOT NULL DEFAULT '',
  time_ms REAL, lo_ms REAL, hi_ms REAL, support TEXT, limiter TEXT, dram_mb REAL, memory_mib REAL,
  shaded_samples INTEGER, from_cache INTEGER) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS pass (
  point_id TEXT NOT NULL REFERENCES point(id), ordinal INTEGER NOT NULL, name TEXT NOT NULL,
  kind TEXT NOT NULL, time_ms REAL NOT NULL, limiter TEXT NOT NULL, dram_mb REAL NOT NULL,
  PRIMARY KEY (point_id, ordinal)) WITHOUT ROWID;
)";

bool exists(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

std::string settings_json(const std::vector<Assignment>& settings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Assignment& set : settings) json[set.path] = set.value;
  return json.dump();
}

std::int64_t signed_count(std::uint64_t count) { return static_cast<std::int64_t>(count); }

}  // namespace

SweepStore::SweepStore(const std::string& path, bool may_exist)
    : path_(path), database_([&] {
        if (!may_exist && exists(path))
          hwsim::lab::fail("U013", "`" + path + "` exists and is not overwritten", "",
                           "another --db, --resume to go on with it, or --force to replace it");
        return Database(path, Database::Mode::create);
      }()) {
  database_.execute("PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL; PRAGMA foreign_keys=ON");
  database_.execute(kSchema);
  Database::Statement version(database_, "SELECT value FROM sweep WHERE key = 'schema_version'");
  if (!version.step())
    remember("schema_version", kSchemaVersion);
  else if (version.text(0) != kSchemaVersion)
    hwsim::lab::fail(
        "U021", "`" + path + "` has version " + version.text(0) + ", this program writes " + kSchemaVersion);
}

void SweepStore::remember(const std::string& key, const std::string& value) {
  Database::Statement(database_, "INSERT OR REPLACE INTO sweep VALUES (?, ?)")
      .bind(1, key)
      .bind(2, value)
      .run();
}

void SweepStore::add(const std::vector<SweepPoint>& points) {
  Database::Transaction transaction(database_);
  database_.execute("UPDATE point SET state = 'interrupted' WHERE state = 'running'");
  Database::Statement insert(database_,
                             "INSERT INTO point (id, number, scene, technique, gpu, engine, width_px, "
                             "height_px, settings, run_file, gpu_file, state) VALUES "
                             "(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, 'pending') ON CONFLICT (id) DO UPDATE SET "
                             "number = excluded.number");
  for (const SweepPoint& point : points)
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
  transaction.commit();
}

std::string SweepStore::state_of(const std::string& id) {
  Database::Statement select(database_, "SELECT state FROM point WHERE id = ?");
  select.bind(1, id);
  return select.step() ? select.text(0) : "";
}

void SweepStore::set_state(const std::string& id, const std::string& state, const std::string& message) {
  Database::Statement(database_, "UPDATE point SET state = ?, message = ? WHERE id = ?")
      .bind(1, state)
      .bind(2, message)
      .bind(3, id)
      .run();
}

void SweepStore::start(const std::string& id) { set_state(id, "running", ""); }
void SweepStore::fail(const std::string& id, const std::string& message) { set_state(id, "failed", message); }

void SweepStore::finish(const std::string& id, const PointResult& result) {
  const FrameTiming& timing = result.timing;
  const auto dram_mb = [](const StreamBytes& bytes) {
    return (bytes.total_read() + bytes.total_write()) / kBytesPerMb;
  };
  Database::Transaction transaction(database_);
  Database::Statement update(database_,
                             "UPDATE point SET state = 'done', message = '', time_ms = ?, lo_ms = ?, hi_ms "
                             "= ?, support = ?, limiter = ?, dram_mb = ?, memory_mib = ?, shaded_samples = "
                             "?, from_cache = ? WHERE id = ?");
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
  Database::Statement(database_, "DELETE FROM pass WHERE point_id = ?").bind(1, id).run();
  Database::Statement insert(database_, "INSERT INTO pass VALUES (?, ?, ?, ?, ?, ?, ?)");
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
  transaction.commit();
}

std::size_t SweepStore::merge(const std::string& path) {
  if (!exists(path)) hwsim::lab::fail("U021", "there is no database `" + path + "`");
  const auto done = [this] { return count("done"); };
  const std::size_t before = done();
  { SweepStore checked(path, true); }  // another version, or no sweep at all, ends here
  Database::Statement(database_, "ATTACH DATABASE ? AS other").bind(1, path).run();
  {
    Database::Transaction transaction(database_);
    database_.execute(
        "DELETE FROM main.pass WHERE point_id IN (SELECT o.id FROM other.point o JOIN main.point m ON o.id = "
        "m.id WHERE o.state = 'done' AND m.state <> 'done')");
    database_.execute(
        "DELETE FROM main.point WHERE state <> 'done' AND id IN (SELECT id FROM other.point WHERE state = "
        "'done')");
    database_.execute("INSERT OR IGNORE INTO main.point SELECT * FROM other.point");
    database_.execute("INSERT OR IGNORE INTO main.pass SELECT * FROM other.pass");
    transaction.commit();
  }
  database_.execute("DETACH DATABASE other");
  return done() - before;
}

std::size_t SweepStore::count(const std::string& state) {
  Database::Statement select(database_, "SELECT count(*) FROM point WHERE state = ?");
  select.bind(1, state).step();
  return static_cast<std::size_t>(select.integer(0));
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

std::vector<Cell> point_row(const Database::Statement& point) {
  std::vector<Cell> row;
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

/// A column for everything that is varied at some point, in order of appearance.
void insert_settings(Table& table, const std::vector<nlohmann::ordered_json>& settings) {
  std::vector<std::string> varied;
  for (const nlohmann::ordered_json& point : settings)
    for (const auto& [path, value] : point.items())
      if (std::find(varied.begin(), varied.end(), path) == varied.end()) varied.push_back(path);
  for (size_t k = 0; k < varied.size(); ++k) {
    const std::ptrdiff_t at = kSettingsPlace + static_cast<std::ptrdiff_t>(k);
    table.columns.insert(table.columns.begin() + at, {varied[k], varied[k], true});
    for (size_t i = 0; i < table.rows.size(); ++i) {
      const auto found = settings[i].find(varied[k]);
      if (found == settings[i].end())
        table.rows[i].emplace(table.rows[i].begin() + at, NotApplicable{});
      else
        table.rows[i].emplace(table.rows[i].begin() + at, found->get<std::string>());
    }
  }
}

}  // namespace

Table SweepStore::points() {
  Table table{point_columns(), {}};
  std::vector<nlohmann::ordered_json> settings;
  Database::Statement select(database_, kSelectPoints);
  while (select.step()) {
    table.rows.push_back(point_row(select));
    settings.push_back(nlohmann::ordered_json::parse(select.text(kSettings), nullptr, false));
    if (!settings.back().is_object())
      hwsim::lab::fail("U021", "`" + path_ + "` is damaged: the settings of a point are no object");
  }
  insert_settings(table, settings);
  return table;
}

}  // namespace hwsim::lab
