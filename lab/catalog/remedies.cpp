#include "lab/catalog/remedies.h"

#include <algorithm>
#include <array>

namespace hwsim::lab {
namespace {

struct Remedy {
  std::string_view code, text;
};

constexpr std::string_view kShowKeys =
    "`hwsim config show gtx980` lists every key, `hwsim config schema gpu` the ranges";
constexpr std::string_view kReportTechnique =
    "another GPU (`hwsim list gpus`), another resolution, or other parameters of the technique";
constexpr std::string_view kExportAgain =
    "export or copy the scene again; the glTF validator (https://github.khronos.org/glTF-Validator) names "
    "every "
    "fault of the file";
constexpr std::string_view kMapping =
    "mend the named line of configs/published; docs/published_tables.md says what stands where";
constexpr std::string_view kKeepTraces = "scripts/keep_traces.sh writes it anew";

constexpr std::array kRemedies = {
    Remedy{"C010",
           "check the path; `hwsim list gpus` and `hwsim list overlays` name the files that come with hwsim"},
    Remedy{"C011", "mend the marked place; https://toml.io/en/v1.0.0 is the syntax"},
    Remedy{"C012", kShowKeys},
    Remedy{"C013",
           "write the value in the type that is named; `hwsim config schema gpu` gives the type of each key"},
    Remedy{"C014", kShowKeys},
    Remedy{"C015", "give the key, or let the file extend a GPU that has it: extends = \"gtx980\""},
    Remedy{"C016", "`hwsim list gpus` names the GPUs; a file of your own is given by its path"},
    Remedy{"C017", "let the first file extend a GPU that extends nothing"},
    Remedy{"C018", "change one of the keys that the notes name"},
    Remedy{"C019", "begin from a file that works: `hwsim config show gtx980`, or the run.toml of a run"},
    Remedy{"C020", "`hwsim help run` lists the groups that --set takes"},
    Remedy{"C021", "write one value: true, 12, 0.5 or a word"},
    Remedy{"C022", "write a plain value, or { value = 1, provenance = \"assumed\" }"},
    Remedy{"C023", "give one of the files another id"},
    Remedy{"C024", "write the rate into the file, too, or begin with `hwsim gpu new`"},
    Remedy{"C025", "leave one of the two names out"},
    Remedy{"G001", kReportTechnique},
    Remedy{"G002", "1, 2, 4, 8, 16 or 32 samples"},
    Remedy{"G003",
           "docs/architecture.md says what a frame graph must hold; `hwsim show TECHNIQUE` lists parameters"},
    Remedy{"G004", "draw into another image than the one that is read"},
    Remedy{"G005", "write or clear the image in an earlier pass"},
    Remedy{"G006", "another GPU, or an overlay that adds the feature (`hwsim list overlays`)"},
    Remedy{"G007", "give the pass the programs and images that are named"},
    Remedy{"G008", "let the last pass write a color image of one sample"},
    Remedy{"G009", "make both images alike, or resolve into one of one sample"},
    Remedy{"G010", kReportTechnique},
    Remedy{"G011", kReportTechnique},
    Remedy{"G012", "fewer vertices an invocation, or a GPU with a larger functional.gs_max_scalars"},
    Remedy{"I001",
           "install the program again, or set HWSIM_MODULE_DIR to the folder of libhwsim_image_io.so"},
    Remedy{"I002", "copy or save the image again"},
    Remedy{"I003", "a smaller image"},
    Remedy{"I004", "save the image as PNG, JPEG or OpenEXR of half or float channels"},
    Remedy{"I005", "another folder, or free space; the image must have pixels"},
    Remedy{"I006", "a name that ends in .png, .jpg or .exr"},
    Remedy{"M001", kMapping},
    Remedy{"M002", kMapping},
    Remedy{"M003", "mend the named line; docs/calibration.md says what each column of parameters.csv means"},
    Remedy{"M004", "leave parameters of that GPU out of configs/calibration/parameters.csv"},
    Remedy{"M005", "fewer lines of configs/calibration/parameters.csv, or more papers"},
    Remedy{"M006", "`hwsim fit --out configs/calibrated --force` writes it anew"},
    Remedy{"M007", "mend the named line of configs/calibration/accuracy.csv"},
    Remedy{"M008", kKeepTraces},
    Remedy{"M009", kKeepTraces},
    Remedy{"M010", kMapping},
    Remedy{"S001", "check the path; `hwsim list scenes` names the generated scenes"},
    Remedy{"S002", kExportAgain},
    Remedy{"S003", kExportAgain},
    Remedy{"S004", kExportAgain},
    Remedy{"S005", kExportAgain},
    Remedy{"S006", "export without the extension (for Draco and meshopt: without compression of meshes)"},
    Remedy{"S007", "put the missing file beside the scene, or export as one .glb"},
    Remedy{"S008", kExportAgain},
    Remedy{"S009", kExportAgain},
    Remedy{"S010", kExportAgain},
    Remedy{"S011", "let every node have one parent at most"},
    Remedy{"S012", "a larger --set scene.memory_mib, or a smaller scene"},
    Remedy{"S013", "put the image beside the scene as PNG, JPEG or OpenEXR, or export as one .glb"},
    Remedy{"S014", "export as glTF 2.0, with a scene"},
    Remedy{"S015", "copy the file below the folder of the scene, or export as one .glb"},
    Remedy{"S201", "a file that ends in .gltf or .glb, or a name of `hwsim list scenes`"},
    Remedy{"S202", "`hwsim show GENERATOR` lists its parameters"},
    Remedy{"S203", "`hwsim show GENERATOR` lists the ranges"},
    Remedy{"S204", "write it as grass:seed=3,blades=500"},
    Remedy{"S205", "smaller parameters of the generator"},
    Remedy{"S206", "set HWSIM_CACHE to a folder that can be written"},
    Remedy{"T001", "`hwsim list techniques` lists the names"},
    Remedy{"T002", "`hwsim show TECHNIQUE` lists its parameters"},
    Remedy{"T003", "`hwsim show TECHNIQUE` lists ranges and choices"},
    Remedy{"T004", "any modifiers, one base, any filters: wire_aa+msaa4x+fxaa"},
    Remedy{"T005", "a scene, or filters alone: none+fxaa"},
    Remedy{"U001", "`hwsim help` lists the commands, `hwsim COMMAND --help` its flags"},
    Remedy{"U002", "`hwsim COMMAND --help` says what it needs"},
    Remedy{"U003", "`hwsim COMMAND --help` gives the values"},
    Remedy{"U004", "`hwsim COMMAND --help` says how many"},
    Remedy{"U005", "--resolution 1280x720"},
    Remedy{"U006", "--engine roofline, queue or detailed"},
    Remedy{"U007", "--set emulator.skip=all"},
    Remedy{"U008", "`hwsim show TECHNIQUE` lists its parameters"},
    Remedy{"U009", "`hwsim scene check SCENE` names the cameras"},
    Remedy{"U010", "check that the folder exists, may be written and has space"},
    Remedy{"U011", "check that the path is a file that may be read"},
    Remedy{"U012", "set HWSIM_CONFIG_DIR to the folder `configs` of hwsim"},
    Remedy{"U013", "another --out, or --force to replace it"},
    Remedy{"U014", "`hwsim help` lists the codes and the commands"},
    Remedy{"U015", "mend the named line: as many fields as the header, quotes in pairs"},
    Remedy{"U016", "`hwsim list gpus`, `scenes`, `techniques`, `counters` or `tables` gives the names"},
    Remedy{"U017", "a whole number of MiB: HWSIM_CACHE_MIB=4096"},
    Remedy{"U018", "`hwsim list overlays` gives the names; a file of your own is given by its path"},
    Remedy{"U019", "--vary gpu.core_clock_mhz=500..1500:5, or =500,1000"},
    Remedy{"U020", "the folder of a run, or its result.json"},
    Remedy{"U021", "a database that `hwsim sweep` wrote, or a new name"},
    Remedy{"U022", "--budget 'aa_ms<=1.5, extra_mib<=192'"},
    Remedy{"U023", "give fewer folders, or run with fewer techniques and GPUs"},
    Remedy{"U024", "name each once"},
    Remedy{"U030", "leave the flag out, or give a scene"},
    Remedy{"C026", "begin from configs/prices/example.toml"},
    Remedy{"C027", "write the number in the unit that the key ends in"},
    Remedy{"U041", "a scene, -t with techniques, and --vary of scene, camera, resolution or scene.*"},
    Remedy{"U040", "emulate the frame anew for this GPU"},
    Remedy{"X001", "please report the message: it is a mistake in hwsim"},
    Remedy{"X002", "a smaller scene, a smaller --resolution, fewer --jobs, or a larger limit"},
};

}  // namespace

std::string_view remedy_of(std::string_view code) {
  const auto found = std::ranges::find(kRemedies, code, &Remedy::code);
  return found == kRemedies.end() ? std::string_view() : found->text;
}

}  // namespace hwsim::lab
