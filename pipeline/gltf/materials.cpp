#include "pipeline/gltf/materials.h"

#include <algorithm>
#include <map>
#include <string>
#include <thread>

#include "pipeline/base/parallel.h"
#include "pipeline/image/image_io.h"
#include "pipeline/image/image_signature.h"
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
    uv_sources_ = {};
    next_set_ = 0;
    if (textured) set_textures(out, source, where);
    return out;
  }
  /// Belong to the material that was built last.
  const UvSources& uv_sources() const { return uv_sources_; }

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
    const auto each = [&](auto&& use) {
      use(pbr.baseColorTexture, out.base_color_texture, true, ".baseColorTexture");
      use(pbr.metallicRoughnessTexture, out.metallic_roughness_texture, false, ".metallicRoughnessTexture");
      use(source.normalTexture, out.normal_texture, false, ".normalTexture");
      use(source.emissiveTexture, out.emissive_texture, true, ".emissiveTexture");
      use(source.occlusionTexture, out.occlusion_texture, false, ".occlusionTexture");
    };
    // The two sets keep their numbers unless a texture moves its coordinates.
    sources_are_plain_ = true;
    each([&](const auto& info, TextureRef&, bool, const char*) {
      if (info.index >= 0)
        sources_are_plain_ = sources_are_plain_ && source_of(info).transform == UvTransform{};
    });
    each([&](const auto& info, TextureRef& to, bool srgb, const char* name) {
      to = ref(info, srgb, where + name);
    });
  }

  template <class Info>
  static UvSource source_of(const Info& info) {
    UvSource out{info.texCoord, {}};
    const auto found = info.extensions.find("KHR_texture_transform");
    if (found == info.extensions.end()) return out;
    const auto number = [](const tinygltf::Value& v) { return v.GetNumberAsDouble(); };
    const auto pair = [&](const char* key, glm::dvec2& to) {
      if (found->second.Has(key))
        to = {number(found->second.Get(key).Get(0)), number(found->second.Get(key).Get(1))};
    };
    pair("offset", out.transform.offset);
    pair("scale", out.transform.scale);
    if (found->second.Has("rotation")) out.transform.rotation_rad = number(found->second.Get("rotation"));
    if (found->second.Has("texCoord")) out.file_set = found->second.Get("texCoord").GetNumberAsInt();
    return out;
  }

  // The set of the vertices that holds these coordinates; -1: both are taken by others.
  int set_of(const UvSource& source) {
    if (sources_are_plain_) return source.file_set;
    for (int i = 0; i < next_set_; ++i)
      if (uv_sources_.sets[static_cast<std::size_t>(i)] == source) return i;
    if (next_set_ == 2) return -1;
    uv_sources_.sets[static_cast<std::size_t>(next_set_)] = source;
    return next_set_++;
  }

  template <class Info>
  TextureRef ref(const Info& info, bool srgb, const std::string& where) {
    TextureRef out;
    if (info.index < 0) return out;
    const UvSource source = source_of(info);
    if (source.file_set > 1) {
      report_.warn("S112", "textures on a UV set above 1 are left out", where);
      return out;
    }
    const tinygltf::Texture& texture = model_.textures[static_cast<std::size_t>(info.index)];
    if (texture.source < 0) {
      const std::string why =
          texture.extensions.empty() ? "no image" : "only an image of " + texture.extensions.begin()->first;
      report_.warn("S112", "a texture has " + why + " and is left out", where);
      return out;
    }
    const int set = set_of(source);
    if (set < 0) {
      report_.warn("S112", "a texture is left out: its material moves coordinates in more than two ways",
                   where);
      return out;
    }
    out.texture = request(texture.source, srgb);
    out.sampler = texture.sampler + 1;  // 0 is the default sampler
    out.uv_set = set;
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
  UvSources uv_sources_;
  bool sources_are_plain_ = true;
  int next_set_ = 0;
};

}  // namespace

MaterialSet build_materials(Report& report, const Source& source, const std::vector<bool>& used) {
  const tinygltf::Model& model = source.model;
  MaterialSet out;
  out.samplers.emplace_back();
  for (std::size_t i = 0; i < model.samplers.size(); ++i)
    out.samplers.push_back(sampler_of(report, model.samplers[i], element("samplers", i)));
  MaterialBuilder builder(report, model);
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    out.materials.push_back(builder.build(model.materials[i], element("materials", i), used[i]));
    out.uv_sources.push_back(builder.uv_sources());
  }
  Material fallback;
  fallback.name = "default";
  out.materials.push_back(fallback);
  out.uv_sources.emplace_back();
  out.textures = builder.take_requests();
  return out;
}

namespace {

// For each request the first one of an equal image read in the same way: itself, or one before it.
std::vector<std::size_t> first_equals(const Source& source, const std::vector<TextureRequest>& requests) {
  std::vector<std::size_t> out;
  std::map<TextureRequest, std::size_t> first;
  for (const auto& [image, srgb] : requests) {
    const int same = source.images[static_cast<std::size_t>(image)].same_as;
    out.push_back(first.try_emplace({same < 0 ? image : same, srgb}, out.size()).first->second);
  }
  return out;
}

}  // namespace

void charge_textures(const Report& report, Budget& budget, const Source& source,
                     const std::vector<TextureRequest>& requests) {
  const std::vector<std::size_t> first = first_equals(source, requests);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const EncodedImage& image = source.images[static_cast<std::size_t>(requests[i].first)];
    if (image.bytes.empty())
      report.fail("S013", image.label + " " + image.fault,
                  "put the image beside the .gltf file, or remove the texture");
    if (first[i] != i) continue;
    const ImageSize size = image_size(image.bytes);
    const std::uint64_t texel_bytes = std::uint64_t{4} * size.width * size.height;
    budget.charge(2 * (texel_bytes + texel_bytes / 3), image.label);  // and in the emulated GPU's memory
  }
}

std::vector<Texture> build_textures(const Report& report, const Source& source,
                                    const std::vector<TextureRequest>& requests) {
  const std::vector<std::size_t> first = first_equals(source, requests);
  std::vector<Texture> out(requests.size());
  std::vector<std::size_t> decoded;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const auto image = static_cast<std::size_t>(requests[i].first);
    out[i].name = source.images[image].name.empty() ? element("images", image) : source.images[image].name;
    out[i].srgb = requests[i].second;
    if (first[i] == i)
      decoded.push_back(i);
    else
      out[i].same_texels_as = static_cast<int>(first[i]);
  }
  const int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  parallel_for(decoded.size(), jobs, [&](std::size_t k, int) {
    Texture& texture = out[decoded[k]];
    const EncodedImage& image = source.images[static_cast<std::size_t>(requests[decoded[k]].first)];
    RawImage raw = decode_image(image.bytes, report.file() + ": " + image.label);
    texture.levels = mip_chain(raw.width, raw.height, std::move(raw.texels), texture.srgb);
  });
  return out;
}

}  // namespace hwsim::pipeline::gltf
