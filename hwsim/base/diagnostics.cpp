#include "hwsim/base/diagnostics.h"

#include <algorithm>
#include <string>
#include <utility>

#include "hwsim/base/plain_name.h"
#include "hwsim/base/printable.h"

namespace hwsim {
namespace {

std::string first_message(const std::vector<Diagnostic>& diagnostics) {
  return diagnostics.empty() ? std::string("unknown input error") : diagnostics.front().message;
}

const char* severity_name(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "error";
}

const char* severity_color(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "\033[1;36m";
    case Severity::warning:
      return "\033[1;33m";
    case Severity::error:
      return "\033[1;31m";
  }
  return "";
}

/// What fits a terminal of a long line, with the marked column in it.
SourcePlace excerpt(SourcePlace place) {
  constexpr size_t kColumns = 160, kBefore = 60;
  if (place.line_text.size() <= kColumns) return place;
  const auto column = static_cast<size_t>(std::max(1, place.column));
  const size_t first = std::min(column > kBefore ? column - kBefore : 0, place.line_text.size());
  place.line_text = std::string(whole_characters(place.line_text, first, kColumns));
  place.column = static_cast<int>(column - first);
  const size_t room = place.line_text.size() + 1 - std::min(column - first, place.line_text.size());
  place.length = std::min(place.length, static_cast<int>(room));
  return place;
}

/// As many bytes as before, so that the mark below stays in its place.
std::string shown_line(std::string line) {
  if (printable(line) != line)
    for (char& c : line)
      if (c != '\t' && (c < 0x20 || c > 0x7e)) c = '?';
  return line;
}

void append_excerpt(std::string& out, const Diagnostic& d) {
  const SourcePlace place = excerpt(d.place);
  const std::string number = std::to_string(place.line);
  const std::string margin(number.size(), ' ');
  out += margin + " |\n" + number + " | " + shown_line(place.line_text) + "\n" + margin + " | ";
  const auto column = static_cast<size_t>(std::max(1, place.column));
  for (size_t i = 0; i + 1 < column; ++i)  // a tab stays a tab, so that the mark stands below its column
    out += i < place.line_text.size() && place.line_text[i] == '\t' ? '\t' : ' ';
  out += std::string(static_cast<size_t>(std::max(1, place.length)), '^');
  if (!d.hint.empty()) out += " " + printable_line(d.hint);
  out += "\n";
}

// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbors cost 1.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substitution = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        current[j] = std::min(current[j], before[j - 2] + 1);
    }
    before = previous;
    previous = current;
  }
  return previous[b.size()];
}

/// Those that are the name but for case and separators, else those that begin with it: three at most.
std::vector<std::string> same_or_longer(std::string_view name, std::span<const std::string> candidates) {
  constexpr std::size_t kLeast = 2, kMost = 3;  // letters that say which name is meant; names in a hint
  const std::string plain = plain_name(name);
  std::vector<std::string> same, longer;
  for (const std::string& candidate : candidates) {
    const std::string other = plain_name(candidate);
    if (!other.starts_with(plain)) continue;
    (other == plain ? same : longer).push_back(candidate);
  }
  std::vector<std::string>& found = same.empty() ? longer : same;
  if (plain.size() < kLeast) found.clear();
  if (found.size() > kMost) found.resize(kMost);
  return found;
}

/// The first of those that fewest letters turn into the name; "" where these are more than a third.
std::string nearest_by_letters(std::string_view name, std::span<const std::string> candidates) {
  std::string best;
  size_t best_distance = 0;
  const std::string plain = plain_name(name);
  for (const std::string& candidate : candidates) {
    const std::string other = plain_name(candidate);
    const size_t limit = std::max<size_t>(1, std::max(name.size(), candidate.size()) / 3);
    const auto [shorter, longer] = std::minmax({plain.size(), other.size()});
    if (longer - shorter > limit) continue;  // as many letters differ at least
    const size_t distance = edit_distance(plain, other);
    if (distance <= limit && (best.empty() || distance < best_distance)) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

/// What people leave out at the end beats a letter that they may have mistaken.
std::vector<std::string> near_names(std::string_view name, std::span<const std::string> candidates) {
  std::vector<std::string> near = same_or_longer(name, candidates);
  if (!near.empty()) return near;
  const std::string nearest = nearest_by_letters(name, candidates);
  return nearest.empty() ? near : std::vector{nearest};
}

}  // namespace

InputError::InputError(Diagnostic diagnostic, ExitStatus status)
    : std::runtime_error(diagnostic.message), diagnostics_{std::move(diagnostic)}, status_(status) {}

InputError::InputError(std::vector<Diagnostic> diagnostics, ExitStatus status)
    : std::runtime_error(first_message(diagnostics)), diagnostics_(std::move(diagnostics)), status_(status) {
  keep_first(diagnostics_);
}

std::string render(const Diagnostic& d, bool color) {
  const std::string reset = color ? "\033[0m" : "";
  std::string out = (color ? severity_color(d.severity) : "") + std::string(severity_name(d.severity));
  if (!d.code.empty()) out += "[" + d.code + "]";
  out += reset + ": " + printable(d.message) + "\n";
  if (!d.place.file.empty()) {
    out += "  --> " + printable_line(d.place.file);
    if (d.place.line > 0)
      out += ":" + std::to_string(d.place.line) + ":" + std::to_string(std::max(1, d.place.column));
    out += "\n";
  }
  const bool excerpt = d.place.line > 0 && !d.place.line_text.empty();
  if (excerpt) append_excerpt(out, d);
  if (!excerpt && !d.hint.empty()) out += "   = hint: " + printable(d.hint) + "\n";
  for (const std::string& note : d.notes) out += "   = note: " + printable(note) + "\n";
  if (!d.help.empty()) out += "   = help: " + printable(d.help) + "\n";
  return out;
}

std::string_view whole_characters(std::string_view text, std::size_t first, std::size_t bytes_max) {
  const auto continues = [&text](std::size_t i) {
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80;
  };
  first = std::min(first, text.size());
  std::size_t last = first + std::min(bytes_max, text.size() - first);
  while (last > first && continues(last)) --last;
  while (first < last && continues(first)) ++first;
  return text.substr(first, last - first);
}

std::string shortened(std::string_view name) {
  constexpr std::size_t kShown = 80;
  if (name.size() <= kShown) return std::string(name);
  return std::string(whole_characters(name, 0, kShown)) + "...";
}

void keep_first(std::vector<Diagnostic>& problems) {
  if (problems.size() <= kProblemsShown) return;
  const std::size_t left_out = problems.size() - (kProblemsShown - 1);
  problems.resize(kProblemsShown - 1);
  Diagnostic& rest = problems.emplace_back();
  rest.code = problems.front().code;
  rest.message = std::to_string(left_out) + " further problems are not listed";
  rest.place.file = problems.front().place.file;
  rest.help = "mend those above first";
}

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
  const std::vector<std::string> near = near_names(name, candidates);
  return near.empty() ? "" : near.front();
}

std::string did_you_mean(std::string_view name, std::span<const std::string> candidates) {
  const std::vector<std::string> near = near_names(name, candidates);
  std::string hint;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const std::string_view before = i == 0 ? "did you mean " : i + 1 == near.size() ? " or " : ", ";
    hint += std::string(before) + "`" + near[i] + "`";
  }
  return hint.empty() ? "" : hint + "?";
}

}  // namespace hwsim
