#include "algos/techniques.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "hwsim/base/plain_name.h"

namespace hwsim::algos {
namespace {

using Problems = std::vector<Diagnostic>;

void add(Problems& problems, std::string code, std::string message, std::string hint, std::string help) {
  problems.push_back(
      {Severity::error, std::move(code), std::move(message), {}, std::move(hint), {}, std::move(help)});
}

std::string quoted(std::string_view text) { return "`" + std::string(text) + "`"; }

const TechniqueInfo* find_technique(std::string_view id) {
  const auto all = techniques();
  const auto found = std::find_if(all.begin(), all.end(), [&](const TechniqueInfo& t) { return t.id == id; });
  return found == all.end() ? nullptr : &*found;
}

/// Whether people call a temporal technique so: one that needs the frames before.
bool is_temporal(std::string_view id) {
  constexpr std::array<std::string_view, 12> kNames = {
      "taa", "txaa", "tssaa", "tsaa", "tsr", "dlss", "dlaa", "fsr2", "fsr3", "xess", "smaat2x", "temporal"};
  const std::string plain = plain_name(id);
  return std::ranges::any_of(kNames, [&](std::string_view name) { return plain.starts_with(name); });
}

void add_unknown(Problems& problems, std::string_view id, std::string_view text) {
  std::vector<std::string> ids;
  for (const TechniqueInfo& t : techniques()) ids.emplace_back(t.id);
  const std::string help = "`hwsim list techniques` lists them";
  if (id.empty())
    add(problems, "T001", quoted(text) + " has a part without a name", "", help);
  else if (is_temporal(id))
    add(problems, "T001", "unknown technique " + quoted(id) + ": temporal techniques are not modeled", "",
        help);
  else
    add(problems, "T001", "unknown technique " + quoted(id), did_you_mean(id, ids), help);
}

BoundOption* find_option(const TechniqueInfo& technique, std::vector<BoundOption>& options,
                         std::string_view name, Problems& problems) {
  std::vector<std::string> names;
  for (BoundOption& option : options) {
    if (option.info.name == name) return &option;
    names.emplace_back(option.info.name);
  }
  add(problems, "T002", "technique " + quoted(technique.id) + " has no parameter " + quoted(name),
      did_you_mean(name, names), "`hwsim show " + std::string(technique.id) + "` lists them");
  return nullptr;
}

std::string number_text(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string_view choice_name(std::string_view choices, double index) {
  for (; index >= 1.0; --index) choices.remove_prefix(choices.find('|') + 1);
  return choices.substr(0, choices.find('|'));
}

double choice_index(std::string_view choices, std::string_view value) {
  for (double index = 0;; ++index) {
    const std::size_t bar = choices.find('|');
    if (choices.substr(0, bar) == value) return index;
    if (bar == std::string_view::npos) return -1;
    choices.remove_prefix(bar + 1);
  }
}

/// Sets the option. Returns what the value must be if it is not.
std::string set_from_text(BoundOption& option, std::string_view text) {
  const OptionInfo& info = option.info;
  if (!info.choices.empty()) {  // no index into choices: those may be numbers themselves
    const double index = choice_index(info.choices, text);
    if (index < 0) return "must be one of " + std::string(info.choices);
    option.set(index);
    return "";
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  if (!number || value < info.min || value > info.max)
    return "must be between " + number_text(info.min) + " and " + number_text(info.max);
  if (info.whole && value != std::floor(value)) return "must be a whole number";
  option.set(value);
  return "";
}

void set_option(const TechniqueInfo& technique, BoundOption& option, std::string_view text,
                Problems& problems) {
  const std::string allowed = set_from_text(option, text);
  if (allowed.empty()) return;
  add(problems, "T003",
      "technique " + quoted(technique.id) + ": " + std::string(option.info.name) + " = " + std::string(text) +
          ", " + allowed,
      "", "`hwsim show " + std::string(technique.id) + "` describes it");
}

void parse_options(std::string_view text, TechniquePart& part, Problems& problems) {
  std::vector<BoundOption> options = part.options.bound();
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    const std::string_view pair = text.substr(0, comma);
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos)
      add(problems, "T002", "technique parameter " + quoted(pair) + " has no value", "",
          "write it as key=value");
    else if (BoundOption* option = find_option(*part.info, options, pair.substr(0, equals), problems))
      set_option(*part.info, *option, pair.substr(equals + 1), problems);
    text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
  }
}

TechniquePart parse_part(std::string_view text, std::string_view whole, Problems& problems) {
  const std::size_t colon = text.find(':');
  TechniquePart part;
  part.info = find_technique(text.substr(0, colon));
  if (part.info == nullptr) {
    add_unknown(problems, text.substr(0, colon), whole);
    return part;
  }
  part.options = part.info->defaults;
  parse_options(colon == std::string_view::npos ? "" : text.substr(colon + 1), part, problems);
  return part;
}

std::string_view refusal(const TechniqueInfo& a, const TechniqueInfo& b) {
  const std::string_view reason = a.refuses != nullptr ? a.refuses(b) : "";
  return !reason.empty() || b.refuses == nullptr ? reason : b.refuses(a);
}

void check_pair(const TechniqueInfo& a, const TechniqueInfo& b, Problems& problems) {
  const std::string both = quoted(a.id) + " and " + quoted(b.id);
  const std::string reason(refusal(a, b));
  if (a.id == b.id)
    add(problems, "T004", quoted(a.id) + " is named twice", "", "write each technique once");
  else if (a.kind() == TechniqueKind::base && b.kind() == TechniqueKind::base)
    add(problems, "T004",
        both + " cannot be combined: each draws the whole frame" + (reason.empty() ? "" : "; " + reason), "",
        "combine one base with modifiers and filters; `hwsim list techniques` says which is which");
  else if (!reason.empty())
    add(problems, "T004", both + " cannot be combined: " + reason, "",
        "`hwsim show " + std::string(a.id) + "` describes it");
}

/// The image as the output of a frame without passes.
pipeline::FrameGraph start_from_image(const TechniqueChoice& choice, const FrameRequest& request) {
  require_filters(choice);
  pipeline::FrameGraph graph(request.scene, request.image->width, request.image->height);
  graph.set_output(graph.add_image(
      {"image", Format::rgba8_srgb, request.image->width, request.image->height, 1}, request.image));
  return graph;
}

}  // namespace

const TechniquePart& TechniqueChoice::base() const {
  return *std::find_if(parts.begin(), parts.end(),
                       [](const TechniquePart& part) { return part.info->kind() == TechniqueKind::base; });
}

TechniqueChoice parse_technique(std::string_view text) {
  Problems problems;
  TechniqueChoice choice;
  bool has_base = false;
  for (std::string_view rest = text;;) {
    const std::size_t plus = rest.find('+');
    TechniquePart part = parse_part(rest.substr(0, plus), text, problems);
    if (part.info != nullptr) {
      has_base = has_base || part.info->kind() == TechniqueKind::base;
      choice.parts.push_back(std::move(part));
    }
    if (plus == std::string_view::npos) break;
    rest.remove_prefix(plus + 1);
  }
  if (!has_base) {
    const TechniqueInfo* none = find_technique("none");
    choice.parts.push_back({none, none->defaults});
  }
  for (std::size_t i = 0; i < choice.parts.size(); ++i)
    for (std::size_t j = i + 1; j < choice.parts.size(); ++j)
      check_pair(*choice.parts[i].info, *choice.parts[j].info, problems);
  if (!problems.empty()) throw InputError(std::move(problems), ExitStatus::usage);
  const auto order = [](const TechniquePart& part) {
    constexpr std::array<int, 3> kRank = {1, 0, 3};  // base, modifier, filter
    return part.info->linear_input ? 2 : kRank.at(static_cast<std::size_t>(part.info->kind()));
  };
  std::stable_sort(choice.parts.begin(), choice.parts.end(),
                   [&](const auto& a, const auto& b) { return order(a) < order(b); });
  return choice;
}

std::string technique_text(const TechniquePart& part, bool complete) {
  const std::vector<OptionInfo> values = part.options.infos();
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const OptionInfo& option = values[i];
    const double value = option.default_value;
    if (!complete && value == part.info->options[i].default_value) continue;
    text += (text.empty() ? ":" : ",") + std::string(option.name) + "=" +
            (option.choices.empty() ? number_text(value) : std::string(choice_name(option.choices, value)));
  }
  return std::string(part.info->id) + text;
}

std::string technique_text(const TechniqueChoice& choice, bool complete) {
  std::string text;
  for (const TechniquePart& part : choice.parts) {
    if (technique_text(part) == "none" && choice.parts.size() > 1) continue;
    text += (text.empty() ? "" : "+") + technique_text(part, complete);
  }
  return text;
}

void require_filters(const TechniqueChoice& choice) {
  std::string filters;
  for (const TechniqueInfo& t : techniques())
    if (t.kind() == TechniqueKind::filter) filters += (filters.empty() ? "" : ", ") + std::string(t.id);
  bool any_filter = false, draws = false;
  for (const TechniquePart& part : choice.parts) {
    any_filter = any_filter || part.info->kind() == TechniqueKind::filter;
    draws = draws || (part.info->kind() != TechniqueKind::filter && part.info->id != "none");
  }
  if (any_filter && !draws) return;
  Problems problems;
  add(problems, "T005", quoted(technique_text(choice)) + " draws a scene, and the input is an image", "",
      "filters of images: " + filters);
  throw InputError(std::move(problems), ExitStatus::usage);
}

pipeline::FrameGraph build_frame(const TechniqueChoice& choice, const FrameRequest& request) {
  FrameRequest modified = request;
  for (const TechniquePart& part : choice.parts)
    if (part.info->modify) part.info->modify(modified, part.options);
  modified.linear_output = !request.image && std::ranges::any_of(choice.parts, [](const TechniquePart& part) {
    return part.info->linear_input;
  });
  const TechniquePart& base = choice.base();
  pipeline::FrameGraph graph =
      request.image ? start_from_image(choice, request) : base.info->build(modified, base.options);
  if (modified.linear_output) graph.make_output_linear();
  for (const TechniquePart& part : choice.parts)
    if (part.info->filter)
      graph.set_output(part.info->filter(graph, graph.output(), part.options), Format::rgba8_srgb);
  return graph;
}

std::vector<Diagnostic> frame_notes(const TechniqueChoice& choice, const DrawnFrame& frame) {
  std::vector<Diagnostic> all;
  for (const TechniquePart& part : choice.parts) {
    if (!part.info->notes) continue;
    for (Diagnostic note : part.info->notes(part.options, frame)) {
      note.message = technique_text(choice) + ": " + note.message;
      all.push_back(std::move(note));
    }
  }
  return all;
}

}  // namespace hwsim::algos
