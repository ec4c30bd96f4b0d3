#include "cli/terminal/answer.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "lab/base/files.h"

namespace hwsim::cli {
namespace {

std::string render_as(const Answer& answer, Format format) {
  switch (format) {
    case Format::table:
      return answer.heading + to_text(answer.table) + answer.footing;
    case Format::md:
      return answer.heading + to_markdown(answer.table) + answer.footing;
    case Format::csv:
      return to_csv(answer.table);
    case Format::json:
      break;
  }
  return (answer.json ? *answer.json : to_json(answer.table)).dump(2) + "\n";
}

}  // namespace

void print(const Answer& answer, const CommonOptions& options) {
  const std::vector<FormatRequest> requests =
      options.formats.empty() ? std::vector<FormatRequest>{FormatRequest{}} : options.formats;
  for (const FormatRequest& request : requests) {
    const std::string text = render_as(answer, request.format);
    if (request.file.empty())
      std::fwrite(text.data(), 1, text.size(), stdout);
    else
      lab::write_file(request.file, text);
  }
  std::fflush(stdout);
}

}  // namespace hwsim::cli
