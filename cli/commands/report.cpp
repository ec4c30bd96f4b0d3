#include <fmt/format.h>

#include <filesystem>

#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/commands/report_file.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"

namespace hwsim::cli {
namespace {

namespace fs = std::filesystem;

std::string command_line(const std::vector<std::string>& arguments) {
  std::string line = "hwsim";
  for (std::size_t i = 1; i < arguments.size(); ++i) line += " " + shell_word(arguments[i]);
  return line;
}

}  // namespace

void check_report_place(const std::string& file, bool force) {
  if (file.empty()) return;
  std::error_code error;
  const fs::path folder = fs::path(file).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, error))
    fail("U010", "cannot write `" + file + "`: there is no folder `" + folder.string() + "`");
  place_of_file(file);
  if (!force && fs::exists(file, error))
    fail("U013", "`" + file + "` is there already", "", "--force replaces it, another name keeps it");
}

void write_report(const Lab& lab, const std::string& file, Context& context,
                  const std::function<Report()>& gather) {
  if (file.empty()) return;
  Report report = gather();
  report.command = command_line(context.arguments);
  lab.write_report(report, file);
  context.log.say(
      fmt::format("report: {} ({:.2f} MB)", file, static_cast<double>(fs::file_size(file)) / 1e6));
}

ExitStatus report(const ReportArguments& options, Context& context) {
  check_report_place(options.file, options.force);
  Lab lab(lab_options(options.common, context.log));
  write_report(lab, options.file, context, [&] { return lab.report(options.inputs); });
  return ExitStatus::done;
}

}  // namespace hwsim::cli
