#pragma once
// Materials, samplers and textures of a glTF file.
#include <utility>
#include <vector>

#include "pipeline/gltf/source.h"
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline::gltf {

/// One Scene texture: an image read as colors (sRGB) or as data (linear).
using TextureRequest = std::pair<int, bool>;  ///< image, srgb

struct MaterialSet {
  std::vector<Material> materials;       ///< the file's, then one default material
  std::vector<Sampler> samplers;         ///< the default one, then the file's
  std::vector<TextureRequest> textures;  ///< what the materials in use refer to
};

/// Materials that no drawn primitive uses get no textures. Throws InputError (S004).
MaterialSet build_materials(Report& report, const tinygltf::Model& model, const std::vector<bool>& used);

/// Decodes the images and builds their mip chains, in parallel. Throws InputError (S013, and decode_image's).
std::vector<Texture> build_textures(const Report& report, const Source& source,
                                    const std::vector<TextureRequest>& requests);

}  // namespace hwsim::pipeline::gltf
