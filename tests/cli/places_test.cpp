// Where answers go: a file is made or replaced, whatever else stands under the name stays what it is.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <functional>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

namespace fs = std::filesystem;

class PlacesTest : public testing::Test {
 protected:
  PlacesTest() {
    place.write("triangle.gltf", kTriangleGltf);
    EXPECT_EQ(place.hwsim("run triangle.gltf --resolution 64x48 --no-image --out ran").status, 0);
  }

  /// Each command that writes one file, here to P.
  static std::vector<std::string> writers() {
    return {"report ran -o P",
            "gpu new cut --like gtx980 --sms 13 --out P",
            "run triangle.gltf --resolution 64x48 --no-image --out again --report P",
            "compare triangle.gltf -t none,msaa4x --resolution 64x48 --report P",
            "sweep triangle.gltf --resolution 64x48 --plan P",
            "list gpus --format csv=P"};
  }

  /// The command ends at once, in one message with place and remedy.
  void expect_refused(const std::string& arguments) {
    const Outcome outcome = place.shell("timeout 60 hwsim " + arguments);
    EXPECT_EQ(outcome.status, 3) << arguments << outcome.err;
    EXPECT_NE(outcome.err.find("error[U010]: cannot write `P`: "), std::string::npos)
        << arguments << outcome.err;
    EXPECT_NE(outcome.err.find("= help: "), std::string::npos) << arguments << outcome.err;
    EXPECT_FALSE(fs::exists(place / "again")) << "told after the work: " << arguments;
  }

  /// Every writer, with --force and without, leaves what `make` puts to P.
  void expect_kept(const std::vector<std::string>& commands, const std::function<void()>& make) {
    make();
    const auto type = [&] { return fs::symlink_status(place / "P").type(); };
    const fs::file_type before = type();
    const std::string listing = place.listing();
    for (const std::string& command : commands)
      for (const char* flag : {"", " --force"}) {
        expect_refused(command + flag);
        EXPECT_EQ(type(), before) << command << flag;
        EXPECT_EQ(place.listing(), listing) << command << flag;
      }
  }

  Workplace place;
};

TEST_F(PlacesTest, PipeThatNobodyReadsIsRefused) {
  expect_kept(writers(), [&] { ASSERT_EQ(::mkfifo((place / "P").c_str(), 0600), 0); });
}

TEST_F(PlacesTest, FolderIsRefused) {
  expect_kept(writers(), [&] { fs::create_directory(place / "P"); });
}

TEST_F(PlacesTest, LinkToItselfIsRefused) {
  expect_kept(writers(), [&] { fs::create_symlink("P", place / "P"); });
}

TEST_F(PlacesTest, DeviceIsReplacedByNoPageAndNoGpu) {
  if (::mknod((place / "P").c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) GTEST_SKIP() << "needs root";
  std::vector<std::string> pages = writers();
  pages.resize(4);  // the other ones give a device their text
  expect_kept(pages, [] {});
  EXPECT_EQ(place.hwsim("list gpus --format csv=P --force").status, 0);
  EXPECT_TRUE(fs::is_character_file(place / "P"));
}

TEST_F(PlacesTest, FileBehindALinkIsReplacedAndTheLinkStays) {
  fs::create_directory(place / "below");
  for (const std::string& command : writers())
    for (const bool is_there : {true, false}) {
      fs::remove_all(place / "again");
      fs::remove(place / "P");
      fs::remove(place / "below/target");
      fs::create_symlink("below/target", place / "P");
      if (is_there) place.write("below/target", "old");
      EXPECT_EQ(place.hwsim(command + " --force").status, 0) << command;
      EXPECT_TRUE(fs::is_symlink(place / "P")) << command;
      EXPECT_GT(place.read("below/target").size(), 3u) << command;
      EXPECT_EQ(place.listing("below"), "target") << command;
    }
}

TEST_F(PlacesTest, PipeThatIsReadGetsTheAnswer) {
  ASSERT_EQ(::mkfifo((place / "P").c_str(), 0600), 0);
  // The shell itself reads, so that no reader comes late on a busy machine; the pipe holds the whole answer.
  const Outcome outcome =
      place.shell("exec 3<>P; timeout 60 hwsim list papers --format csv=P --force && head -n 1 <&3");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, place.shell("hwsim list papers --format csv | head -n 1").out);
}

// A list of the manifest where a text belongs was an internal error.
TEST_F(PlacesTest, ReportOfADamagedManifestNamesFileAndField) {
  ASSERT_EQ(place.hwsim("run triangle.gltf -t none,msaa4x --resolution 64x48 --no-image --out two").status,
            0);
  const std::string none = R"({"technique": "none"})";
  for (const auto& [manifest, field] : std::initializer_list<std::pair<std::string, std::string>>{
           {R"({"points": [)" + none + R"(, {"technique": []}]})", "`points[1].technique` is no text"},
           {R"({"points": [)" + none + R"(, {}]})", "`points[1].technique` is no text"},
           {R"({"points": [7]})", "`points[0].technique` is no text"},
           {R"({"points": {}})", "`points` is no list"},
           {"[]", "it is no JSON object"},
           {"{", "it is no JSON object"}}) {
    place.write("two/manifest.json", manifest);
    const Outcome outcome = place.hwsim("report two -o x.html");
    EXPECT_EQ(outcome.status, 3) << manifest;
    EXPECT_NE(outcome.err.find("error[U020]: `two/manifest.json` is damaged: " + field), std::string::npos)
        << manifest << outcome.err;
    EXPECT_NE(outcome.err.find("= help: "), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(place / "x.html"));
  }
}

}  // namespace
}  // namespace hwsim::cli::test
