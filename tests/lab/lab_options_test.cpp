// What a lab is told when it is made: each keeps to its own folders and limits, and asks no environment.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "lab/lab.h"
#include "lab/workbench.h"
#include "support/places.h"

namespace hwsim::lab {
namespace {

using test::Workbench;
namespace fs = std::filesystem;

bool from_cache(const LabOptions& options, const Request& request) {
  return Lab(options).run(request).results.front().from_cache;
}

std::size_t files_in(const std::string& folder) {
  std::error_code none;
  std::size_t count = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, none))
    count += entry.is_regular_file() ? 1 : 0;
  return count;
}

/// A variable that has its old value again at the end.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { old_ ? setenv(name_, old_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

TEST(LabOptions, LabsWithTwoCacheFoldersDoNotTouchEachOther) {
  const Workbench bench;
  const LabOptions a{.cache_folder = bench.path("a")}, b{.cache_folder = bench.path("b")};
  EXPECT_FALSE(from_cache(a, bench.request()));
  EXPECT_GT(files_in(bench.path("a/traces")), 0u);
  EXPECT_FALSE(fs::exists(bench.path("b")));
  // Only what the other lab's runs leave is counted: a second run of this one may keep the scene's summary.
  std::size_t files = files_in(bench.path("a"));
  EXPECT_FALSE(from_cache(b, bench.request())) << "one lab read what the other keeps";
  EXPECT_EQ(files_in(bench.path("a")), files) << "one lab wrote where the other keeps";
  EXPECT_TRUE(from_cache(a, bench.request()));
  files = files_in(bench.path("a"));
  EXPECT_TRUE(from_cache(b, bench.request()));
  EXPECT_EQ(files_in(bench.path("a")), files) << "one lab wrote where the other keeps";
}

TEST(LabOptions, LabsInTurnKeepToTheirFolders) {
  const Workbench bench;
  Lab a({.cache_folder = bench.path("a")}), b({.cache_folder = bench.path("b")});
  Request request = bench.request();
  a.run(request);
  request.view.point_lights = 1;
  b.run(request);
  request.view.point_lights = 2;
  a.run(request);
  EXPECT_EQ(files_in(bench.path("a/traces")), 2u);
  EXPECT_EQ(files_in(bench.path("b/traces")), 1u);
  EXPECT_EQ(a.cache().files().front().path.string().rfind(bench.path("a"), 0), 0u);
}

TEST(LabOptions, LabWithoutACacheFolderLeavesNothing) {
  const Workbench bench;
  std::string folder;
  {
    Lab lab;
    lab.run(bench.request());
    folder = lab.cache().folder();
    EXPECT_GT(files_in(folder), 0u);
  }
  EXPECT_FALSE(folder.empty());
  EXPECT_FALSE(fs::exists(folder));
}

TEST(LabOptions, EachLabHasItsOwnLimitOfTheCache) {
  const Workbench bench;
  const LabOptions none{.cache_folder = bench.path("none"), .cache_limit_bytes = 0};
  EXPECT_FALSE(from_cache(none, bench.request()));
  EXPECT_EQ(files_in(bench.path("none/traces")), 0u);
  EXPECT_FALSE(from_cache(none, bench.request()));
  const LabOptions some{.cache_folder = bench.path("some")};
  EXPECT_FALSE(from_cache(some, bench.request()));
  EXPECT_TRUE(from_cache(some, bench.request()));
}

TEST(LabOptions, EachLabReadsItsOwnConfigFolder) {
  const Workbench bench;
  fs::create_directories(bench.path("configs/gpus"));
  fs::create_directories(bench.path("configs/overlays"));
  fs::copy(hwsim::test::source_dir() + "/configs/gpus/gtx980.toml", bench.path("configs/gpus/gtx980.toml"));
  std::ofstream(bench.path("configs/gpus/mine.toml"))
      << "schema = 1\nkind = \"gpu\"\nid = \"mine\"\nextends = \"gtx980\"\nl2_size_kib = 512\n";
  std::ofstream(bench.path("configs/overlays/half.toml"))
      << "schema = 1\nkind = \"overlay\"\nabout = \"half the clock\"\ncore_clock_mhz = \"x0.5\"\n";
  Lab own({.config_folder = bench.path("configs")}), usual;
  EXPECT_EQ(names_of(own.catalog().gpus()), (std::vector<std::string>{"gtx980", "mine"}));
  EXPECT_EQ(names_of(own.catalog().overlays()), std::vector<std::string>{"half"});
  EXPECT_EQ(names_of(usual.catalog().overlays()).size(), usual.catalog().folder().overlay_names().size());
  Request request = bench.request({"none"}, {"mine"});
  request.overlays = {"half"};
  EXPECT_EQ(own.run(request).results.front().frame.support, "uncalibrated");
  EXPECT_THROW(usual.run(request), InputError) << "the GPU of another lab was found";
  EXPECT_NE(usual.run(bench.request()).results.front().frame.support, "uncalibrated");
}

TEST(LabOptions, NoLabAsksTheEnvironment) {
  const Workbench bench;
  const Variable cache("HWSIM_CACHE", bench.path("of_environment"));
  const Variable configs("HWSIM_CONFIG_DIR", "/nowhere");
  const Variable limit("HWSIM_CACHE_MIB", "3");
  EXPECT_EQ(Lab().run(bench.request()).results.size(), 1u);
  EXPECT_FALSE(fs::exists(bench.path("of_environment")));
  const LabOptions options = options_of_environment();
  EXPECT_EQ(options.cache_folder, bench.path("of_environment"));
  EXPECT_EQ(options.config_folder, "/nowhere");
  EXPECT_EQ(options.cache_limit_bytes, 3u << 20);
  const Variable wrong("HWSIM_CACHE_MIB", "3x");
  EXPECT_THROW(options_of_environment(), InputError);
}

TEST(Catalog, EveryNameHasItsEntry) {
  const Lab lab;
  const Catalog& catalog = lab.catalog();
  for (const Table& table : {catalog.gpus(), catalog.scenes(), catalog.techniques(), catalog.counters(),
                             catalog.overlays(), catalog.published_tables()})
    EXPECT_FALSE(table.rows.empty()) << table.columns.back().title;
  for (const std::string& name : catalog.entry_names()) {
    const std::optional<CatalogEntry> entry = catalog.entry(name);
    ASSERT_TRUE(entry) << name;
    EXPECT_FALSE(entry->table.columns.empty()) << name;
  }
  EXPECT_FALSE(catalog.entry("gtx980")) << "a GPU has keys and an origin of each: see key_table";
  const std::vector<ErrorCode> codes = catalog.error_codes();
  for (std::size_t i = 1; i < codes.size(); ++i) EXPECT_LT(codes[i - 1].code, codes[i].code);
}

/// A rejection without a way on leaves the user alone; most messages cannot know one, their code does.
TEST(Catalog, EveryCodeOfAnErrorSaysHowToGoOn) {
  const auto is_note = [](std::string_view code) {
    return code[0] == 'K' || code[0] == 'P' || code.starts_with("S1") || code.starts_with("S3") ||
           code.starts_with("T1");
  };
  for (const ErrorCode& code : Lab().catalog().error_codes())
    EXPECT_NE(code.remedy.empty(), !is_note(code.code)) << code.code << " " << code.title;
}

TEST(SelfCheck, FindsWhatIsMissingAndGoesOn) {
  const Workbench bench;
  std::ofstream(bench.path("file")) << "in the way";
  const auto failed = [](const LabOptions& options) {
    std::vector<std::string> names;
    for (const SelfCheck& check : Lab(options).check_itself())
      if (!check.ok) names.push_back(check.name);
    return names;
  };
  EXPECT_EQ(failed({}), std::vector<std::string>{});
  EXPECT_EQ(failed({.cache_folder = bench.path("file/cache")}), std::vector<std::string>{"cache"});
  EXPECT_EQ(failed({.config_folder = "/nowhere"}), (std::vector<std::string>{"configs", "simulation"}));
}

}  // namespace
}  // namespace hwsim::lab
