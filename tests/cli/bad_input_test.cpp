// Every mistake ends in its exit status, one clear message with a code, and nothing written.
#include <gtest/gtest.h>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

struct Mistake {
  std::string name;
  std::string arguments;
  int status;
  std::string code;
  std::string says;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.arguments; }

class BadInput : public testing::TestWithParam<Mistake> {};

TEST_P(BadInput, EndsInItsStatusAndMessageAndWritesNothing) {
  const Workplace place;
  place.write("triangle.gltf", kTriangleGltf);
  place.write("bad.png", "not a picture");
  place.write("cut.glb", std::string("glTF\2\0\0\0\377\0\0\0", 12));
  place.write("bad.toml",
              "schema = 1\nkind = \"gpu\"\nid = \"bad\"\nextends = \"gtx980\"\ncore_clock_mzh = 1000\n");
  place.write("bad_run.toml",
              "schema = 1\nkind = \"run\"\nscene = \"triangle.gltf\"\nwidht_px = 64\nheight_px = 0\n");
  place.write("damaged.exr", std::string("\x76\x2f\x31\x01\2\0\0\0", 8));
  std::string counted = kTriangleGltf;
  place.write("count.gltf", counted.replace(counted.find("\"count\": 3"), 10, "\"count\": 9007199254740992"));
  place.write("price.toml",
              "schema = 1\nkind = \"prices\"\n[shader_cores]\narea = 1e308\nlow = 4\nhigh = 64\n");
  const std::string before = place.listing();
  const Outcome outcome = place.hwsim(GetParam().arguments);
  EXPECT_EQ(outcome.status, GetParam().status) << outcome.err;
  EXPECT_NE(outcome.err.find("error[" + GetParam().code + "]"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(GetParam().says), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("X001"), std::string::npos) << "a user's mistake shown as an internal error";
  EXPECT_EQ(place.listing(), before);
}

const Mistake kMistakes[] = {
    {"UnknownCommand", "rnu triangle.gltf", 2, "U001", "did you mean `run`"},
    {"NoCommand", "", 2, "U002", "no command"},
    {"EmptyArgument", "run triangle.gltf '' --camera", 2, "U003", "an argument is empty"},
    {"UnknownFlag", "run triangle.gltf --techniqe none", 2, "U001", "did you mean `--technique`"},
    {"MissingScene", "run", 2, "U002", "SCENE"},
    {"FlagWithoutValue", "run triangle.gltf --engine", 2, "U004", "--engine"},
    {"BadJobs", "run triangle.gltf --jobs 0", 2, "U003", "--jobs"},
    {"BadFormat", "list gpus --format cvs", 2, "U003", "did you mean `csv`"},
    {"BadColor", "list gpus --color purple", 2, "U003", "auto"},
    {"ResolutionZero", "run triangle.gltf --resolution 0x0", 2, "U005", "1 to 16384"},
    {"ResolutionHuge", "run triangle.gltf --resolution 100000x100000", 2, "U005", "1 to 16384"},
    {"ResolutionNoNumber", "run triangle.gltf --resolution wide", 2, "U005", "WIDTHxHEIGHT"},
    {"ResolutionOverflow", "run triangle.gltf --resolution 99999999999999999999x1", 2, "U005",
     "WIDTHxHEIGHT"},
    {"BadLights", "run triangle.gltf --lights 5000", 2, "U003", "--lights"},
    {"BadAnisotropy", "run triangle.gltf --anisotropy 17", 2, "U003", "--anisotropy"},
    {"BadAnisotropySet", "run triangle.gltf --set scene.anisotropy=0", 3, "C014", "between 1.0 and 16.0"},
    {"ExposureNan", "run triangle.gltf --exposure nan", 2, "U003",
     "--exposure is `nan`, must be a number from 1e-12 to 1e+12"},
    {"ExposureMinusNan", "run triangle.gltf --exposure=-nan", 2, "U003", "--exposure is `-nan`"},
    {"ExposureNanWithPayload", "run triangle.gltf --exposure 'nan(1)'", 2, "U003", "--exposure is `nan(1)`"},
    {"ExposureInf", "run triangle.gltf --exposure inf", 2, "U003", "--exposure is `inf`, must be"},
    {"ExposureZero", "run triangle.gltf --exposure 0", 2, "U003", "from 1e-12 to 1e+12"},
    {"TimeNan", "optimize triangle.gltf --prices example --time-ms nan", 2, "U003",
     "--time-ms is `nan`, must be a number from 1e-06 to 1e+09"},
    {"AreaNan", "optimize triangle.gltf --prices example --area nan", 2, "U003",
     "--area is `nan`, must be a number from 1e-06 to 1e+12"},
    {"AreaOfAPrice", "optimize triangle.gltf --prices price.toml --time-ms 1", 3, "C014",
     "`shader_cores.area` is 1e+308, must be a number from 0 to 1e+12"},
    {"ClockNan", "gpu new x --like gtx980 --clock nan", 2, "U003",
     "--clock is `nan`, must be a plain number of MHz"},
    {"LightsNan", "run triangle.gltf --lights nan", 2, "U003",
     "--lights is `nan`, must be a whole number from 0 to 1024"},
    {"BadSamples", "run triangle.gltf --reference 0", 2, "U003", "--reference"},
    {"ListNothing", "list gpu", 2, "U003", "did you mean `gpus`"},
    {"HelpOnNothing", "help Z999", 2, "U014", "Z999"},
    {"TwoBases", "run triangle.gltf -t msaa4x+deferred", 3, "T004", "each draws the whole frame"},
    {"NoImageInAnImageFile", "run bad.png -t fxaa", 3, "I006", "bad.png"},
    {"DamagedExr", "run damaged.exr -t fxaa", 3, "I002", "export it again, as OpenEXR"},
    {"CountThatNoDoubleHolds", "scene check count.gltf", 3, "S004",
     "is 9007199254740992, must be a whole number from 0 to 9007199254740991"},
    {"MissingImage", "run missing.png -t fxaa", 3, "U011", "missing.png"},
    {"ImageIsNoScene", "run bad.png -t msaa4x+fxaa", 3, "T005", "filters of images: fxaa"},
    {"ImageHasItsSize", "run bad.png -t fxaa --resolution 64x48", 3, "U030", "--resolution"},
    {"UnknownTechnique", "run triangle.gltf -t msaa5x", 3, "T001", "did you mean `msaa"},
    {"TechniqueByItsBeginning", "run triangle.gltf -t sbaa", 3, "T001",
     "did you mean `sbaa_top` or `sbaa_merge`?"},
    {"TechniqueOfManyKinds", "run triangle.gltf -t msaa", 3, "T001",
     "did you mean `msaa2x`, `msaa4x` or `msaa8x`?"},
    {"ThreeLetters", "run triangle.gltf -t sss", 3, "T001", "did you mean `sss_gs`, `sss_cs` or `sss_ppll`?"},
    {"TechniqueInCapitals", "run triangle.gltf -t AGAA", 3, "T001", "did you mean `agaa`?"},
    {"TechniqueWithADash", "run triangle.gltf -t 'MSAA 4X+wire-aa'", 3, "T001", "did you mean `wire_aa`?"},
    {"TemporalTechnique", "run triangle.gltf -t TAA", 3, "T001", "temporal techniques are not modeled"},
    {"TemporalUpscaler", "run triangle.gltf -t dlss_3", 3, "T001", "temporal techniques are not modeled"},
    {"GpuByItsBeginning", "run triangle.gltf -g rtx4070", 3, "C016", "did you mean `rtx4070_laptop`?"},
    {"GpuWithASpace", "run triangle.gltf -g 'GTX 980'", 3, "C016", "did you mean `gtx980`?"},
    {"SixSamples", "run triangle.gltf -t sbaa_top:msaa=6", 3, "T003", "must be one of 2|4|8|16|32"},
    {"SixSamplesSet", "run triangle.gltf -t deferred --set technique.samples=6", 3, "T003",
     "must be one of 1|2|4|8|16|32"},
    {"OneSampleOfTwo", "run triangle.gltf -t deferred_simple_complex:samples=1", 3, "T003",
     "must be one of 2|4|8|16|32"},
    {"KeyOfAnotherUnit", "run triangle.gltf --set gpu.core_clock_ghz=2.6", 3, "C012",
     "did you mean `core_clock_mhz`, in MHz: 2600?"},
    {"UnitInANumber", "gpu new x --like gtx980 --clock 2.6GHz", 2, "U003",
     "--clock is `2.6GHz`, must be a plain number of MHz"},
    {"AliasOfAFlag", "gpu new x --like gtx980 --cores 60,5", 2, "U003",
     "--cores is `60,5`, must be a plain number"},
    {"AliasWithEquals", "gpu new x --like gtx980 --cus=many", 2, "U003", "--cus is `many`"},
    {"NegativeBudget", "rank triangle.gltf --budget 'aa_ms<=-1'", 2, "U022", "is negative"},
    {"OtherKindOfScene", "run bad.toml.obj", 3, "S201", "a file that ends in .gltf or .glb"},
    {"PictureAsAScene", "scene check bad.png", 3, "S201", "`bad.png` is a file of another kind"},
    {"FolderAsAScene", "scene check .", 3, "S201", "`.` is a folder"},
    {"NoSurfaces", "run triangle.gltf -t sbaa_top:n=0", 3, "T003", "between 1 and 32"},
    {"MoreSurfacesThanSamples", "run triangle.gltf -t sbaa_merge:n=9,msaa=8", 3, "T003", "at most msaa = 8"},
    {"FiveAggregates", "run triangle.gltf -t agaa:c=5", 3, "T003", "must be one of 1|2|3|4"},
    {"Native64x", "run triangle.gltf -t ssaa64x:variant=sample_rate", 3, "G002", "1, 2, 4, 8, 16 or 32"},
    {"NoSuchMultisampling", "run triangle.gltf -t msaa64x", 3, "T001", "did you mean `ssaa64x`"},
    {"Native16xIsMissing", "run triangle.gltf -t msaa16x:emulate=off", 3, "G006",
     "gpu.features.native_msaa_max"},
    {"NoCoverageSamples", "run triangle.gltf -t csaa:mode=16xq -g gtx980", 3, "G006",
     "gpu.features.coverage_samples_max"},
    {"NoSuchCoverage", "run triangle.gltf -t csaa:mode=64x", 3, "T003", "8x|8xq|16x|16xq|32x"},
    {"NoPlanesToRead", "run triangle.gltf -t agaa:plane_path=on -g gtx980", 3, "G006",
     "gpu.features.compressed_depth_read"},
    {"UnknownGpu", "run triangle.gltf -g gtx981", 3, "C016", "gtx980"},
    {"UnknownScene", "run sponza_hal", 3, "S201", "sponza_hall"},
    {"UnknownEngine", "run triangle.gltf --engine quue", 3, "U006", "did you mean `queue`"},
    {"UnknownCamera", "run triangle.gltf --camera 7", 3, "U009", "index 0 to 0"},
    {"MissingFile", "run missing.gltf", 3, "S001", "missing.gltf"},
    {"DamagedGlb", "run cut.glb", 3, "S002", "cut.glb"},
    {"SetWithoutValue", "run triangle.gltf --set gpu.core_clock_mhz", 3, "C020", "gpu.core_clock_mhz"},
    {"SetUnknownGroup", "run triangle.gltf --set gup.core_clock_mhz=1", 3, "C020", "gpu"},
    {"SetUnknownKey", "run triangle.gltf --set gpu.core_clock_mzh=1000", 3, "C012", "core_clock_mhz"},
    {"SetUnknownSceneKey", "run triangle.gltf --set scene.point_light=3", 3, "C012", "point_lights"},
    {"NegativeClock", "run triangle.gltf --set gpu.core_clock_mhz=-1", 3, "C014", "core_clock_mhz"},
    {"WrongType", "run triangle.gltf --set gpu.core_clock_mhz=fast", 3, "C013", "core_clock_mhz"},
    {"UnknownSkip", "run triangle.gltf --set emulator.skip=frustrum", 3, "U007", "did you mean `frustum`"},
    {"UnknownTechniqueParameter", "run triangle.gltf -t msaa4x --set technique.zebra=2", 3, "U008", "zebra"},
    {"UnknownKeyInFile", "config check bad.toml", 3, "C012", "bad.toml:5:1"},
    {"UnknownKeyInOverlay", "run triangle.gltf --overlay bad.toml", 3, "C012", "bad.toml:5:1"},
    {"UnknownKeyInRunFile", "run bad_run.toml", 3, "C012", "did you mean `width_px`"},
    {"RangeInRunFile", "run bad_run.toml", 3, "C014", "bad_run.toml:5:"},
    {"ShowNothing", "show gtx981", 3, "U016", "did you mean `gtx980`"},
};

INSTANTIATE_TEST_SUITE_P(, BadInput, testing::ValuesIn(kMistakes),
                         [](const auto& info) { return info.param.name; });

TEST(BadInputAtOnce, AllMistakesOfTheCommandLineAreReportedTogether) {
  const Workplace place;
  const Outcome outcome =
      place.hwsim("run sponza_hall -t msaa5x -g gtx981 --engine quue --set gpu.core_clock_mhz=-1");
  EXPECT_EQ(outcome.status, 3);
  for (const char* code : {"T001", "C016", "U006"})
    EXPECT_NE(outcome.err.find(code), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("errors, nothing was run"), std::string::npos) << outcome.err;
}

// A flag that nobody typed was blamed, and another variable proposed.
TEST(BadEnvironment, TheVariableIsNamedAndWhatItTakes) {
  const Workplace place;
  for (const auto& [variable, words] :
       {std::pair{"HWSIM_JOBS=nan", "HWSIM_JOBS is `nan`, must be a whole number from 1 to 1024"},
        std::pair{"HWSIM_COLOR=purple", "HWSIM_COLOR is `purple`, must be always, auto, never"},
        std::pair{"HWSIM_PROGRESS=neve", "did you mean `never`?"},
        std::pair{"HWSIM_CACHE_MIB=nan", "help: HWSIM_CACHE_MIB="},
        std::pair{"HWSIM_SHARED_PASSES_MIB=nan", "help: HWSIM_SHARED_PASSES_MIB=64"}}) {
    const Outcome outcome = place.hwsim("list gpus", variable);
    EXPECT_NE(outcome.status, 0) << variable;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << variable << ": " << outcome.err;
    EXPECT_EQ(outcome.err.find("--jobs is"), std::string::npos) << outcome.err;
  }
}

TEST(BadConfigFolder, IsNamed) {
  const Workplace place;
  const Outcome outcome = place.hwsim("list gpus", "HWSIM_CONFIG_DIR=/nowhere");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("error[U012]"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace hwsim::cli::test
