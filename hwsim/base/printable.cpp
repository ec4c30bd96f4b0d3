#include "hwsim/base/printable.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>

namespace hwsim {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
};

/// The character at the beginning of `text`, by table 3-7 of the Unicode standard; nothing where no UTF-8
/// begins.
std::optional<Character> first_character(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return Character{lead, 1};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return std::nullopt;
  std::uint32_t code = lead & (0xffu >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return std::nullopt;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  const std::uint32_t smallest = bytes == 4 ? 0x10000 : bytes == 3 ? 0x800 : 0x80;
  if (code < smallest || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return std::nullopt;
  return Character{code, bytes};
}

bool is_control(std::uint32_t code) { return code < 0x20 || (code >= 0x7f && code < 0xa0); }

/// Line and paragraph separators, and what turns the direction of writing.
bool is_hidden(std::uint32_t code) {
  return code == 0x2028 || code == 0x2029 || code == 0x200e || code == 0x200f || code == 0x061c ||
         code == 0xfeff || (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

std::string escape(std::uint32_t code) {
  char text[16];
  std::snprintf(text, sizeof text, code < 0x100 ? "\\x%02x" : "\\u%04x", static_cast<unsigned>(code));
  return text;
}

bool is_plain(std::string_view text) {
  for (const char c : text)
    if (c < 0x20 || c > 0x7e) return false;
  return true;
}

std::string made_printable(std::string_view text, bool keep_lines) {
  if (is_plain(text)) return std::string(text);
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::optional<Character> c = first_character(text.substr(at));
    const bool line_end = c && (c->code == '\n' || (c->code == '\r' && text.substr(at, 2) == "\r\n"));
    if (keep_lines && (line_end || (c && c->code == '\t')))
      out += text[at];
    else if (!c)
      out += escape(static_cast<std::uint8_t>(text[at]));
    else if (is_control(c->code) || is_hidden(c->code))
      out += escape(c->code);
    else
      out += text.substr(at, c->bytes);
    at += c ? c->bytes : 1;
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) { return made_printable(text, true); }
std::string printable_line(std::string_view text) { return made_printable(text, false); }

}  // namespace hwsim
