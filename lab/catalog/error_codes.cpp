#include "lab/catalog/error_codes.h"

#include <algorithm>

#include "algos/rooms.h"
#include "hwsim/gpu/gpu_config.h"
#include "lab/catalog/remedies.h"

namespace hwsim::lab {
namespace {

constexpr ErrorCode kCodes[] = {
    {"U001", "unknown command, flag or argument",
     "No command or flag has this name. Commands are not abbreviated."},
    {"U002", "something is missing", "The command needs another argument or flag; its --help says which."},
    {"U003", "bad value of a flag or argument", "The value is none of those allowed, or outside the range."},
    {"U004", "wrong number of values", "The flag takes another number of values; its --help says how many."},
    {"U005", "bad resolution",
     "--resolution takes WIDTHxHEIGHT, each from 1 to 16384 pixels, the largest image of Direct3D 11."},
    {"U006", "unknown timing engine",
     "The engines are roofline (pass totals), queue (chunks through queues of finite depth) and detailed\n"
     "(event-driven; --set timing.detailed_sample=0.1 simulates a tenth)."},
    {"U007", "unknown skip",
     "emulator.skip is all, none, or a list of the skips to use. No skip changes an image or a count."},
    {"U008", "no technique has this parameter",
     "--set technique.KEY applies to every chosen technique with that parameter; one at least must have it."},
    {"U009", "no such camera",
     "--camera takes the name of one of the scene's cameras, or its index from 0; --camera-eye and "
     "--camera-target "
     "place another one."},
    {"U010", "cannot write",
     "The folder is missing, full or not writable. Nothing that looks complete was left behind."},
    {"U011", "cannot read", "The file is missing, too large, not a file, or may not be read."},
    {"U012", "configuration files not found",
     "hwsim looks in $HWSIM_CONFIG_DIR, then in ../share/hwsim/configs beside the folder of the program, "
     "then in the source tree that it was built from."},
    {"U013", "results exist",
     "Results are never overwritten unasked. --force replaces a folder that hwsim wrote, and no other."},
    {"U014", "no such help topic", "`hwsim help` takes the code of a message or the name of a command."},
    {"U015", "damaged CSV",
     "Every record of a CSV file must have as many fields as its header, which is the first line."},
    {"U016", "unknown name", "`hwsim show` takes the name of a GPU, scene, technique, counter or table."},
    {"U024", "named more than once",
     "A technique, a GPU, a what-if, a value of --vary, a paper or an input of a report stands twice in a "
     "list. "
     "It is taken once, at its first place: the second would give the same numbers. --zip keeps its values, "
     "as "
     "they are pairs."},
    {"U030", "no meaning for an image",
     "An image file in place of a scene has its own size, and neither camera nor lights; it is filtered as "
     "it "
     "is."},
    {"U017", "bad size of the cache",
     "HWSIM_CACHE_MIB limits the traces kept on disk, and HWSIM_SHARED_PASSES_MIB what techniques share of "
     "their "
     "passes in memory, in MiB; 0 keeps none."},
    {"U018", "unknown overlay",
     "--overlay and --what-if take a name of `hwsim list overlays`; --overlay also a file that ends in "
     ".toml."},
    {"U019", "bad axis",
     "--vary takes path=a,b,c or path=lo..hi:n or path=lo..hi:n:log; --zip wants lists of one length, "
     "--sample lhs:POINTS."},
    {"U020", "no result",
     "The folder or file is not what hwsim writes: results of `run` and `rank`, for a report also "
     "the database of a sweep and the JSON of `compare` and `rank`."},
    {"U021", "database of a sweep",
     "The SQLite database cannot be opened or written, is damaged, or was not written by `hwsim sweep` of "
     "this version: such a database carries the application id 0x68775357, and holds hwsim's tables alone. A "
     "file of which that is not true is never written to, with --force neither: it may hold what somebody "
     "else put there (a table, a view, an index, statistics of ANALYZE)."},
    {"U022", "bad budget",
     "--budget is a list of quantity<=number; quantities are aa_ms, frame_ms, extra_mib, memory_mib, "
     "dram_mb."},
    {"U023", "number of points in a report",
     "A page carries the counted work and the pictures of each point, and stays below 5 MB: it takes from 1 "
     "to "
     "32 points."},
    {"U040", "a frame of other features",
     "A frame is timed on GPUs with the features and limits that it was drawn for (features.*, "
     "functional.*): others "
     "would do other work."},
    {"C026", "prices of a GPU's parts",
     "A list of prices (`hwsim optimize --prices`) has a table for each number of a GPU that may be chosen: "
     "its area, "
     "its bounds, its step, and the keys that scale with it."},
    {"C027", "number that no GPU ever had",
     "A clock, a size or a number of units is smaller or larger than those of any GPU: it may be in another "
     "unit than the key's. The number is taken as it is."},
    {"U041", "nothing to optimize",
     "`hwsim optimize` changes one GPU for frames: techniques, and views that --vary names."},
    {"K001", "damaged file in the cache",
     "A file that hwsim keeps to save work is cut off, changed, or of another version. It is made anew: "
     "results "
     "are not affected."},
    {"K002", "cache cannot be written",
     "Traces are kept below $HWSIM_CACHE (else $XDG_CACHE_HOME/hwsim, else ~/.cache/hwsim). Without them "
     "every "
     "run emulates again; results are not affected."},
    {"T001", "unknown technique",
     "`hwsim list techniques` lists the names; parameters follow after a colon."},
    {"T002", "unknown parameter of a technique",
     "A technique is written name:key=value,key=value; `hwsim show TECHNIQUE` lists its keys."},
    {"T003", "bad value of a technique's parameter", "`hwsim show TECHNIQUE` lists ranges and choices."},
    {"T004", "impossible combination",
     "Techniques are combined with +: any modifiers, one base, any filters, each once. The message says what "
     "excludes what."},
    {"T005", "an image is no scene",
     "Techniques that draw need a scene. An image file stands for a finished frame: only filters apply to "
     "it."},
    {"X001", "internal error",
     "hwsim broke one of its own rules. That is never your input's fault: please report the message and the "
     "manifest."},
    {"X002", "out of memory",
     "Images take width x height x samples x bytes; scenes their triangles and textures."},

    {"S001", "scene file cannot be read", "The path does not exist, is not a file, or may not be read."},
    {"S002", "damaged GLB",
     "The binary container breaks its own rules: a header, chunk type or length is wrong. The file was "
     "probably cut off while it was copied."},
    {"S003", "damaged JSON", "The JSON part of the glTF does not parse."},
    {"S004", "wrong glTF value",
     "A property is missing, has the wrong type, or a value that glTF 2.0 does not allow; the message names "
     "the element."},
    {"S005", "reference to nothing", "An index points past the end of the array that it refers to."},
    {"S006", "unsupported required extension",
     "The file says that it cannot be read without an extension that hwsim does not have (Draco, meshopt, "
     "KTX2 among them)."},
    {"S007", "buffer missing or too short",
     "A buffer's file is missing, or holds fewer bytes than the glTF promises."},
    {"S008", "range outside its buffer",
     "An accessor or buffer view reaches past the end of what it reads from."},
    {"S009", "element out of range",
     "A vertex index names no vertex, or attributes of one primitive differ in length."},
    {"S010", "value without meaning",
     "A number is not finite, or so large that arithmetic on it would not be."},
    {"S011", "nodes form no tree", "A node is reached twice: by a cycle, or by two parents."},
    {"S012", "scene too large", "The limits keep a damaged file from taking all memory."},
    {"S013", "image cannot be read", "A texture's image is missing or not readable."},
    {"S014", "no glTF 2.0 scene", "The version is missing or not 2.x, or the file holds no scene."},
    {"S015", "file outside of the scene's folder",
     "A URI leads out of the folder of the .gltf file, by `..`, an absolute path, a link or a scheme. Only "
     "files "
     "below it are read, so that a scene from a stranger shows none of your files."},
    {"S101", "extension ignored",
     "The extension is optional and not supported; the note says what is drawn instead. The image may differ "
     "from that of other viewers."},
    {"S102", "bytes ignored", "The file goes on after its declared end."},
    {"S103", "points and lines not drawn", "Only triangles are drawn."},
    {"S104", "no positions", "A primitive without positions draws nothing."},
    {"S105", "no whole triangle", "Indices that form no triangle are ignored."},
    {"S106", "normals or tangents generated", "The file has none where shading needs them."},
    {"S107", "normals or tangents repaired", "They were not of unit length."},
    {"S108", "no texture coordinates", "A texture is used without them: one texel colors everything."},
    {"S109", "wire radius ignored",
     "A wire needs normals outward and tangents along its axis beside _HWSIM_RADIUS."},
    {"S110", "motion ignored", "Animations, skins and morph targets: the scene is drawn as modeled."},
    {"S111", "factors clamped", "Material factors outside 0 to 1 were clamped."},
    {"S112", "texture left out", "It uses an extension or a coordinate set that is not supported."},
    {"S113", "light left out or changed",
     "Its type is unknown, its direction cannot be told, or a value is out of range."},
    {"S114", "first scene taken", "The file has several scenes and names none as the default."},
    {"S115", "camera left out or changed",
     "Its values are none that glTF 2.0 allows, or its node has a scale of zero: it is left out, and the "
     "other cameras are there. An aspectRatio that is none leaves the camera with the picture's own shape."},
    {"S116", "unused meshes not loaded", "No node of the scene refers to them."},
    {"S117", "sun added", "The file has no lights."},
    {"S118", "camera added or completed", "The file has no camera, or one without a far plane."},
    {"S119", "unused buffers not read", "Nothing that is drawn refers to them; they may be missing."},
    {"S120", "scene moved and scaled",
     "Arithmetic is in single precision: a scene at map coordinates, a tiny or a huge one is moved and "
     "scaled in double precision while it is loaded, cameras and lights with it. The picture is that of the "
     "same scene at the origin, in meters. Where parts lie too far from each other, a warning says so: draw "
     "them one by one."},
    {"S121", "integers taken as fractions",
     "Colors and texture coordinates in whole numbers lack the flag `normalized`. They are divided by the "
     "largest "
     "whole number, as every exporter that is known to forget the flag means them."},
    {"S122", "lights exposed",
     "The lights are so bright that all would be white, as lights in lux and candela are: they are scaled "
     "until a "
     "white surface shows about 1. --exposure sets the factor."},
    {"S123", "near plane too near",
     "Depth is stored as a float of 1 - near/distance: where the distance is ten million times the near "
     "plane, "
     "all depths are one number, and what lies behind is seen or nothing is. Raise znear in the file."},
    {"S201", "unknown scene",
     "The name is neither a .gltf or .glb file nor a generator of `hwsim list scenes`."},
    {"S202", "unknown parameter of a generator", "`hwsim show GENERATOR` lists its parameters."},
    {"S203", "generator's parameter out of range", "`hwsim show GENERATOR` lists the ranges."},
    {"S204", "bad generator text", "A generated scene is written name:key=number,key=number, each key once."},
    {"S205", "generated scene too large", "A GLB file holds at most 4 GiB."},
    {"S206", "cache folder cannot be created",
     "Generated scenes are kept below $HWSIM_CACHE, else $XDG_CACHE_HOME/hwsim, else ~/.cache/hwsim."},
    {"S300", "contents of a scene", "What the file holds, as `hwsim scene check` counts it."},
    {"S301", "shadow map is coarse",
     "A texel of the shadow map covers more than 10 pixels: shadows have steps of that size, and stop that "
     "far "
     "from what casts them. The map holds the whole scene, however little of it is seen."},

    {"M001", "mapping of the published tables",
     "A line of configs/published/mapping/*.csv matches no row, or names something that does not exist."},
    {"M002", "published row without a run",
     "Every time and count of configs/published needs lines in mapping/ that name its scene, technique, GPU "
     "and "
     "passes, or a reason in uses.csv why it is left out."},

    {"M010", "number of a published table",
     "A value, resolution or rate of configs/published, or a number of its mapping, is no finite number in "
     "its range, or a unit is not that of its quantity. Times and counts are positive, percentages above "
     "-100; NA says that the document prints none. A time is in ms, never in s."},

    {"M003", "parameter of the fit",
     "configs/calibration/parameters.csv declares scope, name, start, range and prior of each number that "
     "the fit may move. \"file\" takes start or range from the GPU's own file; a prior is a factor above 1, "
     "or "
     "\"none\"."},
    {"M004", "too many parameters of a GPU",
     "The derivatives of one GPU are computed side by side, 12 at a time."},
    {"M005", "too many parameters", "The fit takes at most one parameter for four fitted values."},
    {"M006", "damaged calibration", "calibration.json must be as `hwsim fit` wrote it."},
    {"M007", "statement about accuracy",
     "A line of configs/calibration/accuracy.csv says in which range a figure of `hwsim validate` lies: "
     "papers, split, "
     "figure, low, high."},
    {"M008", "no trace is kept of a run",
     "tests/data/published.traces holds the work traces of every published run. scripts/keep_traces.sh "
     "writes it."},
    {"M009", "optimum of a fold",
     "tests/data/fold_optima.csv holds where each fit of a validation ended. scripts/keep_traces.sh writes "
     "it."},

    {"I001", "image module not found",
     "Images are read and written by libhwsim_image_io.so, which lies beside the program's libraries and "
     "needs OpenImageIO. HWSIM_MODULE_DIR names another folder."},
    {"I002", "damaged image", "The file is cut off or its contents break its format."},
    {"I003", "image too large", "The limit keeps a damaged file from taking all memory."},
    {"I004", "image cannot be read", "The file is missing, or its flavor of the format is not supported."},
    {"I005", "image cannot be written",
     "The folder is missing, full or not writable, or the image is empty."},
    {"I006", "unknown image format",
     "PNG, JPEG and OpenEXR are read, PNG and OpenEXR written; the name's ending says which."},

    {"P001", "nothing is drawn",
     "The picture shows the background alone: the camera looks elsewhere, the scene is out of its range, or "
     "its "
     "materials let everything through."},
    {"P002", "picture is white", "More than half of what is drawn is white: the light is too bright."},
    {"P003", "picture is black", "More than half of what is drawn is black: hardly any light reaches it."},

    {"G001", "size out of range",
     "An image or dispatch of the technique is empty or larger than this GPU allows "
     "(gpu.functional.max_image_px)."},
    {"G002", "bad sample count", "Images have 1, 2, 4, 8, 16 or 32 samples."},
    {"G003", "attachments do not match",
     "Formats, sizes or sample counts of a pass's attachments contradict each other."},
    {"G004", "feedback loop", "A pass reads an image while it draws into it."},
    {"G005", "read before written", "A pass reads an image that no pass has written."},
    {"G006", "feature missing",
     "The technique needs a feature that this GPU lacks; the message names the switch that adds it."},
    {"G007", "incomplete pass", "Programs and attachments of a pass do not fit together."},
    {"G008", "no output", "The frame's output is missing, multisampled, or a depth image."},
    {"G009", "bad copy or resolve",
     "Source and target of a copy must be alike; a resolve goes from several samples to one."},
    {"G011", "multicast used wrongly",
     "A draw pass may have up to 16 viewports, each shifted by up to one pixel, and attachments of as many "
     "layers."},
    {"G010", "coverage used wrongly",
     "Coverage after depth tests needs forced early tests; a mask that replaces coverage, a shader that "
     "writes "
     "one."},
    {"G012", "geometry program emits too much",
     "The vertices of one invocation, position and attributes, exceed functional.gs_max_scalars."},
};

}  // namespace

std::vector<ErrorCode> error_codes() {
  std::vector<ErrorCode> codes(std::begin(kCodes), std::end(kCodes));
  for (const ConfigCode& code : config_codes()) codes.push_back({code.code, code.title, code.explanation});
  for (const algos::MessageCode& code : algos::message_codes())
    codes.push_back({code.code, code.title, code.explanation});
  for (ErrorCode& code : codes) code.remedy = remedy_of(code.code);
  std::sort(codes.begin(), codes.end(),
            [](const ErrorCode& a, const ErrorCode& b) { return a.code < b.code; });
  return codes;
}

}  // namespace hwsim::lab
