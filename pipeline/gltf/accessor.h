#pragma once
// Values of an accessor as plain arrays.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/gltf/source.h"

namespace hwsim::pipeline::gltf {

/// What is wanted of an accessor of numbers.
struct AccessorUse {
  int accessor = 0;
  int components = 1;       ///< values an element has
  std::string where{};      ///< names the use: "meshes[0].primitives[1] attribute NORMAL"
  bool normalized = false;  ///< integers are divided as glTF 2.0 section 3.11 says
};

/// Throws InputError (S004) for a type with another number of components.
void require_components(const Report& report, const tinygltf::Model& model, const AccessorUse& use);

/// A dense copy, sparse substitutions applied, into memory for count x components values. Throws InputError
/// for a value that is not finite (S010).
void read_floats(const Report& report, const tinygltf::Model& model, const AccessorUse& use,
                 std::span<float> out);
/// The same into new memory, with the components checked.
std::vector<float> read_floats(const Report& report, const tinygltf::Model& model, const AccessorUse& use);

/// Unsigned scalars of 8, 16 or 32 bits.
std::vector<std::uint32_t> read_indices(const Report& report, const tinygltf::Model& model, int accessor,
                                        const std::string& where);

/// Bytes of one element as stored.
int element_bytes(const tinygltf::Model& model, int accessor);

}  // namespace hwsim::pipeline::gltf
