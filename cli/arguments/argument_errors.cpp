#include "cli/arguments/argument_errors.h"

#include <algorithm>

#include "cli/arguments/argument_values.h"
#include "lab/base/messages.h"

namespace hwsim::cli {

const CLI::App& selected(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* chosen = &app;
  for (const std::string& word : words) {
    const CLI::App* next = nullptr;
    for (const CLI::App* sub : chosen->get_subcommands([](const CLI::App*) { return true; }))
      if (sub->get_name() == word) next = sub;
    if (!next) break;
    chosen = next;
  }
  return *chosen;
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!sub->get_name().empty())
      names.push_back(sub->get_name());  // option groups are subcommands without a name
  return names;
}

void check_command_names(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App& chosen = selected(app, words);
  const std::vector<std::string> names = subcommand_names(chosen);
  if (names.empty()) return;
  const size_t depth = &chosen == &app ? 0 : 1;
  const std::string lead = depth == 0 ? "" : chosen.get_name() + " ";
  if (words.size() == depth)
    fail_usage("U002", "no command given after `hwsim" + (depth == 0 ? "" : " " + chosen.get_name()) + "`",
               "one of " + CLI::detail::join(names, ", "));
  if (words[depth].starts_with("-")) return;
  fail_usage("U001", "unknown command `" + lead + words[depth] + "`", did_you_mean(words[depth], names));
}

std::vector<FlagInfo> flags_of(const CLI::App& app) {
  std::vector<FlagInfo> flags;
  for (const CLI::Option* option :
       app.get_options([](const CLI::Option* o) { return !o->get_positional(); })) {
    FlagInfo flag;
    for (const std::string& name : option->get_snames()) flag.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) flag.names.push_back("--" + name);
    flag.description = option->get_description();
    flag.takes_value = option->get_items_expected_max() > 0;
    flags.push_back(std::move(flag));
  }
  for (const CLI::App* group :
       app.get_subcommands([](const CLI::App* sub) { return sub->get_name().empty(); }))
    for (FlagInfo& flag : flags_of(*group)) flags.push_back(std::move(flag));
  return flags;
}

namespace {

/// "cache prune".
std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  const bool is_part = parent != nullptr && parent->get_parent() != nullptr;
  return is_part ? full_name(*parent) + " " + command.get_name() : command.get_name();
}

[[noreturn]] void fail_unknown_argument(const CLI::App& chosen, const std::string& argument) {
  std::vector<std::string> names;
  for (const FlagInfo& flag : flags_of(chosen))
    names.insert(names.end(), flag.names.begin(), flag.names.end());
  const std::string name = argument.substr(0, argument.find('='));
  const std::string kind = argument.starts_with("-") ? "unknown flag `" : "unexpected argument `";
  fail_usage("U001", kind + name + "`", did_you_mean(name, names),
             "`hwsim " + full_name(chosen) + " --help` lists the flags");
}

bool is_typed(const std::string& name, const std::vector<std::string>& words) {
  return std::ranges::any_of(words, [&](const std::string& word) {
    const bool is_short = !name.starts_with("--");
    return word == name || word.starts_with(is_short ? name : name + "=");
  });
}

/// CLI11 calls a flag by the first of its long names: `--sms` where `--cores` was typed.
std::string as_typed(std::string text, const CLI::App& chosen, const std::vector<std::string>& words) {
  for (const FlagInfo& flag : flags_of(chosen)) {
    const auto first =
        std::ranges::find_if(flag.names, [](const auto& name) { return name.starts_with("--"); });
    if (first == flag.names.end() || is_typed(*first, words)) continue;
    const auto typed =
        std::ranges::find_if(flag.names, [&](const auto& name) { return is_typed(name, words); });
    const std::size_t at = text.find(*first);
    if (typed == flag.names.end() || at == std::string::npos) continue;
    const std::size_t end = at + first->size();
    if (end == text.size() || text[end] == ' ' || text[end] == ':') text.replace(at, first->size(), *typed);
  }
  return text;
}

/// "Could not convert: --clock = 2.6GHz" in the words of the other messages, with the flag's unit.
std::string conversion_message(const std::string& text, const CLI::App& chosen) {
  const std::size_t colon = text.find(": "), equals = text.find(" = ");
  if (colon == std::string::npos || equals == std::string::npos || equals < colon) return text;
  const std::string name = text.substr(colon + 2, equals - colon - 2);
  const CLI::Option* const option = chosen.get_option_no_throw(name);
  const std::string unit = option ? option->get_type_name() : "";
  const bool has_unit = !unit.empty() && unit != "N" && unit.find('[') == std::string::npos;
  return name + " is `" + text.substr(equals + 3) + "`, must be a plain number" +
         (has_unit ? " of " + unit : "");
}

/// "--jobs: is `0`, must be ..." of a check, without the colon, and with the variable's name where it was no
/// flag that had the value.
std::string check_message(const std::string& text, const CLI::App& chosen,
                          const std::vector<std::string>& words) {
  const std::size_t colon = text.find(": ");
  if (colon == std::string::npos) return text;
  std::string name = text.substr(0, colon);
  const CLI::Option* const option = chosen.get_option_no_throw(name);
  const std::string variable = option ? option->get_envname() : "";
  if (!variable.empty() && !is_typed(name, words)) name = variable;
  return name + " " + text.substr(colon + 2);
}

}  // namespace

void fail_parse(const CLI::ParseError& error, const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App& chosen = selected(app, words);
  const std::string help = "`hwsim " + full_name(chosen) + " --help` lists the flags";
  std::string message = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
    const auto rest = app.remaining(true);
    if (!rest.empty()) fail_unknown_argument(chosen, rest.front());
  }
  if (dynamic_cast<const CLI::ConversionError*>(&error)) message = conversion_message(message, chosen);
  if (dynamic_cast<const CLI::ValidationError*>(&error)) message = check_message(message, chosen, words);
  const std::size_t line_end = std::min(message.find('\n'), message.size());  // a hint follows
  const std::string hint = message.substr(std::min(line_end + 1, message.size()));
  message = as_typed(message.substr(0, line_end), chosen, words);
  if (dynamic_cast<const CLI::RequiredError*>(&error)) fail_usage("U002", message, "", help);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) fail_usage("U004", message, "", help);
  fail_usage("U003", message, hint, help);
}

}  // namespace hwsim::cli
