#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "cli/arguments/help_texts.h"
#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/progress.h"
#include "hwsim/base/units_of_measure.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/results/contact_sheet.h"
#include "lab/results/run_files.h"
#include "lab/studies/budget.h"
#include "pipeline/image/image_io.h"

namespace hwsim::cli {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr int kRegionSidePx = 48, kRegions = 4;

struct Candidate {
  std::string technique;
  std::string verdict;
  std::string reason;  ///< why an unsupported one cannot run
  bool pareto = false;
  Costs costs;
  std::string support;
  std::uint64_t shaded_samples = 0;
  pipeline::ImageError error;
  bool runs() const { return reason.empty(); }
};

/// Every base on its own, and every filter behind no anti-aliasing: what `list techniques` names.
std::vector<std::string> all_techniques() {
  std::vector<std::string> names;
  for (const algos::TechniqueInfo& info : algos::techniques())
    if (info.kind() != algos::TechniqueKind::modifier) names.emplace_back(info.id);
  return names;
}

/// Nobody else is both faster and closer to the reference.
void mark_pareto(std::vector<Candidate>& candidates) {
  for (Candidate& a : candidates)
    a.pareto = a.runs() && std::none_of(candidates.begin(), candidates.end(), [&](const Candidate& b) {
                 const double time = b.costs.frame_ms - a.costs.frame_ms;
                 const double error = b.error.flip_mean - a.error.flip_mean;
                 return b.runs() && time <= 0.0 && error <= 0.0 && (time < 0.0 || error < 0.0);
               });
}

Table rank_table(const std::vector<Candidate>& candidates) {
  Table table{{{"technique", "technique"},
               {"verdict", "verdict"},
               {"pareto", "Pareto"},
               {"frame_ms", "ms", true},
               {"lo_ms", "lo", true},
               {"hi_ms", "hi", true},
               {"support", "support"},
               {"aa_ms", "AA ms", true},
               {"extra_mib", "extra MiB", true},
               {"dram_mb", "DRAM MB", true},
               {"flip_mean", "FLIP", true},
               {"psnr_db", "PSNR dB", true},
               {"shaded_samples", "shaded samples", true},
               {"reason", "reason", false, 48}},
              {}};
  for (const Candidate& c : candidates) {
    const auto value = [&](double number, int decimals) -> Cell {
      return c.runs() ? Cell{Real{number, decimals}} : Cell{NotApplicable{}};
    };
    const auto bound = [&](size_t i) -> Cell {
      return c.costs.interval_ms ? Cell{Real{(*c.costs.interval_ms)[i], 3}} : Cell{NotApplicable{}};
    };
    table.rows.push_back({c.technique, c.verdict, c.pareto ? "yes" : "", value(c.costs.frame_ms, 3), bound(0),
                          bound(1), c.support, value(c.costs.aa_ms, 3), value(c.costs.extra_mib, 1),
                          value(c.costs.dram_mb, 1), value(c.error.flip_mean, 4), value(c.error.psnr_db, 2),
                          c.runs() ? Cell{c.shaded_samples} : Cell{NotApplicable{}}, c.reason});
  }
  return table;
}

class Ranking {
 public:
  Ranking(const RankOptions& options, Context& context);
  ExitStatus finish();

 private:
  void run_all();
  void run_one(const algos::TechniqueChoice& technique, Simulator& simulator);
  void judge();
  std::string sentence() const;

  const RankOptions& options_;
  Context& context_;
  Clock::time_point start_ = Clock::now();
  std::vector<Limit> budget_;
  RunPlan plan_;
  InterruptGuard guard_;
  std::unique_ptr<RunDirectory> directory_;
  std::unique_ptr<SceneView> scene_;
  ReferenceImage reference_;
  std::vector<Candidate> candidates_;
  std::vector<ShownImage> shown_;
  size_t done_ = 0;
};

RunOptions with_defaults(const RankOptions& options) {
  RunOptions run = options;
  if (run.techniques.empty()) run.techniques = all_techniques();
  if (!run.reference_samples) run.reference_samples = kDefaultReferenceSamples;
  return run;
}

/// The costs of anti-aliasing are those beyond a frame without any: `none` is always among the candidates.
void put_none_first(std::vector<algos::TechniqueChoice>& techniques) {
  const auto is_none = [](const algos::TechniqueChoice& t) { return algos::technique_text(t) == "none"; };
  const auto found = std::find_if(techniques.begin(), techniques.end(), is_none);
  if (found == techniques.end())
    techniques.insert(techniques.begin(), algos::parse_technique("none"));
  else
    std::rotate(techniques.begin(), found, found + 1);
}

Ranking::Ranking(const RankOptions& options, Context& context) : options_(options), context_(context) {
  if (!options.budget.empty()) budget_ = parse_budget(options.budget);
  plan_ = plan_of(with_defaults(options));
  if (plan_.gpus.size() != 1)
    fail_usage("U004", "techniques are ranked on one GPU at a time", "", "one --gpu");
  put_none_first(plan_.techniques);
  context_.log.say(fmt::format("plan: {}, {} techniques on {}, {}x{}, reference of {} samples a pixel",
                               plan_.view.scene, plan_.techniques.size(), plan_.gpus.front().id,
                               plan_.view.resolution.width_px, plan_.view.resolution.height_px,
                               plan_.reference_samples));
  directory_ = std::make_unique<RunDirectory>(options.out, plan_.view.scene + options.budget);
  guard_.remove_on_interrupt(directory_->partial());
  run_all();
  judge();
}

void Ranking::run_all() {
  Progress progress(options_.common, context_.terminal);
  scene_ = std::make_unique<SceneView>(plan_.view, context_.log);
  const auto stages = static_cast<double>(plan_.techniques.size() + 1);
  reference_ =
      make_reference(*scene_, plan_.reference_samples, options_.common.jobs,
                     [&](double done, const std::string& what) { progress.update(done / stages, what); });
  if (plan_.images) shown_.push_back(shown_image("reference", reference_.image, nullptr));
  TraceStore store({.jobs = options_.common.jobs, .disk = !options_.no_cache}, context_.log);
  Simulator simulator(plan_, *scene_, &reference_, store);
  for (const algos::TechniqueChoice& technique : plan_.techniques) {
    progress.update(static_cast<double>(++done_) / stages, algos::technique_text(technique));
    run_one(technique, simulator);
  }
}

void Ranking::run_one(const algos::TechniqueChoice& technique, Simulator& simulator) {
  Candidate candidate;
  candidate.technique = algos::technique_text(technique);
  try {
    const PointResult point = simulator.run(technique, plan_.gpus.front(), nullptr);
    write_point_files(directory_->path(point_folder(point)), point, plan_, scene_->summary().name,
                      &reference_);
    const FrameTiming& timing = point.timing;
    candidate.costs.frame_ms = timing.time_ns / kNsPerMs;
    if (timing.interval_ns)
      candidate.costs.interval_ms = {(*timing.interval_ns)[0] / kNsPerMs,
                                     (*timing.interval_ns)[1] / kNsPerMs};
    candidate.costs.memory_mib = static_cast<double>(point.emulation->trace.peak_memory_bytes) / kBytesPerMib;
    candidate.costs.dram_mb =
        (timing.dram_bytes.total_read() + timing.dram_bytes.total_write()) / kBytesPerMb;
    candidate.support = support_name(timing.support);
    candidate.shaded_samples = algos::shaded_samples(point.emulation->trace);
    candidate.error = *point.image_error;
    if (plan_.images)
      shown_.push_back(shown_image(candidate.technique, point.emulation->color, &point.flip_map));
  } catch (const InputError& error) {  // this GPU lacks a feature, or an image would be too large for it
    if (candidates_.empty()) throw;    // not even a plain frame can be drawn
    candidate.reason = error.what();
  }
  candidates_.push_back(std::move(candidate));
}

void Ranking::judge() {
  const Costs none = candidates_.front().costs;
  for (Candidate& candidate : candidates_) {
    candidate.costs.aa_ms = candidate.costs.frame_ms - none.frame_ms;
    candidate.costs.extra_mib = candidate.costs.memory_mib - none.memory_mib;
    candidate.verdict = candidate.runs() ? std::string(verdict(candidate.costs, budget_)) : "unsupported";
  }
  mark_pareto(candidates_);
  // The best first: within the budget before at risk before the others, then by error.
  const auto grade = [](const Candidate& c) {
    return c.verdict == "ok" ? 0 : c.verdict == "at risk" ? 1 : c.verdict == "unsupported" ? 3 : 2;
  };
  std::stable_sort(candidates_.begin(), candidates_.end(), [&](const Candidate& a, const Candidate& b) {
    return std::pair(grade(a), a.error.flip_mean) < std::pair(grade(b), b.error.flip_mean);
  });
}

std::string Ranking::sentence() const {
  const Candidate& best = candidates_.front();
  if (best.verdict != "ok" && best.verdict != "at risk") return "no technique stays within the budget\n\n";
  return fmt::format(
      "{} has the least error{}: FLIP {:.4f}, {:+.3f} ms and {:+.1f} MiB beyond no anti-aliasing{}\n\n",
      best.technique, budget_.empty() ? "" : " within the budget", best.error.flip_mean, best.costs.aa_ms,
      best.costs.extra_mib, best.verdict == "ok" ? "" : ", at risk");
}

ExitStatus Ranking::finish() {
  const Table table = rank_table(candidates_);
  Json json = {{"schema_version", kResultSchemaVersion},
               {"scene", scene_->summary().name},
               {"gpu", plan_.gpus.front().id},
               {"resolution", {plan_.view.resolution.width_px, plan_.view.resolution.height_px}},
               {"budget", options_.budget},
               {"reference_samples", plan_.reference_samples},
               {"techniques", to_json(table)}};
  if (plan_.images) {
    const std::vector<Region> regions = worst_regions(shown_, kRegionSidePx, kRegions);
    pipeline::write_image(contact_sheet(shown_, regions), directory_->path("contact_sheet.png"));
    json["regions"] = Json::array();
    for (const Region& region : regions)
      json["regions"].push_back({{"x_px", region.x}, {"y_px", region.y}, {"side_px", region.side}});
  }
  write_file(directory_->path("ranking.csv"), to_csv(table));
  write_file(directory_->path("ranking.json"), json.dump(2) + "\n");
  const double wall_s = std::chrono::duration<double>(Clock::now() - start_).count();
  const ManifestInput manifest_input{.arguments = context_.arguments,
                                     .plan = &plan_,
                                     .scene = &scene_->summary(),
                                     .wall_s = wall_s,
                                     .fragments = 0,
                                     .emulation_s = 0.0,
                                     .state = "done"};
  write_file(directory_->path("manifest.json"), manifest(manifest_input).dump(2) + "\n");
  write_file(directory_->path("log.txt"), context_.log.text());
  directory_->commit();
  guard_.keep();
  print({.table = table, .heading = sentence(), .footing = {}, .json = &json}, options_.common);
  context_.log.say("results: " + directory_->final_place().string());
  return ExitStatus::done;
}

}  // namespace

ExitStatus rank(const RankOptions& options, Context& context) { return Ranking(options, context).finish(); }

}  // namespace hwsim::cli
