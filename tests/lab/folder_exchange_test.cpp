// How results take the place of earlier ones, and what is done with what killed runs left.
#include "lab/results/folder_exchange.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <thread>

#include "hwsim/base/diagnostics.h"
#include "lab/results/run_directory.h"
#include "lab/workbench.h"
#include "pipeline/base/file_descriptor.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;
using test::Workbench;

class FolderExchange : public ::testing::Test {
 protected:
  fs::path make(const std::string& name, const std::string& content) const {
    const fs::path folder = bench.path(name);
    fs::create_directories(folder);
    std::ofstream(folder / "result.txt") << content;
    std::ofstream(folder / "manifest.json") << R"({"written_by": "hwsim fit"})";
    return folder;
  }
  static std::string content_of(const fs::path& folder) {
    std::string text;
    std::ifstream(folder / "result.txt") >> text;
    return text;
  }
  std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(bench.path("")), fs::directory_iterator()));
  }
  OutPlace place(bool force) const { return {bench.path("results"), force}; }

  Workbench bench;
};

TEST_F(FolderExchange, BothWaysPutTheNewFolderInPlaceAndKeepTheOldOne) {
  for (const auto exchange : {exchange_folders, exchange_in_steps}) {
    const fs::path fresh = make("fresh", "new"), old = make("results", "old");
    EXPECT_FALSE(exchange(fresh, old));
    EXPECT_EQ(content_of(old), "new");
    EXPECT_EQ(content_of(fresh), "old");
  }
}

TEST_F(FolderExchange, OldResultsComeBackWhereTheNewOnesCannotTakeTheirPlace) {
  const fs::path old = make("results", "old");
  EXPECT_TRUE(exchange_in_steps(bench.path("none"), old)) << "there was nothing to put in place";
  EXPECT_EQ(content_of(old), "old");
}

TEST_F(FolderExchange, ForcedRunReplacesTheOldResultsAndLeavesNothingBeside) {
  make("results", "old");
  const std::size_t before = entries();
  {
    RunDirectory run(place(true), "id");
    std::ofstream(run.path("result.txt")) << "new";
    EXPECT_EQ(content_of(bench.path("results")), "old") << "until it is complete";
    run.commit();
  }
  EXPECT_EQ(content_of(bench.path("results")), "new");
  EXPECT_FALSE(fs::exists(fs::path(bench.path("results")) / kUnfinishedMark));
  EXPECT_EQ(entries(), before);
}

TEST_F(FolderExchange, RunThatIsNotCommittedKeepsTheOldResults) {
  make("results", "old");
  const std::size_t before = entries();
  { const RunDirectory run(place(true), "id"); }
  EXPECT_EQ(content_of(bench.path("results")), "old");
  EXPECT_EQ(entries(), before);
}

TEST_F(FolderExchange, LinkToResultsIsReplacedAndItsTargetStays) {
  make("elsewhere", "old");
  fs::create_directory_symlink(bench.path("elsewhere"), bench.path("results"));
  RunDirectory run(place(true), "id");
  std::ofstream(run.path("result.txt")) << "new";
  run.commit();
  EXPECT_EQ(content_of(bench.path("results")), "new");
  EXPECT_EQ(content_of(bench.path("elsewhere")), "old");
}

TEST_F(FolderExchange, WhatKilledRunsLeftIsRemovedByTheNext) {
  std::ofstream(make(".results.partial-4711", "half") / kUnfinishedMark);
  fs::remove(fs::path(bench.path(".results.partial-4711")) / "manifest.json");
  make(".results.partial-12", "old, was being removed");
  const pid_t ended = ::fork();
  if (ended == 0) ::_exit(0);
  ::waitpid(ended, nullptr, 0);
  fs::create_directories(bench.path(".results.partial-" + std::to_string(ended)));
  EXPECT_EQ(clear_abandoned(bench.path("")), 3u);
  EXPECT_EQ(entries(), 1u) << "the scene alone";
}

TEST_F(FolderExchange, ResultThatHadSteppedAsideComesBack) {
  make(".results.old-4711", "old");
  EXPECT_EQ(clear_abandoned(bench.path("")), 1u);
  EXPECT_EQ(content_of(bench.path("results")), "old");
  make(".results.old-4712", "older");
  EXPECT_EQ(clear_abandoned(bench.path("")), 1u);
  EXPECT_EQ(content_of(bench.path("results")), "old") << "its place is taken: the older one goes";
}

// Web pages and browser extensions have a manifest.json, too.
TEST_F(FolderExchange, ManifestOfAnotherProgramMakesNoFolderOfResults) {
  for (const char* manifest : {R"({"name": "a page"})", "{}", "[]", "", R"({"written_by": "somebody"})"}) {
    for (const char* name : {"results", ".results.partial-12", ".other.old-12"}) {
      make(name, "precious");
      std::ofstream(fs::path(bench.path(name)) / "manifest.json") << manifest;
    }
    EXPECT_THROW(RunDirectory(place(true), "id"), InputError) << manifest;
    EXPECT_EQ(clear_abandoned(bench.path("")), 0u) << manifest;
    for (const char* name : {"results", ".results.partial-12", ".other.old-12"})
      EXPECT_EQ(content_of(bench.path(name)), "precious") << manifest;
  }
}

TEST_F(FolderExchange, UnfinishedFolderGoesWhileAThreadWritesIntoIt) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    const fs::path folder = bench.path(".results.partial-4711");
    fs::create_directories(folder);
    std::ofstream(folder / kUnfinishedMark);
    std::atomic<bool> ends{false};
    std::thread writer([&] {
      for (int i = 0; !ends; ++i) std::ofstream(folder / std::to_string(i)) << i;
    });
    remove_unfinished(folder);
    ends = true;
    writer.join();
    EXPECT_EQ(entries(), 1u) << "the scene alone";
  }
}

TEST_F(FolderExchange, FoldersOfOthersAndOfLivingRunsStay) {
  const std::vector<std::string> names = {".results.partial-x", "results.partial-12", ".partial-12",
                                          ".results.partial-12y"};
  for (const std::string& name : names) make(name, "of another program");
  const fs::path no_mark = make(".thesis.partial-12", "a thesis");
  fs::remove(no_mark / "manifest.json");
  fs::create_directories(bench.path(".results.partial-" + std::to_string(::getpid())));  // not locked yet
  const fs::path living = make(".results.partial-13", "half");
  const pipeline::FileDescriptor lock(::open(living.c_str(), O_RDONLY | O_DIRECTORY));
  ASSERT_TRUE(lock.lock());
  EXPECT_EQ(clear_abandoned(bench.path("")), 0u);
  EXPECT_EQ(entries(), 1 + names.size() + 3);
}

}  // namespace
}  // namespace hwsim::lab
