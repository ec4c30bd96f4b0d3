#pragma once
// Materials, samplers and textures of a glTF file.
#include <utility>
#include <vector>

#include "pipeline/gltf/source.h"
#include "pipeline/gltf/uv_sources.h"
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline::gltf {

/// One Scene texture: an image read as colors (sRGB) or as data (linear).
using TextureRequest = std::pair<int, bool>;  ///< image, srgb

struct MaterialSet {
  std::vector<Material> materials;       ///< the file's, then one default material
  std::vector<UvSources> uv_sources;     ///< one a material
  std::vector<Sampler> samplers;         ///< the default one, then the file's
  std::vector<TextureRequest> textures;  ///< what the materials in use refer to
};

/// Materials that no drawn primitive uses get no textures. Throws InputError (S004).
MaterialSet build_materials(Report& report, const Source& source, const std::vector<bool>& used);

/// Charges what the textures will take with their mip chains, as loaded and as the emulated GPU holds them.
/// Throws InputError (S012, S013).
void charge_textures(const Report& report, Budget& budget, const Source& source,
                     const std::vector<TextureRequest>& requests);

/// Decodes the images, equal ones once, and builds their mip chains, in parallel. Throws InputError (S013,
/// and decode_image's).
std::vector<Texture> build_textures(const Report& report, const Source& source,
                                    const std::vector<TextureRequest>& requests);

}  // namespace hwsim::pipeline::gltf
