#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "algos/deferred.h"
#include "algos/forward_techniques.h"
#include "algos/technique.h"

namespace hwsim::algos {
namespace {

constexpr ParameterInfo kCentroid{
    "centroid", 1, 0, 1, "attributes inside the primitive at partly covered pixels", "off|on"};
constexpr ParameterInfo kVariant{"variant",
                                 0,
                                 0,
                                 2,
                                 "one large image, jittered frames, or sample-rate shading",
                                 "ordered|accumulate|sample_rate"};
constexpr std::array<ParameterInfo, 2> msaa(double samples) {
  return {ParameterInfo{"samples", samples, samples, samples, "samples a pixel"}, kCentroid};
}
constexpr std::array<ParameterInfo, 2> ssaa(double samples) {
  return {ParameterInfo{"samples", samples, samples, samples, "shaded samples a pixel"}, kVariant};
}
constexpr auto kMsaa2 = msaa(2), kMsaa4 = msaa(4), kMsaa8 = msaa(8);
constexpr auto kSsaa4 = ssaa(4), kSsaa16 = ssaa(16), kSsaa64 = ssaa(64);
constexpr std::array<ParameterInfo, 1> kDeferred = {
    ParameterInfo{"samples", 8, 1, 8, "samples a pixel: 1, 2, 4 or 8"}};
constexpr std::array<ParameterInfo, 3> kSimpleComplex = {
    ParameterInfo{"samples", 8, 2, 8, "samples a pixel: 2, 4 or 8"},
    ParameterInfo{"lighting", 0, 0, 1, "full-screen passes with stencil, or 16x16 compute tiles",
                  "stencil|compute"},
    ParameterInfo{"normal_dot_min", 0.99, 0, 1, "normals further apart make a pixel complex (cosine)"}};

constexpr std::array<TechniqueInfo, 9> kTechniques = {{
    {"none", "one sample a pixel, forward shading", {}, build_none},
    {"ssaa4x", "supersampling, 2x2", kSsaa4, build_ssaa},
    {"ssaa16x", "supersampling, 4x4", kSsaa16, build_ssaa},
    {"ssaa64x", "supersampling, 8x8", kSsaa64, build_ssaa},
    {"msaa2x", "multisampling, hardware resolve", kMsaa2, build_msaa},
    {"msaa4x", "multisampling, hardware resolve", kMsaa4, build_msaa},
    {"msaa8x", "multisampling, hardware resolve", kMsaa8, build_msaa},
    {"deferred", "multisampled G-buffer, every sample lit", kDeferred, build_deferred},
    {"deferred_simple_complex", "multisampled G-buffer, samples lit only where they differ (Lauritzen 2010)",
     kSimpleComplex, build_simple_complex},
}};

[[noreturn]] void fail(std::string code, std::string message, std::string hint, std::string help) {
  throw InputError(
      {Severity::error, std::move(code), std::move(message), {}, std::move(hint), {}, std::move(help)},
      ExitStatus::usage);
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(name, names);
  return nearest.empty() ? "" : "did you mean `" + nearest + "`?";
}

const TechniqueInfo& find_technique(std::string_view id) {
  std::vector<std::string> ids;
  for (const TechniqueInfo& t : kTechniques) {
    if (t.id == id) return t;
    ids.emplace_back(t.id);
  }
  fail("T001", "unknown technique `" + std::string(id) + "`", did_you_mean(id, ids),
       "`hwsim list techniques` lists them");
}

const ParameterInfo& find_parameter(const TechniqueInfo& technique, std::string_view name) {
  std::vector<std::string> names;
  for (const ParameterInfo& p : technique.parameters) {
    if (p.name == name) return p;
    names.emplace_back(p.name);
  }
  fail("T002", "technique `" + std::string(technique.id) + "` has no parameter `" + std::string(name) + "`",
       did_you_mean(name, names), "`hwsim show " + std::string(technique.id) + "` lists them");
}

double choice_index(std::string_view choices, std::string_view value) {
  for (double index = 0;; ++index) {
    const std::size_t bar = choices.find('|');
    if (choices.substr(0, bar) == value) return index;
    if (bar == std::string_view::npos) return -1;
    choices.remove_prefix(bar + 1);
  }
}

double parse_value(const TechniqueInfo& technique, const ParameterInfo& p, std::string_view text) {
  double value = p.choices.empty() ? -1 : choice_index(p.choices, text);
  if (value >= 0) return value;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  if (number && value >= p.min && value <= p.max) return value;
  const auto print = [](double v) {
    std::string s = std::to_string(v);
    s.erase(s.find_last_not_of('0') + 1);
    if (s.back() == '.') s.pop_back();
    return s;
  };
  fail("T003",
       "technique `" + std::string(technique.id) + "`: " + std::string(p.name) + " = " + std::string(text) +
           (p.choices.empty() ? ", must be between " + print(p.min) + " and " + print(p.max)
                              : ", must be one of " + std::string(p.choices)),
       "", "`hwsim show " + std::string(technique.id) + "` describes it");
}

}  // namespace

std::span<const TechniqueInfo> techniques() { return kTechniques; }

TechniqueChoice parse_technique(std::string_view text) {
  const std::size_t colon = text.find(':');
  TechniqueChoice choice;
  choice.info = &find_technique(text.substr(0, colon));
  for (const ParameterInfo& p : choice.info->parameters) choice.parameters.emplace(p.name, p.default_value);
  if (colon == std::string_view::npos) return choice;
  std::string_view rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    const std::string_view pair = rest.substr(0, comma);
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos)
      fail("T002", "technique parameter `" + std::string(pair) + "` has no value", "",
           "write it as key=value");
    const ParameterInfo& p = find_parameter(*choice.info, pair.substr(0, equals));
    choice.parameters[std::string(p.name)] = parse_value(*choice.info, p, pair.substr(equals + 1));
    rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
  }
  return choice;
}

}  // namespace hwsim::algos
