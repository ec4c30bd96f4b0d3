#include "cli/terminal/answer.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "hwsim/base/printable.h"
#include "lab/base/files.h"
#include "lab/base/json_text.h"
#include "lab/base/messages.h"

namespace hwsim::cli {
namespace {

std::string render_as(const Answer& answer, OutputFormat format) {
  switch (format) {
    case OutputFormat::table:
      return printable(answer.heading) + to_text(answer.table) + printable(answer.footing);
    case OutputFormat::md:
      return printable(answer.heading) + to_markdown(answer.table) + printable(answer.footing);
    case OutputFormat::csv:
      return to_csv(answer.table);
    case OutputFormat::json:
      break;
  }
  return json_text(answer.json ? *answer.json : to_json(answer.table));
}

std::vector<FormatRequest> requests_of(const CommonArguments& options) {
  return options.formats.empty() ? std::vector<FormatRequest>{FormatRequest{}} : options.formats;
}

void write_rows(const lab::RowSource& rows, OutputFormat format, const lab::TakeText& take) {
  switch (format) {
    case OutputFormat::table:
      return write_text(rows, take);
    case OutputFormat::md:
      return write_markdown(rows, take);
    case OutputFormat::csv:
      return write_csv(rows, take);
    case OutputFormat::json:
      return write_json(rows, take);
  }
}

// What was asked for is lost: the run has failed, whatever the reason.
[[noreturn]] void fail_to_write(int reason) {
  throw InputError(
      lab::problem("U010", std::string("cannot write to standard output: ") + std::strerror(reason), "",
                   "send it to a file or a terminal that can be written and has space"),
      ExitStatus::run_failed);
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
      fail_to_write(errno);
  }
}

void print(const Answer& answer, const CommonArguments& options) {
  for (const FormatRequest& request : requests_of(options)) {
    const std::string text = render_as(answer, request.format);
    if (request.file.empty())
      write_output(text);
    else
      lab::write_answer(request.file, text);
  }
}

void print_rows(const lab::RowSource& rows, const CommonArguments& options) {
  constexpr std::size_t kBlock = 1 << 16;
  for (const FormatRequest& request : requests_of(options)) {
    std::string text;
    write_rows(rows, request.format, [&](std::string_view piece) {
      text += piece;
      if (!request.file.empty() || text.size() < kBlock) return;  // a file appears whole
      write_output(text);
      text.clear();
    });
    request.file.empty() ? write_output(text) : lab::write_answer(request.file, text);
  }
}

}  // namespace hwsim::cli
