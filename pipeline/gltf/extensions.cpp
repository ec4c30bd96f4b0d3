#include "pipeline/gltf/extensions.h"

#include <array>
#include <set>
#include <utility>

#include "pipeline/gltf/rules.h"

namespace hwsim::pipeline::gltf {

std::string effect_of_extension(const std::string& name) {
  if (is_honored_extension(name)) return "";
  constexpr std::array<std::pair<const char*, const char*>, 7> kEffects = {
      {{"KHR_texture_basisu", "textures with no PNG or JPEG beside the KTX2 image are left out"},
       {"EXT_texture_webp", "textures with no PNG or JPEG beside the WebP image are left out"},
       {"KHR_draco_mesh_compression", "the uncompressed accessors are read"},
       {"EXT_meshopt_compression", "the uncompressed buffers are read"},
       {"EXT_mesh_gpu_instancing", "the mesh is drawn once, at its node"},
       {"KHR_materials_variants", "the default materials are drawn"},
       {"MSFT_lod", "the finest level is drawn"}}};
  for (const auto& [known, effect] : kEffects)
    if (name == known) return effect;
  if (name.rfind("KHR_materials_", 0) == 0) return "the metallic-roughness base material is drawn";
  return "the file is drawn as if it were absent";
}

void note_extensions(Report& report, const Source& source) {
  const tinygltf::Model& model = source.model;
  const std::set<std::string> used(model.extensionsUsed.begin(), model.extensionsUsed.end());
  for (const std::string& name : used)
    if (const std::string effect = effect_of_extension(name); !effect.empty())
      report.note("S101", "the extension " + name + " is not supported: " + effect);
  if (source.has_animations) report.note("S110", "animations are ignored: nodes stay where they are");
}

}  // namespace hwsim::pipeline::gltf
