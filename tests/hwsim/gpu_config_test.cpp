// GPU files: layers, errors with code, place and hint, text that loads again.
#include "hwsim/gpu/gpu_config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "hwsim/base/diagnostics.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/gpu_rates.h"
#include "hwsim/gpu/sheet_words.h"
#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

namespace fs = std::filesystem;

class GpuFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    dir_ = fs::path(::testing::TempDir()) / (std::string("hwsim_gpu_") + test->name());
    fs::remove_all(dir_);
    fs::create_directories(dir_);
    write("base", show(sample_gpu(), false));
  }
  void TearDown() override { fs::remove_all(dir_); }

  std::string write(const std::string& id, const std::string& text) {
    const fs::path path = dir_ / (id + ".toml");
    std::ofstream(path) << text;
    return path.string();
  }
  std::string write_child(const std::string& id, const std::string& rest) {
    return write(id, "schema = 1\nkind = \"gpu\"\nextends = \"base\"\n" + rest);
  }
  GpuConfig load(const std::string& id, std::vector<Assignment> sets = {},
                 std::vector<std::string> overlays = {}) {
    return load_gpu(id, overlays, sets, dir_.string());
  }
  std::vector<Diagnostic> errors_of(const std::string& id, std::vector<Assignment> sets = {},
                                    std::vector<std::string> overlays = {}) {
    try {
      load(id, sets, overlays);
    } catch (const InputError& error) {
      EXPECT_EQ(error.status(), ExitStatus::invalid_input);
      return error.diagnostics();
    }
    return {};
  }
  /// The only error of a child file with these lines.
  Diagnostic error_in(const std::string& rest) {
    write_child("child", rest);
    const auto errors = errors_of("child");
    EXPECT_EQ(errors.size(), 1u) << rest;
    return errors.empty() ? Diagnostic{} : errors[0];
  }

  fs::path dir_;
};

TEST_F(GpuFiles, LayersOverrideInOrderAndOriginsSayWhich) {
  write_child("child",
              "core_clock_mhz = 1100\nl2_size_kib = { value = 900, provenance = \"fitted\", source = \"t3\", "
              "interval = [800, 1000] }\ndraw_cycles = 1\ncrop_units = 41\n");
  const std::string overlay =
      write("over", "schema = 1\nkind = \"overlay\"\ndraw_cycles = 2\ncrop_units = 42\n");
  const GpuConfig c =
      load("child", {{"gpu.crop_units", "43"}, {"gpu.crop_units", "44"}, {"technique.x", "1"}}, {overlay});
  EXPECT_EQ(c.id, "child");
  EXPECT_EQ(c.core_clock_mhz, 1100.0);
  EXPECT_EQ(c.l2_size_kib, 900.0);
  EXPECT_EQ(c.draw_cycles, 2.0);
  EXPECT_EQ(c.crop_units, 44.0);
  EXPECT_EQ(c.tex_bilinear_per_clk, 40.0);
  EXPECT_EQ(c.origins.at("core_clock_mhz").to_string(), "child.toml:4");
  EXPECT_EQ(c.origins.at("l2_size_kib").to_string(), "child.toml:5, fitted t3");
  EXPECT_EQ((*c.origins.at("l2_size_kib").interval)[1], 1000.0);
  EXPECT_EQ(c.origins.at("draw_cycles").layer, Origin::Layer::overlay);
  EXPECT_EQ(c.origins.at("crop_units").to_string(), "--set");
  EXPECT_EQ(c.origins.at("tex_bilinear_per_clk").layer, Origin::Layer::parent);
}

TEST_F(GpuFiles, GrandparentsAndRelativePathsAreFound) {
  write_child("child", "draw_cycles = 5\n");
  fs::create_directories(dir_ / "mine");
  write("mine/grandchild",
        "schema = 1\nkind = \"gpu\"\nextends = \"../child.toml\"\ndram_bandwidth_gb_s = 7\n");
  const GpuConfig c = load((dir_ / "mine/grandchild.toml").string());
  EXPECT_EQ(c.draw_cycles, 5.0);
  EXPECT_EQ(c.dram_bandwidth_gb_s, 7.0);
  EXPECT_EQ(c.id, "grandchild");
}

TEST_F(GpuFiles, DerivedRatesFollowEveryOverride) {
  const GpuConfig base = load("base"), fast = load("base", {{"gpu.core_clock_mhz", "2000"}});
  EXPECT_DOUBLE_EQ(derive_rates<double>(fast).color_px_ns[0],
                   derive_rates<double>(base).color_px_ns[0] / 2.0);
  EXPECT_DOUBLE_EQ(derive_rates<double>(fast).bilinear_probe_ns,
                   derive_rates<double>(base).bilinear_probe_ns / 2.0);
  EXPECT_DOUBLE_EQ(derive_rates<double>(fast).dram_byte_ns, derive_rates<double>(base).dram_byte_ns);
}

TEST_F(GpuFiles, UnknownKeyNamesTheNearestAndTheInheritedValue) {
  const Diagnostic d = error_in("\ncrop_unit = 16\n");
  EXPECT_EQ(d.code, "C012");
  EXPECT_EQ(d.message, "unknown key `crop_unit` in gpu \"child\"");
  EXPECT_EQ(d.place.line, 5);
  EXPECT_EQ(d.place.column, 1);
  EXPECT_EQ(d.place.length, 9);
  EXPECT_EQ(d.place.line_text, "crop_unit = 16");
  EXPECT_EQ(d.hint, "did you mean `crop_units`?");
  ASSERT_EQ(d.notes.size(), 1u);
  EXPECT_TRUE(d.notes[0].starts_with("inherited value 40.0 from base.toml:")) << d.notes[0];
  EXPECT_FALSE(d.help.empty());
}

TEST_F(GpuFiles, KeysOfAnotherUnitAreHintedWithTheNumber) {
  const std::pair<const char*, const char*> hints[] = {
      {"core_clock_ghz = 2.6", "did you mean `core_clock_mhz`, in MHz: 2600?"},
      {"clock_ghz = 1", "did you mean `clock_mhz`, in MHz: 1000?"},
      {"l2_size_mib = 36", "did you mean `l2_size_kib`, in KiB: 36864?"},
      {"l2_size_mib = \"x2\"", "did you mean `l2_size_kib`, in KiB, 1024 times the number?"},
      {"dram_bandwidth_tb_s = 0.64", "did you mean `dram_bandwidth_gb_s`, in GB/s: 640?"},
      {"infinity_cache_kib = 65536", "did you mean `infinity_cache_mib`, in MiB: 64?"},
      {"pass_overhead_ns = 4000", "did you mean `pass_overhead_us`, in us: 4?"},
      {"core_clock = 2600", "did you mean `core_clock_mhz`?"}};
  for (const auto& [line, hint] : hints) EXPECT_EQ(error_in(std::string(line) + "\n").hint, hint) << line;
}

TEST_F(GpuFiles, FeatureWithoutItsTableIsRecognized) {
  EXPECT_EQ(error_in("float_atomics = true\n").hint, "did you mean `features.float_atomics`?");
  EXPECT_EQ(error_in("[featuers]\nfloat_atomics = true\n").hint, "did you mean `features.float_atomics`?");
}

TEST_F(GpuFiles, WrongTypesAndRangesPointAtTheValue) {
  const struct {
    const char* line;
    const char* code;
    int column;
  } cases[] = {{"core_clock_mhz = -5", "C014", 18},
               {"core_clock_mhz = \"fast\"", "C013", 18},
               {"core_clock_mhz = nan", "C014", 18},
               {"core_clock_mhz = inf", "C014", 18},
               {"core_clock_mhz = [1, 2]", "C013", 18},
               {"crop_units = 2.5", "C013", 14},
               {"tile_based = 1", "C013", 14},
               {"title = 3", "C013", 9},
               {"crop_efficiency_ratio = 1.5", "C014", 25},
               {"queue_packets = 1e9", "C014", 17},
               {"core_clock_mhz = { value = 0 }", "C014", 28},
               {"core_clock_mhz = 99999999999999999999", "C011", 18}};
  for (const auto& c : cases) {
    const Diagnostic d = error_in(std::string(c.line) + "\n");
    EXPECT_EQ(d.code, c.code) << c.line << ": " << d.message;
    EXPECT_EQ(d.place.line, 4) << c.line;
    if (d.code != "C011") {
      EXPECT_EQ(d.place.column, c.column) << c.line;
    }
    EXPECT_EQ(d.place.line_text, c.line);
  }
}

TEST_F(GpuFiles, TablesOfValuesAreChecked) {
  EXPECT_EQ(error_in("draw_cycles = { value = 1, provenance = \"fited\" }\n").hint, "did you mean `fitted`?");
  EXPECT_EQ(error_in("draw_cycles = { value = 1, sourec = \"x\" }\n").hint, "did you mean `source`?");
  for (const char* bad :
       {"{ value = 1, interval = [2, 3] }", "{ value = 1, interval = [3, 1] }", "{ value = 1, interval = 1 }",
        "{ value = 1, interval = [0, nan] }", "{ value = 1, source = 5 }", "{ value = 1, provenance = 1 }"})
    EXPECT_EQ(error_in("draw_cycles = " + std::string(bad) + "\n").code, "C022") << bad;
}

TEST_F(GpuFiles, MissingKeysAreAllNamed) {
  write("empty", "schema = 1\nkind = \"gpu\"\n");
  const auto errors = errors_of("empty");
  std::size_t required = 0;
  for (const KeyInfo& info : gpu_keys()) required += info.has(kRequired) ? 1 : 0;
  EXPECT_EQ(errors.size(), required);
  for (const Diagnostic& d : errors) {
    EXPECT_EQ(d.code, "C015");
    EXPECT_EQ(d.place.file, (dir_ / "empty.toml").string());
  }
}

TEST_F(GpuFiles, UnknownGpuNamesTheNearest) {
  const auto errors = errors_of("bsae");
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].code, "C016");
  EXPECT_EQ(errors[0].hint, "did you mean `base`?");
  EXPECT_EQ(errors_of("no/such.toml").at(0).code, "C010");
  EXPECT_EQ(errors_of("base", {}, {"no_such_overlay.toml"}).at(0).code, "C010");
  EXPECT_EQ(errors_of(dir_.string() + "/").at(0).code, "C010");
}

TEST_F(GpuFiles, CirclesOfExtendsAreFound) {
  write("a", "schema = 1\nkind = \"gpu\"\nextends = \"b\"\n");
  write("b", "schema = 1\nkind = \"gpu\"\nextends = \"a\"\n");
  const auto errors = errors_of("a");
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].code, "C017");
  EXPECT_EQ(errors[0].place.line, 3);
  write("c", "schema = 1\nkind = \"gpu\"\nextends = \"c\"\n");
  EXPECT_EQ(errors_of("c").at(0).code, "C017");
}

TEST_F(GpuFiles, RulesOverSeveralKeysNameThemAll) {
  const auto errors = errors_of("base", {{"gpu.vliw_slots", "3"},
                                         {"gpu.vliw_fill_slots", "4"},
                                         {"gpu.subgroup_size", "48"},
                                         {"gpu.features.native_msaa_max", "6"}});
  ASSERT_EQ(errors.size(), 3u);
  for (const Diagnostic& d : errors) EXPECT_EQ(d.code, "C018");
  ASSERT_EQ(errors[1].notes.size(), 2u);
  EXPECT_EQ(errors[1].notes[0], "vliw_fill_slots = 4.0 (--set)");
  EXPECT_EQ(errors[1].notes[1], "vliw_slots = 3.0 (--set)");
}

TEST_F(GpuFiles, AllErrorsComeTogetherInTheOrderOfTheLayers) {
  write_child("child", "bogus_key = 1\ndraw_cycles = -1\n[features]\nfloat_atomics = 3\n");
  const auto errors = errors_of("child", {{"gpu.crop_unitz", "1"}, {"gpu.l2_size_kib", "big"}});
  ASSERT_EQ(errors.size(), 5u);
  EXPECT_EQ(errors[0].code, "C012");
  EXPECT_EQ(errors[1].place.line_text, "--set gpu.crop_unitz=1");
  std::string all;
  for (const Diagnostic& d : errors) all += render(d, false);
  for (const char* part : {"bogus_key", "draw_cycles", "float_atomics", "l2_size_kib", "(command line):1:7"})
    EXPECT_NE(all.find(part), std::string::npos) << part << "\n" << all;
}

TEST_F(GpuFiles, HeadersAreChecked) {
  for (const char* text :
       {"kind = \"gpu\"\nextends = \"base\"\n", "schema = 2\nkind = \"gpu\"\nextends = \"base\"\n",
        "schema = 1\nkind = \"run\"\nextends = \"base\"\n", "schema = 1\nextends = \"base\"\n",
        "schema = 1\nkind = \"gpu\"\nextends = \"base\"\nid = 7\n"}) {
    write("child", text);
    const auto errors = errors_of("child");
    ASSERT_EQ(errors.size(), 1u) << text;
    EXPECT_EQ(errors[0].code, "C019");
  }
  const std::string overlay = write("over", "schema = 1\nkind = \"overlay\"\nextends = \"base\"\n");
  EXPECT_EQ(errors_of("base", {}, {overlay}).at(0).code, "C019");
}

TEST_F(GpuFiles, CutOffAnywhereTheyLoadOrEndInAnInputError) {
  const std::string text = show(sample_gpu(), true);
  for (std::size_t n = 0; n < text.size(); n += 3) {
    write("cut", text.substr(0, n));
    EXPECT_FALSE(errors_of("cut").empty() && n < text.size() / 2) << n;
  }
  for (const char* garbage :
       {"\xff\xfe", "[[a]]\n[a]\nb=1", "a.b.c = 1\na.b = 2", "= 1", "x = \"\\u0000\"", "value = 1"}) {
    write("cut", garbage);
    EXPECT_FALSE(errors_of("cut").empty());
  }
}

TEST_F(GpuFiles, ShowLoadsAgainToTheSameNumbersAndOrigins) {
  write_child("child",
              "title = \"quo\\\"te\\nline\"\nl2_size_kib = { value = 900.1, provenance = \"fitted\", source "
              "= \"a\\nb\", "
              "interval = [800, 1000] }\nshader_clock_ratio = 2.0016474464579903\n");
  const GpuConfig first = load("child");
  for (const bool with_origin : {false, true}) {
    write("again", show(first, with_origin));
    const GpuConfig second = load("again");
    EXPECT_EQ(content_hash(second), content_hash(first));
    EXPECT_EQ(second.title, first.title);
    EXPECT_EQ(second.origins.at("l2_size_kib").source, "a\nb");
    EXPECT_EQ(*second.origins.at("l2_size_kib").provenance, Provenance::fitted);
    EXPECT_EQ(second.shader_clock_ratio, first.shader_clock_ratio);
  }
}

TEST_F(GpuFiles, HashesSeeNumbersAndOnlyTheirOwn) {
  const GpuConfig base = load("base");
  GpuConfig other = base;
  other.title = "another";
  EXPECT_EQ(content_hash(other), content_hash(base));
  other.dram_bandwidth_gb_s += 1e-9;
  EXPECT_NE(content_hash(other), content_hash(base));
  EXPECT_EQ(functional_hash(other), functional_hash(base));
  other.features.native_msaa_max = 4;
  EXPECT_NE(functional_hash(other), functional_hash(base));
}

TEST(GpuConfigInCode, IsValidatedLikeAFile) {
  GpuConfig c = sample_gpu();
  EXPECT_NO_THROW(validate(c));
  c.core_clock_mhz = -1;
  c.crop_units = 2.5;
  try {
    validate(c);
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 2u);
    EXPECT_EQ(error.diagnostics()[0].code, "C014");
    EXPECT_EQ(error.diagnostics()[1].code, "C013");
  }
}

TEST(GpuSchema, ListsEveryKeyWithItsRange) {
  const auto schema = nlohmann::json::parse(gpu_schema_json());
  for (const KeyInfo& info : gpu_keys()) {
    const std::string name(info.name);
    const auto dot = name.find('.');
    const auto& properties = schema.at("properties");
    const auto& key = dot == std::string::npos
                          ? properties.at(name)
                          : properties.at(name.substr(0, dot)).at("properties").at(name.substr(dot + 1));
    EXPECT_FALSE(key.at("description").get<std::string>().empty());
    EXPECT_EQ(key.contains("default"), !info.has(kRequired)) << name;
  }
  EXPECT_EQ(schema.at("properties").at("core_clock_mhz").at("anyOf").at(0).at("minimum"), 1.0);
}

TEST_F(GpuFiles, WordsOfDataSheetsAreKeys) {
  write_child("child",
              "rops = 48\ntmus = { value = 96, interval = [90, 100] }\nsms = 12\ninfinity_cache = 2\n");
  const GpuConfig c = load("child", {{"gpu.bandwidth_gb_s", "300"}, {"gpu.sms", "x2"}});
  EXPECT_EQ(c.crop_units, 48.0);
  EXPECT_EQ(c.tex_bilinear_per_clk, 96.0);
  EXPECT_EQ(c.shader_cores, 24.0);
  EXPECT_EQ(c.llc_size_kib, 2048.0);
  EXPECT_EQ(c.dram_bandwidth_gb_s, 300.0);
  EXPECT_EQ(c.origins.find("tex_bilinear_per_clk")->second.interval, (std::array<double, 2>{90.0, 100.0}));
  EXPECT_EQ(load("base", {{"gpu.l2_mib", "3"}}).l2_size_kib, 3072.0);
  EXPECT_EQ(load("base", {{"gpu.cus", "9"}}).shader_cores, 9.0);
  for (const SheetWord& word : sheet_words()) {
    const auto keys = gpu_keys();
    EXPECT_TRUE(std::ranges::any_of(keys, [&](const KeyInfo& key) { return key.name == word.key; }))
        << word.word;
    EXPECT_TRUE(std::ranges::none_of(keys, [&](const KeyInfo& key) { return key.name == word.word; }))
        << word.word;
  }
}

TEST_F(GpuFiles, MessagesNameTheWordAndTheKey) {
  const Diagnostic twice = error_in("rops = 48\ncrop_units = 32\n");
  EXPECT_EQ(twice.code, "C025");
  EXPECT_NE(twice.message.find("`crop_units` and `rops`"), std::string::npos) << twice.message;
  const Diagnostic range = error_in("rops = -1\n");
  EXPECT_EQ(range.code, "C014");
  ASSERT_FALSE(range.notes.empty());
  EXPECT_NE(range.notes.back().find("`rops` of data sheets is the key `crop_units`"), std::string::npos);
  EXPECT_EQ(error_in("infinity_cach = 64\n").hint, "did you mean `infinity_cache` or `infinity_cache_mib`?");
}

TEST(GpuKeys, CarryTheirUnitAndEveryCodeIsExplained) {
  for (const KeyInfo& info : gpu_keys()) EXPECT_FALSE(info.description.empty() || info.name.empty());
  std::string before;
  for (const ConfigCode& code : config_codes()) {
    EXPECT_LT(before, code.code);
    EXPECT_FALSE(code.explanation.empty());
    before = code.code;
  }
}

}  // namespace
}  // namespace hwsim::test
