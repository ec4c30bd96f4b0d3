#pragma once
// A checked file: its JSON parsed by tinygltf, its buffers and images as bytes.
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/gltf/budget.h"
#include "pipeline/gltf/cameras.h"
#include "pipeline/gltf/container.h"
#include "pipeline/gltf/gltf_loader.h"
#include "pipeline/gltf/images.h"
#include "pipeline/gltf/report.h"
#include "pipeline/gltf/skins.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

namespace hwsim::pipeline::gltf {

struct Source {
  tinygltf::Model
      model;  ///< buffers filled, but for those that nothing drawn refers to; no images, cameras, skins
  std::vector<CameraSpec> cameras;
  std::vector<SkinSpec> skins;
  std::vector<EncodedImage> images;
  bool has_animations = false;
  std::string content_hash;
  std::vector<std::string> files;  ///< that were read, or looked for
};

/// Everything that is checked without looking at vertices is right in the result: types, references, byte
/// ranges. Throws InputError.
Source read_source(Report& report, Container container, const SceneLoadOptions& options, Budget& budget);

}  // namespace hwsim::pipeline::gltf
