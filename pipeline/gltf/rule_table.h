#pragma once
// The types and references that glTF 2.0 asks of each key, as a table.
#include <cstddef>
#include <span>

namespace hwsim::pipeline::gltf {

enum class Kind {
  text,
  texts,
  boolean,
  number,
  numbers,
  count,
  index,
  indices,
  index_map,
  index_maps,
  object,
  objects,
  object_map,
  values  ///< an array of anything
};

/// What a key's value must be. `target`: the array that an index points into. `length`: of `numbers`, 0 is
/// any.
struct Rule {
  const char* key;
  Kind kind;
  bool required = false;
  const char* target = "";
  std::size_t length = 0;
  std::span<const Rule> children{};
};

/// The keys of glTF 2.0 that the loader or tinygltf reads; keys without a rule are not read.
std::span<const Rule> root_rules();

}  // namespace hwsim::pipeline::gltf
