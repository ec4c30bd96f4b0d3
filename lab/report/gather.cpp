#include "lab/report/gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <tuple>

#include "hwsim/config/assign.h"
#include "hwsim/trace/trace_file.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/report/offers.h"
#include "lab/report/report_inputs.h"
#include "lab/results/contact_sheet.h"

namespace hwsim::lab {
namespace {

constexpr int kRegionSidePx = 64, kRegions = 6;

float largest(const pipeline::Image& image) {
  float found = 1.0f;
  for (const glm::vec4& pixel : image.pixels) found = std::max(found, pixel.x);
  return found;
}

/// Lifetimes follow from the frame graph, which is built again: it costs what loading the scene does.
FrameMemory memory_of(SceneView& scene, const algos::TechniqueChoice& technique, const GpuConfig& gpu) {
  algos::FrameRequest request = scene.frame_request();
  request.features = gpu.features;
  request.functional = gpu.functional;
  const pipeline::FrameGraph graph = algos::build_frame(technique, request);
  const pipeline::CompiledGraph compiled = pipeline::compile(graph, gpu.features, gpu.functional);
  FrameMemory memory;
  for (const int pass : compiled.order)
    memory.passes.push_back(graph.passes()[static_cast<std::size_t>(pass)].name);
  const auto add = [&](const auto& part, const pipeline::CompiledGraph::Lifetime& life) {
    if (life.first_pass >= 0)
      memory.parts.push_back({part.name, pipeline::allocated_bytes(part), life.first_pass, life.last_pass});
  };
  for (std::size_t i = 0; i < compiled.images.size(); ++i) add(graph.images()[i], compiled.images[i]);
  for (std::size_t i = 0; i < compiled.buffers.size(); ++i) add(graph.buffers()[i], compiled.buffers[i]);
  return memory;
}

/// The scene and the flags that give the view again.
std::string view_words(View view) {
  View plain;
  std::string words = shell_word(view.scene);
  if (view.resolution != plain.resolution)
    words += fmt::format(" --resolution {}x{}", view.resolution.width_px, view.resolution.height_px);
  if (view.camera != plain.camera) words += " --camera " + shell_word(view.camera);
  const std::vector<Field> fields = fields_of(view), defaults = fields_of(plain);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string value = to_toml(value_in(fields[i].slot));
    if (fields[i].info.group == "scene" && value != to_toml(value_in(defaults[i].slot)))
      words += fmt::format(" --set scene.{}={}", fields[i].info.key.name, value);
  }
  return words;
}

using ViewParts = std::array<std::string, 3>;  ///< scene, camera, resolution

/// Takes points as they come into a report.
class ReportSink : public RunSink {
 public:
  ReportSink(Report& report, Session& session) : report_(report), session_(session) {}

  void begin(const RunContext& run) override {
    const bool again =
        run.reference && reference_ && view_ == run.plan.view && samples_ == run.reference->samples;
    if (again) return;
    reference_.reset();
    if (!run.reference) return;
    view_ = run.plan.view;
    samples_ = run.reference->samples;
    reference_ = report_.references.size();
    report_.references.push_back(color_picture(run.reference->image));
  }

  void point(const PointResult& point, const RunContext& run) override {
    ReportedPoint& shown = report_.points.emplace_back();
    shown.explanation = explain(point, run.plan, run.scene.name);
    shown.technique = algos::technique_text(*point.technique, true);
    shown.view_words = view_words(run.plan.view);
    shown.gpu = *point.gpu;
    shown.trace = encode_trace(point.emulation->trace);
    shown.memory = memory_of(session_.scene(run.plan.view), *point.technique, *point.gpu);
    shown.reference = reference_;
    take_pictures(point, run, shown.pictures);
    share_pictures(shown);
    view_parts_.push_back(parts_of(run));
    shown.calibrated = run.plan.calibrated && run.plan.engine == Engine::queue;
    for (const Diagnostic& note : run.scene.notes) take_note(note);
  }

  bool takes_failures() const override { return true; }
  void failed(const algos::TechniqueChoice& technique, const GpuConfig& gpu,
              const InputError& error) override {
    report_.limits.push_back(
        fmt::format("{} cannot run: {}", point_name(technique, gpu), error.diagnostics().front().message));
  }

  /// Names of views from what differs between them; views that differ in something else are told by their
  /// words.
  void name_views() {
    for (std::size_t part = 0; part < std::tuple_size_v<ViewParts>; ++part) {
      const auto same = [&](const ViewParts& other) { return other[part] == view_parts_.front()[part]; };
      if (std::ranges::all_of(view_parts_, same)) continue;
      for (std::size_t i = 0; i < view_parts_.size(); ++i) {
        std::string& view = report_.points[i].view;
        view += (view.empty() ? "" : ", ") + view_parts_[i][part];
      }
    }
    const auto unnamed = [&](const ReportedPoint& point) {
      return point.view == report_.points.front().view &&
             point.view_words != report_.points.front().view_words;
    };
    if (std::ranges::any_of(report_.points, unnamed))
      for (ReportedPoint& point : report_.points) point.view = point.view_words;
  }

  /// Where the images err most, in the view of the first point.
  void mark_regions() {
    if (std::ranges::any_of(images_, [](const ShownImage& i) { return !i.error.empty(); }))
      report_.regions = worst_regions(images_, kRegionSidePx, kRegions);
  }

 private:
  /// What the loader of the scene ignored or changed: a default light, features that it does not know.
  void take_note(const Diagnostic& note) {
    if (std::ranges::find(report_.limits, note.message) == report_.limits.end())
      report_.limits.push_back(note.message);
  }

  ViewParts parts_of(const RunContext& run) {
    const std::vector<std::string>& cameras = run.scene.cameras;
    const auto camera = static_cast<std::size_t>(session_.scene(run.plan.view).camera());
    const Resolution& size = run.plan.view.resolution;
    return {run.scene.name, cameras.empty() ? std::string() : cameras.at(camera),
            fmt::format("{}x{}", size.width_px, size.height_px)};
  }

  void take_pictures(const PointResult& point, const RunContext& run, PointPictures& pictures) {
    const pipeline::Emulation& emulation = *point.emulation;
    if (!run.plan.images || emulation.color.pixels.empty()) return;
    pictures.color = color_picture(emulation.color);
    pictures.heat =
        value_picture(emulation.shading_heat, static_cast<double>(largest(emulation.shading_heat)));
    if (!point.flip_map) return;
    pictures.flip = value_picture(*point.flip_map, 1.0);
    if (report_.points.back().view_words == report_.points.front().view_words)
      images_.push_back(shown_image("", emulation.color, point.flip_map.get()));
  }

  /// GPUs of the same features draw the same picture, which the page needs once.
  void share_pictures(ReportedPoint& shown) {
    shown.pictures_of = report_.points.size() - 1;
    if (shown.pictures.color.empty()) return;
    const auto same = [](const Picture& a, const Picture& b) {
      return a.full_scale == b.full_scale && a.texels == b.texels;
    };
    for (std::size_t i = 0; i + 1 < report_.points.size(); ++i) {
      const PointPictures& other = report_.points[i].pictures;
      if (report_.points[i].view_words != shown.view_words || !same(other.color, shown.pictures.color) ||
          !same(other.flip, shown.pictures.flip) || !same(other.heat, shown.pictures.heat))
        continue;
      shown.pictures_of = i;
      shown.pictures = {};
      return;
    }
  }

  Report& report_;
  Session& session_;
  std::optional<std::size_t> reference_;  ///< the one of view_ with samples_
  View view_;
  int samples_ = 0;
  std::vector<ShownImage> images_;
  std::vector<ViewParts> view_parts_;  ///< one entry a point
};

void require_size(std::size_t points) {
  if (points == 0)
    fail("U023", "there is no point to report on", "", "a folder of `hwsim run` or `hwsim rank`, a sweep");
  if (points > kReportPointsMax)
    fail("U023", fmt::format("{} points, a report holds {} at most", points, kReportPointsMax), "",
         "fewer folders, or fewer techniques and GPUs");
}

void run_all(const std::vector<RunPlan>& plans, Report& report, Session& session) {
  std::size_t points = 0, stages = 0;
  for (const RunPlan& plan : plans) {
    points += plan.techniques.size() * plan.gpus.size();
    stages += Session::stages(plan);
  }
  require_size(points);
  StageProgress progress(session.observer(), stages);
  ReportSink sink(report, session);
  for (const RunPlan& plan : plans) session.run(plan, sink, progress);
  require_size(report.points.size());
  sink.mark_regions();
  sink.name_views();
}

/// "sponza_hall on gtx980"; what the points differ in is counted.
std::string title_of(const Report& report, const Result& first) {
  std::set<std::string> gpus, scenes;
  for (const ReportedPoint& point : report.points) {
    gpus.insert(point.explanation.result.gpu);
    scenes.insert(point.explanation.result.scene);
  }
  const auto one_or_count = [](const std::set<std::string>& names, const std::string& first_name,
                               const char* many) {
    return names.size() == 1 ? first_name : fmt::format("{} {}", names.size(), many);
  };
  const std::string on =
      one_or_count(scenes, first.scene, "scenes") + " on " + one_or_count(gpus, first.gpu, "GPUs");
  if (report.sweep) return fmt::format("{}: a sweep of {} points", on, report.sweep->findings.points);
  return report.rankings.size() > 1 ? fmt::format("{}: {} rankings", on, report.rankings.size()) : on;
}

void finish(Report& report, Session& session) {
  offer_gpus(report, session.files());
  offer_what_ifs(report, session.files().folder());
  std::set<std::string> gpus;
  for (const ReportedPoint& point : report.points) gpus.insert(point.gpu.id);
  report.belief = belief_of(gpus, session);
  note_limits(report);
  if (const auto calibration = session.files().calibration()) {
    const auto [fast, slow] = extremes_of(report);
    report.spread_interval =
        time_change_interval(fast->explanation.result, slow->explanation.result, *calibration);
  }
  const Result& first = report.points.front().explanation.result;
  report.title = title_of(report, first);
}

std::optional<std::size_t> changed_point(const Report& report, const RunPlan& plan,
                                         const algos::TechniqueChoice& technique, const GpuConfig& gpu) {
  for (std::size_t i = 0; i < report.points.size(); ++i) {
    const ReportedPoint& point = report.points[i];
    if (point.technique == algos::technique_text(technique, true) && point.gpu.id == gpu.id &&
        functional_hash(point.gpu) == functional_hash(gpu) && plan.engine == Engine::queue)
      return i;
  }
  return std::nullopt;
}

/// Variations that change nothing but numbers of a GPU become hardware that the page can take.
void add_variations(const std::vector<RunPlan>& plans, const std::vector<Variation>& variations,
                    Report& report) {
  for (std::size_t i = 1; i < plans.size(); ++i)
    for (const algos::TechniqueChoice& technique : plans[i].techniques)
      for (const GpuConfig& gpu : plans[i].gpus)
        if (const auto point = changed_point(report, plans[i], technique, gpu))
          report.variations.push_back({variations[i - 1].label, *point, gpu});
}

}  // namespace

Report gather_report(const std::vector<std::string>& inputs, Session& session) {
  Report report;
  std::vector<RunPlan> plans;
  std::vector<ReportInput> kept;  // files of theirs are read by make_plan
  for (const std::string& input : inputs) {
    ReportInput& read = kept.emplace_back(read_report_input(input));
    for (const Request& request : read.requests) plans.push_back(make_plan(request, session.files()));
    std::ranges::move(read.rankings, std::back_inserter(report.rankings));
    if (read.comparison) report.comparison = std::move(read.comparison);
    if (read.sweep) report.sweep = std::move(read.sweep);
  }
  run_all(plans, report, session);
  finish(report, session);
  return report;
}

Report gather_report(const Request& request, const std::vector<Variation>& variations,
                     const std::optional<Comparison>& comparison, Session& session) {
  Report report;
  const std::vector<RunPlan> plans = plans_of(request, variations, session.files());
  run_all({plans.front()}, report, session);
  report.comparison = comparison;
  add_variations(plans, variations, report);
  finish(report, session);
  return report;
}

Report gather_report(const Reproduction& reproduction, Session& session) {
  Report report;
  report.title = reproduction.paper + ": published and predicted";
  report.reproduction = reproduction;
  report.paper_tables = paper_tables(reproduction, session.files().folder().published());
  std::set<std::string> gpus, missing;
  for (const ReproducedRow& row : reproduction.rows) {
    if (row.cell.has_run) gpus.insert(row.cell.run.gpu);
    if (row.excluded_because.starts_with("not run")) missing.insert(row.excluded_because);
  }
  report.limits.emplace_back(
      "The scenes are stand-ins that are generated: built to the counts and looks that the paper tells of "
      "its own.");
  report.limits.emplace_back(
      "Fitted times were seen by the fit. The column of scenes held out, and the last section, have those "
      "that were not.");
  report.limits.emplace_back(
      "hwsim's pages docs/differences.md and docs/calibration.md say what differs from the paper, which "
      "cells are worst, "
      "and why as far as it is known.");
  report.limits.insert(report.limits.end(), missing.begin(), missing.end());
  report.belief = belief_of(gpus, session);
  return report;
}

}  // namespace hwsim::lab
