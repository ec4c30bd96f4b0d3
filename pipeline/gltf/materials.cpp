#include "pipeline/gltf/materials.h"

#include <algorithm>
#include <map>
#include <string>
#include <thread>

#include "pipeline/base/parallel.h"
#include "pipeline/image/image_io.h"
#include "pipeline/scene/mip_chain.h"

namespace hwsim::pipeline::gltf {
namespace {

Wrap wrap_of(const Report& report, int code, const std::string& where) {
  switch (code) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::clamp_to_edge;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::mirrored_repeat;
    default:
      report.fail("S004", where + " wrap mode " + std::to_string(code) + " does not exist");
  }
}

Sampler sampler_of(const Report& report, const tinygltf::Sampler& source, const std::string& where) {
  Sampler out;
  out.wrap_u = wrap_of(report, source.wrapS, where);
  out.wrap_v = wrap_of(report, source.wrapT, where);
  switch (source.magFilter) {
    case -1:
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
      break;
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
      out.mag = Filter::nearest;
      break;
    default:
      report.fail("S004", where + ".magFilter " + std::to_string(source.magFilter) + " does not exist");
  }
  const auto set_min = [&](Filter min, MipFilter mip) { out.min = min, out.mip = mip; };
  switch (source.minFilter) {
    case -1:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
      break;
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
      set_min(Filter::nearest, MipFilter::none);
      break;
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
      set_min(Filter::linear, MipFilter::none);
      break;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
      set_min(Filter::nearest, MipFilter::nearest);
      break;
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
      set_min(Filter::linear, MipFilter::nearest);
      break;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
      set_min(Filter::nearest, MipFilter::linear);
      break;
    default:
      report.fail("S004", where + ".minFilter " + std::to_string(source.minFilter) + " does not exist");
  }
  return out;
}

class MaterialBuilder {
 public:
  MaterialBuilder(Report& report, const tinygltf::Model& model) : report_(report), model_(model) {}

  Material build(const tinygltf::Material& source, const std::string& where, bool textured) {
    Material out;
    out.name = source.name.empty() ? where : source.name;
    const auto& pbr = source.pbrMetallicRoughness;
    for (int i = 0; i < 4; ++i)
      out.base_color[i] = unit(pbr.baseColorFactor[static_cast<std::size_t>(i)], where + " baseColorFactor");
    out.metallic = unit(pbr.metallicFactor, where + " metallicFactor");
    out.roughness = unit(pbr.roughnessFactor, where + " roughnessFactor");
    const double strength = emissive_strength(source);
    for (std::size_t i = 0; i < source.emissiveFactor.size() && i < 3; ++i)
      out.emissive[static_cast<int>(i)] =
          static_cast<float>(std::clamp(source.emissiveFactor[i] * strength, 0.0, 1e6));
    set_alpha(out, source, where);
    out.normal_scale = static_cast<float>(std::clamp(source.normalTexture.scale, -1e3, 1e3));
    out.occlusion_strength = unit(source.occlusionTexture.strength, where + " occlusionTexture.strength");
    if (source.extensions.count("KHR_materials_unlit")) out.model = ShadingModel::unlit;
    if (textured) set_textures(out, source, where);
    return out;
  }

  std::vector<TextureRequest> take_requests() { return std::move(requests_); }

 private:
  float unit(double value, const std::string& what) {
    if (value < 0.0 || value > 1.0)
      report_.warn("S111", "material factors outside 0 to 1 were clamped", what);
    return static_cast<float>(std::clamp(value, 0.0, 1.0));
  }

  static double emissive_strength(const tinygltf::Material& source) {
    const auto found = source.extensions.find("KHR_materials_emissive_strength");
    if (found == source.extensions.end() || !found->second.Has("emissiveStrength")) return 1.0;
    return found->second.Get("emissiveStrength").GetNumberAsDouble();
  }

  void set_alpha(Material& out, const tinygltf::Material& source, const std::string& where) {
    out.alpha_cutoff = static_cast<float>(std::clamp(source.alphaCutoff, 0.0, 1e6));
    out.double_sided = source.doubleSided;
    if (source.alphaMode == "OPAQUE" || source.alphaMode.empty())
      out.alpha_mode = AlphaMode::opaque;
    else if (source.alphaMode == "MASK")
      out.alpha_mode = AlphaMode::mask;
    else if (source.alphaMode == "BLEND")
      out.alpha_mode = AlphaMode::blend;
    else
      report_.fail("S004",
                   where + ".alphaMode is \"" + source.alphaMode + "\", must be OPAQUE, MASK or BLEND");
  }

  void set_textures(Material& out, const tinygltf::Material& source, const std::string& where) {
    const auto& pbr = source.pbrMetallicRoughness;
    out.base_color_texture = ref(pbr.baseColorTexture, true, where + ".baseColorTexture");
    out.metallic_roughness_texture =
        ref(pbr.metallicRoughnessTexture, false, where + ".metallicRoughnessTexture");
    out.normal_texture = ref(source.normalTexture, false, where + ".normalTexture");
    out.emissive_texture = ref(source.emissiveTexture, true, where + ".emissiveTexture");
    out.occlusion_texture = ref(source.occlusionTexture, false, where + ".occlusionTexture");
  }

  template <class Info>
  TextureRef ref(const Info& info, bool srgb, const std::string& where) {
    TextureRef out;
    if (info.index < 0) return out;
    if (info.texCoord > 1) {
      report_.warn("S112", "textures on a UV set above 1 are left out", where);
      return out;
    }
    if (info.extensions.count("KHR_texture_transform"))
      report_.warn("S101", "KHR_texture_transform is ignored: the texture coordinates are used as they are",
                   where);
    const tinygltf::Texture& texture = model_.textures[static_cast<std::size_t>(info.index)];
    if (texture.source < 0) {
      const std::string why =
          texture.extensions.empty() ? "no image" : "only an image of " + texture.extensions.begin()->first;
      report_.warn("S112", "a texture has " + why + " and is left out", where);
      return out;
    }
    out.texture = request(texture.source, srgb);
    out.sampler = texture.sampler + 1;  // 0 is the default sampler
    out.uv_set = info.texCoord;
    return out;
  }

  int request(int image, bool srgb) {
    const auto [place, is_new] = texture_of_.try_emplace({image, srgb}, static_cast<int>(requests_.size()));
    if (is_new) requests_.emplace_back(image, srgb);
    return place->second;
  }

  Report& report_;
  const tinygltf::Model& model_;
  std::map<TextureRequest, int> texture_of_;
  std::vector<TextureRequest> requests_;
};

}  // namespace

MaterialSet build_materials(Report& report, const tinygltf::Model& model, const std::vector<bool>& used) {
  MaterialSet out;
  out.samplers.emplace_back();
  for (std::size_t i = 0; i < model.samplers.size(); ++i)
    out.samplers.push_back(sampler_of(report, model.samplers[i], element("samplers", i)));
  MaterialBuilder builder(report, model);
  for (std::size_t i = 0; i < model.materials.size(); ++i)
    out.materials.push_back(builder.build(model.materials[i], element("materials", i), used[i]));
  Material fallback;
  fallback.name = "default";
  out.materials.push_back(fallback);
  out.textures = builder.take_requests();
  return out;
}

std::vector<Texture> build_textures(const Report& report, const Source& source,
                                    const std::vector<TextureRequest>& requests) {
  std::vector<Texture> out(requests.size());
  const int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  parallel_for(requests.size(), jobs, [&](std::size_t i, int) {
    const auto image = static_cast<std::size_t>(requests[i].first);
    const tinygltf::Image& info = source.model.images[image];
    const std::string where = element("images", image) + (info.uri.empty() ? "" : " (" + info.uri + ")");
    if (source.images[image].empty())
      report.fail("S013", where + " cannot be read",
                  "put the image beside the .gltf file, or remove the texture");
    RawImage raw = decode_image(source.images[image], report.file() + ": " + where);
    out[i].name = info.name.empty() ? element("images", image) : info.name;
    out[i].srgb = requests[i].second;
    out[i].levels = mip_chain(raw.width, raw.height, std::move(raw.texels), out[i].srgb);
  });
  return out;
}

}  // namespace hwsim::pipeline::gltf
