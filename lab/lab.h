#pragma once
// The whole application as one class: a program asks a lab, and gets answers as plain data. A lab keeps the
// scenes, traces and references that it has loaded, so that a second question costs less than the first.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lab/catalog/catalog.h"
#include "lab/environment.h"
#include "lab/point/run_sink.h"
#include "lab/report/report.h"
#include "lab/results/result.h"
#include "lab/studies/comparison.h"
#include "lab/studies/explanation.h"
#include "lab/studies/external.h"
#include "lab/studies/kept_frame.h"
#include "lab/studies/optimize.h"
#include "lab/studies/ranking.h"
#include "lab/studies/reproduction.h"
#include "lab/studies/self_check.h"
#include "lab/studies/sweep.h"
#include "lab/studies/sweep_work.h"
#include "lab/studies/validation.h"
#include "lab/studies/variants.h"
#include "lab/studies/variation.h"

namespace hwsim::lab {

struct NamedPlan {
  std::string name;  ///< how its files are called; empty for a request that is not varied
  RunPlan plan;
};

/// Every function throws InputError for a mistake in what was asked, before anything is drawn where it can be
/// told by then, and InternalError when hwsim broke one of its own laws. Not for several threads at once.
class Lab {
 public:
  /// The environment is not asked: options_of_environment() does that for who wants it.
  explicit Lab(const LabOptions& options = {});
  ~Lab();
  Lab(Lab&&) noexcept;
  Lab& operator=(Lab&&) noexcept;

  /// What there is: GPUs, techniques, scenes, overlays, counters, published tables, error codes.
  const Catalog& catalog() const { return catalog_; }
  const Cache& cache() const;
  /// What intervals come from; null where the configuration holds no fit. Valid as long as the lab.
  const cost_models::Calibration* calibration();

  /// The request with every value decided; its problems are appended, nothing is drawn.
  RunPlan plan(const Request& request, std::vector<Diagnostic>& problems);

  /// The same for GPUs that are chosen one by one: the request's overlays and gpu.* settings are laid over
  /// each of them, and its own list of GPUs is not looked at.
  RunPlan plan(const Request& request, const std::vector<GpuChoice>& gpus, std::vector<Diagnostic>& problems);

  /// The request's plan in each view, with the name of the view's files. Throws InputError with the problems
  /// of all views, and U019 where `views` varies what changes no image.
  std::vector<NamedPlan> plan_views(const Request& request, const PointSettings& views);

  /// The GPU with all that is laid over it.
  GpuConfig gpu(const GpuChoice& choice);

  /// What the same plan took the last time; none when it is new.
  std::optional<double> expected_seconds(const RunPlan& plan) const;

  /// Each technique on each GPU. `sink` is given every point with its images while it comes.
  Run run(const Request& request, RunSink* sink = nullptr);
  Run run(const RunPlan& plan, RunSink* sink = nullptr);

  /// Draws one technique for one GPU; time(), explain() and gradient() of studies/kept_frame.h take the frame
  /// then. Throws InputError U004 unless there is one of each.
  KeptFrame emulate(const RunPlan& plan);
  /// The same frame where its work is that GPU's work, else one that is drawn for the GPU's features.
  KeptFrame frame_for(const KeptFrame& frame, const GpuConfig& gpu);
  /// The frame on each variant of a GPU, each a list of gpu.* settings, in the lab's threads.
  std::vector<VariantTime> time_variants(const KeptFrame& frame, const GpuChoice& gpu,
                                         const PointSettings& each);

  /// The request against each variation of it, each technique and each GPU; there must be two results at
  /// least.
  Comparison compare(const Request& request, const std::vector<Variation>& variations = {});
  /// Results that runs have written.
  Comparison compare_folders(const std::vector<std::string>& folders);

  /// What the lab knows of a view's scene, and the view's ray-traced truth. Valid as long as the lab.
  const SceneSummary& scene(const View& view);
  const ReferenceImage& reference(const View& view, int samples);

  /// The request's techniques on its GPU, with `none` among them, under a budget ("aa_ms<=1.5,
  /// extra_mib<=192"; empty: none). `contact_sheet` receives crops where the images err most.
  Ranking rank(const Request& request, const std::string& budget = {}, RunSink* sink = nullptr,
               pipeline::Image* contact_sheet = nullptr);
  Ranking rank(const RunPlan& plan, const std::string& budget = {}, RunSink* sink = nullptr,
               pipeline::Image* contact_sheet = nullptr);

  /// The same in several views and on all GPUs of each plan: a ranking for each, in this order. Images are
  /// drawn and compared once for all GPUs that share a frame. `begin_view` is told of each plan before it
  /// runs; `contact_sheets` receives one a plan.
  std::vector<Ranking> rank_each(const std::vector<RunPlan>& plans, const RankQuestion& question,
                                 RunSink* sink = nullptr,
                                 std::vector<pipeline::Image>* contact_sheets = nullptr,
                                 const std::function<void(std::size_t)>& begin_view = {});

  /// Why each technique takes its time on each GPU.
  std::vector<Explanation> explain(const Request& request);
  std::vector<Explanation> explain(const RunPlan& plan);

  /// Every technique on every GPU with each list of settings, into a database. A plan stays valid as long as
  /// the lab.
  SweepPlan plan_sweep(const Request& request, PointSettings settings);
  SweepSummary sweep(const SweepPlan& plan, const SweepJob& job);
  /// The frames that a sweep's points need, shared out among so many processes; and those of one of them,
  /// emulated into the cache.
  std::vector<PlannedWork> sweep_works(const SweepPlan& plan, std::size_t shards);
  EmulationSummary emulate_works(const SweepPlan& plan, const Shard& shard);

  /// The cheapest or the fastest GPU for the request's techniques in each view that `frames` varies, at the
  /// prices of a file (studies/prices.h). Throws InputError U004 unless there is one GPU, and U019 where
  /// `frames` varies what changes no image.
  Optimization optimize(const Request& request, const PointSettings& frames, const std::string& prices,
                        const OptimizeGoal& goal);

  /// The tables of a paper, published beside predicted.
  Reproduction reproduce(const std::string& paper);

  /// Errors on published times that the fit did not see; all papers, or those named.
  Validation validate(const std::vector<std::string>& papers = {});
  /// The same from several random starts, for write_calibration. Throws InputError M004 and M005 when there
  /// are more parameters than the published times can tell.
  FittedModel fit(const std::vector<std::string>& papers = {}, int starts = 10);

  /// Errors on other renderers' times, which no fit sees. `scenes_folder`: where the scenes are that their
  /// frames are emulated from; empty: from kept work.
  ExternalValidation validate_external(const std::string& scenes_folder = {});

  /// All that a report shows of what `run`, `rank`, `compare` and `sweep` wrote (docs/report.md).
  Report report(const std::vector<std::string>& inputs);
  /// The same of a request's points, and of a comparison that was just made of it: its variations become
  /// hardware that the page can take.
  Report report(const Request& request, const std::vector<Variation>& variations,
                const std::optional<Comparison>& comparison);
  /// A paper's tables, laid out as the paper has them.
  Report report_of_paper(const Reproduction& reproduction);
  /// One HTML file that needs nothing else. Says what it lacks where parts of the page were not built.
  /// Throws InputError U010.
  void write_report(const Report& report, const std::string& file) const;

  /// Whether hwsim works here: its files, its modules, its cache, a small simulation.
  std::vector<SelfCheck> check_itself();

 private:
  Catalog catalog_;
  std::string page_folder_;
  std::unique_ptr<Observer> silence_;
  std::unique_ptr<Session> session_;
};

}  // namespace hwsim::lab
