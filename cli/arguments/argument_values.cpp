#include "cli/arguments/argument_values.h"

#include <map>

#include "lab/base/messages.h"

namespace hwsim::cli {
namespace {

OutputFormat format_from_name(const std::string& name) {
  static const std::map<std::string, OutputFormat, std::less<>> formats = {{"table", OutputFormat::table},
                                                                           {"csv", OutputFormat::csv},
                                                                           {"json", OutputFormat::json},
                                                                           {"md", OutputFormat::md}};
  if (const auto found = formats.find(name); found != formats.end()) return found->second;
  const std::vector<std::string> words = {"table", "csv", "json", "md"};
  fail_usage("U003", "--format is `" + name + "`, must be table, csv, json or md", did_you_mean(name, words));
}

}  // namespace

FormatRequest parse_format(const std::string& text) {
  const auto equals = text.find('=');
  FormatRequest request{format_from_name(text.substr(0, equals)), ""};
  if (equals != std::string::npos) request.file = text.substr(equals + 1);
  if (equals != std::string::npos && request.file.empty())
    fail_usage("U003", "--format " + text + " names no file", "--format csv=passes.csv");
  return request;
}

std::string number_complaint(const std::string& text, const cost_models::NumberRange& range,
                             const std::string& unit) {
  if (cost_models::table_number(text, range)) return "";
  const cost_models::NumberRange any;
  const bool bounded = range.low > any.low || range.high < any.high;
  return "is `" + text + "`, must be " + (bounded ? cost_models::range_text(range) : "a plain number") +
         (unit.empty() ? "" : " of " + unit);
}

}  // namespace hwsim::cli
