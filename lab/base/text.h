#pragma once
// Small operations on text that several rooms share.
#include <string>
#include <string_view>
#include <vector>

namespace hwsim::lab {

/// The pieces between the separators: one more than there are separators.
std::vector<std::string> split(std::string_view text, char separator);

/// Splits "msaa4x,agaa:c=2,msaa=8" into techniques: a piece whose '=' comes before any ':' is a parameter of
/// the piece before it.
std::vector<std::string> split_techniques(std::string_view text);

/// A word as a POSIX shell reads it back: quoted where it holds more than plain characters.
std::string shell_word(const std::string& word);

}  // namespace hwsim::lab
