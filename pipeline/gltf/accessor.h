#pragma once
// Values of an accessor as plain arrays.
#include <cstdint>
#include <vector>

#include "pipeline/gltf/source.h"

namespace hwsim::pipeline::gltf {

/// A dense copy, `components` values an element, sparse substitutions applied. `normalized`: integers are
/// divided as glTF 2.0 section 3.11 says. Throws InputError for a value that is not finite (S010) or a type
/// with another number of components (S004); `where` names the use ("meshes[0].primitives[1] attribute
/// NORMAL").
std::vector<float> read_floats(const Report& report, const tinygltf::Model& model, int accessor,
                               int components, const std::string& where, bool normalized);

/// Unsigned scalars of 8, 16 or 32 bits.
std::vector<std::uint32_t> read_indices(const Report& report, const tinygltf::Model& model, int accessor,
                                        const std::string& where);

/// Bytes of one element as stored.
int element_bytes(const tinygltf::Model& model, int accessor);

}  // namespace hwsim::pipeline::gltf
