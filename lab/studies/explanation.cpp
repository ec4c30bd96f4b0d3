#include "lab/studies/explanation.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "hwsim/base/units_of_measure.h"
#include "hwsim/engines/sensitivity.h"

namespace hwsim::lab {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kAnalyzedMs = "analyzed_ms";

NamedValues<double> stack_of(const PassTiming& pass) {
  NamedValues<double> stack;
  for (std::size_t u = 0; u < kUnitCount; ++u)
    stack.emplace_back(unit_name(static_cast<Unit>(u)), pass.stack_ns[u] / kNsPerMs);
  return stack;
}

std::vector<SensitivityResult> sensitivities_of(const WorkTrace& trace, const GpuConfig& gpu, Engine engine) {
  std::vector<Sensitivity> all = sensitivities(trace, gpu, engine);
  std::ranges::stable_sort(all, std::greater{}, [](const Sensitivity& s) { return std::abs(s.elasticity); });
  std::vector<SensitivityResult> results;
  for (const Sensitivity& s : all) {
    SensitivityResult& result = results.emplace_back();
    result = {"gpu." + std::string(s.key), s.value, s.slope_ns / kNsPerMs, s.elasticity, std::nullopt};
    if (s.doubled_ns) result.doubled_ms = *s.doubled_ns / kNsPerMs;
  }
  return results;
}

Json sensitivity_json(const SensitivityResult& s) {
  return {{"parameter", s.parameter},
          {"value", s.value},
          {"slope_ms", s.slope_ms},
          {"elasticity", s.elasticity},
          {"doubled_ms", s.doubled_ms ? Json(*s.doubled_ms) : Json(nullptr)}};
}

SensitivityResult sensitivity_from_json(const Json& json) {
  SensitivityResult s{json.at("parameter").get<std::string>(), json.at("value").get<double>(),
                      json.at("slope_ms").get<double>(), json.at("elasticity").get<double>(), std::nullopt};
  if (const Json& doubled = json.at("doubled_ms"); !doubled.is_null()) s.doubled_ms = doubled.get<double>();
  return s;
}

}  // namespace

Explanation explain(const PointResult& point, const RunPlan& plan, const std::string& scene_name) {
  const WorkTrace& trace = point.emulation->trace;
  const Engine engine = plan.engine == Engine::detailed ? Engine::queue : plan.engine;
  Explanation explanation{.result = make_result(point, plan, scene_name)};
  for (const PassTiming& pass : point.timing.passes) explanation.stack_ms.push_back(stack_of(pass));
  for (const UnitHeadroom& unit : headroom(trace, *point.gpu, engine))
    explanation.headroom.push_back({std::string(unit_name(unit.unit)), unit.time_ns / kNsPerMs});
  explanation.sensitivities = sensitivities_of(trace, *point.gpu, engine);
  explanation.analyzed_ms = engine == plan.engine ? explanation.result.frame.time_ms
                                                  : time_frame(trace, *point.gpu, engine).time_ns / kNsPerMs;
  return explanation;
}

Json to_json(const Explanation& explanation) {
  Json json = to_json(explanation.result);
  for (std::size_t i = 0; i < explanation.stack_ms.size(); ++i)
    for (const auto& [unit, time_ms] : explanation.stack_ms[i]) json["passes"][i]["stack_ms"][unit] = time_ms;
  if (explanation.analyzed_ms != explanation.result.frame.time_ms)
    json[kAnalyzedMs] = explanation.analyzed_ms;
  json["headroom"] = Json::object();
  for (const UnitHeadroomResult& unit : explanation.headroom)
    json["headroom"][unit.unit] = {{"time_ms", unit.time_ms}};
  json["sensitivity"] = Json::array();
  for (const SensitivityResult& s : explanation.sensitivities)
    json["sensitivity"].push_back(sensitivity_json(s));
  return json;
}

Explanation explanation_from_json(const Json& json) {
  Explanation explanation{.result = result_from_json(json)};
  for (const Json& pass : json.at("passes")) {
    NamedValues<double>& stack = explanation.stack_ms.emplace_back();
    for (const auto& [unit, time_ms] : pass.at("stack_ms").items())
      stack.emplace_back(unit, time_ms.get<double>());
  }
  for (const auto& [unit, value] : json.at("headroom").items())
    explanation.headroom.push_back({unit, value.at("time_ms").get<double>()});
  for (const Json& s : json.at("sensitivity")) explanation.sensitivities.push_back(sensitivity_from_json(s));
  explanation.analyzed_ms = json.value(kAnalyzedMs, explanation.result.frame.time_ms);
  return explanation;
}

std::string label_of(const Explanation& explanation) {
  return explanation.result.technique + " on " + explanation.result.gpu;
}

Comparison compare(const std::vector<Explanation>& explanations,
                   const cost_models::Calibration* calibration) {
  std::vector<LabeledResult> results;
  for (const Explanation& explanation : explanations)
    results.push_back({label_of(explanation), explanation.result, {}});
  return compare(results, calibration);
}

Json to_json(const std::vector<Explanation>& explanations, const cost_models::Calibration* calibration) {
  if (explanations.size() == 1) return to_json(explanations.front());
  Json json = {{"schema_version", kResultSchemaVersion}, {"results", Json::array()}};
  for (const Explanation& explanation : explanations) json["results"].push_back(to_json(explanation));
  json["difference"] = to_json(compare(explanations, calibration))["results"];
  return json;
}

}  // namespace hwsim::lab
