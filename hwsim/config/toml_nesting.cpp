#include "hwsim/config/toml_nesting.h"

#include <algorithm>

namespace hwsim {
namespace {

class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  std::optional<TomlNesting> run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_text(c);
        continue;
      }
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
        continue;
      }
      if (const char* what = take(c)) return found(what);
      ++at_;
    }
    return std::nullopt;
  }

 private:
  /// What is too deep from this character on, or nothing. A number has one dot, so that dots count between
  /// the characters that end a key or a value.
  const char* take(char c) {
    if (c == '.' && ++dots_ >= kTomlLevelsMax) return "a key of more than 16 parts";
    if (c == '[' || c == '{') ++open_;
    if (c == ']' || c == '}') --open_;
    if (c == '[' || c == '{' || c == ']' || c == '}' || c == ',' || c == '=' || c == '\n') dots_ = 0;
    return open_ > kTomlLevelsMax ? "more than 16 arrays or tables in each other" : nullptr;
  }

  /// A text in quotes, of several lines where there are three of them.
  void skip_text(char quote) {
    const std::string three(3, quote);
    const bool long_text = text_.substr(at_).starts_with(three);
    at_ += long_text ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      if (quote == '"' && text_[at_] == '\\') {
        ++at_;
      } else if (long_text && text_.substr(at_).starts_with(three)) {
        at_ += 3;
        return;
      } else if (!long_text && (text_[at_] == quote || text_[at_] == '\n')) {
        ++at_;
        return;
      }
    }
  }

  TomlNesting found(std::string what) const {
    const std::string_view before = text_.substr(0, at_);
    TomlNesting nesting;
    nesting.what = std::move(what);
    for (const char c : before) nesting.line += c == '\n' ? 1 : 0;
    const auto line_end = before.rfind('\n');
    nesting.column = static_cast<int>(at_ - (line_end == before.npos ? 0 : line_end + 1)) + 1;
    return nesting;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int dots_ = 0, open_ = 0;
};

}  // namespace

std::optional<TomlNesting> too_deep(std::string_view text) { return Scan(text).run(); }

}  // namespace hwsim
