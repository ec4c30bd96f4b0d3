#include "lab/lab.h"

#include <fmt/format.h>

#include <chrono>

#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/report/gather.h"
#include "lab/report/page.h"
#include "lab/request/image_input.h"
#include "lab/studies/published_runs.h"
#include "lab/studies/views.h"

namespace hwsim::lab {
namespace {

/// Tells both; only the first one may take a failure.
class Fork : public RunSink {
 public:
  Fork(RunSink& first, RunSink* second) : first_(first), second_(second) {}
  void begin(const RunContext& run) override {
    first_.begin(run);
    if (second_) second_->begin(run);
  }
  void point(const PointResult& point, const RunContext& run) override {
    first_.point(point, run);
    if (second_) second_->point(point, run);
  }
  bool takes_failures() const override { return first_.takes_failures(); }
  void failed(const algos::TechniqueChoice& technique, const GpuConfig& gpu,
              const InputError& error) override {
    first_.failed(technique, gpu, error);
  }

 private:
  RunSink& first_;
  RunSink* second_;
};

class ResultSink : public RunSink {
 public:
  void begin(const RunContext& run) override {
    run_.scene = run.scene.name;
    run_.resolution = run.plan.view.resolution;
  }
  void point(const PointResult& point, const RunContext& run) override {
    run_.results.push_back(make_result(point, run.plan, run.scene.name));
  }
  Run take() { return std::move(run_); }

 private:
  Run run_;
};

class ExplanationSink : public RunSink {
 public:
  void point(const PointResult& point, const RunContext& run) override {
    explanations.push_back(lab::explain(point, run.plan, run.scene.name));
  }
  std::vector<Explanation> explanations;
};

class FrameSink : public RunSink {
 public:
  void point(const PointResult& point, const RunContext& run) override { frame = kept_frame(point, run); }
  KeptFrame frame;
};

/// Neither images nor what they would be compared with.
RunPlan numbers_only(RunPlan plan) {
  plan.images = false;
  plan.reference_samples = 0;
  return plan;
}

std::string label_of(const Result& result, const std::string& variation, bool several) {
  if (!several) return variation;
  const std::string point = result.technique + " on " + result.gpu;
  return variation.empty() ? point : point + " " + variation;
}

}  // namespace

Lab::Lab(const LabOptions& options)
    : catalog_(ConfigFolder(options.config_folder)),
      page_folder_(options.page_folder),
      silence_(std::make_unique<Observer>()),
      session_(std::make_unique<Session>(options, options.observer ? *options.observer : *silence_)) {}

Lab::~Lab() = default;
Lab::Lab(Lab&&) noexcept = default;
Lab& Lab::operator=(Lab&&) noexcept = default;

const Cache& Lab::cache() const { return session_->cache(); }

const cost_models::Calibration* Lab::calibration() { return session_->files().calibration().get(); }

RunPlan Lab::plan(const Request& request, std::vector<Diagnostic>& problems) {
  return make_plan(request, session_->files(), problems);
}

std::vector<NamedPlan> Lab::plan_views(const Request& request, const PointSettings& views) {
  std::vector<Diagnostic> problems;
  std::vector<NamedPlan> plans;
  for (const NamedView& view : views_of(request, views, problems))
    plans.push_back({view.name, make_plan(view.request, session_->files(), problems)});
  if (!problems.empty()) throw InputError(problems);
  return plans;
}

RunPlan Lab::plan(const Request& request, const std::vector<GpuChoice>& gpus,
                  std::vector<Diagnostic>& problems) {
  Request shared = request;
  shared.gpus.clear();
  RunPlan plan = make_plan(shared, session_->files(), problems);
  for (GpuChoice choice : gpus) try {
      choice.overlays.insert(choice.overlays.end(), request.overlays.begin(), request.overlays.end());
      choice.sets.insert(choice.sets.end(), request.sets.begin(), request.sets.end());
      plan.gpus.push_back(gpu(choice));
    } catch (const InputError& error) {
      append(problems, error);
    }
  return plan;
}

GpuConfig Lab::gpu(const GpuChoice& choice) { return session_->files().gpu(choice); }

KeptFrame Lab::emulate(const RunPlan& plan) {
  if (plan.techniques.size() != 1 || plan.gpus.size() != 1)
    fail_usage("U004", "a frame is of one technique and one GPU", "", "one of each");
  FrameSink sink;
  run(plan, &sink);
  return std::move(sink.frame);
}

KeptFrame Lab::frame_for(const KeptFrame& frame, const GpuConfig& gpu) {
  if (is_work_of(frame, gpu)) return frame;
  RunPlan plan = frame.plan;
  plan.gpus = {gpu};
  return emulate(plan);
}

std::vector<VariantTime> Lab::time_variants(const KeptFrame& frame, const GpuChoice& gpu,
                                            const PointSettings& each) {
  return lab::time_variants(frame, {session_->files().gpu_files(gpu), gpu.sets, each}, session_->jobs(),
                            session_->observer());
}

Run Lab::run(const Request& request, RunSink* sink) {
  return run(make_plan(request, session_->files()), sink);
}

std::optional<double> Lab::expected_seconds(const RunPlan& plan) const {
  return cache().remembered_seconds(plan_key(plan, session_->jobs()));
}

Run Lab::run(const RunPlan& plan, RunSink* sink) {
  const auto start = std::chrono::steady_clock::now();
  ResultSink results;
  Fork fork(results, sink);
  StageProgress progress(session_->observer(), Session::stages(plan));
  session_->run(plan, fork, progress);
  cache().remember_seconds(plan_key(plan, session_->jobs()),
                           std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return results.take();
}

Comparison Lab::compare(const Request& request, const std::vector<Variation>& variations) {
  std::vector<RunPlan> plans = plans_of(request, variations, session_->files());
  const std::size_t points = plans.front().techniques.size() * plans.front().gpus.size();
  if (points * plans.size() < 2)
    fail_usage("U002", "there is nothing to compare the result with", "",
               "two results, two techniques or GPUs, --set, --overlay, --vary or --what-if");
  session_->observer().say(
      fmt::format("plan: {}, {} results to compare", request.view.scene, points * plans.size()));
  StageProgress progress(session_->observer(), points * plans.size());
  std::vector<RunPlan> numbers;
  for (const RunPlan& plan : plans) numbers.push_back(numbers_only(plan));
  const SharedFrames shared(numbers, *session_);
  std::vector<LabeledResult> labeled;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    ResultSink sink;
    session_->run(numbers[i], sink, progress);
    const std::string label = i > 0 ? variations[i - 1].label : points == 1 ? "baseline" : "";
    const std::size_t gpus = plans[i].gpus.size();  // points go by technique, then by GPU
    const bool same_view = plans[i].view == plans.front().view;
    std::size_t point = 0;
    for (Result& result : sink.take().results) {
      std::string name = label_of(result, label, points > 1);
      labeled.push_back({std::move(name), std::move(result), i > 0 ? variations[i - 1].label : "",
                         plans[i].gpus[point++ % gpus], same_view ? 0 : i});
    }
  }
  return lab::compare(labeled, plans.front().calibration.get());
}

Comparison Lab::compare_folders(const std::vector<std::string>& folders) {
  return compare_results(folders, calibration());
}

const SceneSummary& Lab::scene(const View& view) { return session_->scene(view).summary(); }

const ReferenceImage& Lab::reference(const View& view, int samples) {
  if (is_image_file(view.scene))
    fail("U030", "a ray-traced reference has no meaning for the image `" + view.scene + "`", "",
         "a scene: a glTF file, or a name of `hwsim list scenes`");
  const StageProgress progress(session_->observer(), 1);
  return session_->reference(session_->scene(view), samples,
                             [&](double done, const std::string& what) { progress.update(done, what); });
}

Ranking Lab::rank(const Request& request, const std::string& budget, RunSink* sink,
                  pipeline::Image* contact_sheet) {
  return rank(make_plan(request, session_->files()), budget, sink, contact_sheet);
}

Ranking Lab::rank(const RunPlan& plan, const std::string& budget, RunSink* sink,
                  pipeline::Image* contact_sheet) {
  if (plan.gpus.size() != 1) fail_usage("U004", "one ranking is of one GPU", "", "one --gpu");
  std::vector<pipeline::Image> sheets;
  std::vector<Ranking> rankings =
      rank_each({plan}, {.budget = budget}, sink, contact_sheet ? &sheets : nullptr);
  if (contact_sheet && !sheets.empty()) *contact_sheet = std::move(sheets.front());
  return std::move(rankings.front());
}

std::vector<Ranking> Lab::rank_each(const std::vector<RunPlan>& given, const RankQuestion& question,
                                    RunSink* sink, std::vector<pipeline::Image>* contact_sheets,
                                    const std::function<void(std::size_t)>& begin_view) {
  std::vector<RunPlan> plans;
  std::size_t stages = 0;
  for (const RunPlan& plan : given) stages += Session::stages(plans.emplace_back(ranking_plan(plan)));
  for (const RunPlan& plan : plans)
    session_->scene(plan.view);  // a camera that is none comes before any work
  StageProgress progress(session_->observer(), stages);
  std::vector<Ranking> rankings;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    if (begin_view) begin_view(i);
    RankingSink ranking(question);
    Fork fork(ranking, sink);
    session_->run(plans[i], fork, progress);
    if (contact_sheets && plans[i].images) contact_sheets->push_back(ranking.sheet());
    for (Ranking& found : ranking.rankings()) rankings.push_back(std::move(found));
  }
  return rankings;
}

std::vector<Explanation> Lab::explain(const Request& request) {
  return explain(make_plan(request, session_->files()));
}

std::vector<Explanation> Lab::explain(const RunPlan& given) {
  const RunPlan plan = numbers_only(given);
  ExplanationSink sink;
  StageProgress progress(session_->observer(), Session::stages(plan));
  session_->run(plan, sink, progress);
  return std::move(sink.explanations);
}

SweepPlan Lab::plan_sweep(const Request& request, PointSettings settings) {
  return {request, std::move(settings), *session_};
}

SweepSummary Lab::sweep(const SweepPlan& plan, const SweepJob& job) {
  return run_sweep(plan, job, *session_);
}

std::vector<PlannedWork> Lab::sweep_works(const SweepPlan& plan, std::size_t shards) {
  return works_of(plan, shards, *session_);
}

EmulationSummary Lab::emulate_works(const SweepPlan& plan, const Shard& shard) {
  return lab::emulate_works(plan, shard, *session_);
}

Optimization Lab::optimize(const Request& request, const PointSettings& frames, const std::string& prices,
                           const OptimizeGoal& goal) {
  if (request.gpus.size() != 1)
    fail_usage("U004", "a GPU is optimized from one GPU on", "", "one --gpu, the one to be changed");
  GpuChoice choice{request.gpus.front(), request.overlays, request.sets, request.settings.calibrated};
  const GpuFiles files = session_->files().gpu_files(choice);
  const GpuConfig gpu = files.with(choice.sets);
  const PriceList list = read_prices(session_->files().folder().prices_file(prices), gpu);
  std::vector<KeptFrame> kept;
  for (const NamedPlan& view : plan_views(request, frames)) {
    RunPlan plan = numbers_only(view.plan);
    for (const algos::TechniqueChoice& technique : view.plan.techniques) {
      plan.techniques = {technique};
      kept.push_back(emulate(plan));
    }
  }
  return lab::optimize(kept, {files, choice.sets}, list, goal);
}

Reproduction Lab::reproduce(const std::string& paper) {
  const auto calibration = session_->files().calibration();
  const cost_models::Experiment experiment = load_experiment({paper}, *session_);
  return lab::reproduce(paper, experiment, calibration.get(), session_->jobs(), session_->observer());
}

Validation Lab::validate(const std::vector<std::string>& papers) {
  cost_models::FitOptions options;
  options.jobs = session_->jobs();
  return errors_of(std::make_shared<const FittedModel>(
      fit_and_validate(load_experiment(papers, *session_), options, session_->observer())));
}

FittedModel Lab::fit(const std::vector<std::string>& papers, int starts) {
  cost_models::FitOptions options;
  options.jobs = session_->jobs();
  options.starts = starts;
  cost_models::Experiment experiment = load_experiment(papers, *session_);
  cost_models::check_parameter_count(experiment, cost_models::fitted_cells(experiment));
  return fit_and_validate(std::move(experiment), options, session_->observer());
}

ExternalValidation Lab::validate_external(const std::string& scenes_folder) {
  Observer& observer = session_->observer();
  ExternalValidation validation =
      lab::validate_external(external_traces(scenes_folder, *session_), *session_,
                             [&](double done, const std::string& what) { observer.progress(done, what); });
  observer.progress_ended();
  return validation;
}

Report Lab::report(const std::vector<std::string>& inputs) { return gather_report(inputs, *session_); }

Report Lab::report(const Request& request, const std::vector<Variation>& variations,
                   const std::optional<Comparison>& comparison) {
  return gather_report(request, variations, comparison, *session_);
}

Report Lab::report_of_paper(const Reproduction& reproduction) {
  return gather_report(reproduction, *session_);
}

void Lab::write_report(const Report& report, const std::string& file) const {
  const PageParts parts = read_page_parts(page_folder_);
  for (const std::string& missing : parts.missing) session_->observer().say("the report lacks " + missing);
  write_file(file, page_of(report, parts));
}

std::vector<SelfCheck> Lab::check_itself() { return lab::check_itself(*session_); }

}  // namespace hwsim::lab
