#include "cli/arguments/argument_groups.h"

#include <algorithm>
#include <functional>
#include <map>
#include <sstream>
#include <thread>

#include "cli/arguments/argument_values.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/request/request_words.h"

namespace hwsim::cli {
namespace {

/// A flag whose value is one of a few words.
template <class T>
void add_choice(CLI::App& app, const std::string& flag, std::string description,
                std::map<std::string, T> choices, std::function<void(T)> set,
                const std::string& environment = {}) {
  std::vector<std::string> words;
  for (const auto& [word, value] : choices) words.push_back(word);
  CLI::Option* option = app.add_option_function<std::string>(
      flag, [=](const std::string& text) { set(choices.at(text)); }, std::move(description));
  option->check([=](const std::string& text) {
    if (choices.contains(text)) return std::string();
    return "is `" + text + "`, must be " + CLI::detail::join(words, ", ") + "\n" + did_you_mean(text, words);
  });
  option->type_name(CLI::detail::join(words, "|"));
  if (!environment.empty()) option->envname(environment);
}

}  // namespace

CLI::Validator number_in(const cost_models::NumberRange& range, const std::string& unit) {
  std::ostringstream described;
  if (range.high < cost_models::NumberRange{}.high)
    described << (range.whole ? "INT" : "FLOAT") << " in [" << range.low << " - " << range.high << "]";
  return {[=](const std::string& text) { return number_complaint(text, range, unit); }, described.str()};
}

CLI::Validator whole_in(int low, int high) {
  return number_in({static_cast<double>(low), static_cast<double>(high), true});
}

CLI::Option* add_number(CLI::App& app, const std::string& flag, std::optional<double>& target,
                        std::string description, const CLI::Validator& range) {
  return app
      .add_option_function<std::string>(
          flag, [&target](const std::string& text) { target = cost_models::table_number(text); },
          std::move(description))
      ->check(range);
}

CLI::Option* add_repeatable(CLI::App& app, const std::string& flag, std::vector<std::string>& target,
                            std::string description, const std::string& type) {
  return app.add_option(flag, target, std::move(description))->allow_extra_args(false)->type_name(type);
}

void add_common(CLI::App& app, CommonArguments& common) {
  CLI::App* group = app.add_option_group("Output and progress");
  group
      ->add_option_function<std::vector<std::string>>(
          "--format",
          [&common](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) common.formats.push_back(parse_format(text));
          },
          "Shape of the answer; FORMAT=FILE writes it to a file (repeatable)")
      ->allow_extra_args(false)
      ->type_name("table|csv|json|md");
  // Commands that write results have the flag already: it stands for these files, too.
  if (CLI::Option* force = app.get_option_no_throw("--force"))
    force->each([&common](const std::string&) { common.force = true; });
  else
    group->add_flag("--force", common.force, "Replace files of --format that exist");
  group->add_flag_callback(
      "--json",
      [&common] {
        common.formats.push_back({OutputFormat::json, ""});
      },
      "--format json");
  group->add_flag_callback(
      "-q,--quiet", [&common] { common.verbosity = -1; }, "Only the answer and errors");
  group->add_flag_callback(
      "-v,--verbose", [&common] { common.verbosity = 1; }, "Say more on standard error");
  const std::map<std::string, When> when = {
      {"auto", When::automatic}, {"always", When::always}, {"never", When::never}};
  add_choice<When>(
      *group, "--color", "Colored messages; NO_COLOR and TERM=dumb are obeyed", when,
      [&common](When value) { common.color = value; }, "HWSIM_COLOR");
  add_choice<When>(
      *group, "--progress", "Progress; auto: a bar on a terminal, elsewhere a line for every 10 %", when,
      [&common](When value) { common.progress = value; }, "HWSIM_PROGRESS");
  common.jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  group->add_option("--jobs", common.jobs, "Threads; the results do not depend on it")
      ->check(whole_in(1, 1024))
      ->type_name("N")
      ->envname("HWSIM_JOBS");
}

void add_sets(CLI::App& app, std::vector<std::string>& sets) {
  add_repeatable(app, "--set", sets,
                 "gpu., scene., technique., emulator. or timing. setting (repeatable, last wins)",
                 "PATH=VALUE");
}

void add_overlays(CLI::App& app, std::vector<std::string>& overlays) {
  add_repeatable(app, "--overlay", overlays,
                 "A what-if of `hwsim list overlays`, or a .toml file, laid over the GPU (repeatable)",
                 "NAME|FILE");
}

void add_out(CLI::App& app, OutPlace& out) {
  app.add_option("--out", out.directory, "Folder for the results; default runs/<date>-<time>-<id>")
      ->type_name("DIR");
  app.add_flag("--force", out.force, "Replace the results in --out");
}

void add_report_file(CLI::App& app, std::string& file) {
  app.add_option("--report", file, "Also one HTML page of the results: see `hwsim report`")
      ->type_name("FILE");
}

void add_view_flags(CLI::App& app, ViewArguments& view) {
  app.add_option_function<std::string>(
         "--resolution",
         [&view](const std::string& text) { view.resolution = parse_resolution(text, "--resolution"); },
         "Pixels, 1 to 16384 each way; default 1280x720")
      ->type_name("WxH");
  app.add_option("--camera", view.camera, "A camera of the scene; default the first")
      ->type_name("NAME|INDEX");
  CLI::Option* eye =
      app.add_option("--camera-eye", view.camera_eye, "A camera of your own stands here, in meters, y up")
          ->excludes("--camera")
          ->type_name("X,Y,Z");
  CLI::Option* target = app.add_option("--camera-target", view.camera_target, "and looks there")
                            ->needs(eye)
                            ->type_name("X,Y,Z");
  eye->needs(target);
  app.add_option("--camera-fov", view.camera_fov, "from the bottom to the top of the picture; default 60")
      ->needs(eye)
      ->type_name("DEGREES");
  app.add_option("--lights", view.point_lights, "Point lights added to those of the scene")
      ->check(whole_in(0, 1024))
      ->type_name("N");
  app.add_flag("--no-shadows", view.no_shadows, "No shadow map");
  app.add_option("--anisotropy", view.anisotropy,
                 "Probes of a texture request at most, along the longer axis of its footprint; default 1")
      ->check(whole_in(1, 16))
      ->type_name("N");
  add_number(app, "--exposure", view.exposure,
             "Factor of the file's lights; default 1, or less where they are in photometric units",
             number_in({1e-12, 1e12}))
      ->type_name("FACTOR");
  add_sets(app, view.sets);
}

void add_view(CLI::App& app, ViewArguments& view, bool required) {
  app.add_option("SCENE", view.scene, "A .gltf or .glb file, or a generator: name:key=value,key=value")
      ->required(required)
      ->type_name(" ");
  add_view_flags(app, view);
}

void add_points(CLI::App& app, RunArguments& run, const std::string& techniques) {
  app.add_option_function<std::vector<std::string>>(
         "-t,--technique",
         [&run](const std::vector<std::string>& texts) {
           for (const std::string& text : texts)
             for (std::string& technique : split_techniques(text))
               run.techniques.push_back(std::move(technique));
         },
         "Techniques, separated by commas (repeatable); default " + techniques)
      ->allow_extra_args(false)
      ->type_name("NAME[:key=value]");
  app.add_option_function<std::vector<std::string>>(
         "-g,--gpu",
         [&run](const std::vector<std::string>& texts) {
           for (const std::string& text : texts)
             for (const std::string& gpu : lab::split(text, ',')) run.gpus.push_back(gpu);
         },
         "GPUs of `hwsim list gpus`, or .toml files, separated by commas (repeatable)")
      ->allow_extra_args(false)
      ->type_name("NAME|FILE")
      ->envname("HWSIM_GPU");
  add_overlays(app, run.overlays);
  app.add_option("--engine", run.engine, "Timing engine; default queue")
      ->type_name("roofline|queue|detailed");
  app.add_flag("--no-cache", run.no_cache, "Emulate anew, and keep no traces");
}

void add_reference_shadows(CLI::App& app, ViewArguments& view) {
  add_choice<std::string>(app, "--reference-shadows",
                          "The reference's shadows: map (the frame's own, default) or rays",
                          {{"map", "map"}, {"rays", "rays"}},
                          [&view](const std::string& value) { view.reference_shadows = value; });
}

void add_reference_samples(CLI::App& app, RunArguments& run) {
  app.add_option("--reference", run.reference_samples,
                 "Compare with the ray-traced reference of so many samples a pixel; default 64")
      ->check(whole_in(1, 65536))
      ->type_name("[SAMPLES]");
  add_reference_shadows(app, run.view);
}

void add_no_image(CLI::App& app, RunArguments& run) {
  app.add_flag("--no-image", run.no_image, "Write no images");
}

void add_vary(CLI::App& app, std::vector<std::string>& vary, bool& zip) {
  add_repeatable(
      app, "--vary", vary,
      "Values of a setting: a,b,c or lo..hi:n or lo..hi:n:log; or of resolution, camera, gpu, overlay, "
      "scene (repeatable)",
      "PATH=VALUES");
  app.add_flag("--zip", zip, "Vary all together instead of every combination");
}

void add_optimize_goal(CLI::App& app, OptimizeArguments& optimize) {
  app.add_option("--prices", optimize.prices,
                 "Area, bounds and step of each key that may be chosen: a .toml file, or `example`")
      ->required()
      ->type_name("NAME|FILE");
  add_number(app, "--time-ms", optimize.goal.time_ms, "The smallest GPU whose slowest frame takes no longer",
             number_in({1e-6, 1e9}))
      ->type_name("MS");
  add_number(app, "--area", optimize.goal.area, "The fastest GPU with no more area", number_in({1e-6, 1e12}))
      ->type_name("UNITS");
  app.add_option("--front", optimize.goal.front_points,
                 "Areas of the front of area and time; default 9, 0: none")
      ->check(whole_in(0, 1000))
      ->type_name("N");
}

}  // namespace hwsim::cli
