#pragma once
// A checked file, parsed by tinygltf.
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/gltf/gltf_loader.h"
#include "pipeline/gltf/report.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

namespace hwsim::pipeline::gltf {

struct Source {
  tinygltf::Model model;
  std::vector<std::vector<std::uint8_t>> images;  ///< encoded; empty where the file could not be read
  std::string content_hash;
  std::vector<std::string> files;  ///< that were read, or looked for
};

/// Everything that is checked without looking at vertices is right in the result: types, references, byte
/// ranges. Throws InputError.
Source read_source(Report& report, const SceneLoadOptions& options);

}  // namespace hwsim::pipeline::gltf
