#include "cost_models/calibration.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cost_models/covariance.h"
#include "cost_models/published.h"
#include "hwsim/config/assign.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/gpu_show.h"

namespace hwsim::cost_models {
namespace {

using Json = nlohmann::ordered_json;

Json parameter_json(const CalibratedParameter& p) {
  return {{"scope", scope_name(p.scope)},
          {"member", p.member},
          {"name", p.name},
          {"unit", p.unit},
          {"value", p.value},
          {"interval90", {p.low90, p.high90}},
          {"start", p.start},
          {"range", {p.low, p.high}},
          {"used", p.used},
          {"at_bound", p.at_bound},
          {"identified", p.identified},
          {"credible", p.credible}};
}

CalibratedParameter parameter_from(const Json& json) {
  CalibratedParameter p;
  const std::string scope = json.at("scope");
  for (const Scope s : {Scope::gpu, Scope::all, Scope::scene})
    if (scope_name(s) == scope) p.scope = s;
  p.member = json.at("member");
  p.name = json.at("name");
  p.unit = json.at("unit");
  p.value = json.at("value");
  p.low90 = json.at("interval90").at(0);
  p.high90 = json.at("interval90").at(1);
  p.start = json.at("start");
  p.low = json.at("range").at(0);
  p.high = json.at("range").at(1);
  p.used = json.at("used");
  p.at_bound = json.at("at_bound");
  p.identified = json.at("identified");
  p.credible = json.at("credible");
  return p;
}

[[noreturn]] void damaged(const std::string& path, const std::string& why) {
  Diagnostic problem{.code = "M006", .message = "`" + path + "` is no calibration: " + why};
  problem.place.file = path;
  problem.help = "`hwsim fit --out " + path.substr(0, path.rfind('/')) + " --force` writes it anew";
  throw InputError(problem);
}

/// Fitted values of one GPU: those of scope all, then its own.
std::vector<const CalibratedParameter*> parameters_of(const Calibration& calibration,
                                                      const std::string& gpu) {
  std::vector<const CalibratedParameter*> found;
  for (const CalibratedParameter& p : calibration.parameters)
    if (p.used && concerns(calibration, p, gpu)) found.push_back(&p);
  return found;
}

}  // namespace

bool concerns(const Calibration& calibration, const CalibratedParameter& parameter, const std::string& gpu) {
  if (parameter.scope != Scope::all) return parameter.scope == Scope::gpu && parameter.member == gpu;
  return std::none_of(calibration.parameters.begin(), calibration.parameters.end(), [&](const auto& own) {
    return own.scope == Scope::gpu && own.member == gpu && own.name == parameter.name;
  });
}

Calibration make_calibration(const Experiment& experiment, const Validation& validation) {
  Calibration c;
  const Fit& fit = validation.fit;
  for (std::size_t i = 0; i < experiment.parameters.size(); ++i) {
    const FittedParameter& p = experiment.parameters[i];
    const Estimate& e = fit.estimates[i];
    c.parameters.push_back({p.scope, p.member, p.name, p.unit, p.start, p.low, p.high, e.value, e.low90,
                            e.high90, e.used, e.at_bound, e.identified, e.credible});
  }
  c.covariance = fit.covariance;
  c.residual_log_sd = fit.residual_log_sd;
  c.ratio_log_sd = validation.ratio_log_sd;
  for (const SplitResult& split : validation.splits) {
    c.ratio_quantile90[std::string(split_name(split.split))] = split.ratio_quantile90;
    c.quantile90[std::string(split_name(split.split))] = split.quantile90;
    if (split.split != Split::leave_scene_out) continue;
    for (const HeldOut& held : split.cells)
      c.held_out_ms[experiment.cells[held.cell].row.id()] = held.predicted_ms;
  }
  const std::vector<bool> fitted = fitted_cells(experiment);
  for (const Replay& replay : experiment.replays)
    for (const std::size_t cell : replay.cells)
      if (fitted[cell]) c.techniques[replay.run.gpu].insert(replay.trace->technique);
  c.gpu_keys = hashed_keys();
  for (const GpuConfig& gpu : experiment.gpus)
    if (c.techniques.contains(gpu.id))
      c.gpu_hashes[gpu.id] = content_hash(calibrated_gpu(gpu, c), c.gpu_keys);
  return c;
}

GpuConfig calibrated_gpu(const GpuConfig& documented, const Calibration& calibration) {
  GpuConfig gpu = documented;
  const std::vector<Key> keys = keys_of(static_cast<GpuValues<double>&>(gpu));
  for (const CalibratedParameter* p : parameters_of(calibration, gpu.id)) {
    const auto key =
        std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.info.name == p->name; });
    if (key == keys.end()) continue;
    *std::get<double*>(key->slot) = p->value;
    Origin& origin = gpu.origins[p->name];
    origin = Origin{};
    origin.layer = Origin::Layer::file;
    origin.provenance = Provenance::fitted;
    origin.source = p->scope == Scope::all ? "hwsim fit, all GPUs" : "hwsim fit";
    if (p->at_bound) origin.source += ", at the end of its range";
    if (!p->credible) origin.source += ", not credible";
    if (!p->identified) origin.source += ", not identified by the data";
    origin.interval = {std::min(p->low90, p->value), std::max(p->high90, p->value)};
  }
  return gpu;
}

std::string calibrated_file(const GpuConfig& documented, const Calibration& calibration) {
  std::set<std::string> keys;
  for (const CalibratedParameter* p : parameters_of(calibration, documented.id)) keys.insert(p->name);
  return "# Written by `hwsim fit`: what the papers' times say about this GPU beyond its documents.\n" +
         show_extension(calibrated_gpu(documented, calibration), documented.id, keys);
}

std::string to_json(const Calibration& c) {
  Json json = {{"schema_version", c.version}, {"residual_log_sd", c.residual_log_sd}};
  json["quantile90"] = c.quantile90;
  json["ratio_log_sd"] = c.ratio_log_sd;
  json["ratio_quantile90"] = c.ratio_quantile90;
  json["techniques"] = c.techniques;
  json["gpu_keys"] = c.gpu_keys;
  json["gpu_hashes"] = c.gpu_hashes;
  json["parameters"] = Json::array();
  for (const CalibratedParameter& p : c.parameters) json["parameters"].push_back(parameter_json(p));
  const std::size_t n = c.parameters.size();
  json["covariance"] = Json::array();
  for (std::size_t i = 0; i < n; ++i)
    json["covariance"].push_back(
        std::vector<double>(c.covariance.begin() + static_cast<std::ptrdiff_t>(i * n),
                            c.covariance.begin() + static_cast<std::ptrdiff_t>((i + 1) * n)));
  json["held_out_ms"] = c.held_out_ms;
  return json.dump(1) + "\n";
}

Calibration calibration_from_json(const std::string& text, const std::string& path) try {
  const Json json = Json::parse(text);
  Calibration c;
  c.version = json.at("schema_version");
  c.residual_log_sd = json.at("residual_log_sd");
  c.quantile90 = json.at("quantile90").get<std::map<std::string, double>>();
  c.ratio_log_sd = json.at("ratio_log_sd");
  c.ratio_quantile90 = json.at("ratio_quantile90").get<std::map<std::string, double>>();
  c.techniques = json.at("techniques").get<std::map<std::string, std::set<std::string>>>();
  c.gpu_keys = json.at("gpu_keys").get<std::set<std::string>>();
  c.gpu_hashes = json.at("gpu_hashes").get<std::map<std::string, std::string>>();
  c.held_out_ms = json.at("held_out_ms").get<std::map<std::string, double>>();
  for (const Json& p : json.at("parameters")) c.parameters.push_back(parameter_from(p));
  for (const Json& row : json.at("covariance"))
    for (const Json& value : row) c.covariance.push_back(value);
  if (c.covariance.size() != c.parameters.size() * c.parameters.size())
    damaged(path, "its covariance has another size than its parameters");
  return c;
} catch (const nlohmann::json::exception& error) {
  damaged(path, error.what());
}

std::optional<Fit> fit_of(const Calibration& calibration, const std::vector<FittedParameter>& parameters) {
  const bool same =
      std::equal(parameters.begin(), parameters.end(), calibration.parameters.begin(),
                 calibration.parameters.end(), [](const FittedParameter& a, const CalibratedParameter& b) {
                   return a.scope == b.scope && a.member == b.member && a.name == b.name;
                 });
  if (!same) return std::nullopt;
  Fit fit;
  for (const CalibratedParameter& p : calibration.parameters) {
    fit.log_values.push_back(std::log(p.value));
    fit.estimates.push_back({p.value, p.low90, p.high90, p.used, p.at_bound, p.identified, p.credible});
  }
  fit.covariance = calibration.covariance;
  fit.residual_log_sd = calibration.residual_log_sd;
  return fit;
}

}  // namespace hwsim::cost_models
