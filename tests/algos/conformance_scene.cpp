#include "tests/algos/conformance_scene.h"

#include <cmath>

#include "tests/pipeline/image/make_png.h"

namespace hwsim::test {
namespace {
using nlohmann::json;

constexpr float kHalf = 0.4f;  ///< half a square's side
const std::vector<float> kCorners = {-kHalf, -kHalf, 0, kHalf, -kHalf, 0, -kHalf, kHalf, 0, kHalf, kHalf, 0};
const std::vector<float> kUp = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
const std::vector<std::uint16_t> kIndices = {0, 1, 2, 2, 1, 3};
const std::vector<float> kWholeUv = {0, 1, 1, 1, 0, 0, 1, 0};  ///< v runs down, as images do
constexpr int kFloat = 5126, kShort = 5122, kByte = 5120, kUnsignedShort = 5123, kUnsignedByte = 5121;

float linear(int code) {
  const float c = static_cast<float>(code) / 255.0f;
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

ConformanceScene::ConformanceScene() {
  glb_.root["nodes"] = json::array();
  glb_.root["meshes"] = json::array();
  glb_.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_emissive_strength",
                                 "KHR_materials_unlit", "KHR_mesh_quantization", "KHR_texture_transform"};
  add_transforms();
  add_vertex_colors();
  add_modes();
  add_alpha();
  add_textures();
  add_normal_maps();
  add_accessors();
  add_materials();
  add_camera_and_light();
}

glm::vec3 ConformanceScene::lit(const glm::vec3& base, float cosine, float open) {
  // Roughness 1: Blinn-Phong's exponent is 0, its lobe 8 / (8 pi), reflectance 0.04.
  const float lobe = cosine > 0.0f ? 0.04f / 3.14159265f : 0.0f;
  return base * (kAmbient * open + cosine) + glm::vec3(lobe) + glm::vec3(0.04f * kAmbient * open);
}

int ConformanceScene::add_material(const json& material) {
  glb_.root["materials"].push_back(material);
  return static_cast<int>(glb_.root["materials"].size()) - 1;
}

json ConformanceScene::plain_material(const glm::vec3& base) const {
  return {
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {base.x, base.y, base.z, 1.0}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}};
}

int ConformanceScene::add_texture(const std::vector<std::array<std::uint8_t, 4>>& texels, int width) {
  pipeline::test::Bytes rows;
  for (const auto& texel : texels) rows.insert(rows.end(), texel.begin(), texel.end());
  const auto height = static_cast<std::uint32_t>(texels.size()) / static_cast<std::uint32_t>(width);
  const int view =
      glb_.add_view(pipeline::testing::make_png({static_cast<std::uint32_t>(width), height}, rows));
  glb_.root["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  if (!glb_.root.contains("samplers"))
    glb_.root["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33071}}};
  glb_.root["textures"].push_back({{"source", glb_.root["images"].size() - 1}, {"sampler", 0}});
  return static_cast<int>(glb_.root["textures"].size()) - 1;
}

void ConformanceScene::add(const std::string& name, const glm::vec3& color, json primitive,
                           const json& node) {
  glb_.root["meshes"].push_back({{"name", name}, {"primitives", json::array({std::move(primitive)})}});
  json drawn = node;
  drawn["mesh"] = glb_.root["meshes"].size() - 1;
  const auto cell = static_cast<int>(patches_.size());
  glb_.root["nodes"].push_back(drawn);
  glb_.root["nodes"].push_back({{"translation", {cell % kColumns + 0.5, cell / kColumns + 0.5, 0}},
                                {"children", {glb_.root["nodes"].size() - 1}}});
  patches_.push_back({kind_, name, glm::min(color, glm::vec3(1.0f))});
}

json ConformanceScene::square(int material, bool with_normals) {
  json primitive = {{"material", material},
                    {"indices", glb_.add_accessor(kIndices, kUnsignedShort, "SCALAR", 1)}};
  primitive["attributes"]["POSITION"] = glb_.add_accessor(kCorners, kFloat, "VEC3", 3);
  if (with_normals) primitive["attributes"]["NORMAL"] = glb_.add_accessor(kUp, kFloat, "VEC3", 3);
  return primitive;
}

json ConformanceScene::textured_square(int material, const std::vector<float>& uv, const char* name) {
  json primitive = square(material);
  primitive["attributes"][name] = glb_.add_accessor(uv, kFloat, "VEC2", 2);
  return primitive;
}

void ConformanceScene::add_transforms() {
  kind_ = "negative scales";
  const glm::vec3 red(0.6f, 0.1f, 0.1f);
  const int material = add_material(plain_material(red));
  add("as it is", lit(red), square(material));
  add("mirrored in x", lit(red), square(material), {{"scale", {-1, 1, 1}}});
  add("mirrored in x, y and z, seen from behind", kBackground, square(material), {{"scale", {-1, -1, -1}}});
  kind_ = "non-uniform scales";
  add("flattened in z", lit(red), square(material), {{"scale", {1, 1, 0}}});
  add("turned by a matrix that ends in 0.9999999", lit(red), square(material),
      {{"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.9999999}}});
  // Turned by 60 degrees around y, then stretched along x and z: the normal (sin, 0, cos) becomes (sin, 0,
  // cos / 2).
  const float s = std::sqrt(0.75f), c = 0.5f, cosine = c / 2 / std::sqrt(s * s / 3.61f + c * c / 4);
  json turned = square(material);
  std::vector<float> corners = kCorners, normals;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const float x = corners[i];
    corners[i] = c * x;
    corners[i + 2] = -s * x;
    normals.insert(normals.end(), {s, 0, c});
  }
  turned["attributes"]["POSITION"] = glb_.add_accessor(corners, kFloat, "VEC3", 3);
  turned["attributes"]["NORMAL"] = glb_.add_accessor(normals, kFloat, "VEC3", 3);
  add("a slope, stretched along x and z", lit(red, cosine), turned, {{"scale", {1.9, 1, 2}}});
}

void ConformanceScene::add_vertex_colors() {
  kind_ = "vertex colors";
  const int white = add_material(plain_material(glm::vec3(1.0f)));
  const glm::vec3 color(0.2f, 0.4f, 0.6f);
  const auto colored = [&](int accessor, bool normalized) {
    if (normalized) glb_.root["accessors"][static_cast<std::size_t>(accessor)]["normalized"] = true;
    json primitive = square(white);
    primitive["attributes"]["COLOR_0"] = accessor;
    return primitive;
  };
  std::vector<float> floats;
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint16_t> shorts;
  for (int v = 0; v < 4; ++v) {
    for (int i = 0; i < 3; ++i) {
      floats.push_back(color[i]);
      bytes.push_back(static_cast<std::uint8_t>(color[i] * 255.0f + 0.5f));
      shorts.push_back(static_cast<std::uint16_t>(color[i] * 65535.0f + 0.5f));
    }
    bytes.push_back(255);
    shorts.push_back(65535);
  }
  add("vertex colors, floats", lit(color), colored(glb_.add_accessor(floats, kFloat, "VEC3", 3), false));
  add("vertex colors, normalized bytes", lit(color),
      colored(glb_.add_accessor(bytes, kUnsignedByte, "VEC4", 4), true));
  add("vertex colors, bytes without the flag", lit(color),
      colored(glb_.add_accessor(bytes, kUnsignedByte, "VEC4", 4), false));
  add("vertex colors, normalized shorts", lit(color),
      colored(glb_.add_accessor(shorts, kUnsignedShort, "VEC4", 4), true));
}

void ConformanceScene::add_modes() {
  kind_ = "primitive modes";
  const glm::vec3 green(0.1f, 0.5f, 0.2f);
  const int material = add_material(plain_material(green));
  const auto mode = [&](int number, const std::vector<std::uint16_t>& indices) {
    json primitive = square(material);
    primitive["mode"] = number;
    if (indices.empty())
      primitive.erase("indices");
    else
      primitive["indices"] = glb_.add_accessor(indices, kUnsignedShort, "SCALAR", 1);
    return primitive;
  };
  add("points draw nothing", kBackground, mode(0, {}));
  add("lines draw nothing", kBackground, mode(1, {0, 1, 2, 3}));
  add("line loops draw nothing", kBackground, mode(2, {0, 1, 3, 2}));
  add("line strips draw nothing", kBackground, mode(3, {0, 1, 3, 2}));
  add("triangles", lit(green), mode(4, {0, 1, 3, 0, 3, 2}));
  add("a strip without indices", lit(green), mode(5, {}));
  add("a strip with indices", lit(green), mode(5, {2, 0, 3, 1}));
  add("a fan", lit(green), mode(6, {0, 1, 3, 2}));
}

void ConformanceScene::add_alpha() {
  kind_ = "alpha modes";
  const glm::vec3 blue(0.1f, 0.2f, 0.7f);
  const auto with_alpha = [&](double alpha, const char* mode, double cutoff = 0.5) {
    json material = plain_material(blue);
    material["pbrMetallicRoughness"]["baseColorFactor"][3] = alpha;
    material["alphaMode"] = mode;
    if (std::string(mode) == "MASK") material["alphaCutoff"] = cutoff;
    return square(add_material(material));
  };
  add("opaque, whatever alpha says", lit(blue), with_alpha(0.1, "OPAQUE"));
  add("masked out", kBackground, with_alpha(0.3, "MASK"));
  add("masked in by its own cutoff", lit(blue), with_alpha(0.3, "MASK", 0.2));
  add("blended", lit(blue) * 0.25f + kBackground * 0.75f, with_alpha(0.25, "BLEND"));
  kind_ = "double-sided";
  json two_sides = plain_material(blue);
  two_sides["doubleSided"] = true;
  const json turned = {{"rotation", {0, 1, 0, 0}}};
  add("double-sided, from behind", lit(blue), square(add_material(two_sides)), turned);
  add("single-sided, from behind", kBackground, square(add_material(plain_material(blue))), turned);
}

void ConformanceScene::add_textures() {
  kind_ = "texture transforms";
  // Left half red, right half green, lower half twice as dark: which texel a corner shows tells the
  // coordinates.
  const int texture =
      add_texture({{200, 0, 0, 255}, {0, 200, 0, 255}, {120, 0, 0, 255}, {0, 120, 0, 255}}, 2);
  const glm::vec3 left(linear(200), 0, 0), right(0, linear(200), 0), low_right(0, linear(120), 0);
  const auto textured = [&](const json& info) {
    json material = plain_material(glm::vec3(1.0f));
    material["pbrMetallicRoughness"]["baseColorTexture"] = info;
    return add_material(material);
  };
  const std::vector<float> upper_left = {0.1f, 0.2f, 0.2f, 0.2f, 0.1f, 0.1f, 0.2f, 0.1f};
  add("a texture's upper left texel", lit(left), textured_square(textured({{"index", texture}}), upper_left));
  const auto moved = [&](const json& transform) {
    return textured({{"index", texture}, {"extensions", {{"KHR_texture_transform", transform}}}});
  };
  add("moved by a texture transform", lit(right), textured_square(moved({{"offset", {0.5, 0}}}), upper_left));
  add("scaled by a texture transform", lit(low_right),
      textured_square(moved({{"scale", {5, 6}}}), upper_left));
  // A quarter turn: (u, v) becomes (v, -u), moved back inside by one.
  add("turned by a texture transform", lit(glm::vec3(linear(120), 0, 0)),
      textured_square(moved({{"rotation", 1.5707963267948966}, {"offset", {0, 1}}}), upper_left));
  kind_ = "multiple coordinates";
  json second = textured_square(textured({{"index", texture}, {"texCoord", 1}}), upper_left);
  second["attributes"]["TEXCOORD_1"] =
      glb_.add_accessor<float>({0.8f, 0.2f, 0.9f, 0.2f, 0.8f, 0.1f, 0.9f, 0.1f}, kFloat, "VEC2", 2);
  add("the second set of coordinates", lit(right), second);
  second["material"] = moved({{"texCoord", 1}, {"offset", {-0.5, 0}}});
  add("the second set by a texture transform", lit(left), second);
  kind_ = "occlusion";  // keeps off ambient light, not the sun's
  json occluded = plain_material(glm::vec3(0.5f));
  occluded["occlusionTexture"] = {{"index", add_texture({{0, 255, 255, 255}}, 1)}, {"strength", 0.5}};
  add("occlusion by half", lit(glm::vec3(0.5f), 1.0f, 0.5f),
      textured_square(add_material(occluded), kWholeUv));
}

void ConformanceScene::add_normal_maps() {
  // Texel (1, 0.5, 0.5) is the tangent itself, (0.5 + 0.5 s, 0.5, 0.5 + 0.5 c) a lean of 45 degrees toward
  // it.
  const int lean = add_texture({{218, 128, 218, 255}}, 1);
  const glm::vec3 base(0.5f, 0.5f, 0.2f);
  const float x = 218.0f / 255.0f * 2.0f - 1.0f, y = 128.0f / 255.0f * 2.0f - 1.0f;
  const float cosine = x / std::sqrt(2 * x * x + y * y);
  json material = plain_material(base);
  material["normalTexture"] = {{"index", lean}};
  const int leaning = add_material(material);
  json with_tangents = textured_square(leaning, kWholeUv);
  with_tangents["attributes"]["TANGENT"] =
      glb_.add_accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, kFloat, "VEC4", 4);
  kind_ = "normal maps with tangents";
  add("a normal map with tangents", lit(base, cosine), with_tangents);
  kind_ = "normal maps without tangents";
  add("a normal map without tangents", lit(base, cosine), textured_square(leaning, kWholeUv));
  material["normalTexture"]["scale"] = 0.5;
  add("a normal map at half its scale", lit(base, x / std::sqrt(x * x * 1.25f + y * y / 4)),
      textured_square(add_material(material), kWholeUv));
}

void ConformanceScene::add_accessors() {
  const glm::vec3 base(0.5f, 0.3f, 0.1f);
  const int material = add_material(plain_material(base));
  json interleaved = square(material);
  std::vector<float> mixed;
  for (std::size_t v = 0; v < 4; ++v) {
    for (std::size_t i = 0; i < 3; ++i) mixed.push_back(kCorners[3 * v + i]);
    for (std::size_t i = 0; i < 3; ++i) mixed.push_back(kUp[3 * v + i]);
  }
  const int view = glb_.add_view(mixed, 24);
  for (const auto& [name, offset] : {std::pair{"POSITION", 0}, std::pair{"NORMAL", 12}}) {
    glb_.root["accessors"].push_back({{"bufferView", view},
                                      {"byteOffset", offset},
                                      {"componentType", kFloat},
                                      {"count", 4},
                                      {"type", "VEC3"}});
    interleaved["attributes"][name] = glb_.root["accessors"].size() - 1;
  }
  kind_ = "interleaved accessors";
  add("interleaved attributes", lit(base), interleaved);
  kind_ = "sparse accessors";
  json sparse = square(material);
  glb_.root["accessors"].push_back(
      {{"componentType", kFloat},
       {"count", 4},
       {"type", "VEC3"},
       {"sparse",
        {{"count", 4},
         {"indices",
          {{"bufferView", glb_.add_view<std::uint8_t>({0, 1, 2, 3})}, {"componentType", kUnsignedByte}}},
         {"values", {{"bufferView", glb_.add_view(kCorners)}}}}}});
  sparse["attributes"]["POSITION"] = glb_.root["accessors"].size() - 1;
  add("sparse positions without a base", lit(base), sparse);
  kind_ = "quantized meshes";
  json quantized = square(material);
  quantized["attributes"]["POSITION"] = glb_.add_accessor<std::int16_t>(
      {-400, -400, 0, 0, 400, -400, 0, 0, -400, 400, 0, 0, 400, 400, 0, 0}, kShort, "VEC3", 4, 8);
  const int normals = glb_.add_accessor<std::int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0},
                                                     kByte, "VEC3", 4, 4);
  glb_.root["accessors"][static_cast<std::size_t>(normals)]["normalized"] = true;
  quantized["attributes"]["NORMAL"] = normals;
  add("a quantized mesh", lit(base), quantized, {{"scale", {0.001, 0.001, 0.001}}});
  kind_ = "generated normals";
  add("no normals", lit(base), square(material, false));
}

void ConformanceScene::add_materials() {
  kind_ = "emissive strength";
  const glm::vec3 base(0.2f, 0.5f, 0.8f), shine(0.1f, 0.3f, 0.2f);
  json emissive = plain_material(glm::vec3(0.0f));
  emissive["emissiveFactor"] = {shine.x, shine.y, shine.z};
  add("emission", lit(glm::vec3(0.0f)) + shine, square(add_material(emissive)));
  emissive["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 2.5;
  add("emission with a strength", lit(glm::vec3(0.0f)) + 2.5f * shine, square(add_material(emissive)));
  kind_ = "unlit";
  json unlit = plain_material(base);
  unlit["extensions"]["KHR_materials_unlit"] = json::object();
  add("unlit", base, square(add_material(unlit)));
  json unlit_colors = square(add_material(unlit));
  unlit_colors["attributes"]["COLOR_0"] =
      glb_.add_accessor<float>({0.5f, 1, 1, 0.5f, 1, 1, 0.5f, 1, 1, 0.5f, 1, 1}, kFloat, "VEC3", 3);
  add("unlit with vertex colors", base * glm::vec3(0.5f, 1, 1), unlit_colors);
}

void ConformanceScene::add_camera_and_light() {
  const double half_height = rows() / 2.0;
  glb_.root["cameras"] = {
      {{"type", "orthographic"},
       {"orthographic", {{"xmag", kColumns / 2.0}, {"ymag", half_height}, {"znear", 0.1}, {"zfar", 20}}}}};
  glb_.root["nodes"].push_back(
      {{"camera", 0}, {"name", "eye"}, {"translation", {kColumns / 2.0, half_height, 10}}});
  glb_.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  glb_.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"intensity", 1}}};
  json roots = json::array();
  std::vector<bool> is_child(glb_.root["nodes"].size(), false);
  for (const json& node : glb_.root["nodes"])
    if (node.contains("children"))
      for (const json& child : node["children"]) is_child[child.get<std::size_t>()] = true;
  for (std::size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) roots.push_back(i);
  glb_.root["scenes"][0]["nodes"] = roots;
}

}  // namespace hwsim::test
