#include "lab/studies/sweep_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <thread>

#include "lab/base/messages.h"
#include "pipeline/base/file_io.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kApplicationId = 0x68775357;  // "hwSW", in the header of the file
constexpr std::uint32_t kSchemaVersion = 4;           // raised when a table or a column changes its meaning

constexpr const char* kSchema = R"(
CREATE TABLE sweep (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE point (
  id TEXT PRIMARY KEY, number INTEGER NOT NULL, scene TEXT NOT NULL, technique TEXT NOT NULL,
  gpu TEXT NOT NULL, engine TEXT NOT NULL, width_px INTEGER NOT NULL, height_px INTEGER NOT NULL,
  settings TEXT NOT NULL, run_file TEXT NOT NULL, gpu_file TEXT NOT NULL,
  state TEXT NOT NULL, owner TEXT NOT NULL DEFAULT '', message TEXT NOT NULL DEFAULT '',
  time_ms REAL, lo_ms REAL, hi_ms REAL, support TEXT, limiter TEXT, dram_mb REAL, memory_mib REAL,
  shaded_samples INTEGER, from_cache INTEGER,
  flip_mean REAL, psnr_db REAL, ssim REAL) WITHOUT ROWID;
CREATE TABLE pass (
  point_id TEXT NOT NULL REFERENCES point(id), ordinal INTEGER NOT NULL, name TEXT NOT NULL,
  kind TEXT NOT NULL, time_ms REAL NOT NULL, limiter TEXT NOT NULL, dram_mb REAL NOT NULL,
  PRIMARY KEY (point_id, ordinal)) WITHOUT ROWID;
)";

[[noreturn]] void refuse(const std::string& message) {
  fail("U021", message, "", "another file: this one stays as it was");
}

std::string other_version(const std::string& path, std::int64_t version) {
  return fmt::format("`{}` is a sweep of version {}, this program reads {}", path, version, kSchemaVersion);
}

/// The schema's version in the file's header (https://www.sqlite.org/fileformat.html), or none where the file
/// is no sweep.
std::optional<std::uint32_t> version_in_header(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;  // a pipe would be waited for
  std::array<char, 100> header{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(header.data(), header.size())) return std::nullopt;
  const auto word = [&header](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(header.at(at + i));
    return value;
  };
  constexpr std::size_t kUserVersionAt = 60, kApplicationIdAt = 68;
  const bool is_sweep =
      std::memcmp(header.data(), "SQLite format 3", 16) == 0 && word(kApplicationIdAt) == kApplicationId;
  return is_sweep ? std::optional(word(kUserVersionAt)) : std::nullopt;
}

/// What the database consists of, as SQLite keeps it: the row of each part in its schema, by the part's name.
std::map<std::string, std::string> parts_of(Database& database) {
  std::map<std::string, std::string> parts;
  Database::Statement select(database, "SELECT type, name, tbl_name, sql FROM sqlite_master");
  while (select.step())
    parts[select.text(0) + " `" + select.text(1) + "`"] += select.text(2) + " " + select.text(3);
  return parts;
}

std::int64_t number_of(Database& database, const std::string& pragma) {
  Database::Statement select(database, "PRAGMA " + pragma);
  return select.step() ? select.integer(0) : 0;
}

/// The tables of a sweep and nothing else: no table, view, index, trigger or column of somebody else's, and
/// no statistics of ANALYZE, which would go with the tables. The numbers of the header are asked for once
/// more: a log beside the file may hold others than the file's first bytes.
void require_own_schema(Database& database, const std::string& path) {
  Database made(":memory:", Database::Mode::create);
  made.execute(kSchema);
  const std::map<std::string, std::string> ours = parts_of(made), found = parts_of(database);
  for (const auto& [part, text] : found)
    if (const auto own = ours.find(part); own == ours.end() || own->second != text)
      fail("U021",
           fmt::format("`{}` is no database of `hwsim sweep`{}: {} is {}", path,
                       own == ours.end() ? " alone" : "", part,
                       own == ours.end() ? "not hwsim's" : "another one than hwsim makes"),
           "", "another --db, or a copy without it: this file stays as it was");
  if (found.size() != ours.size() || number_of(database, "application_id") != kApplicationId)
    refuse("`" + path + "` is no database of `hwsim sweep`");
  if (const std::int64_t version = number_of(database, "user_version"); version != kSchemaVersion)
    refuse(other_version(path, version));
}

void write_schema(Database& database) {
  database.execute(kSchema);
  database.execute(
      fmt::format("PRAGMA application_id={}; PRAGMA user_version={}", kApplicationId, kSchemaVersion));
}

/// A file beside the database that goes with its owner, whatever happens.
struct Unfinished {
  std::string name;
  pipeline::FileDescriptor lock;
  explicit Unfinished(const std::string& path) : lock(pipeline::open_unfinished(path, name)) {}
  ~Unfinished() {
    std::error_code ignored;
    if (lock.is_open()) fs::remove(name, ignored);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
};

/// Appears under its name with all of its tables, or not at all; a file that another process made meanwhile
/// stays. Returns whether this process made it.
bool make(const std::string& path) {
  Unfinished file{path};
  if (!file.lock.is_open()) refuse("the database `" + path + "` cannot be made: " + std::strerror(errno));
  {
    Database database(file.name, Database::Mode::write, path);
    database.execute("PRAGMA journal_mode=MEMORY");  // no journal that a killed process could leave
    Database::Transaction transaction(database);
    write_schema(database);
    transaction.commit();
  }
  const bool linked = ::link(file.name.c_str(), path.c_str()) == 0;
  const int why = linked ? 0 : errno;
  if (!linked && why != EEXIST) refuse("the database `" + path + "` cannot be made: " + std::strerror(why));
  return linked;
}

void empty(Database& database) {
  Database::Transaction transaction(database);
  database.execute("DROP TABLE pass; DROP TABLE point; DROP TABLE sweep");
  write_schema(database);
  transaction.commit();
}

/// The mode needs the database for itself, and SQLite does not wait for that where another process opens or
/// closes it.
void log_writes(Database& database) {
  constexpr int kAttempts = 1000;
  constexpr std::chrono::milliseconds kPause{10};
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (database.try_execute("PRAGMA journal_mode=WAL")) return;
    std::this_thread::sleep_for(kPause);
  }
  database.execute("PRAGMA journal_mode=WAL");
}

/// SQLite is not given the file before its header shows that it is a sweep.
void require_header(const std::string& path) {
  const std::optional<std::uint32_t> version = version_in_header(path);
  if (!version) refuse("`" + path + "` is no database of `hwsim sweep`");
  if (*version != kSchemaVersion) refuse(other_version(path, *version));
}

/// Reads the schema before the database is opened for writing. Who was killed while it changed the mode of
/// the journal left one that only a writer can take back; the first page alone is in it, and the schema is
/// read without it.
void look_at_schema(const std::string& path) {
  const std::string journal = path + "-journal";
  std::error_code error;
  const bool unfinished = fs::exists(journal, error);
  Database database(path, unfinished ? Database::Mode::look_as_it_lies : Database::Mode::look);
  require_own_schema(database, path);
}

}  // namespace

Database open_sweep(const std::string& path, SweepAccess access) {
  std::error_code error;
  bool is_there = fs::exists(path, error);
  if (error) refuse("the database `" + path + "` cannot be used: " + error.message());
  if (!is_there && access == SweepAccess::look)
    fail("U021", "there is no database `" + path + "`", "",
         "the name of a database that `hwsim sweep` wrote");
  if (!is_there) is_there = !make(path);  // another process may have been faster
  if (is_there && access == SweepAccess::create)
    fail("U013", "`" + path + "` exists and is not overwritten", "",
         "another --db, --resume to go on with it, or --force to replace it");
  require_header(path);
  const bool looks = access == SweepAccess::look;
  if (!looks) look_at_schema(path);
  Database database(path, looks ? Database::Mode::look : Database::Mode::write);
  require_own_schema(database, path);  // again: another program may have been here meanwhile
  return database;
}

void begin_writing(Database& database, SweepAccess access) {
  log_writes(database);
  database.execute("PRAGMA synchronous=NORMAL; PRAGMA foreign_keys=ON");
  if (access == SweepAccess::replace) empty(database);
}

}  // namespace hwsim::lab
