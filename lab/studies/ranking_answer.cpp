#include <fmt/format.h>

#include "lab/studies/ranking.h"

namespace hwsim::lab {
namespace {

std::string within(const Ranking& ranking) { return ranking.budget.empty() ? "" : " within the budget"; }

std::string error_text(const Ranking& ranking, double error) {
  const char* where = ranking.edges ? " at edges" : "";
  const double shown = shown_error(ranking.metric, error);
  if (ranking.metric == "psnr") return fmt::format("PSNR{} {:.2f} dB", where, shown);
  return fmt::format("{}{} {:.4f}", ranking.metric == "ssim" ? "SSIM" : "FLIP", where, shown);
}

std::string doubt(const std::string& verdict) {
  if (verdict == "ok") return "";
  return verdict == "unknown" ? " (no interval says how sure that is)" : " (" + verdict + ")";
}

std::string answer_of_one(const Ranking& ranking) {
  const RankedTechnique& best = ranking.techniques.front();
  if (!may_be_within(best.verdict)) return "no technique stays within the budget";
  return fmt::format("{} has the least error{}: {}, {:+.3f} ms and {:+.1f} MiB beyond no anti-aliasing{}",
                     best.technique, within(ranking), error_text(ranking, best.error), best.aa_ms,
                     best.extra_mib, doubt(best.verdict));
}

std::string view_name(const Ranking& ranking) {
  return fmt::format("{} of {}, {}x{}, on {}", ranking.camera, ranking.scene, ranking.resolution.width_px,
                     ranking.resolution.height_px, ranking.gpu);
}

}  // namespace

std::string answer_of(const std::vector<Ranking>& rankings) {
  if (rankings.size() == 1) return answer_of_one(rankings.front());
  const OverallTechnique best = overall(rankings).front();
  const std::string where = fmt::format("all {} rankings", rankings.size());
  if (!may_be_within(best.verdict)) return "no technique stays within the budget in " + where;
  const std::string error = error_text(rankings.front(), best.error_mean);
  return fmt::format(
      "{} has the least error in {}{}: {} in the mean, {:+.3f} ms and {:+.1f} MiB beyond no "
      "anti-aliasing at most{}",
      best.technique, where, within(rankings.front()), error, best.aa_ms_most, best.extra_mib_most,
      doubt(best.verdict));
}

Table best_table(const std::vector<Ranking>& rankings) {
  Table table{
      {{"view", "view"}, {"technique", "least error"}, {"verdict", "verdict"}, {"aa_ms", "AA ms", true}}, {}};
  for (const Ranking& ranking : rankings) {
    const RankedTechnique& best = ranking.techniques.front();
    table.rows.push_back({view_name(ranking), best.technique, best.verdict, Real{best.aa_ms, 3}});
  }
  return table;
}

}  // namespace hwsim::lab
