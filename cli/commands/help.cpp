#include <algorithm>
#include <cctype>

#include "cli/arguments/arguments.h"
#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "lab/base/messages.h"
#include "lab/base/table.h"
#include "lab/catalog/error_codes.h"

namespace hwsim::cli {
namespace {

bool looks_like_code(const std::string& topic) {
  return topic.size() == 4 && std::isalpha(static_cast<unsigned char>(topic[0])) != 0 &&
         std::all_of(topic.begin() + 1, topic.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::string command_list() {
  Table table{{{"command", "command"}, {"does", "does", false, 100}}, {}};
  for (const CommandInfo& command : describe_commands())
    table.rows.push_back({command.name, command.description});
  return "hwsim help COMMAND explains one, as hwsim COMMAND --help does:\n\n" + to_text(table) + "\n";
}

/// Commands for people; the codes are data, too.
void print_topics(const HelpArguments& options) {
  Table table{{{"code", "code"}, {"title", "means"}}, {}};
  for (const ErrorCode& code : error_codes())
    table.rows.push_back({std::string(code.code), std::string(code.title)});
  print({.table = table, .heading = command_list() + "hwsim help CODE explains the message that has it:\n\n"},
        options.common);
}

ExitStatus explain(std::string topic) {
  topic[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(topic[0])));
  for (const ErrorCode& code : error_codes())
    if (code.code == topic) {
      const std::string remedy =
          code.remedy.empty() ? "" : "\nWhat to do: " + std::string(code.remedy) + "\n";
      write_output(topic + ": " + std::string(code.title) + "\n\n" + std::string(code.explanation) + "\n" +
                   remedy);
      return ExitStatus::done;
    }
  fail_usage("U014", "no message has the code `" + topic + "`", "", "`hwsim help` lists the codes");
}

}  // namespace

ExitStatus help(const HelpArguments& options, Context&) {
  if (options.topic.empty()) {
    print_topics(options);
    return ExitStatus::done;
  }
  if (looks_like_code(options.topic)) return explain(options.topic);
  if (const auto text = help_text(options.topic)) {
    write_output(*text);
    return ExitStatus::done;
  }
  std::vector<std::string> names;
  for (const CommandInfo& command : describe_commands()) names.push_back(command.name);
  fail_usage("U014", "no help on `" + options.topic + "`", did_you_mean(options.topic, names),
             "`hwsim help` lists the commands and the codes");
}

}  // namespace hwsim::cli
