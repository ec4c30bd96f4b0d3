#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/progress.h"
#include "hwsim/base/units_of_measure.h"
#include "hwsim/engines/sensitivity.h"
#include "lab/base/messages.h"
#include "lab/results/results.h"
#include "lab/studies/comparison.h"

namespace hwsim::cli {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kPercent = 100.0;
constexpr size_t kTopUnits = 5;
constexpr double kShownElasticity = 0.0005;  // less than 0.05 % of time for 100 % of value

template <class Values>
std::vector<size_t> largest(const Values& values, size_t count) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return values[a] > values[b]; });
  order.resize(std::min(count, order.size()));
  std::erase_if(order, [&](size_t i) { return values[i] <= 0.0; });
  return order;
}

/// Hardware's answer to "why": what has the largest share, and who comes next.
Table pass_table_of(const PointResult& point) {
  Table table{{{"pass", "pass"},
               {"time_ms", "ms", true},
               {"limiter", "limiter"},
               {"stack", "time stack", false, 60},
               {"top_sol", "busiest units, SOL %", false, 60}},
              {}};
  for (const PassTiming& pass : point.timing.passes) {
    std::string stack, busiest;
    for (const size_t u : largest(pass.stack_ns, kTopUnits))
      stack += fmt::format("{}{} {:.0f} %", stack.empty() ? "" : ", ", unit_name(static_cast<Unit>(u)),
                           kPercent * pass.stack_ns[u] / std::max(pass.time_ns, 1e-9));
    for (const size_t u : largest(pass.sol_ratio, kTopUnits))
      busiest += fmt::format("{}{} {:.0f}", busiest.empty() ? "" : ", ", unit_name(static_cast<Unit>(u)),
                             kPercent * pass.sol_ratio[u]);
    table.rows.push_back(
        {pass.name, Real{pass.time_ns / kNsPerMs, 4}, std::string(unit_name(pass.limiter)), stack, busiest});
  }
  return table;
}

Table headroom_table(const std::vector<UnitHeadroom>& units, double frame_ns) {
  Table table{
      {{"unit", "if this unit took no time"}, {"time_ms", "ms", true}, {"change_pct", "change %", true}}, {}};
  for (const UnitHeadroom& unit : units)
    table.rows.push_back({std::string(unit_name(unit.unit)), Real{unit.time_ns / kNsPerMs, 4},
                          Real{kPercent * relative_change(frame_ns, unit.time_ns).value_or(0.0), 1}});
  return table;
}

Table sensitivity_table(const std::vector<Sensitivity>& all, double frame_ns, bool every) {
  Table table{{{"parameter", "parameter"},
               {"value", "value", true},
               {"elasticity", "% of time a % of it", true},
               {"doubled_change_pct", "doubled: change %", true}},
              {}};
  for (const Sensitivity& s : all) {
    if (!every && std::abs(s.elasticity) < kShownElasticity) continue;
    const Cell doubled =
        s.doubled_ns ? Cell{Real{kPercent * relative_change(frame_ns, *s.doubled_ns).value_or(0.0), 2}}
                     : Cell{NotApplicable{}};
    table.rows.push_back({"gpu." + std::string(s.key), Real{s.value, 3}, Real{s.elasticity, 4}, doubled});
  }
  return table;
}

/// What one sentence can say: where the time goes, and what would help.
std::string verdict(double frame_ns, const std::vector<Sensitivity>& sensitivities,
                    const std::vector<UnitHeadroom>& units) {
  if (units.empty()) return "";
  const UnitHeadroom& best = units.front();
  const double gain = -relative_change(frame_ns, best.time_ns).value_or(0.0);
  std::string text =
      fmt::format("{} holds the frame back most: without its work it would be {:.1f} % shorter",
                  unit_name(best.unit), kPercent * gain);
  const auto helps = std::find_if(sensitivities.begin(), sensitivities.end(),
                                  [](const Sensitivity& s) { return s.elasticity != 0.0; });
  if (helps != sensitivities.end())
    text += fmt::format("; the strongest lever is gpu.{} ({:+.2f} % of time a percent)", helps->key,
                        helps->elasticity);
  return text + "\n";
}

Json explanation_json(const PointResult& point, const RunPlan& plan, const std::string& scene,
                      const std::vector<Sensitivity>& all, const std::vector<UnitHeadroom>& units) {
  Json json = result_json(point, plan, scene);
  for (size_t i = 0; i < point.timing.passes.size(); ++i)
    for (size_t u = 0; u < kUnitCount; ++u)
      json["passes"][i]["stack_ms"][std::string(unit_name(static_cast<Unit>(u)))] =
          point.timing.passes[i].stack_ns[u] / kNsPerMs;
  json["headroom"] = Json::object();
  for (const UnitHeadroom& unit : units)
    json["headroom"][std::string(unit_name(unit.unit))] = {{"time_ms", unit.time_ns / kNsPerMs}};
  json["sensitivity"] = Json::array();
  for (const Sensitivity& s : all)
    json["sensitivity"].push_back(
        {{"parameter", "gpu." + std::string(s.key)},
         {"value", s.value},
         {"slope_ms", s.slope_ns / kNsPerMs},
         {"elasticity", s.elasticity},
         {"doubled_ms", s.doubled_ns ? Json(*s.doubled_ns / kNsPerMs) : Json(nullptr)}});
  return json;
}

struct Explanation {
  std::string text;
  Table sensitivities;
  Json json;
};

Explanation explain_point(const PointResult& point, const RunPlan& plan, const std::string& scene,
                          bool every) {
  const WorkTrace& trace = point.emulation->trace;
  // The events of `detailed` have no derivatives: what its parameters do is said by `queue`.
  const Engine engine = plan.engine == Engine::detailed ? Engine::queue : plan.engine;
  std::vector<Sensitivity> all = sensitivities(trace, *point.gpu, engine);
  std::stable_sort(all.begin(), all.end(), [](const Sensitivity& a, const Sensitivity& b) {
    return std::abs(a.elasticity) > std::abs(b.elasticity);
  });
  const std::vector<UnitHeadroom> units = headroom(trace, *point.gpu, engine);
  const double frame_ns =
      engine == plan.engine ? point.timing.time_ns : time_frame(trace, *point.gpu, engine).time_ns;
  Explanation result;
  result.sensitivities = sensitivity_table(all, frame_ns, every);
  result.text = headline(point, plan, scene) + verdict(frame_ns, all, units) + "\n" +
                to_text(pass_table_of(point)) + "\n" + to_text(headroom_table(units, frame_ns)) + "\n";
  result.json = explanation_json(point, plan, scene, all, units);
  return result;
}

/// Rows of all points under one header, the point first where there are several.
Table joined(const std::vector<Explanation>& explanations, const std::vector<std::string>& names) {
  Table table = explanations.front().sensitivities;
  if (explanations.size() == 1) return table;
  table.rows.clear();
  table.columns.insert(table.columns.begin(), {"point", "point"});
  for (size_t i = 0; i < explanations.size(); ++i)
    for (std::vector<Cell> row : explanations[i].sensitivities.rows) {
      row.insert(row.begin(), names[i]);
      table.rows.push_back(std::move(row));
    }
  return table;
}

}  // namespace

ExitStatus explain(const ExplainOptions& options, Context& context) {
  RunOptions run = options;
  run.no_image = true;
  const RunPlan plan = plan_of(run);
  SceneView scene(plan.view, context.log);
  TraceStore store({.jobs = options.common.jobs, .disk = !options.no_cache}, context.log);
  Progress progress(options.common, context.terminal);
  Simulator simulator(plan, scene, nullptr, store);
  std::vector<Explanation> explanations;
  std::vector<std::string> names;
  std::vector<ComparedResult> compared;
  for (const algos::TechniqueChoice& technique : plan.techniques)
    for (const GpuConfig& gpu : plan.gpus) {
      names.push_back(algos::technique_text(technique) + " on " + gpu.id);
      const PointResult point = simulator.run(technique, gpu, [&](double done, const std::string& pass) {
        progress.update(done, names.back() + ": " + pass);
      });
      explanations.push_back(explain_point(point, plan, scene.summary().name, options.all));
      compared.push_back({names.back(), result_json(point, plan, scene.summary().name)});
    }
  progress.finish();
  std::string heading, footing;
  Json json = explanations.front().json;
  for (const Explanation& explanation : explanations) heading += explanation.text;
  if (explanations.size() > 1) {
    footing = "\n" + to_text(frame_comparison(compared)) + "\n" + to_text(pass_comparison(compared));
    json = {{"schema_version", kResultSchemaVersion}, {"results", Json::array()}};
    for (Explanation& explanation : explanations) json["results"].push_back(std::move(explanation.json));
    json["difference"] = comparison_json(compared)["results"];
  }
  print({.table = joined(explanations, names), .heading = heading, .footing = footing, .json = &json},
        options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
