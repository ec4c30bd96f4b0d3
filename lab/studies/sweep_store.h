#pragma once
// The points of a sweep in one SQLite database: all of them are there before the first one runs, and results
// are there whole or not at all.
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "lab/base/table.h"
#include "lab/results/results.h"
#include "lab/store/database.h"
#include "lab/studies/sweep_file.h"

namespace hwsim::lab {

struct SweepPoint {
  std::string id;  ///< hash of the resolved configuration, the scene's content and the model's version
  std::int64_t number = 0;
  std::string scene, technique, gpu, engine;
  Resolution resolution;
  std::vector<Assignment> settings;  ///< what is varied
  std::string run_file, gpu_file;    ///< everything that was decided, as TOML
};

struct FinishedPoint {
  std::string id;
  PointResult result;  ///< its technique and its GPU are not looked at
};

class SweepStore {
 public:
  /// Throws what `open_sweep` throws, and U021 where another build of hwsim wrote the points and more are to
  /// be added.
  SweepStore(const std::string& path, SweepAccess access);
  ~SweepStore();
  SweepStore(const SweepStore&) = delete;
  SweepStore& operator=(const SweepStore&) = delete;

  /// Points that are new become pending; those whose process has ended while they ran become interrupted.
  void add(std::size_t count, const std::function<SweepPoint(std::size_t)>& point_at);
  /// Points that any process has claimed are free again: for who knows that no other one works here.
  void take_over();
  void remember(const std::string& key, const std::string& value);

  std::string state_of(const std::string& id);
  /// Takes points for this process, which are then running: all but those that are done and those that
  /// another process runs. Returns which of them it got. One transaction: no point is run twice.
  std::vector<bool> claim(std::span<const std::string> ids);
  /// All in one transaction.
  void finish(std::span<const FinishedPoint> points);
  void fail(const std::string& id, const std::string& message);

  /// Takes over the finished points of another sweep's database, which is only read. Returns how many were
  /// new. Throws InputError U021 where another build of hwsim wrote them.
  std::size_t merge(const std::string& path);

  /// Every point, in order: CSV, and what follows from it. Valid as long as the store.
  RowSource points();
  /// How many points are in each state.
  std::map<std::string, std::size_t> states();

 private:
  void add(std::span<const SweepPoint> points);  ///< one transaction
  /// Running points whose process has ended become interrupted.
  void interrupt_ended();
  /// Whether the point is there for this process.
  bool is_free(const std::string& id);
  void finish(const std::string& id, const PointResult& result);
  /// The statement, compiled once.
  Database::Statement& prepared(const char* sql);

  std::string path_;
  std::string process_;  ///< the owner of what this store claims
  bool writes_;
  Database database_;
  std::map<const char*, Database::Statement> statements_;
};

/// The points of a database, which is only read, and opened anew each time. Throws what `open_sweep` throws.
RowSource sweep_rows(const std::string& path);

}  // namespace hwsim::lab
