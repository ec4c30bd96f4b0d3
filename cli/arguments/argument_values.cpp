#include "cli/arguments/argument_values.h"

#include <charconv>
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

Resolution parse_resolution(std::string_view text) {
  Resolution size;
  const auto cross = text.find('x');
  const auto number = [](std::string_view part, int& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size();
  };
  if (cross == std::string_view::npos || !number(text.substr(0, cross), size.width_px) ||
      !number(text.substr(cross + 1), size.height_px))
    fail_usage("U005", "--resolution is `" + std::string(text) + "`, must be WIDTHxHEIGHT",
               "--resolution 1280x720");
  for (const int side : {size.width_px, size.height_px})
    if (side < 1 || side > kMaxSidePx)
      fail_usage("U005", "--resolution is " + std::string(text) + ", each side must be 1 to " +
                             std::to_string(kMaxSidePx) + " pixels");
  return size;
}

}  // namespace hwsim::cli
