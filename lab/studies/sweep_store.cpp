#include "lab/studies/sweep_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "algos/rooms.h"
#include "hwsim/base/units_of_measure.h"
#include "lab/base/build_info.h"
#include "lab/base/json_text.h"
#include "lab/base/messages.h"
#include "lab/store/process_id.h"
#include "lab/studies/sweep_rows.h"

namespace hwsim::lab {
namespace {

std::string settings_json(const std::vector<Assignment>& settings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Assignment& set : settings) json[set.path] = set.value;
  return json_text(json, -1);
}

std::int64_t signed_count(std::uint64_t count) { return static_cast<std::int64_t>(count); }

/// The program that computed the points; empty where none was computed yet.
std::string model_of(Database& database) {
  Database::Statement select(database, "SELECT value FROM sweep WHERE key = 'model_version'");
  return select.step() ? select.text(0) : "";
}

/// Times of two programs in one table would be compared as if one had made them.
void require_model(const std::string& found, std::string_view wanted, const std::string& path) {
  if (!found.empty() && found != wanted)
    fail("U021",
         fmt::format("`{}` holds points of another build of hwsim (model {}, not {})", path, found, wanted),
         "", "another --db, --force to compute all points anew, or that build to go on with it");
}

}  // namespace

SweepStore::SweepStore(const std::string& path, SweepAccess access)
    : path_(path),
      process_(own_process_id()),
      writes_(access != SweepAccess::look),
      database_(open_sweep(path, access)) {
  if (!writes_) return;
  if (access != SweepAccess::replace) require_model(model_of(database_), model_version(), path_);
  begin_writing(database_, access);
  remember("model_version", std::string(model_version()));
}

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

void SweepStore::interrupt_ended() {
  std::set<std::string> ended;
  Database::Statement running(database_, "SELECT DISTINCT owner FROM point WHERE state = 'running'");
  while (running.step())
    if (const std::string owner = running.text(0); has_ended(owner)) ended.insert(owner);
  for (const std::string& owner : ended)
    prepared("UPDATE point SET state = 'interrupted', owner = '' WHERE state = 'running' AND owner = ?")
        .bind(1, owner)
        .run();
}

void SweepStore::take_over() {
  database_.execute("UPDATE point SET state = 'interrupted', owner = '' WHERE state = 'running'");
}

void SweepStore::add(std::size_t count, const std::function<SweepPoint(std::size_t)>& point_at) {
  constexpr std::size_t kTogether = 1000;  // others wait for a transaction, so that it is short
  interrupt_ended();
  for (std::size_t begin = 0; begin < count; begin += kTogether) {
    std::vector<SweepPoint> points;
    for (std::size_t i = begin; i < std::min(count, begin + kTogether); ++i) points.push_back(point_at(i));
    add(points);
  }
}

void SweepStore::add(std::span<const SweepPoint> points) {
  Database::Transaction transaction(database_);
  Database::Statement& insert = prepared(
      "INSERT INTO point (id, number, scene, technique, gpu, engine, width_px, height_px, settings, "
      "run_file, "
      "gpu_file, state) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, 'pending') ON CONFLICT (id) DO UPDATE SET "
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
  Database::Statement& select = prepared("SELECT state FROM point WHERE id = ?");
  std::string state = select.bind(1, id).step() ? select.text(0) : "";
  select.reset();  // or it would keep its view of the database
  return state;
}

bool SweepStore::is_free(const std::string& id) {
  Database::Statement& select = prepared("SELECT state, owner FROM point WHERE id = ?");
  const bool known = select.bind(1, id).step();
  const std::string state = known ? select.text(0) : "done", owner = known ? select.text(1) : "";
  select.reset();
  return state != "done" && (state != "running" || owner == process_ || has_ended(owner));
}

std::vector<bool> SweepStore::claim(std::span<const std::string> ids) {
  Database::Transaction transaction(database_);
  std::vector<bool> got;
  for (const std::string& id : ids) {
    got.push_back(is_free(id));
    if (got.back())
      prepared("UPDATE point SET state = 'running', owner = ?, message = '' WHERE id = ?")
          .bind(1, process_)
          .bind(2, id)
          .run();
  }
  transaction.commit();
  return got;
}

void SweepStore::fail(const std::string& id, const std::string& message) {
  prepared("UPDATE point SET state = 'failed', owner = '', message = ? WHERE id = ?")
      .bind(1, message)
      .bind(2, id)
      .run();
}

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
      "UPDATE point SET state = 'done', owner = '', message = '', time_ms = ?, lo_ms = ?, hi_ms = ?, support "
      "= ?, "
      "limiter = "
      "?, dram_mb = ?, memory_mib = ?, shaded_samples = ?, from_cache = ?, flip_mean = ?, psnr_db = ?, ssim "
      "= ? WHERE id "
      "= ?");
  update.bind(1, timing.time_ns / kNsPerMs).bind_null(2).bind_null(3).bind(4, support_name(timing.support));
  if (timing.interval_ns)
    update.bind(2, (*timing.interval_ns)[0] / kNsPerMs).bind(3, (*timing.interval_ns)[1] / kNsPerMs);
  update.bind(5, timing.passes.empty() ? "" : unit_name(slowest_pass(timing).limiter))
      .bind(6, dram_mb(timing.dram_bytes))
      .bind(7, static_cast<double>(result.emulation->trace.peak_memory_bytes) / kBytesPerMib)
      .bind(8, signed_count(algos::shaded_samples(result.emulation->trace)))
      .bind(9, std::int64_t{result.from_cache})
      .bind_null(10)
      .bind_null(11)
      .bind_null(12)
      .bind(13, id);
  if (const auto& error = result.image_error)
    update.bind(10, error->flip_mean).bind(11, error->psnr_db).bind(12, error->ssim);
  update.run();
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
  require_model(model_of(other), model_version(), path);
  require_valid_rows(other, path);
  std::size_t taken = 0;
  Database::Transaction transaction(database_);
  RowCopier points(
      other, database_, "point",
      {"id",         "number",    "scene",    "technique", "gpu",     "engine",     "width_px",
       "height_px",  "settings",  "run_file", "gpu_file",  "state",   "message",    "time_ms",
       "lo_ms",      "hi_ms",     "support",  "limiter",   "dram_mb", "memory_mib", "shaded_samples",
       "from_cache", "flip_mean", "psnr_db",  "ssim"});
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

RowSource SweepStore::points() { return point_rows(database_, path_); }

RowSource sweep_rows(const std::string& path) {
  const auto store = std::make_shared<SweepStore>(path, SweepAccess::look);
  RowSource rows = store->points();
  rows.each = [store, each = rows.each](const TakeRow& take) { each(take); };
  return rows;
}

}  // namespace hwsim::lab
