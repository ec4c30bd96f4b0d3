#include "lab/base/text.h"

namespace hwsim::lab {

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> pieces(1);
  for (const char c : text)
    if (c == separator)
      pieces.emplace_back();
    else
      pieces.back() += c;
  return pieces;
}

std::vector<std::string> split_techniques(std::string_view text) {
  std::vector<std::string> techniques;
  for (const std::string& piece : split(text, ',')) {
    // Further parts may follow a parameter: "b=1+fxaa:preset=39".
    const bool parameter = piece.find('=') < piece.find(':');
    if (parameter && !techniques.empty())
      techniques.back() += "," + piece;
    else
      techniques.push_back(piece);
  }
  return techniques;
}

std::string shell_word(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace hwsim::lab
