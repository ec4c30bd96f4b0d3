// Labs: what is drawn, ranked, compared and validated.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>

#include "python/bindings.h"
#include "python/convert.h"
#include "python/workshop.h"

namespace hwsim::python {
namespace {

using lab::KeptFrame;
using Json = nlohmann::ordered_json;

/// What a lab of Python is made of; what is None is as the environment says.
std::unique_ptr<Workshop> make_workshop(const std::optional<std::string>& configs,
                                        const std::optional<std::string>& cache, int jobs, bool use_cache,
                                        py::object listener) {
  lab::LabOptions options = lab::options_of_environment();
  if (configs) options.config_folder = *configs;
  if (cache) options.cache_folder = *cache;
  options.jobs = jobs;
  options.use_cache = use_cache;
  return std::make_unique<Workshop>(std::move(options), std::move(listener));
}

/// The words of a request and its GPUs become a plan. Throws InputError with all problems.
lab::RunPlan planned(lab::Lab& lab, const lab::Request& request, const std::vector<lab::GpuChoice>& gpus) {
  std::vector<Diagnostic> problems;
  lab::RunPlan plan = lab.plan(request, gpus, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  return plan;
}

std::vector<lab::GpuChoice> choices_of(const std::vector<const Gpu*>& gpus) {
  std::vector<lab::GpuChoice> choices;
  for (const Gpu* gpu : gpus) choices.push_back(gpu->choice);
  return choices;
}

Gpu make_gpu(Workshop& shop, const std::string& name, const std::vector<std::string>& overlays,
             const py::list& sets, bool calibrated) {
  lab::GpuChoice choice{name, overlays, to_assignments(sets), calibrated};
  GpuConfig config = shop.ask([&](lab::Lab& lab) { return lab.gpu(choice); });
  return {std::move(choice), std::move(config)};
}

py::dict scene_of(Workshop& shop, const py::dict& words) {
  const lab::Request request = to_request(words);
  const lab::SceneSummary summary = shop.ask([&](lab::Lab& lab) { return lab.scene(request.view); });
  py::dict scene;
  scene["name"] = summary.name;
  scene["content_hash"] = summary.content_hash;
  scene["cameras"] = summary.cameras;
  scene["notes"] = to_python(summary.notes);
  return scene;
}

/// A copy, since the lab's own goes with the lab.
py::array_t<float> reference_of(Workshop& shop, const py::dict& words, int samples) {
  const lab::Request request = to_request(words);
  const pipeline::Image image =
      shop.ask([&](lab::Lab& lab) { return lab.reference(request.view, samples).image; });
  return py::array_t<float>(std::vector<py::ssize_t>{image.height, image.width, 4}, &image.pixels[0][0]);
}

/// Finds the mistakes of a request, and draws nothing.
void check(Workshop& shop, const py::dict& words, const std::vector<const Gpu*>& gpus) {
  const lab::Request request = to_request(words);
  const std::vector<lab::GpuChoice> choices = choices_of(gpus);
  shop.ask([&](lab::Lab& lab) { return planned(lab, request, choices).techniques.size(); });
}

KeptFrame emulate(Workshop& shop, const py::dict& words, const Gpu& gpu) {
  const lab::Request request = to_request(words);
  return shop.ask([&](lab::Lab& lab) { return lab.emulate(planned(lab, request, {gpu.choice})); });
}

KeptFrame frame_for(Workshop& shop, const KeptFrame& frame, const Gpu& gpu) {
  return shop.ask([&](lab::Lab& lab) { return lab.frame_for(frame, gpu.config); });
}

/// Axes of (path, values); the last one varies fastest.
lab::PointSettings settings_of(const std::vector<std::pair<std::string, py::list>>& words) {
  std::vector<lab::Axis> axes;
  for (const auto& [path, values] : words) {
    lab::Axis& axis = axes.emplace_back();
    axis.path = path;
    for (const py::handle& value : values)
      axis.values.push_back(to_assignments(py::make_tuple(py::make_tuple(path, value))).front().value);
  }
  return {std::move(axes), lab::Combine::grid};
}

/// One array a number, flat, in the order of the settings.
py::dict time_variants(Workshop& shop, const KeptFrame& frame, const Gpu& gpu,
                       const std::vector<std::pair<std::string, py::list>>& axes) {
  const lab::PointSettings each = settings_of(axes);
  const std::vector<lab::VariantTime> times =
      shop.ask([&](lab::Lab& lab) { return lab.time_variants(frame, gpu.choice, each); });
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto count = static_cast<py::ssize_t>(times.size());
  py::array_t<double> time_ms(count), low_ms(count), high_ms(count), dram_mb(count);
  py::array_t<std::uint8_t> support(count);
  for (py::ssize_t i = 0; i < count; ++i) {
    const lab::VariantTime& time = times[static_cast<std::size_t>(i)];
    time_ms.mutable_at(i) = time.time_ms;
    low_ms.mutable_at(i) = time.interval_ms ? (*time.interval_ms)[0] : kNone;
    high_ms.mutable_at(i) = time.interval_ms ? (*time.interval_ms)[1] : kNone;
    dram_mb.mutable_at(i) = time.dram_mb;
    support.mutable_at(i) = static_cast<std::uint8_t>(time.support);
  }
  py::dict arrays;
  arrays["time_ms"] = time_ms;
  arrays["low_ms"] = low_ms;
  arrays["high_ms"] = high_ms;
  arrays["dram_mb"] = dram_mb;
  arrays["support"] = support;
  return arrays;
}

py::dict rank(Workshop& shop, const py::dict& words, const Gpu& gpu, const std::string& budget) {
  const lab::Request request = to_request(words);
  const lab::Ranking ranking =
      shop.ask([&](lab::Lab& lab) { return lab.rank(planned(lab, request, {gpu.choice}), budget); });
  py::dict answer;
  answer["json"] = to_python(to_json(ranking));
  answer["table"] = to_python(lab::ranking_table(ranking));
  return answer;
}

py::dict tables_of(const lab::Comparison& comparison) {
  py::dict answer;
  answer["json"] = to_python(to_json(comparison));
  answer["frames"] = to_python(lab::frame_comparison(comparison));
  answer["matrix"] = to_python(lab::variation_matrix(comparison));
  answer["passes"] = to_python(lab::pass_comparison(comparison));
  answer["counters"] = to_python(lab::counter_comparison(comparison));
  return answer;
}

/// GPUs by their names; each what-if is a list of overlays with a label.
py::dict compare(Workshop& shop, const py::dict& words, const std::vector<std::string>& gpus,
                 const std::vector<std::string>& what_ifs) {
  lab::Request request = to_request(words);
  request.gpus = gpus;
  return tables_of(shop.ask(
      [&](lab::Lab& lab) { return lab.compare(request, lab::variations_of({.what_ifs = what_ifs})); }));
}

/// A result as to_json() writes it, with its label, its variation (what is laid over its GPU), that GPU, and
/// a number that results of one frame share.
using TimedWords = std::tuple<std::string, std::string, std::string, const Gpu*, std::size_t>;

lab::LabeledResult labeled(const TimedWords& words) {
  const auto& [label, variation, text, gpu, view] = words;
  return {label, lab::result_from_json(Json::parse(text)), variation, gpu->config, view};
}

py::dict compare_results(Workshop& shop, const std::vector<TimedWords>& results) {
  std::vector<lab::LabeledResult> all;
  for (const TimedWords& words : results) all.push_back(labeled(words));
  return tables_of(shop.ask([&](lab::Lab& lab) { return lab::compare(all, lab.calibration()); }));
}

/// The 90 % interval of (after - before) / before; none without a calibration.
std::optional<std::array<double, 2>> change_interval(Workshop& shop, const TimedWords& before,
                                                     const TimedWords& after) {
  const std::vector<lab::LabeledResult> both = {labeled(before), labeled(after)};
  return shop.ask([&](lab::Lab& lab) {
    return lab::compare(both, lab.calibration()).differences.front().time_change_interval;
  });
}

py::dict validate(Workshop& shop, const std::vector<std::string>& papers) {
  const lab::Validation validation = shop.ask([&](lab::Lab& lab) { return lab.validate(papers); });
  py::dict answer;
  answer["json"] = to_python(to_json(validation));
  answer["splits"] = to_python(lab::split_table(validation));
  answer["ratios"] = to_python(lab::ratio_table(validation));
  answer["labels"] = to_python(lab::label_table(validation));
  return answer;
}

/// Writes the page of a request's points, with the what-ifs as hardware that they can be moved to.
void report(Workshop& shop, const py::dict& words, const std::vector<std::string>& gpus,
            const std::vector<std::string>& what_ifs, const std::string& file, const std::string& command) {
  lab::Request request = to_request(words);
  request.gpus = gpus;
  const std::vector<lab::Variation> variations = lab::variations_of({.what_ifs = what_ifs});
  shop.ask([&](lab::Lab& lab) {
    std::optional<lab::Comparison> comparison;
    if (!variations.empty()) comparison = lab.compare(request, variations);
    lab::Report page = lab.report(request, variations, comparison);
    page.command = command;
    lab.write_report(page, file);
    return true;
  });
}

/// The same of folders, databases and JSON that the program wrote.
void report_of(Workshop& shop, const std::vector<std::string>& inputs, const std::string& file,
               const std::string& command) {
  shop.ask([&](lab::Lab& lab) {
    lab::Report page = lab.report(inputs);
    page.command = command;
    lab.write_report(page, file);
    return true;
  });
}

py::list doctor(Workshop& shop) {
  py::list checks;
  for (const lab::SelfCheck& check : shop.ask([](lab::Lab& lab) { return lab.check_itself(); }))
    checks.append(py::make_tuple(check.name, check.ok, check.wall_ms, check.detail));
  return checks;
}

py::dict table_of(const Workshop& shop, const std::string& kind) {
  const lab::Catalog& catalog = shop.catalog();
  if (kind == "gpus") return to_python(catalog.gpus());
  if (kind == "scenes") return to_python(catalog.scenes());
  if (kind == "techniques") return to_python(catalog.techniques());
  if (kind == "counters") return to_python(catalog.counters());
  if (kind == "overlays") return to_python(catalog.overlays());
  throw py::value_error("no table is called " + kind);
}

}  // namespace

void bind_labs(py::module_& module) {
  py::class_<Workshop>(module, "Lab", "A lab that works in a thread of its own.")
      .def(py::init(&make_workshop), py::arg("configs"), py::arg("cache"), py::arg("jobs"),
           py::arg("use_cache"), py::arg("listener"))
      .def("gpu", make_gpu, py::arg("name"), py::arg("overlays"), py::arg("sets"), py::arg("calibrated"))
      .def("scene", scene_of, py::arg("request"))
      .def("reference", reference_of, py::arg("request"), py::arg("samples"))
      .def("check", check, py::arg("request"), py::arg("gpus"))
      .def("emulate", emulate, py::arg("request"), py::arg("gpu"))
      .def("frame_for", frame_for, py::arg("frame"), py::arg("gpu"))
      .def("time_variants", time_variants, py::arg("frame"), py::arg("gpu"), py::arg("axes"))
      .def("rank", rank, py::arg("request"), py::arg("gpu"), py::arg("budget"))
      .def("compare", compare, py::arg("request"), py::arg("gpus"), py::arg("what_ifs"))
      .def("compare_results", compare_results, py::arg("results"))
      .def("change_interval", change_interval, py::arg("before"), py::arg("after"))
      .def("validate", validate, py::arg("papers"))
      .def("report", report, py::arg("request"), py::arg("gpus"), py::arg("what_ifs"), py::arg("file"),
           py::arg("command"))
      .def("report_of", report_of, py::arg("inputs"), py::arg("file"), py::arg("command"))
      .def("doctor", doctor)
      .def("table", table_of, py::arg("kind"));
}

}  // namespace hwsim::python
