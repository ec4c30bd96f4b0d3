#include <algorithm>

#include "lab/studies/validation.h"

namespace hwsim::lab {
namespace {

using Json = nlohmann::ordered_json;

Json errors_json(const Errors& errors) {
  Json json = {{"cells", errors.cells},
               {"mape_pct", errors.mape_pct},
               {"median_ape_pct", errors.median_ape_pct},
               {"worst", nullptr},
               {"kendall", errors.kendall},
               {"coverage90_pct", errors.coverage90_pct},
               {"width_ratio", errors.width_ratio}};
  if (errors.worst)
    json["worst"] = {
        {"row", errors.worst->row}, {"cell", errors.worst->cell}, {"ape_pct", errors.worst->ape_pct}};
  return json;
}

Errors errors_from_json(const Json& json) {
  Errors errors{.cells = json.at("cells").get<std::size_t>(),
                .mape_pct = json.at("mape_pct").get<double>(),
                .median_ape_pct = json.at("median_ape_pct").get<double>(),
                .kendall = json.at("kendall").get<double>(),
                .coverage90_pct = json.at("coverage90_pct").get<double>(),
                .width_ratio = json.value("width_ratio", 1.0)};
  if (const Json& worst = json.at("worst"); !worst.is_null())
    errors.worst = CellError{worst.at("row").get<std::string>(), worst.at("cell").get<std::string>(),
                             worst.at("ape_pct").get<double>()};
  return errors;
}

Json ratios_json(const RatioErrors& ratios) {
  return {{"pairs", ratios.pairs},
          {"median_ape_pct", ratios.median_ape_pct},
          {"coverage90_pct", ratios.coverage90_pct},
          {"width_ratio", ratios.width_ratio}};
}

/// None in a file of an earlier version.
RatioErrors ratios_from_json(const Json& json) {
  return {.pairs = json.value("pairs", std::size_t{0}),
          .median_ape_pct = json.value("median_ape_pct", 0.0),
          .coverage90_pct = json.value("coverage90_pct", 0.0),
          .width_ratio = json.value("width_ratio", 1.0)};
}

Json named_json(const NamedValues<Errors>& values) {
  Json json = Json::object();
  for (const auto& [name, errors] : values) json[name] = errors_json(errors);
  return json;
}

NamedValues<Errors> named_from_json(const Json& json) {
  NamedValues<Errors> values;
  for (const auto& [name, errors] : json.items()) values.emplace_back(name, errors_from_json(errors));
  return values;
}

/// In the file by baseline, then by split.
void take_baselines(const Json& json, std::vector<SplitErrors>& splits) {
  for (const auto& [baseline, by_split] : json.items())
    for (const auto& [name, errors] : by_split.items()) {
      const auto split = std::ranges::find(splits, name, &SplitErrors::split);
      if (split != splits.end()) split->baselines.emplace_back(baseline, errors_from_json(errors));
    }
}

}  // namespace

Json to_json(const Validation& validation) {
  Json json = {{"schema_version", 1}, {"splits", Json::object()}, {"baselines", Json::object()}};
  for (const SplitErrors& split : validation.splits) {
    json["splits"][split.split] = errors_json(split.errors);
    json["splits"][split.split]["ratios"] = ratios_json(split.ratios);
    for (const auto& [baseline, errors] : split.baselines)
      json["baselines"][baseline][split.split] = errors_json(errors);
  }
  json["papers"] = named_json(validation.papers);
  json["gpus"] = named_json(validation.gpus);
  json["counts"] = {
      {"shaded_samples",
       {{"mape_pct", validation.shaded_samples.error_pct}, {"cells", validation.shaded_samples.cells}}},
      {"memory", {{"worst_pct", validation.memory.error_pct}, {"cells", validation.memory.cells}}}};
  json["parameters"] = validation.parameters;
  json["fitted_values"] = validation.fitted_values;
  json["not_run"] = Json::array();
  for (const UnpredictedRow& row : validation.not_run)
    json["not_run"].push_back({{"row", row.row}, {"reason", row.reason}});
  return json;
}

Validation validation_from_json(const Json& json) {
  const Json& samples = json.at("counts").at("shaded_samples");
  const Json& memory = json.at("counts").at("memory");
  Validation validation{
      .papers = named_from_json(json.at("papers")),
      .gpus = named_from_json(json.at("gpus")),
      .shaded_samples = {samples.at("mape_pct").get<double>(), samples.at("cells").get<std::size_t>()},
      .memory = {memory.at("worst_pct").get<double>(), memory.at("cells").get<std::size_t>()},
      .parameters = json.at("parameters").get<std::size_t>(),
      .fitted_values = json.at("fitted_values").get<std::size_t>()};
  for (const auto& [name, errors] : json.at("splits").items())
    validation.splits.push_back(
        {name, errors_from_json(errors), {}, ratios_from_json(errors.value("ratios", Json::object()))});
  take_baselines(json.at("baselines"), validation.splits);
  for (const Json& row : json.at("not_run"))
    validation.not_run.push_back({row.at("row").get<std::string>(), row.at("reason").get<std::string>()});
  return validation;
}

}  // namespace hwsim::lab
