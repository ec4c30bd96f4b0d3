#include "cli/terminal/answer.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "lab/base/files.h"
#include "lab/base/messages.h"

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

void write_output(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, text.data(), text.size());
    if (written > 0)
      text.remove_prefix(static_cast<std::size_t>(written));
    else if (errno == EPIPE)
      return;
    else if (errno != EINTR)
      lab::fail("U010", "cannot write to standard output: " + std::string(std::strerror(errno)), "",
                "send it to a file or a terminal that can be written and has space");
  }
}

void print(const Answer& answer, const CommonOptions& options) {
  const std::vector<FormatRequest> requests =
      options.formats.empty() ? std::vector<FormatRequest>{FormatRequest{}} : options.formats;
  for (const FormatRequest& request : requests) {
    const std::string text = render_as(answer, request.format);
    if (request.file.empty())
      write_output(text);
    else
      lab::write_file(request.file, text);
  }
}

}  // namespace hwsim::cli
