#pragma once
// One value to one key, with the messages that can come of it. Shared by files and by --set.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/config/key.h"
#include "hwsim/config/toml_value.h"

namespace hwsim {

/// Stores `value` in the key's slot, checked for type and range; otherwise C013 or C014 and the slot stays.
bool assign(const Key& key, const TomlValue& value, const SourcePlace& place,
            std::vector<Diagnostic>& problems);

/// The range check alone, for values set in code.
std::optional<Diagnostic> check_range(const Key& key);

/// The factor of "x2" or "x0.5", a value relative to what lies below it; none for keys that hold no number,
/// and for anything else.
std::optional<double> scale_factor(const Key& key, const TomlValue& value);

/// A number times a factor, whole where the product is; anything else as it is (its type is checked later).
TomlValue scaled(const TomlValue& value, double factor);

/// The value in a slot, as an integer, real, boolean or text.
TomlValue value_in(const KeySlot& slot);

/// What a file must write for the key: "number", "whole number", "true or false", "text".
std::string_view expected_type(const Key& key);

const Key* find_key(std::span<const Key> keys, std::string_view name);

/// The known name nearest to `name`; "features.x" is found for a mistyped group too. "" if none is near.
std::string nearest_key(std::span<const Key> keys, std::string_view name);

/// C012 with the nearest name; `subject` is, e.g., `gpu "gtx470"`.
Diagnostic unknown_key(std::span<const Key> keys, std::string_view name, std::string_view subject,
                       SourcePlace place);

/// The place of a `--set` on the command line, shown as a line of a file; the mark stands under the value, or
/// the path.
SourcePlace command_line_place(const Assignment& assignment, bool at_value);

/// The value of a `--set`; none, and C021 with its place, where it is no TOML scalar.
std::optional<TomlValue> value_of_assignment(const Assignment& assignment, std::vector<Diagnostic>& problems);

}  // namespace hwsim
