#include "lab/results/result.h"
#include "lab/studies/ranking.h"

namespace hwsim::lab {
namespace {

using Json = nlohmann::ordered_json;

/// 0 where a technique that cannot run has no number.
double number(const Json& row, const char* key) {
  const Json& value = row.at(key);
  return value.is_null() ? 0.0 : value.get<double>();
}

/// None where an older program wrote no such number, or a technique that cannot run has none.
std::optional<double> optional_number(const Json& row, const char* key) {
  const Json value = row.value(key, Json());
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

std::string text(const Json& row, const char* key) {
  const Json& value = row.at(key);
  return value.is_null() ? std::string() : value.get<std::string>();
}

RankedTechnique technique_from_json(const Json& row) {
  RankedTechnique technique{.technique = text(row, "technique"),
                            .verdict = text(row, "verdict"),
                            .pareto = text(row, "pareto") == "yes",
                            .frame_ms = number(row, "frame_ms"),
                            .support = text(row, "support"),
                            .aa_ms = number(row, "aa_ms"),
                            .extra_mib = number(row, "extra_mib"),
                            .dram_mb = number(row, "dram_mb"),
                            .flip_mean = number(row, "flip_mean"),
                            .psnr_db = number(row, "psnr_db"),
                            .ssim = optional_number(row, "ssim").value_or(0.0),
                            .reason = text(row, "reason")};
  if (const auto flip = optional_number(row, "edge_flip_mean"))
    technique.edges = {*flip, row.at("edge_psnr_db").get<double>()};
  if (!row.at("lo_ms").is_null())
    technique.interval_ms = {row.at("lo_ms").get<double>(), row.at("hi_ms").get<double>()};
  if (const Json low = row.value("aa_lo_ms", Json()); !low.is_null())
    technique.aa_interval_ms = {low.get<double>(), row.at("aa_hi_ms").get<double>()};
  if (!row.at("shaded_samples").is_null())
    technique.shaded_samples = row.at("shaded_samples").get<std::uint64_t>();
  return technique;
}

}  // namespace

Table ranking_table(const Ranking& ranking) {
  Table table{{{"technique", "technique"},
               {"verdict", "verdict"},
               {"pareto", "Pareto", false, 0, true},
               {"frame_ms", "ms", true},
               {"lo_ms", "lo", true, 0, true},
               {"hi_ms", "hi", true, 0, true},
               {"support", "support"},
               {"aa_ms", "AA ms", true},
               {"aa_lo_ms", "lo", true},
               {"aa_hi_ms", "hi", true},
               {"extra_mib", "extra MiB", true},
               {"dram_mb", "DRAM MB", true, 0, true},
               {"flip_mean", "FLIP", true},
               {"psnr_db", "PSNR dB", true, 0, true},
               {"ssim", "SSIM", true, 0, true},
               {"shaded_samples", "shaded samples", true, 0, true},
               {"reason", "reason", false, 48}},
              {}};
  if (ranking.edges)
    table.columns.insert(table.columns.end() - 2,
                         {{"edge_flip_mean", "edge FLIP", true}, {"edge_psnr_db", "edge PSNR dB", true}});
  for (const RankedTechnique& t : ranking.techniques) {
    const auto value = [&](double number, int decimals) -> TableCell {
      return t.runs() ? TableCell{Real{number, decimals}} : TableCell{NotApplicable{}};
    };
    const auto bound = [](const std::optional<std::array<double, 2>>& interval, std::size_t i) -> TableCell {
      return interval ? TableCell{Real{(*interval)[i], 3}} : TableCell{NotApplicable{}};
    };
    table.rows.push_back({t.technique, t.verdict, t.pareto ? "yes" : "", value(t.frame_ms, 3),
                          bound(t.interval_ms, 0), bound(t.interval_ms, 1), t.support, value(t.aa_ms, 3),
                          bound(t.aa_interval_ms, 0), bound(t.aa_interval_ms, 1), value(t.extra_mib, 1),
                          value(t.dram_mb, 1), value(t.flip_mean, 4), value(t.psnr_db, 2), value(t.ssim, 4),
                          t.runs() ? TableCell{t.shaded_samples} : TableCell{NotApplicable{}}, t.reason});
    if (!ranking.edges) continue;
    const EdgeError edges = t.edges.value_or(EdgeError{});
    std::vector<TableCell>& row = table.rows.back();
    row.insert(row.end() - 2, {value(edges.flip_mean, 4), value(edges.psnr_db, 2)});
  }
  return table;
}

Json to_json(const Ranking& ranking) {
  Json json = {{"schema_version", kResultSchemaVersion},
               {"scene", ranking.scene},
               {"gpu", ranking.gpu},
               {"camera", ranking.camera},
               {"resolution", {ranking.resolution.width_px, ranking.resolution.height_px}},
               {"budget", ranking.budget},
               {"metric", ranking.metric},
               {"edges", ranking.edges},
               {"reference_samples", ranking.reference_samples},
               {"techniques", to_json(ranking_table(ranking))}};
  if (!ranking.regions) return json;
  json["regions"] = Json::array();
  for (const Region& region : *ranking.regions)
    json["regions"].push_back({{"x_px", region.x}, {"y_px", region.y}, {"side_px", region.side}});
  return json;
}

Ranking ranking_from_json(const Json& json) {
  Ranking ranking{
      .scene = json.at("scene").get<std::string>(),
      .gpu = json.at("gpu").get<std::string>(),
      .camera = json.value("camera", std::string()),
      .resolution = {json.at("resolution").at(0).get<int>(), json.at("resolution").at(1).get<int>()},
      .budget = json.at("budget").get<std::string>(),
      .metric = json.value("metric", std::string("flip")),
      .edges = json.value("edges", false),
      .reference_samples = json.at("reference_samples").get<int>()};
  for (const Json& row : json.at("techniques")) ranking.techniques.push_back(technique_from_json(row));
  for (RankedTechnique& technique : ranking.techniques)
    technique.error = error_by(metric_from_name(ranking.metric), technique);
  if (const auto regions = json.find("regions"); regions != json.end()) {
    ranking.regions.emplace();
    for (const Json& region : *regions)
      ranking.regions->push_back(
          {region.at("x_px").get<int>(), region.at("y_px").get<int>(), region.at("side_px").get<int>()});
  }
  return ranking;
}

std::vector<Ranking> rankings_from_json(const Json& json) {
  if (!json.contains("rankings")) return {ranking_from_json(json)};
  std::vector<Ranking> rankings;
  for (const Json& ranking : json.at("rankings")) rankings.push_back(ranking_from_json(ranking));
  return rankings;
}

Table joined_table(const std::vector<Ranking>& rankings) {
  Table joined;
  for (const Ranking& ranking : rankings) {
    Table table = ranking_table(ranking);
    if (joined.columns.empty()) {
      joined.columns = {
          {"scene", "scene"}, {"gpu", "GPU"}, {"camera", "camera"}, {"resolution", "resolution"}};
      joined.columns.insert(joined.columns.end(), table.columns.begin(), table.columns.end());
    }
    const std::string resolution =
        std::to_string(ranking.resolution.width_px) + "x" + std::to_string(ranking.resolution.height_px);
    for (std::vector<TableCell>& row : table.rows) {
      std::vector<TableCell> whole = {ranking.scene, ranking.gpu, ranking.camera, resolution};
      whole.insert(whole.end(), row.begin(), row.end());
      joined.rows.push_back(std::move(whole));
    }
  }
  return joined;
}

double shown_error(const std::string& metric, double error) {
  return metric == "psnr" ? -error : metric == "ssim" ? 1.0 - error : error;
}

Table overall_table(const std::vector<OverallTechnique>& techniques) {
  const OverallTechnique first = techniques.empty() ? OverallTechnique{} : techniques.front();
  const bool psnr = first.metric == "psnr", ssim = first.metric == "ssim";
  const std::string of = psnr ? "PSNR dB" : ssim ? "SSIM" : "FLIP";
  Table table{{{"technique", "technique"},
               {"verdict", "worst verdict"},
               {"rankings", "runs in", true},
               {"aa_ms_most", "AA ms at most", true},
               {"extra_mib_most", "extra MiB at most", true},
               {"mean_" + first.metric, std::string("mean ") + (first.edges ? "edge " : "") + of, true}},
              {}};
  for (const OverallTechnique& t : techniques) {
    const auto value = [&](double number, int decimals) -> TableCell {
      return t.rankings > 0 ? TableCell{Real{number, decimals}} : TableCell{NotApplicable{}};
    };
    table.rows.push_back({t.technique, t.verdict, std::uint64_t{t.rankings}, value(t.aa_ms_most, 3),
                          value(t.extra_mib_most, 1),
                          value(shown_error(t.metric, t.error_mean), psnr ? 2 : 4)});
  }
  return table;
}

Json to_json(const std::vector<Ranking>& rankings) {
  Json json = {{"schema_version", kResultSchemaVersion}, {"rankings", Json::array()}};
  for (const Ranking& ranking : rankings) json["rankings"].push_back(to_json(ranking));
  json["overall"] = to_json(overall_table(overall(rankings)));
  return json;
}

}  // namespace hwsim::lab
