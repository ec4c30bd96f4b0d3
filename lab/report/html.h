#pragma once
// Text and tables as HTML. Names come from files of strangers: nothing reaches a page unescaped.
#include <string>
#include <string_view>

#include "lab/base/table.h"

namespace hwsim::lab {

/// For text and for values of attributes in double quotes. Bytes that are no UTF-8, and control characters,
/// are shown as escapes.
std::string html_text(std::string_view text);

/// JSON for a <script> element: no `<` in it, which could end the element.
std::string script_json(const nlohmann::ordered_json& json);

/// A <table> whose cells carry every digit in `data-v`.
std::string html_table(const Table& table, std::string_view caption);

}  // namespace hwsim::lab
