#include "hwsim/base/csv.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hwsim/base/diagnostics.h"

namespace hwsim {
namespace {

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  bool at_end() const { return at_ >= text_.size(); }
  int line() const { return line_; }

  /// Fields of one record; ends behind its line end.
  std::vector<std::string> record() {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (; !at_end(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') ++line_;
      if (quoted) {
        if (c == '"' && at_ + 1 < text_.size() && text_[at_ + 1] == '"')
          fields.back() += text_[++at_];
        else if (c == '"')
          quoted = false;
        else
          fields.back() += c;
      } else if (c == '"') {
        quoted = true;
      } else if (c == ',') {
        fields.emplace_back();
      } else if (c == '\n') {
        ++at_;
        break;
      } else if (c != '\r') {
        fields.back() += c;
      }
    }
    return fields;
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

[[noreturn]] void fail(const std::string& code, const std::string& message, const std::string& path,
                       const std::string& help = {}) {
  Diagnostic problem{.code = code, .message = message, .help = help};
  problem.place.file = path;
  throw InputError(problem);
}

}  // namespace

std::size_t CsvFile::column(std::string_view name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) fail("U015", "`" + path + "` has no column `" + std::string(name) + "`", path);
  return static_cast<std::size_t>(found - header.begin());
}

CsvFile parse_csv(std::string_view text, const std::string& path) {
  Reader reader(text);
  CsvFile file{path, reader.record(), {}, {}};
  while (!reader.at_end()) {
    file.lines.push_back(reader.line());
    file.rows.push_back(reader.record());
    if (file.rows.back().size() == file.header.size()) continue;
    fail("U015",
         "record " + std::to_string(file.rows.size() + 1) + " of `" + path + "` has " +
             std::to_string(file.rows.back().size()) + " fields, the header has " +
             std::to_string(file.header.size()),
         path);
  }
  return file;
}

CsvFile read_csv(const std::string& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    fail("U011", "`" + path + "` is no file", path);  // a pipe would be waited for
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (in && in.peek() == std::ifstream::traits_type::eof() && !in.bad())  // `<<` of nothing fails, too
    fail("U015", "`" + path + "` is empty", path, "its first line must name the columns");
  if (in) text << in.rdbuf();
  if (!in || !text) fail("U011", "`" + path + "` cannot be read", path);
  return parse_csv(text.str(), path);
}

}  // namespace hwsim
