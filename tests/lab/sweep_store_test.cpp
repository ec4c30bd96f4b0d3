// The database of a sweep: what is kept, and what a merge takes over.
#include "lab/studies/sweep_store.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "hwsim/base/diagnostics.h"
#include "lab/lab.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

class SweepStoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("hwsim_sweep_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static SweepPoint point(const std::string& id, std::int64_t number) {
    SweepPoint p;
    p.id = id;
    p.number = number;
    p.scene = "sponza_hall";
    p.technique = "fxaa";
    p.gpu = "gtx980";
    p.engine = "queue";
    p.settings = {{"gpu.l2_size_kib", id}};
    return p;
  }

  static PointResult result(double time_ns) {
    PointResult r;
    r.emulation = std::make_shared<pipeline::Emulation>();
    r.timing.time_ns = time_ns;
    PassTiming pass;
    pass.name = "draw";
    pass.time_ns = time_ns;
    r.timing.passes = {pass};
    return r;
  }

  /// A database with these points, of which those with a time are done.
  void make(const std::string& name, const std::vector<std::pair<std::string, double>>& points) {
    SweepStore store(path(name), SweepAccess::create);
    std::vector<SweepPoint> planned;
    for (const auto& [id, time_ns] : points)
      planned.push_back(point(id, static_cast<std::int64_t>(planned.size()) + 1));
    store.add(planned.size(), [&](std::size_t i) { return planned[i]; });
    std::vector<FinishedPoint> finished;
    for (const auto& [id, time_ns] : points)
      if (time_ns > 0.0) finished.push_back({id, result(time_ns)});
    store.finish(finished);
  }

  /// Milliseconds of each point by its id; -1 where it is not done.
  static std::map<std::string, double> times(SweepStore& store) {
    const Table table = collected(store.points());
    std::map<std::string, double> found;
    for (const auto& row : table.rows) {
      const Real* time = std::get_if<Real>(&row.at(9));
      found[std::get<std::string>(row.at(1))] = time ? time->value : -1.0;
    }
    return found;
  }

  /// A database of another program.
  void make_foreign(const std::string& name) {
    Database database(path(name), Database::Mode::create);
    database.execute("CREATE TABLE point (id TEXT, note TEXT); INSERT INTO point VALUES ('p1', 'a thesis')");
  }

  /// As a killed process leaves a point of a.db.
  void claim_and_die(const std::string& id) const {
    const pid_t child = ::fork();
    if (child == 0) {
      SweepStore(path("a.db"), SweepAccess::go_on).claim(std::vector{id});
      ::_exit(0);
    }
    ::waitpid(child, nullptr, 0);
  }

  /// The bytes of every file in the folder.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      std::ifstream file(entry.path(), std::ios::binary);
      found[entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
    }
    return found;
  }

  static std::string code_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const InputError& error) {
      EXPECT_FALSE(error.diagnostics().front().help.empty()) << error.what();
      return error.diagnostics().front().code;
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(SweepStoreTest, MergeTakesOverWhatIsDoneThereAndNotHere) {
  make("a.db", {{"p1", 1e6}, {"p2", 0.0}, {"p3", 0.0}});
  make("b.db", {{"p1", 9e6}, {"p2", 2e6}, {"p3", 0.0}, {"p4", 4e6}});
  SweepStore a(path("a.db"), SweepAccess::go_on);
  EXPECT_EQ(a.merge(path("b.db")), 2u) << "p2 and p4";
  EXPECT_EQ(times(a), (std::map<std::string, double>{{"p1", 1.0}, {"p2", 2.0}, {"p3", -1.0}, {"p4", 4.0}}))
      << "what was done here stays as it was";
  EXPECT_EQ(a.states()["done"], 3u);
  EXPECT_EQ(a.states()["pending"], 1u);
}

TEST_F(SweepStoreTest, MergingTheSameAgainChangesNothing) {
  make("a.db", {{"p1", 1e6}});
  make("b.db", {{"p2", 2e6}});
  SweepStore a(path("a.db"), SweepAccess::go_on);
  EXPECT_EQ(a.merge(path("b.db")), 1u);
  EXPECT_EQ(a.merge(path("b.db")), 0u);
  EXPECT_EQ(a.states()["done"], 2u);
}

TEST_F(SweepStoreTest, MergedPartsOfASweepEqualTheWhole) {
  make("whole.db", {{"p1", 1e6}, {"p2", 2e6}, {"p3", 3e6}});
  make("1.db", {{"p1", 1e6}, {"p2", 0.0}, {"p3", 0.0}});
  make("2.db", {{"p1", 0.0}, {"p2", 2e6}, {"p3", 3e6}});
  SweepStore merged(path("1.db"), SweepAccess::go_on), whole(path("whole.db"), SweepAccess::go_on);
  merged.merge(path("2.db"));
  EXPECT_EQ(to_csv(collected(merged.points())), to_csv(collected(whole.points())));
}

// Whatever somebody else put into a sweep's database is theirs: nothing replaces it, and nothing is written
// beside it.
TEST_F(SweepStoreTest, DatabaseWithMoreThanASweepsTablesStaysByteForByteAsItWas) {
  for (const char* sql :
       {"CREATE TRIGGER t AFTER UPDATE ON point BEGIN SELECT 1; END", "CREATE VIEW v AS SELECT 1",
        "ALTER TABLE point ADD COLUMN more TEXT AS (hex(zeroblob(300000000)))", "CREATE TABLE more (a)",
        "ALTER TABLE point ADD COLUMN mine TEXT", "CREATE INDEX i ON point (gpu)", "ANALYZE",
        "DROP TABLE pass", "ALTER TABLE point RENAME COLUMN limiter TO limit_", "PRAGMA user_version=999",
        "PRAGMA user_version=3", "PRAGMA application_id=1"}) {
    make("a.db", {{"p1", 1e6}});
    make("b.db", {{"p2", 1e6}});
    Database(path("a.db"), Database::Mode::write).execute(sql);
    const auto before = files();
    for (const SweepAccess access : {SweepAccess::look, SweepAccess::go_on, SweepAccess::replace})
      EXPECT_EQ(code_of([&] { SweepStore(path("a.db"), access); }), "U021") << sql;
    EXPECT_EQ(code_of([&] { Lab().sweep({}, {.database = path("b.db"), .merge = {path("a.db")}}); }), "U021")
        << sql;
    EXPECT_EQ(code_of([&] { Lab().sweep({}, {.database = path("a.db"), .merge = {path("b.db")}}); }), "U021")
        << sql;
    EXPECT_EQ(files(), before) << sql;
    fs::remove(path("a.db"));
    fs::remove(path("b.db"));
  }
}

// What stands in the log beside a database is not in the file's first bytes.
TEST_F(SweepStoreTest, PartsThatStandInALogAreSeen) {
  for (const char* sql : {"CREATE TABLE more (a)", "PRAGMA user_version=999", "PRAGMA application_id=1"}) {
    make("a.db", {{"p1", 1e6}});
    {
      Database other(path("a.db"), Database::Mode::write);
      other.execute("PRAGMA journal_mode=WAL; PRAGMA wal_autocheckpoint=0");
      other.execute(sql);
      const std::string before = files().at("a.db");
      for (const SweepAccess access : {SweepAccess::look, SweepAccess::go_on, SweepAccess::replace})
        EXPECT_EQ(code_of([&] { SweepStore(path("a.db"), access); }), "U021") << sql;
      EXPECT_EQ(files().at("a.db"), before) << sql;
    }
    fs::remove(path("a.db"));
  }
}

// The mode of the journal changes with a journal of its own; who is killed then leaves it.
TEST_F(SweepStoreTest, JournalThatAKilledProcessLeftIsTakenBack) {
  make("a.db", {{"p1", 1e6}});
  const pid_t child = ::fork();
  if (child == 0) {
    Database database(path("a.db"), Database::Mode::write);
    database.execute("PRAGMA cache_size=1; BEGIN; UPDATE sweep SET value = value || hex(zeroblob(100000))");
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  ASSERT_TRUE(fs::exists(path("a.db-journal")));
  EXPECT_EQ(SweepStore(path("a.db"), SweepAccess::go_on).states()["done"], 1u);
}

TEST_F(SweepStoreTest, RowsThatNoSweepWritesAreRefused) {
  for (const char* change : {"width_px = 0", "lo_ms = 100.0, hi_ms = 200.0", "support = 'perfect'",
                             "state = ''", "lo_ms = NULL, hi_ms = 1.0"}) {
    make("a.db", {{"p1", 1e6}});
    {
      Database database(path("a.db"), Database::Mode::write);
      database.execute(std::string("UPDATE point SET ") + change);
    }
    EXPECT_EQ(code_of([&] {
                SweepStore store(path("a.db"), SweepAccess::look);
                collected(store.points());
              }),
              "U021")
        << change;
    fs::remove(path("a.db"));
  }
}

TEST_F(SweepStoreTest, MergeOfAFileThatIsNotThereIsRefused) {
  make("a.db", {{"p1", 1e6}});
  SweepStore a(path("a.db"), SweepAccess::go_on);
  EXPECT_THROW(a.merge(path("none.db")), InputError);
  EXPECT_FALSE(fs::exists(path("none.db"))) << "a look leaves no file";
}

TEST_F(SweepStoreTest, PointsThatAKilledProcessLeftAreInterrupted) {
  make("a.db", {{"p1", 0.0}});
  claim_and_die("p1");
  SweepStore a(path("a.db"), SweepAccess::go_on);
  a.add(1, [](std::size_t) { return point("p1", 1); });
  EXPECT_EQ(a.state_of("p1"), "interrupted");
}

TEST_F(SweepStoreTest, PointOfALivingProcessIsNotClaimed) {
  make("a.db", {{"p1", 0.0}, {"p2", 0.0}, {"p3", 1e6}});
  SweepStore a(path("a.db"), SweepAccess::go_on);
  const std::vector<std::string> all = {"p1", "p2", "p3"};
  Database(path("a.db"), Database::Mode::write)
      .execute("UPDATE point SET state = 'running', owner = 'another-machine 1 2' WHERE id = 'p1'");
  EXPECT_EQ(a.claim(all), (std::vector<bool>{false, true, false})) << "p1 runs elsewhere, p3 is done";
  a.add(1, [](std::size_t) { return point("p1", 1); });
  EXPECT_EQ(a.state_of("p1"), "running");
  claim_and_die("p2");
  EXPECT_EQ(a.claim(all), (std::vector<bool>{false, true, false})) << "what this process has, it keeps";
}

// A task of a cluster that comes again on another node: only it knows that its database is its own.
TEST_F(SweepStoreTest, WhoWorksAloneTakesOverPointsOfOtherMachines) {
  make("a.db", {{"p1", 0.0}, {"p2", 1e6}});
  SweepStore a(path("a.db"), SweepAccess::go_on);
  Database(path("a.db"), Database::Mode::write)
      .execute("UPDATE point SET state = 'running', owner = 'another-machine 1 2' WHERE id = 'p1'");
  EXPECT_EQ(a.claim(std::vector<std::string>{"p1"}), std::vector{false});
  a.take_over();
  EXPECT_EQ(a.state_of("p1"), "interrupted");
  EXPECT_EQ(a.claim(std::vector<std::string>{"p1", "p2"}), (std::vector{true, false})) << "p2 stays done";
}

TEST_F(SweepStoreTest, PatternsNameTheDatabasesToMerge) {
  make("part1.db", {{"p1", 1e6}});
  make("part2.db", {{"p2", 2e6}});
  make("other.db", {{"p3", 3e6}});
  const SweepSummary merged = Lab().sweep({}, {.database = path("part9.db"), .merge = {path("part*.db")}});
  EXPECT_EQ(merged.done, 2u);
  EXPECT_EQ(Lab().sweep({}, {.database = path("part9.db"), .merge = {path("part*.db")}}).done, 2u)
      << "the pattern names the database itself, too";
  EXPECT_EQ(code_of([&] { Lab().sweep({}, {.database = path("b.db"), .merge = {path("none*.db")}}); }),
            "U021");
}

TEST_F(SweepStoreTest, ManyProcessesOpenAndCloseOneDatabase) {
  make("a.db", {{"p1", 0.0}});
  constexpr int kProcesses = 8, kTimes = 25;
  std::vector<pid_t> children;
  for (int i = 0; i < kProcesses; ++i) {
    children.push_back(::fork());
    if (children.back() != 0) continue;
    int failed = 0;
    for (int time = 0; time < kTimes; ++time) try {
        SweepStore(path("a.db"), SweepAccess::go_on).claim(std::vector<std::string>{"p1"});
      } catch (const InputError& error) {
        std::fprintf(stderr, "%s\n", error.what());
        ++failed;
      }
    ::_exit(failed);
  }
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << "of " << kTimes << " times it failed " << WEXITSTATUS(status);
  }
}

TEST_F(SweepStoreTest, FilesOfOtherProgramsStayByteForByteAsTheyWere) {
  make("a.db", {{"p1", 0.0}});
  make_foreign("notes.db");
  std::ofstream(path("text.db")) << "a letter";
  std::ofstream(path("empty.db"));
  const auto before = files();
  for (const char* name : {"notes.db", "text.db", "empty.db"}) {
    for (const SweepAccess access : {SweepAccess::look, SweepAccess::go_on, SweepAccess::replace})
      EXPECT_EQ(code_of([&] { SweepStore(path(name), access); }), "U021") << name;
    EXPECT_EQ(code_of([&] { SweepStore(path(name), SweepAccess::create); }), "U013") << name;
    EXPECT_EQ(code_of([&] { SweepStore(path("a.db"), SweepAccess::go_on).merge(path(name)); }), "U021")
        << name;
  }
  EXPECT_EQ(files().at("notes.db"), before.at("notes.db"));
  EXPECT_EQ(files().size(), before.size()) << "nothing was made beside them";
}

TEST_F(SweepStoreTest, LookAndBeingMergedLeaveAnotherSweepAsItWas) {
  make("a.db", {{"p1", 1e6}, {"p2", 0.0}});
  make("b.db", {});
  const auto before = files();
  {
    SweepStore looked(path("a.db"), SweepAccess::look);
    EXPECT_EQ(collected(looked.points()).rows.size(), 2u);
    EXPECT_THROW(looked.claim(std::vector<std::string>{"p2"}), InputError) << "it is open for reading only";
  }
  EXPECT_EQ(SweepStore(path("b.db"), SweepAccess::go_on).merge(path("a.db")), 1u);
  EXPECT_EQ(files().at("a.db"), before.at("a.db"));
  EXPECT_EQ(files().size(), before.size()) << "one file each, to be copied and read anywhere";
}

TEST_F(SweepStoreTest, LookAtWhatIsNotThereLeavesNoFile) {
  EXPECT_EQ(code_of([&] { SweepStore(path("none.db"), SweepAccess::look); }), "U021");
  EXPECT_TRUE(files().empty());
}

TEST_F(SweepStoreTest, ReplacedSweepIsEmpty) {
  make("a.db", {{"p1", 1e6}});
  EXPECT_EQ(SweepStore(path("a.db"), SweepAccess::replace).states()["done"], 0u);
  EXPECT_TRUE(collected(sweep_rows(path("a.db"))).rows.empty());
}

TEST_F(SweepStoreTest, PointThatAKilledProcessLeftRunningIsStillToBeDone) {
  make("a.db", {{"p1", 1e6}, {"p2", 0.0}, {"p3", 0.0}});
  claim_and_die("p2");
  const SweepSummary summary = Lab().sweep({}, {.database = path("a.db")});
  EXPECT_EQ(summary.done, 1u);
  EXPECT_EQ(summary.left, 2u);
}

TEST_F(SweepStoreTest, RowsThatNoSweepWritesAreRefusedWithTheirPlace) {
  const std::vector<std::string> damages = {
      "UPDATE point SET time_ms = 9e999",  "UPDATE point SET time_ms = -5.0",
      "UPDATE point SET time_ms = 'soon'", "UPDATE point SET time_ms = NULL",
      "UPDATE point SET width_px = -7",    "UPDATE point SET width_px = 1e9",
      "UPDATE point SET height_px = 'x'",  "UPDATE point SET shaded_samples = 0.5",
      "UPDATE point SET dram_mb = -1.0",   "UPDATE point SET state = 'perhaps'",
      "UPDATE point SET settings = '[1]'", "UPDATE point SET settings = '{\"gpu.rops\": 7}'",
      "UPDATE point SET settings = x'ff'",
  };
  for (const std::string& damage : damages) {
    make("a.db", {{"p1", 1e6}});
    Database(path("a.db"), Database::Mode::write).execute(damage);
    EXPECT_EQ(code_of([&] { collected(sweep_rows(path("a.db"))); }), "U021") << damage;
    make("b.db", {{"p2", 1e6}});
    EXPECT_EQ(code_of([&] { SweepStore(path("b.db"), SweepAccess::go_on).merge(path("a.db")); }), "U021")
        << damage;
    EXPECT_EQ(collected(sweep_rows(path("b.db"))).rows.size(), 1u) << "something was merged: " << damage;
    fs::remove(path("a.db"));
    fs::remove(path("b.db"));
  }
}

TEST_F(SweepStoreTest, PassThatNoSweepWritesIsNotMerged) {
  make("a.db", {{"p1", 1e6}});
  make("b.db", {});
  Database(path("a.db"), Database::Mode::write).execute("UPDATE pass SET time_ms = -1.0");
  EXPECT_EQ(code_of([&] { SweepStore(path("b.db"), SweepAccess::go_on).merge(path("a.db")); }), "U021");
}

TEST_F(SweepStoreTest, BytesThatAreNoTextDoNotReachJson) {
  make("a.db", {{"p1", 1e6}});
  Database(path("a.db"), Database::Mode::write)
      .execute("UPDATE point SET message = CAST(x'1b5b324aff' AS TEXT)");
  std::string text, json;
  write_text(sweep_rows(path("a.db")), [&](std::string_view piece) { text += piece; });
  write_json(sweep_rows(path("a.db")), [&](std::string_view piece) { json += piece; });
  EXPECT_NE(text.find("\\x1b[2J\\xff"), std::string::npos) << text;
  EXPECT_EQ((text + json).find('\x1b'), std::string::npos);
  EXPECT_EQ(json.find('\xff'), std::string::npos);
}

TEST_F(SweepStoreTest, PointsOfAnotherBuildAreReadAndNotMixed) {
  make("a.db", {{"p1", 1e6}});
  make("b.db", {{"p2", 1e6}});
  Database(path("a.db"), Database::Mode::write)
      .execute("UPDATE sweep SET value = '0123' WHERE key = 'model_version'");
  EXPECT_EQ(collected(sweep_rows(path("a.db"))).rows.size(), 1u);
  const std::string before = files().at("a.db");
  EXPECT_EQ(code_of([&] { SweepStore(path("a.db"), SweepAccess::go_on); }), "U021");
  EXPECT_EQ(files().at("a.db"), before) << "not even the mode of its journal";
  EXPECT_EQ(code_of([&] { SweepStore(path("b.db"), SweepAccess::go_on).merge(path("a.db")); }), "U021");
  EXPECT_EQ(SweepStore(path("a.db"), SweepAccess::replace).states()["done"], 0u);
  EXPECT_EQ(SweepStore(path("b.db"), SweepAccess::go_on).merge(path("a.db")), 0u)
      << "it is of this build now";
}

}  // namespace
}  // namespace hwsim::lab
