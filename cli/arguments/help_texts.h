#pragma once
// The opening of each --help: examples that run as they stand (a test runs them), then what the command does.
#include <string_view>

namespace hwsim::cli {

inline constexpr std::string_view kHelpTop = R"(Examples:
  hwsim run sponza_hall --technique msaa4x --gpu gtx980
  hwsim list techniques
  hwsim doctor

Executes an anti-aliasing technique on a scene and predicts its time on a GPU.
Exit status: 0 done, 1 run failed, 2 usage, 3 invalid input, 4 check not met, 5 some points failed,
130 interrupted.)";

inline constexpr std::string_view kHelpRun = R"(Examples:
  hwsim run sponza_hall --technique msaa4x --gpu gtx980
  hwsim run sponza_hall -t none,msaa4x,msaa8x -g gtx980 --resolution 320x180 --reference 4
  hwsim run sponza_hall -t msaa8x -g gtx980 --set gpu.dram_bandwidth_gb_s=336 --json

Runs techniques on a scene: images, time of each pass, the unit that limits it. A run.toml of
an earlier run may stand for the scene: it gives the same numbers again.)";

inline constexpr std::string_view kHelpCompare = R"(Examples:
  hwsim compare sponza_hall -t msaa8x -g gtx980 --what-if rops-x2,l2-x4 --resolution 320x180
  hwsim compare sponza_hall -t msaa4x --set gpu.dram_bandwidth_gb_s=x0.5 --resolution 320x180
  hwsim compare sponza_hall -t none,msaa4x --resolution 320x180 --format csv

Compares results pass by pass: those of earlier runs (give their folders), or one scene before
and after --set and --overlay, for each --what-if, each point of --vary, each technique and GPU.
The first result is the baseline; a change is (new - old) / |old|.)";

inline constexpr std::string_view kHelpExplain = R"(Examples:
  hwsim explain sponza_hall -t msaa8x -g gtx980 --resolution 320x180
  hwsim explain sponza_hall -t none,msaa4x --resolution 320x180
  hwsim explain sponza_hall -t msaa4x --resolution 320x180 --all --format csv

Says why a frame takes its time: the busiest units and the time stack of each pass, what the frame
would gain if a unit took no time, and how much each number of the GPU matters (exact derivatives
of the timing engine). With two techniques or GPUs, also where they differ.)";

inline constexpr std::string_view kHelpRank = R"(Examples:
  hwsim rank sponza_hall -t msaa4x,msaa8x -g gtx980 --resolution 320x180 --reference 4
  hwsim rank sponza_hall -t msaa4x,ssaa4x --budget "aa_ms<=0.1, extra_mib<=8" --resolution 320x180 --reference 4
  hwsim rank car_body -t fxaa,smaa -g gtx980,rtx4090 --vary camera=close_up,distant --metric psnr --edges --resolution 320x180 --reference 4

Ranks techniques (all, unless -t names some) on each GPU, in each view that --vary names: time, memory, bytes and error of
the image, the Pareto front of time and error, and what each is under a budget: ok, unknown
(no interval says so), at risk, over time, over memory, unsupported. Status 4: nothing stays within it. Writes crops of the worst regions side by side: contact_sheet.png.)";

inline constexpr std::string_view kHelpSweep = R"(Examples:
  hwsim sweep sponza_hall -t none,msaa4x --vary gpu.l2_size_kib=256..4096:5:log --resolution 320x180
  hwsim sweep sponza_hall -t msaa8x --vary gpu.core_clock_mhz=800..1600 --sample lhs:16 --db s.sqlite --dry-run
  hwsim sweep --format csv

Runs many points: techniques, GPUs, and settings varied over lists and ranges. Every point is
written to the database before the first one runs, each result as it comes: --resume goes on
after an interruption. Without a scene, prints what the database holds.)";

inline constexpr std::string_view kHelpOptimize = R"(Examples:
  hwsim optimize sponza_hall -t msaa4x,deferred -g gtx980 --prices example --time-ms 0.8 --resolution 320x180
  hwsim optimize sponza_hall -t msaa8x --prices example --area 300 --front 0 --resolution 320x180
  hwsim optimize sponza_hall --vary resolution=160x90,320x180 --prices example --format csv

Finds the smallest GPU that draws every frame in a time, or the fastest of an area, at the prices of a
file, and the GPUs that nobody beats in both. Frames are the techniques in each view that --vary names.
Status 4: no GPU within the bounds keeps the limit; the answer says how near one comes.)";

inline constexpr std::string_view kHelpReport = R"(Examples:
  hwsim run sponza_hall -t none,msaa4x --resolution 320x180 --reference 4 --out runs/hall --report hall.html
  hwsim report runs/hall -o hall.html --force

Writes one HTML file to forward: the answer with its limits, hardware that can be moved (the timing
engine itself runs in the page), pictures to compare, tables and charts. It needs no network.)";

inline constexpr std::string_view kHelpReference = R"(Examples:
  hwsim reference sponza_hall --resolution 320x180 --samples 4
  hwsim reference sponza_hall --resolution 160x90 --samples 16 --out reference_hall

Ray-traces the image that every technique approximates: many samples a pixel, the same shading.)";

inline constexpr std::string_view kHelpList = R"(Examples:
  hwsim list gpus
  hwsim list techniques --format md
  hwsim list counters --json

Lists what hwsim knows: gpus, scenes, techniques, counters, overlays or tables.)";

inline constexpr std::string_view kHelpShow = R"(Examples:
  hwsim show gtx980 --origin
  hwsim show sponza_hall
  hwsim show raster.fragments

Shows one GPU, scene, technique, counter or table with all that is known about it.)";

inline constexpr std::string_view kHelpScene = R"(Examples:
  hwsim scene check sponza_hall
  hwsim scene check grass:seed=3 --json

Loads scenes and reports on them.)";

inline constexpr std::string_view kHelpSceneCheck = R"(Examples:
  hwsim scene check sponza_hall
  hwsim scene check grass:seed=3 --json

Loads scenes, counts what is in them, and lists what the loader ignored or changed.)";

inline constexpr std::string_view kHelpGpu = R"(Examples:
  hwsim gpu new rtx4070 --like rtx4090 --sms 46 --rops 64 --tmus 184 --clock 2475 --bandwidth 504 --l2 36M --force
  hwsim gpu new cut --like gtx980 --sms 13 --rops 56 --out cut.toml --force

Makes GPU files.)";

inline constexpr std::string_view kHelpGpuNew = R"(Examples:
  hwsim gpu new rtx4070 --like rtx4090 --sms 46 --rops 64 --tmus 184 --clock 2475 --bandwidth 504 --l2 36M --force
  hwsim gpu new cut --like gtx980 --sms 13 --rops 56 --out cut.toml --force

Writes a GPU file from what a data sheet prints, over a GPU of the same kind. Rates that depend
on a size that changes are scaled with it, and listed with the interval that a guess has.)";

inline constexpr std::string_view kHelpConfig = R"(Examples:
  hwsim config check gtx980
  hwsim config show gtx980 --origin

Checks and shows GPU files.)";

inline constexpr std::string_view kHelpConfigCheck = R"(Examples:
  hwsim config check gtx980
  hwsim config check gtx980 gtx470

Loads files and reports every mistake in them.)";

inline constexpr std::string_view kHelpConfigShow = R"(Examples:
  hwsim config show gtx980
  hwsim config show gtx980 --origin --set gpu.core_clock_mhz=1500

Prints a complete GPU file: what its parents, overlays and --set made of it.)";

inline constexpr std::string_view kHelpConfigSchema = R"(Examples:
  hwsim config schema
  hwsim config schema run
  hwsim config schema manifest

Prints the JSON Schema of a file, for editors.)";

inline constexpr std::string_view kHelpConfigDiff = R"(Examples:
  hwsim config diff gtx470 gtx980
  hwsim config diff gtx470 gtx980 --format csv

Lists the keys in which two GPUs differ.)";

inline constexpr std::string_view kHelpDoctor = R"(Examples:
  hwsim doctor
  hwsim doctor --json

Tests this installation in seconds: files, modules, a small run, its invariants.)";

inline constexpr std::string_view kHelpHelp = R"(Examples:
  hwsim help U001
  hwsim help run

Explains the code of a message, or a command.)";

inline constexpr std::string_view kHelpCache = R"(Examples:
  hwsim cache list
  hwsim cache prune --older-than 30

Lists and removes what is kept on disk: generated scenes, references, and traces of emulated frames.)";

inline constexpr std::string_view kHelpCacheList = R"(Examples:
  hwsim cache list
  hwsim cache list --json

Lists the files below $HWSIM_CACHE (else $XDG_CACHE_HOME/hwsim, else ~/.cache/hwsim).)";

inline constexpr std::string_view kHelpCachePrune = R"(Examples:
  hwsim cache prune --dry-run
  hwsim cache prune --older-than 30
  hwsim cache prune --keep-mib 512

Removes old files from the cache; they are made anew when they are needed.)";

inline constexpr std::string_view kHelpFit = R"(Examples:
  hwsim fit --dry-run
  hwsim fit --dry-run --paper axaa

Fits the uncertain numbers of the GPUs to the published times, and writes calibrated GPU files
that `run` uses from then on: hwsim fit --out configs/calibrated --force. Says which numbers the
data do not determine, and which rows were not run.)";

inline constexpr std::string_view kHelpValidate = R"(Examples:
  hwsim validate --dry-run
  hwsim validate --dry-run --paper sbaa --json

Fits anew with scenes, techniques, rates and GPUs left out, and reports the errors on what was
left out, beside what simple rules would predict. Exit status 4 when a stated accuracy no longer
holds.)";

inline constexpr std::string_view kHelpReproduce = R"(Examples:
  hwsim reproduce sbaa --dry-run
  hwsim reproduce wire_aa
  hwsim reproduce axaa --dry-run --format csv

A paper's tables, row by row: published beside predicted, with intervals. --report shows them as
the paper lays them out.)";

inline constexpr std::string_view kHelpCompletion = R"(Examples:
  hwsim completion bash
  hwsim completion zsh
  hwsim completion fish

Prints a script that completes commands, flags and values. For bash: source <(hwsim completion bash).)";

}  // namespace hwsim::cli
