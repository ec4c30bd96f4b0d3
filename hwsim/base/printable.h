#pragma once
// Text that came from a file, made safe for a terminal and for programs that expect UTF-8.
#include <string>
#include <string_view>

namespace hwsim {

/// The text with every control character, every mark that turns the direction of writing, and every byte that
/// is no UTF-8 shown as an escape ("\x1b", "\u202e"). Line ends and tabs stay.
std::string printable(std::string_view text);

/// The same, with line ends and tabs shown as escapes too: the text stays one line.
std::string printable_line(std::string_view text);

}  // namespace hwsim
