#include "lab/studies/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "hwsim/base/units_of_measure.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/results/results.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kPercent = 100.0;

Cell change_cell(double before, double after) {
  const auto change = relative_change(before, after);
  return change ? Cell{Real{*change * kPercent, 1}} : Cell{NotApplicable{}};
}

const Json* find_pass(const Json& result, const std::string& name) {
  for (const Json& pass : result["passes"])
    if (pass["name"] == name) return &pass;
  return nullptr;
}

double time_ms(const Json* pass) { return pass ? (*pass)["time_ms"].get<double>() : 0.0; }

double dram_mb(const Json* pass) {
  double bytes = 0.0;
  if (pass)
    for (const auto& [stream, value] : (*pass)["bytes"].items()) bytes += value.get<double>();
  return bytes / kBytesPerMb;
}

Cell limiter_cell(const Json* pass) {
  return pass ? Cell{(*pass)["limiter"].get<std::string>()} : Cell{NotApplicable{}};
}

/// Names of all passes of two results: in the order of the first, those that only the second has where they
/// stand there.
std::vector<std::string> pass_names(const Json& before, const Json& after) {
  std::vector<std::string> names;
  for (const Json& pass : before["passes"]) names.push_back(pass["name"]);
  auto place = names.begin();
  for (const Json& pass : after["passes"]) {
    const std::string name = pass["name"];
    const auto known = std::find(names.begin(), names.end(), name);
    place = (known != names.end() ? known : names.insert(place, name)) + 1;
  }
  return names;
}

std::string slowest_limiter(const Json& result) {
  const Json* slowest = nullptr;
  for (const Json& pass : result["passes"])
    if (time_ms(&pass) > time_ms(slowest)) slowest = &pass;
  return slowest ? fmt::format("{} in {}", (*slowest)["limiter"].get<std::string>(),
                               (*slowest)["name"].get<std::string>())
                 : "n/a";
}

/// Calls back for each counter of two passes that differs.
template <class Function>
void for_changed_counters(const Json* before, const Json* after, const Function& call) {
  const auto value = [](const Json* pass, const std::string& id) {
    if (!pass) return std::uint64_t{0};
    const auto found = (*pass)["counters"].find(id);
    return found == (*pass)["counters"].end() ? std::uint64_t{0} : found->template get<std::uint64_t>();
  };
  for (const auto& [id, unused] : (*(after ? after : before))["counters"].items())
    if (value(before, id) != value(after, id)) call(id, value(before, id), value(after, id));
}

Json pair_json(double before, double after) {
  const auto change = relative_change(before, after);
  return {{"before", before}, {"after", after}, {"delta_ratio", change ? Json(*change) : Json(nullptr)}};
}

Json pass_json(const std::string& name, const Json* before, const Json* after) {
  Json json = {{"name", name}, {"time_ms", pair_json(time_ms(before), time_ms(after))}};
  json["limiter"] = {{"before", before ? (*before)["limiter"] : Json(nullptr)},
                     {"after", after ? (*after)["limiter"] : Json(nullptr)}};
  json["dram_mb"] = pair_json(dram_mb(before), dram_mb(after));
  json["bytes"] = Json::object();
  for (const auto& [stream, unused] : (*(after ? after : before))["bytes"].items())
    json["bytes"][stream] = pair_json(before ? (*before)["bytes"].value(stream, 0.0) : 0.0,
                                      after ? (*after)["bytes"].value(stream, 0.0) : 0.0);
  json["counters"] = Json::object();
  for_changed_counters(before, after, [&](const std::string& id, std::uint64_t old, std::uint64_t now) {
    json["counters"][id] = {{"before", old}, {"after", now}};
  });
  return json;
}

ComparedResult read_result(const fs::path& file) try {
  ComparedResult compared{file.parent_path().string(), Json::parse(read_file(file.string()))};
  const Json& result = compared.result;
  for (const char* key : {"scene", "technique", "gpu"}) result.at(key).get<std::string>();
  for (const char* key : {"time_ms", "memory_mib", "dram_mb", "shaded_samples"})
    result.at("frame").at(key).get<double>();
  for (const Json& pass : result.at("passes")) {
    for (const char* key : {"name", "limiter"}) pass.at(key).get<std::string>();
    pass.at("time_ms").get<double>();
    for (const char* key : {"bytes", "counters"})
      for (const auto& [name, value] : pass.at(key).items()) value.get<double>();
  }
  return compared;
} catch (const Json::exception& error) {
  fail("U020", "`" + file.string() + "` is no result of `hwsim run`: " + error.what());
}

}  // namespace

std::optional<double> relative_change(double before, double after) {
  if (before == after) return 0.0;
  if (before == 0.0) return std::nullopt;
  return (after - before) / std::abs(before);
}

Table frame_comparison(const std::vector<ComparedResult>& results) {
  Table table{{{"result", "result"},
               {"technique", "technique"},
               {"gpu", "GPU"},
               {"time_ms", "ms", true},
               {"time_change_pct", "change %", true},
               {"limiter", "limiter of the slowest pass"},
               {"dram_mb", "DRAM MB", true},
               {"dram_change_pct", "change %", true},
               {"memory_mib", "memory MiB", true},
               {"shaded_samples", "shaded samples", true}},
              {}};
  const Json& base = results.front().result["frame"];
  for (const ComparedResult& compared : results) {
    const Json& frame = compared.result["frame"];
    const auto number = [&](const char* key) { return frame[key].get<double>(); };
    table.rows.push_back({compared.label, compared.result["technique"].get<std::string>(),
                          compared.result["gpu"].get<std::string>(), Real{number("time_ms"), 4},
                          change_cell(base["time_ms"], number("time_ms")), slowest_limiter(compared.result),
                          Real{number("dram_mb"), 1}, change_cell(base["dram_mb"], number("dram_mb")),
                          Real{number("memory_mib"), 1}, frame["shaded_samples"].get<std::uint64_t>()});
  }
  return table;
}

Table pass_comparison(const std::vector<ComparedResult>& results) {
  Table table{{{"result", "result"},
               {"pass", "pass"},
               {"before_ms", "before ms", true},
               {"after_ms", "after ms", true},
               {"time_change_pct", "change %", true},
               {"limiter_before", "limiter before"},
               {"limiter_after", "after"},
               {"dram_before_mb", "DRAM before MB", true},
               {"dram_after_mb", "after MB", true},
               {"dram_change_pct", "change %", true}},
              {}};
  const Json& base = results.front().result;
  for (size_t i = 1; i < results.size(); ++i)
    for (const std::string& name : pass_names(base, results[i].result)) {
      const Json* before = find_pass(base, name);
      const Json* after = find_pass(results[i].result, name);
      table.rows.push_back({results[i].label, name, before ? Cell{Real{time_ms(before), 4}} : NotApplicable{},
                            after ? Cell{Real{time_ms(after), 4}} : NotApplicable{},
                            change_cell(time_ms(before), time_ms(after)), limiter_cell(before),
                            limiter_cell(after), Real{dram_mb(before), 2}, Real{dram_mb(after), 2},
                            change_cell(dram_mb(before), dram_mb(after))});
    }
  return table;
}

Table counter_comparison(const std::vector<ComparedResult>& results) {
  Table table{{{"result", "result"},
               {"pass", "pass"},
               {"counter", "counter"},
               {"before", "before", true},
               {"after", "after", true},
               {"change_pct", "change %", true}},
              {}};
  const Json& base = results.front().result;
  for (size_t i = 1; i < results.size(); ++i)
    for (const std::string& name : pass_names(base, results[i].result))
      for_changed_counters(
          find_pass(base, name), find_pass(results[i].result, name),
          [&](const std::string& id, std::uint64_t before, std::uint64_t after) {
            table.rows.push_back({results[i].label, name, id, before, after,
                                  change_cell(static_cast<double>(before), static_cast<double>(after))});
          });
  return table;
}

Json comparison_json(const std::vector<ComparedResult>& results) {
  const Json& base = results.front().result;
  Json json = {{"schema_version", kResultSchemaVersion},
               {"baseline", {{"label", results.front().label}, {"result", base}}},
               {"results", Json::array()}};
  for (size_t i = 1; i < results.size(); ++i) {
    const Json& result = results[i].result;
    Json entry = {{"label", results[i].label},
                  {"scene", result["scene"]},
                  {"technique", result["technique"]},
                  {"gpu", result["gpu"]}};
    for (const char* key : {"time_ms", "memory_mib", "dram_mb", "shaded_samples"})
      entry["frame"][key] = pair_json(base["frame"][key], result["frame"][key]);
    entry["passes"] = Json::array();
    for (const std::string& name : pass_names(base, result))
      entry["passes"].push_back(pass_json(name, find_pass(base, name), find_pass(result, name)));
    json["results"].push_back(std::move(entry));
  }
  return json;
}

std::vector<ComparedResult> read_results(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return {read_result(path)};
  if (fs::exists(fs::path(path) / "result.json", error)) {
    ComparedResult one = read_result(fs::path(path) / "result.json");
    one.label = path;
    return {one};
  }
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error))
    if (fs::exists(entry.path() / "result.json", error)) files.push_back(entry.path() / "result.json");
  if (files.empty())
    fail("U020", "`" + path + "` holds no result.json", "", "give a folder that `hwsim run` wrote");
  std::sort(files.begin(), files.end());
  std::vector<ComparedResult> results;
  for (const fs::path& file : files) results.push_back(read_result(file));
  return results;
}

}  // namespace hwsim::lab
