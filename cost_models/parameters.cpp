#include "cost_models/parameters.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "cost_models/table_number.h"
#include "hwsim/base/csv.h"
#include "hwsim/base/diagnostics.h"
#include "hwsim/gpu/gpu_keys.h"

namespace hwsim::cost_models {
namespace {

std::string unit_of(std::string_view name) {
  for (const auto& [ending, unit] :
       {std::pair{"_mhz", "MHz"}, std::pair{"_us", "us"}, std::pair{"_kib", "KiB"},
        std::pair{"_gb_s", "GB/s"}, std::pair{"_ratio", "ratio"}, std::pair{"_per_clk", "per clock"},
        std::pair{"_clk", "per clock"}, std::pair{"_cycles", "cycles"}, std::pair{"_slots", "slots"}})
    if (name.ends_with(ending)) return unit;
  return "ratio";
}

class Reader {
 public:
  Reader(const std::string& path, const std::map<std::string, GpuConfig>& gpus)
      : file_(read_csv(path)), gpus_(gpus) {}

  std::vector<FittedParameter> run() {
    std::vector<FittedParameter> parameters;
    std::set<std::string> ids;
    for (row_ = 0; row_ < file_.rows.size(); ++row_) {
      const FittedParameter parameter = read();
      if (!ids.insert(parameter.id()).second) problem("`" + parameter.id() + "` is declared twice");
      parameters.push_back(parameter);
    }
    if (!problems_.empty()) throw InputError(problems_);
    for (std::size_t i = 0; i < parameters.size(); ++i)
      for (FittedParameter& own : parameters) {
        FittedParameter& p = parameters[i];
        if (p.scope != Scope::all || own.scope != Scope::gpu || own.name != p.name) continue;
        p.own_of.push_back(own.member);
        own.pooled_with = i;
      }
    return parameters;
  }

 private:
  const std::string& text(std::string_view column) const { return file_.rows[row_][file_.column(column)]; }

  void problem(const std::string& message, const std::string& help = {}) {
    Diagnostic diagnostic{.code = "M003", .message = message, .help = help};
    diagnostic.place.file = file_.path;
    diagnostic.place.line = file_.lines[row_];
    diagnostic.place.column = 1;
    problems_.push_back(diagnostic);
  }

  double number(std::string_view column, double from_file) {
    const std::string& t = text(column);
    if (t == "file") return from_file;
    const std::optional<double> value = table_number(t);
    if (!value) problem("`" + t + "` is no number for " + std::string(column));
    return value.value_or(0.0);
  }

  /// The logarithm of the factor by which the value is likely off its start; 0: any value is as likely.
  double prior() {
    const std::string& t = text("prior_factor");
    if (t == "none") return 0.0;
    const std::optional<double> factor = table_number(t);
    if (factor && *factor > 1.0) return std::log(*factor);
    problem("`" + t + "` is no value of `prior_factor`",
            "write a number above 1, the factor by which the value is likely off its start, or none");
    return 0.0;
  }

  FittedParameter read() {
    FittedParameter p;
    const std::string& scope = text("scope");
    p.scope = scope == "gpu" ? Scope::gpu : scope == "all" ? Scope::all : Scope::scene;
    if (scope_name(p.scope) != scope) problem("`" + scope + "` is no scope: gpu, all or scene");
    p.member = p.scope == Scope::all ? "all" : text("member");
    p.name = text("name");
    p.unit = unit_of(p.name);
    p.meaning = text("meaning");
    const auto [value, interval] = from_file(p);
    p.start = number("start", value);
    p.low = number("low", interval[0]);
    p.high = number("high", interval[1]);
    p.prior_log_sd = prior();
    if (!(p.low > 0.0 && p.low <= p.start && p.start <= p.high && p.low < p.high))
      problem("`" + p.id() + "`: " + std::to_string(p.low) + " < " + std::to_string(p.start) + " < " +
              std::to_string(p.high) + " does not hold, or the GPU's file has no interval for it");
    return p;
  }

  /// Value and interval of a GPU's file; of the key's first GPU for all.
  std::pair<double, std::array<double, 2>> from_file(const FittedParameter& p) {
    if (p.scope == Scope::scene) {
      if (p.name != kGeometryLoad && p.name != kLightReach) problem("scenes have no factor `" + p.name + "`");
      return {1.0, {0.0, 0.0}};
    }
    const auto gpu = p.scope == Scope::all ? gpus_.begin() : gpus_.find(p.member);
    if (gpu == gpus_.end()) {
      problem("no published row names the GPU `" + p.member + "`");
      return {0.0, {0.0, 0.0}};
    }
    if (p.name == kPresent) return {0.0, {0.0, 0.0}};
    GpuConfig copy = gpu->second;
    for (const Key& key : keys_of(static_cast<GpuValues<double>&>(copy))) {
      if (key.info.name != p.name || !std::holds_alternative<double*>(key.slot)) continue;
      const auto origin = copy.origins.find(p.name);
      const bool known = origin != copy.origins.end() && origin->second.interval;
      return {*std::get<double*>(key.slot),
              known ? *origin->second.interval : std::array<double, 2>{0.0, 0.0}};
    }
    problem("GPU files have no real number `" + p.name + "`");
    return {0.0, {0.0, 0.0}};
  }

  CsvFile file_;
  const std::map<std::string, GpuConfig>& gpus_;
  std::size_t row_ = 0;
  std::vector<Diagnostic> problems_;
};

}  // namespace

std::string_view scope_name(Scope scope) {
  switch (scope) {
    case Scope::gpu:
      return "gpu";
    case Scope::all:
      return "all";
    case Scope::scene:
      return "scene";
  }
  return "gpu";
}

double Prior::offset(const std::vector<double>& log_values) const {
  return (log_values[of] - (around ? log_values[*around] : log_center)) / log_sd;
}

std::vector<Prior> priors_of(const std::vector<FittedParameter>& parameters, const std::vector<bool>& used) {
  std::vector<Prior> priors;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (const FittedParameter& p = parameters[i]; used[i] && p.prior_log_sd > 0.0)
      priors.push_back({i, p.pooled_with, std::log(p.start), p.prior_log_sd});
  return priors;
}

bool FittedParameter::concerns(const std::string& gpu, const std::string& scene) const {
  if (scope == Scope::all) return std::find(own_of.begin(), own_of.end(), gpu) == own_of.end();
  return member == (scope == Scope::gpu ? gpu : scene);
}

std::vector<FittedParameter> load_parameters(const std::string& path,
                                             const std::map<std::string, GpuConfig>& gpus) {
  return Reader(path, gpus).run();
}

}  // namespace hwsim::cost_models
