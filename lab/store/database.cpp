#include "lab/store/database.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cctype>
#include <chrono>
#include <filesystem>
#include <thread>

#include "lab/base/messages.h"

namespace hwsim::lab {
namespace {

constexpr int kAttempts = 100;
constexpr std::chrono::milliseconds kPause{10};
constexpr int kBusyMs =
    60'000;  // others hold the lock for a fraction of a second each, on a busy machine longer

/// A database of a stranger runs no code of its own, and none of its values takes much memory.
void distrust(sqlite3* handle) {
  constexpr int kLongestValue = 64 << 20;
  sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, kLongestValue);
  for (const int what :
       {SQLITE_DBCONFIG_TRUSTED_SCHEMA, SQLITE_DBCONFIG_ENABLE_TRIGGER, SQLITE_DBCONFIG_ENABLE_VIEW})
    sqlite3_db_config(handle, what, 0, nullptr);
}

sqlite3* open(const std::string& path, int flags) {
  sqlite3* handle = nullptr;
  if (sqlite3_open_v2(path.c_str(), &handle, flags, nullptr) == SQLITE_OK) {
    sqlite3_busy_timeout(handle, kBusyMs);
    distrust(handle);
  }
  return handle;  // with the error inside, if there was one
}

/// The name of a file that SQLite takes for unchanging: it needs no lock and no file beside it.
std::string immutable_uri(const std::string& path) {
  std::string uri = "file:";
  for (const char c : path)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '.' || c == '_' || c == '-')
      uri += c;
    else
      uri += fmt::format("%{:02x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  return uri + "?immutable=1";
}

/// Whether SQLite may make the files that it wants beside a database of the mode WAL.
bool may_write_beside(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return ::access(folder.empty() ? "." : folder.c_str(), W_OK) == 0;
}

/// SQLite cannot read a database of the mode WAL in a folder without write permission, as it wants a file for
/// locks there. Without a log beside the database nobody writes it, so that no lock is needed. In other
/// folders the file is away for a moment where another process closes the database.
sqlite3* open_to_look(const std::string& path) {
  for (int attempt = 0;; ++attempt) {
    sqlite3* handle = open(path, SQLITE_OPEN_READONLY);
    const int code = sqlite3_exec(handle, "PRAGMA schema_version", nullptr, nullptr, nullptr);
    if (code != SQLITE_CANTOPEN && code != SQLITE_READONLY) return handle;
    std::error_code error;
    const bool is_fixed = !may_write_beside(path) && !std::filesystem::exists(path + "-wal", error);
    if (!is_fixed && attempt == kAttempts) return handle;
    sqlite3_close(handle);
    if (is_fixed) return open(immutable_uri(path), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
    std::this_thread::sleep_for(kPause);
  }
}

sqlite3* open(const std::string& path, Database::Mode mode) {
  if (mode == Database::Mode::look) return open_to_look(path);
  if (mode == Database::Mode::look_as_it_lies)
    return open(immutable_uri(path), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
  return open(path, SQLITE_OPEN_READWRITE | (mode == Database::Mode::create ? SQLITE_OPEN_CREATE : 0));
}

}  // namespace

Database::Database(const std::string& path, Mode mode, const std::string& shown)
    : path_(shown.empty() ? path : shown), handle_(open(path, mode), sqlite3_close) {
  require(sqlite3_errcode(handle_.get()));
}

void Database::fail() const {
  const int code = sqlite3_errcode(handle_.get());
  const bool out_of_space = code == SQLITE_FULL || code == SQLITE_IOERR;
  throw InputError(
      problem("U021", "the database `" + path_ + "`: " + sqlite3_errmsg(handle_.get()), "",
              out_of_space ? "a disk with space; points that were finished are kept"
                           : "a database that `hwsim sweep` wrote, in a folder that can be written"),
      out_of_space ? ExitStatus::run_failed : ExitStatus::invalid_input);
}

void Database::require(int code) const {
  if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE) fail();
}

void Database::execute(const std::string& sql) {
  require(sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

bool Database::try_execute(const std::string& sql) {
  return sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
}

Database::Statement::Statement(Database& database, std::string_view sql)
    : database_(database), handle_(nullptr, sqlite3_finalize) {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(database.handle_.get(), sql.data(), static_cast<int>(sql.size()),
                                      &statement, nullptr);
  handle_.reset(statement);
  database_.require(code);
}

Database::Statement& Database::Statement::bind(int place, std::string_view text) {
  database_.require(
      sqlite3_bind_text(handle_.get(), place, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
  return *this;
}
Database::Statement& Database::Statement::bind(int place, double value) {
  database_.require(sqlite3_bind_double(handle_.get(), place, value));
  return *this;
}
Database::Statement& Database::Statement::bind(int place, std::int64_t value) {
  database_.require(sqlite3_bind_int64(handle_.get(), place, value));
  return *this;
}
Database::Statement& Database::Statement::bind_null(int place) {
  database_.require(sqlite3_bind_null(handle_.get(), place));
  return *this;
}

Database::Statement& Database::Statement::bind(int place, const Statement& row, int column) {
  database_.require(
      sqlite3_bind_value(handle_.get(), place, sqlite3_column_value(row.handle_.get(), column)));
  return *this;
}

bool Database::Statement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) database_.fail();
  return code == SQLITE_ROW;
}

void Database::Statement::run() {
  step();
  reset();
}

void Database::Statement::reset() { database_.require(sqlite3_reset(handle_.get())); }

std::string Database::Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  return text ? std::string(text, static_cast<size_t>(sqlite3_column_bytes(handle_.get(), column)))
              : std::string();
}
std::int64_t Database::Statement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}
bool Database::Statement::is_number(int column) const {
  const int type = sqlite3_column_type(handle_.get(), column);
  return type == SQLITE_INTEGER || type == SQLITE_FLOAT;
}
std::optional<double> Database::Statement::real(int column) const {
  if (sqlite3_column_type(handle_.get(), column) == SQLITE_NULL) return std::nullopt;
  return sqlite3_column_double(handle_.get(), column);
}

Database::Transaction::Transaction(Database& database) : database_(database) {
  database_.execute("BEGIN IMMEDIATE");
}
Database::Transaction::~Transaction() {
  if (open_) sqlite3_exec(database_.handle_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}
void Database::Transaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

}  // namespace hwsim::lab
