#include "cli/terminal/completion_scripts.h"

#include <fmt/format.h>

#include <map>

namespace hwsim::cli {
namespace {

/// What follows a flag or a command: words, or a list to ask for.
struct Values {
  std::string words;    ///< "auto always never"
  std::string catalog;  ///< "gpus": `hwsim list gpus`
  bool list = false;    ///< several, with commas between
};

Values values_of_flag(const std::string& flag) {
  static const std::map<std::string, Values> values = {{"--gpu", {"", "gpus", true}},
                                                       {"--technique", {"", "techniques", true}},
                                                       {"--engine", {"roofline queue detailed", ""}},
                                                       {"--overlay", {"", "overlays"}},
                                                       {"--what-if", {"", "overlays", true}},
                                                       {"--set", {"", "settings"}},
                                                       {"--vary", {"", "settings"}},
                                                       {"--like", {"", "gpus"}},
                                                       {"--paper", {"", "papers"}},
                                                       {"--format", {"table csv json md", ""}},
                                                       {"--color", {"auto always never", ""}},
                                                       {"--progress", {"auto always never", ""}}};
  const auto found = values.find(flag);
  return found == values.end() ? Values{} : found->second;
}

Values values_of_command(const std::string& command) {
  static const std::map<std::string, Values> values = {
      {"run", {"", "scenes"}},
      {"compare", {"", "scenes"}},
      {"explain", {"", "scenes"}},
      {"sweep", {"", "scenes"}},
      {"rank", {"", "scenes"}},
      {"reference", {"", "scenes"}},
      {"scene check", {"", "scenes"}},
      {"list", {"gpus scenes techniques counters overlays tables papers sources settings codes", ""}},
      {"reproduce", {"", "papers"}},
      {"help", {"", "codes"}},
      {"show", {"", "gpus"}},
      {"config check", {"", "gpus"}},
      {"config show", {"", "gpus"}},
      {"config diff", {"", "gpus"}},
      {"config schema", {"gpu run manifest", ""}},
      {"completion", {"bash zsh fish", ""}}};
  const auto found = values.find(command);
  return found == values.end() ? Values{} : found->second;
}

std::string catalog_command(const std::string& catalog) {
  return "hwsim list " + catalog + " --format csv 2>/dev/null | tail -n +2 | cut -d, -f1";
}

std::string joined_flags(const CommandInfo& command) {
  std::string text;
  for (const FlagInfo& flag : command.flags)
    for (const std::string& name : flag.names) text += (text.empty() ? "" : " ") + name;
  return text;
}

std::string top_words(const std::vector<CommandInfo>& commands) {
  std::string text;
  for (const CommandInfo& command : commands)
    if (command.name.find(' ') == std::string::npos) text += (text.empty() ? "" : " ") + command.name;
  return text;
}

std::string sub_words(const std::vector<CommandInfo>& commands, const std::string& parent) {
  std::string text;
  for (const CommandInfo& command : commands)
    if (command.name.starts_with(parent + " "))
      text += (text.empty() ? "" : " ") + command.name.substr(parent.size() + 1);
  return text;
}

/// The text between quotes that a shell replaces by the words of `values`.
std::string shell_words(const Values& values) {
  return values.catalog.empty() ? values.words : "$(" + catalog_command(values.catalog) + ")";
}

/// Flags with the values that scripts know, and their short names in a pattern of a shell.
constexpr std::pair<const char*, const char*> kFlagsWithValues[] = {
    {"--gpu", "|-g"}, {"--technique", "|-t"}, {"--engine", ""},  {"--format", ""},
    {"--color", ""},  {"--progress", ""},     {"--overlay", ""}, {"--what-if", ""},
    {"--set", ""},    {"--vary", ""},         {"--like", ""},    {"--paper", ""}};

/// What completes the word `current`: one of the words; the last of a list with commas; a path before `=`.
constexpr std::string_view kBashHelpers = R"(_hwsim_words() { COMPREPLY=($(compgen -W "$1" -- "$current")); }
_hwsim_list() {
  local before=""
  case "$current" in *,*) before="${current%,*},";; esac
  COMPREPLY=($(compgen -P "$before" -W "$1" -- "${current##*,}"))
}
_hwsim_setting() { COMPREPLY=($(compgen -S = -W "$1" -- "$current")); compopt -o nospace 2>/dev/null; }
)";

std::string bash_script(const std::vector<CommandInfo>& commands) {
  std::string script(kBashHelpers);
  script +=
      "_hwsim() {\n  local current=\"${COMP_WORDS[COMP_CWORD]}\" previous=\"${COMP_WORDS[COMP_CWORD-1]}\"\n"
      "  local command=\"${COMP_WORDS[1]}\" words=\"\"\n"
      "  case \"$command\" in scene|config|cache|gpu) [ \"$COMP_CWORD\" -gt 2 ] && command=\"$command "
      "${COMP_WORDS[2]}\";; esac\n"
      "  case \"$previous\" in\n";
  for (const auto& [flag, short_name] : kFlagsWithValues) {
    const Values values = values_of_flag(flag);
    script += fmt::format("    {}{}) {} \"{}\"; return;;\n", flag, short_name,
                          values.list                    ? "_hwsim_list"
                          : values.catalog == "settings" ? "_hwsim_setting"
                                                         : "_hwsim_words",
                          shell_words(values));
  }
  script += "    --out|--db|--merge) COMPREPLY=($(compgen -f -- \"$current\")); return;;\n  esac\n";
  script += fmt::format("  if [ \"$COMP_CWORD\" -eq 1 ]; then words=\"{}\"; else\n  case \"$command\" in\n",
                        top_words(commands));
  for (const CommandInfo& command : commands) {
    const std::string subs = sub_words(commands, command.name);
    const std::string values = subs.empty() ? shell_words(values_of_command(command.name)) : subs;
    script += fmt::format(
        "    \"{}\") if [ \"${{current#-}}\" != \"$current\" ]; then words=\"{}\"; else words=\"{}\"; fi;;\n",
        command.name, joined_flags(command), values);
  }
  return script +
         "  esac; fi\n  COMPREPLY=($(compgen -W \"$words\" -- \"$current\") $(compgen -f -- "
         "\"$current\"))\n}\n"
         "complete -o filenames -F _hwsim hwsim\n";
}

/// zsh runs the bash script: its emulation of compgen knows all that the script uses.
std::string zsh_script(const std::vector<CommandInfo>& commands) {
  return "#compdef hwsim\nautoload -U +X compinit && compinit\nautoload -U +X bashcompinit && "
         "bashcompinit\n" +
         bash_script(commands);
}

std::string fish_quoted(const std::string& text) {
  std::string quoted;
  for (const char c : text) quoted += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return "'" + quoted + "'";
}

/// Words, or a command in parentheses that fish runs; lists with commas by fish's own function.
std::string fish_words(const Values& values) {
  if (values.catalog.empty()) return values.words;
  const std::string command = shell_words(values).substr(1);
  return values.list ? "(__fish_append , " + command + ")" : command;
}

std::string fish_flag(const std::string& condition, const FlagInfo& flag) {
  std::string line = "complete -c hwsim -n " + fish_quoted(condition);
  std::string long_name;
  for (const std::string& name : flag.names) {
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (name.starts_with("--")) long_name = name;
  }
  if (flag.takes_value) line += " -r";
  const std::string words = fish_words(values_of_flag(long_name));
  if (!words.empty()) line += " -f -a " + fish_quoted(words);
  return line + " -d " + fish_quoted(flag.description) + "\n";
}

std::string fish_script(const std::vector<CommandInfo>& commands) {
  std::string script;
  for (const CommandInfo& command : commands) {
    const auto space = command.name.find(' ');
    const std::string parent = command.name.substr(0, space);
    const std::string last = space == std::string::npos ? parent : command.name.substr(space + 1);
    const std::string where =
        space == std::string::npos ? "__fish_use_subcommand" : "__fish_seen_subcommand_from " + parent;
    script += fmt::format("complete -c hwsim -n {} -a {} -d {}\n", fish_quoted(where), last,
                          fish_quoted(command.description));
    std::string inside = "__fish_seen_subcommand_from " + parent;
    if (space != std::string::npos) inside += "; and __fish_seen_subcommand_from " + last;
    const std::string words = fish_words(values_of_command(command.name));
    if (!words.empty())
      script += fmt::format("complete -c hwsim -n {} -a {}\n", fish_quoted(inside), fish_quoted(words));
    for (const FlagInfo& flag : command.flags) script += fish_flag(inside, flag);
  }
  return script;
}

}  // namespace

std::string completion_script(std::string_view shell, const std::vector<CommandInfo>& commands) {
  if (shell == "bash") return bash_script(commands);
  if (shell == "zsh") return zsh_script(commands);
  if (shell == "fish") return fish_script(commands);
  return {};
}

}  // namespace hwsim::cli
