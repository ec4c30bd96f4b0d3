#include "cli/terminal/answer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/terminal/terminal.h"
#include "hwsim/base/printable.h"
#include "lab/base/files.h"
#include "lab/base/json_text.h"
#include "lab/base/messages.h"

namespace hwsim::cli {
namespace {

/// Lines of a screen that a one-screen answer leaves to the command and what comes after; lines of a table
/// beside its rows; rows that each table gets at least.
constexpr std::size_t kOtherLines = 6, kTableLines = 4, kRowsLeast = 3;

/// The color of a word that says how far an answer holds (SGR): green, cyan, yellow, red; none for other
/// words.
std::string_view color_of(std::string_view word) {
  static const std::map<std::string_view, std::string_view> colors = {
      {"ok", "32"},         {"calibrated", "32"},   {"unknown", "36"},     {"interpolated", "36"},
      {"at risk", "33"},    {"extrapolated", "33"}, {"over time", "31"},   {"over memory", "31"},
      {"over error", "31"}, {"unsupported", "31"},  {"uncalibrated", "31"}};
  const auto found = colors.find(word);
  return found == colors.end() ? std::string_view() : found->second;
}

std::string painted(const std::string& word) {
  const std::string_view color = color_of(word);
  return color.empty() ? word : fmt::format("\033[{}m{}\033[0m", color, word);
}

std::string painted_cell(const lab::Column& column, const std::string& text) {
  return column.id == "verdict" || column.id == "support" ? painted(text) : text;
}

/// The words of support in a sentence.
std::string painted_sentence(const std::string& text) {
  static const std::regex words("\\b(un)?calibrated\\b|\\binterpolated\\b|\\bextrapolated\\b");
  std::string out;
  std::size_t at = 0;
  for (std::sregex_iterator match(text.begin(), text.end(), words), end; match != end; ++match) {
    const auto place = static_cast<std::size_t>(match->position());
    out += text.substr(at, place - at) + painted(match->str());
    at = place + match->str().size();
  }
  return out + text.substr(at);
}

/// Lines that are broken at spaces where a terminal would break words.
std::string wrapped(const std::string& text, std::size_t columns) {
  if (columns == 0) return text;
  std::string out;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::size_t next = end + 1;
    if (const std::size_t space = text.rfind(' ', begin + columns);
        end - begin > columns && space != std::string::npos && space > begin) {
      out += text.substr(begin, space - begin) + "\n";
      begin = space + 1;
      continue;
    }
    out += text.substr(begin, end - begin) + (end < text.size() ? "\n" : "");
    begin = next;
  }
  return out;
}

/// How text stands on a terminal; in a file and a pipe it is complete, plain and as wide as it is.
class Screen {
 public:
  Screen(const Terminal& terminal, bool verbose, bool one_screen) {
    layout_.columns = terminal.columns;
    color_ = terminal.output_color;
    if (color_) layout_.paint = painted_cell;
    cuts_ = one_screen && !verbose && terminal.columns > 0;
    layout_.details = !cuts_;
    lines_ = terminal.lines - std::min(terminal.lines, kOtherLines);
  }
  static Screen paper() { return {Terminal{}, true, false}; }

  bool cuts() const { return cuts_; }
  std::size_t lines() const { return lines_; }
  const lab::TextLayout& layout() const { return layout_; }
  std::string text(const std::string& words) const {
    const std::string safe = wrapped(printable(words), layout_.columns);
    return color_ ? painted_sentence(safe) : safe;
  }

 private:
  lab::TextLayout layout_;
  std::size_t lines_ = 0;
  bool color_ = false, cuts_ = false;
};

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

/// Parts one below the other on the lines of a screen: earlier tables have more rows, each has some, the last
/// one only where there is room.
std::string render_cut(const Passage& passage, const Screen& screen) {
  std::size_t left = screen.lines();
  auto tables = static_cast<std::size_t>(std::ranges::count_if(
      passage.parts(), [](const auto& part) { return std::holds_alternative<lab::Table>(part); }));
  std::string out;
  for (const auto& part : passage.parts()) {
    std::string text;
    if (const auto* words = std::get_if<std::string>(&part)) {
      text = screen.text(*words);
    } else {
      if (tables == 1 && !out.empty() && left < kTableLines + kRowsLeast) break;  // no room for the last one
      lab::TextLayout layout = screen.layout();
      layout.rows = std::max(kRowsLeast, left - std::min(left, kTableLines * tables--));
      text = to_text(std::get<lab::Table>(part), layout);
    }
    left -= std::min(left, count_lines(text));
    out += text;
  }
  return out;
}

std::string render_text(const Passage& passage, const Screen& screen) {
  std::string out;
  for (const auto& part : passage.parts()) {
    const auto* words = std::get_if<std::string>(&part);
    out += words ? screen.text(*words) : to_text(std::get<lab::Table>(part), screen.layout());
  }
  return out;
}

std::string render_markdown(const Passage& passage) {
  std::string out;
  for (const auto& part : passage.parts()) {
    const auto* words = std::get_if<std::string>(&part);
    out += words ? printable(*words) : to_markdown(std::get<lab::Table>(part));
  }
  return out;
}

bool has_details(const Answer& answer) {
  return !answer.footing.parts().empty() || std::ranges::any_of(answer.table.columns, &lab::Column::detail);
}

std::string render_table(const Answer& answer, const Screen& screen) {
  Passage passage = answer.heading;
  passage.add(answer.table);
  if (!screen.cuts()) return render_text(passage, screen) + render_text(answer.footing, screen);
  return render_cut(passage, screen) + (has_details(answer) ? "\n-v shows more\n" : "");
}

std::string render_as(const Answer& answer, OutputFormat format, const Screen& screen) {
  switch (format) {
    case OutputFormat::table:
      return render_table(answer, screen);
    case OutputFormat::md:
      return render_markdown(answer.heading) + to_markdown(answer.table) + render_markdown(answer.footing);
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

void write_rows(const lab::RowSource& rows, OutputFormat format, const Screen& screen,
                const lab::TakeText& take) {
  switch (format) {
    case OutputFormat::table:
      return write_text(rows, take, screen.layout());
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
  const Terminal terminal = inspect_terminal(options);
  for (const FormatRequest& request : requests_of(options)) {
    const Screen screen =
        request.file.empty() ? Screen(terminal, options.verbosity > 0, answer.one_screen) : Screen::paper();
    const std::string text = render_as(answer, request.format, screen);
    if (request.file.empty())
      write_output(text);
    else
      lab::write_answer(request.file, text);
  }
}

void print_rows(const lab::RowSource& rows, const CommonArguments& options) {
  constexpr std::size_t kBlock = 1 << 16;
  const Terminal terminal = inspect_terminal(options);
  for (const FormatRequest& request : requests_of(options)) {
    std::string text;
    const Screen screen = request.file.empty() ? Screen(terminal, true, false) : Screen::paper();
    write_rows(rows, request.format, screen, [&](std::string_view piece) {
      text += piece;
      if (!request.file.empty() || text.size() < kBlock) return;  // a file appears whole
      write_output(text);
      text.clear();
    });
    request.file.empty() ? write_output(text) : lab::write_answer(request.file, text);
  }
}

}  // namespace hwsim::cli
