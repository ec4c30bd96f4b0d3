#pragma once
// Extensions of glTF that are ignored, and what that changes.
#include <string>

#include "pipeline/gltf/source.h"

namespace hwsim::pipeline::gltf {

/// What happens to a file that uses an extension without requiring it: "the base material is drawn"; "" if
/// honored.
std::string effect_of_extension(const std::string& name);

/// Notes each extension that is used and ignored, and animations.
void note_extensions(Report& report, const Source& source);

}  // namespace hwsim::pipeline::gltf
