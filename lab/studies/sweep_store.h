#pragma once
// The points of a sweep in one SQLite database: all of them are there before the first one runs, each result
// is one transaction.
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

class SweepStore {
 public:
  /// Throws what `open_sweep` throws.
  SweepStore(const std::string& path, SweepAccess access);
  ~SweepStore();
  SweepStore(const SweepStore&) = delete;
  SweepStore& operator=(const SweepStore&) = delete;

  /// Points that are new become pending; those that a killed process left running become interrupted.
  void add(const std::vector<SweepPoint>& points);
  void remember(const std::string& key, const std::string& value);

  std::string state_of(const std::string& id);
  void start(const std::string& id);
  void finish(const std::string& id, const PointResult& result);
  void fail(const std::string& id, const std::string& message);

  /// Takes over the finished points of another sweep's database, which is only read. Returns how many were
  /// new.
  std::size_t merge(const std::string& path);

  /// Every point, in order: CSV, and what follows from it.
  Table points();
  std::size_t count(const std::string& state);

 private:
  void set_state(const std::string& id, const std::string& state, const std::string& message);

  std::string path_;
  bool writes_;
  Database database_;
};

}  // namespace hwsim::lab
