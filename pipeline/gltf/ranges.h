#pragma once
// Checks that buffer views, accessors and images lie inside of what holds them.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <vector>

#include "pipeline/gltf/report.h"

namespace hwsim::pipeline::gltf {

/// 0: no such component type.
int component_bytes(std::uint64_t component_type);
/// 0: no such type ("VEC3" is 3).
int component_count(std::string_view type);

/// After the types and references are known to be right: buffer views inside buffers, accessors inside their
/// views, component types, strides, images with exactly one source.
std::vector<Diagnostic> check_ranges(const Report& report, const nlohmann::json& root);

}  // namespace hwsim::pipeline::gltf
