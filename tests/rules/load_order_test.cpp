// Operands of an operator and arguments of a call are evaluated in an order of the compiler's own. Two
// tracked accesses in one of them would give traces that differ between compilers, so each is a statement.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "rules/documents.h"
#include "support/places.h"

namespace {

namespace fs = std::filesystem;

/// Without comments and preprocessor lines.
std::string code_of(const std::string& text) {
  return std::regex_replace(text, std::regex(R"rx(//[^\n]*|(?:^|\n)#[^\n]*)rx"), "");
}

std::size_t closing(const std::string& text, std::size_t open, char opens, char closes) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == opens) ++depth;
    if (text[i] == closes && --depth == 0) return i;
  }
  return text.size();
}

/// What is called in `text`: `name(` or `name<...>(`.
std::size_t calls(const std::string& text, const std::set<std::string>& names) {
  static const std::regex call(R"rx((\w+)(?:<[^;()]*>)?\()rx");
  std::size_t found = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), call), end; at != end; ++at)
    found += names.contains((*at)[1].str());
  return found;
}

/// Adds the functions and lambdas of a file that call one of `names`, and those that call these.
void add_callers(const std::string& code, std::set<std::string>& names) {
  static const std::regex head(R"rx((?:auto (\w+) = \[&\]|(\w+))\()rx");
  static const std::regex body(R"rx(\s*(?:const|HWY_ATTR|\s)*\{)rx");
  static const std::set<std::string> keywords = {"if", "for", "while", "switch", "return"};
  for (std::size_t before = 0; before != names.size();) {
    before = names.size();
    for (std::sregex_iterator at(code.begin(), code.end(), head), end; at != end; ++at) {
      const std::string name = (*at)[1].matched ? (*at)[1].str() : (*at)[2].str();
      if (keywords.contains(name)) continue;
      const auto open = static_cast<std::size_t>(at->position() + at->length()) - 1;
      const std::size_t after = std::min(code.size(), closing(code, open, '(', ')') + 1);
      std::smatch begins;
      if (!std::regex_search(code.begin() + static_cast<std::ptrdiff_t>(after), code.end(), begins, body,
                             std::regex_constants::match_continuous))
        continue;
      const std::size_t brace = after + static_cast<std::size_t>(begins.length()) - 1;
      if (calls(code.substr(brace, closing(code, brace, '{', '}') - brace), names) > 0) names.insert(name);
    }
  }
}

/// The parts of a file whose order the language fixes: statements, elements of braces, sides of `?:`,
/// declarators.
std::vector<std::string> ordered_parts(const std::string& code) {
  std::vector<std::string> parts{""};
  int depth = 0;
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char c = code[i];
    const bool colon = c == ':' && code[i + 1] != ':' && (i == 0 || code[i - 1] != ':');
    const bool ends = c == ';' || c == '{' || c == '}' || c == '?' || colon;
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (ends) depth = 0;
    if (ends || (c == ',' && depth <= 0))
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::vector<std::string> unordered_accesses(const std::string& text) {
  std::set<std::string> names = {
      "load_image",           "load_image_int",    "load_buffer",  "sample_image", "sample_texture",
      "sample_texture_alpha", "sample_texture_at", "atomic_add",   "read_texel",   "atomic_exchange",
      "load_group_byte",      "gather_image",      "compare_image"};
  const std::string code = code_of(text);
  add_callers(code, names);
  std::vector<std::string> found;
  for (const std::string& part : ordered_parts(code))
    if (calls(part, names) > 1) found.push_back(part);
  return found;
}

TEST(LoadOrder, EachTrackedAccessIsAStatement) {
  static const std::regex shaders(R"rx(algos/.*/shaders/.*|pipeline/(?:shade|texture)/.*-inl\.h)rx");
  std::size_t seen = 0;
  for (const fs::path& file : hwsim::test::project_files({".h", ".cpp"})) {
    if (!std::regex_match(file.generic_string(), shaders)) continue;
    ++seen;
    std::ifstream in(fs::path(hwsim::test::source_dir()) / file);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    for (const std::string& part : unordered_accesses(text))
      ADD_FAILURE() << file << ": one statement for each access, in the order in which they shall be:\n"
                    << part;
  }
  EXPECT_GT(seen, 40u) << "the shaders were not found";
}

TEST(LoadOrder, TwoOperandsAreFound) {
  const auto count = [](const std::string& text) { return unordered_accesses(text).size(); };
  EXPECT_EQ(count("const F a = s.load_image(0, x).x, b = s.load_image(1, x).x;"), 0u);
  EXPECT_EQ(count("const F a = s.load_image(0, x).x + s.load_image(1, x).x;"), 1u);
  EXPECT_EQ(count("const auto at = [&](int i) HWY_ATTR { return s.load_image(i); }; sum = f(at(0), at(1));"),
            1u);
  EXPECT_EQ(count("F g(int i) const { return s_.load_buffer(i); } F h() { return g(0) | g(1); }"), 1u);
  EXPECT_EQ(count("return wide ? s.sample_image(0) : s.sample_image(1);"), 0u);
  EXPECT_EQ(count("return {s.sample_image(0), s.sample_image(1)};"), 0u);
}

}  // namespace
