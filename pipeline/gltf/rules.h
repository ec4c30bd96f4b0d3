#pragma once
// Checks of a glTF file before the parser reads it.
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "pipeline/gltf/report.h"

namespace hwsim::pipeline::gltf {

/// The extensions that load_gltf honors; any other one in extensionsRequired is an error.
bool is_honored_extension(std::string_view name);

/// Parses the JSON text. Throws InputError (S003) with line and column, also for nesting that would overrun a
/// stack.
nlohmann::json parse_json(const Report& report, std::string_view text);

/// Checks everything that tinygltf takes on trust: types, required keys, references between arrays, buffer
/// views inside buffers, accessors inside views. Whole numbers become integers in `root` ("1.0", "4.8e1").
/// Cameras are judged one by one (gltf/cameras.h). Throws one InputError with all findings (S004 - S008,
/// S014).
void check_rules(Report& report, nlohmann::json& root);

}  // namespace hwsim::pipeline::gltf
