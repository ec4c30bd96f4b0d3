// Everything that is cached is checked when it is read: damage costs time, never an answer.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>

#include "lab/lab.h"
#include "lab/workbench.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;
using test::Listener;
using test::Workbench;

class CachedFiles : public ::testing::Test {
 protected:
  struct Answer {
    double time_ms = 0.0, psnr_db = 0.0;
    std::vector<std::string> codes;
  };
  /// A lab of its own, as a new process has one.
  Answer run(const std::string& cache) const {
    Request request = bench.request();
    request.settings.reference_samples = 4;
    request.settings.images = true;
    Listener listener;
    const auto answer = Lab({.cache_folder = cache, .observer = &listener}).run(request);
    const Result& result = answer.results.front();
    return {result.frame.time_ms, result.image->psnr_db, listener.reported};
  }
  static void expect_same(const Answer& answer, const Answer& first, const std::string& what) {
    EXPECT_EQ(answer.time_ms, first.time_ms) << what;
    EXPECT_EQ(answer.psnr_db, first.psnr_db) << what;
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(bench.path("cache")))
      if (entry.is_regular_file()) found.push_back(entry.path());
    return found;
  }

  Workbench bench;
};

void change_byte(const fs::path& path, std::uintmax_t at) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(static_cast<std::streamoff>(at));
  const char old = static_cast<char>(file.get());
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(old ^ 0x10));
}

TEST_F(CachedFiles, OneChangedBitOfAnyFileIsNotedAndChangesNoAnswer) {
  fs::last_write_time(bench.path("triangle.gltf"), fs::file_time_type::clock::now() - std::chrono::hours(1));
  const Answer first = run(bench.path("cache"));
  run(bench.path("cache"));  // the scene's summary is kept where its file was not written just now
  std::set<std::string> kinds;
  for (const fs::path& path : files()) {
    kinds.insert(path.extension().string());
    for (const std::uintmax_t at : {std::uintmax_t{3}, fs::file_size(path) / 2, fs::file_size(path) - 1}) {
      change_byte(path, at);
      const Answer again = run(bench.path("cache"));
      const std::string what = path.string() + " byte " + std::to_string(at);
      expect_same(again, first, what);
      if (path.has_extension()) {  // the seconds that a run took are an estimate: none is no news
        EXPECT_NE(std::ranges::find(again.codes, "K001"), again.codes.end()) << what;
      }
      const std::vector<std::string> codes = run(bench.path("cache")).codes;
      EXPECT_EQ(std::ranges::find(codes, "K001"), codes.end()) << what << " was not made anew";
    }
  }
  for (const char* kind : {".trace", ".image", ".truth"}) EXPECT_TRUE(kinds.contains(kind)) << kind;
}

TEST_F(CachedFiles, NobodyElseMayLookIntoTheirFolders) {
  run(bench.path("cache"));
  for (const fs::path& path : files()) {
    struct stat status {};
    ASSERT_EQ(::stat(path.parent_path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, 0700u) << path;
  }
}

TEST_F(CachedFiles, FolderThatCannotBeMadeIsNotedAndTheReferenceIsThere) {
  const Answer first = run(bench.path("cache"));
  std::ofstream(bench.path("file")) << "in the way";
  const Answer without = run(bench.path("file/cache"));
  expect_same(without, first, "without a cache");
  EXPECT_NE(std::ranges::find(without.codes, "K002"), without.codes.end());
}

TEST_F(CachedFiles, UnfinishedFilesOfKilledWritersAreRemoved) {
  run(bench.path("cache"));
  const std::size_t before = files().size();
  std::ofstream(bench.path("cache/traces/0123.trace.hwsim-tmp-0")) << "half";
  EXPECT_EQ(Lab({.cache_folder = bench.path("cache")}).cache().remove_abandoned(), 1u);
  EXPECT_EQ(files().size(), before);
}

}  // namespace
}  // namespace hwsim::lab
