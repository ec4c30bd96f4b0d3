#include "pipeline/generate/blueprint.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

#include "pipeline/generate/exact_math.h"

namespace hwsim::pipeline::generate {
namespace {
using json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

constexpr int kFloat = 5126, kUint16 = 5123, kUint32 = 5125;
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;

json array_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// Quaternion that turns -z into `direction`, with y up as far as possible: from the rotation matrix (Shepperd
// 1978).
json look_rotation(const glm::dvec3& direction) {
  const glm::dvec3 z = unit(-direction);
  const glm::dvec3 x = unit(glm::cross(std::abs(z.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), z));
  const glm::dvec3 y = glm::cross(z, x);
  const double trace[4] = {x.x - y.y - z.z, y.y - x.x - z.z, z.z - x.x - y.y, x.x + y.y + z.z};
  const auto largest = std::max_element(trace, trace + 4) - trace;
  const double root = std::sqrt(trace[largest] + 1.0), half = 0.5 / root;
  double q[4];
  q[largest] = 0.5 * root;
  switch (largest) {
    case 0:
      q[1] = (x.y + y.x) * half, q[2] = (z.x + x.z) * half, q[3] = (y.z - z.y) * half;
      break;
    case 1:
      q[0] = (x.y + y.x) * half, q[2] = (y.z + z.y) * half, q[3] = (z.x - x.z) * half;
      break;
    case 2:
      q[0] = (z.x + x.z) * half, q[1] = (y.z + z.y) * half, q[3] = (x.y - y.x) * half;
      break;
    default:
      q[0] = (y.z - z.y) * half, q[1] = (z.x - x.z) * half, q[2] = (x.y - y.x) * half;
      break;
  }
  return {q[0], q[1], q[2], q[3]};
}

class GlbEncoder {
 public:
  explicit GlbEncoder(const Blueprint& blueprint) : blueprint_(blueprint) {
    root_["asset"] = {{"version", "2.0"}, {"generator", "hwsim"}};
    root_["extensionsUsed"] = json::array({"KHR_lights_punctual"});
    root_["scene"] = 0;
  }

  Bytes encode() {
    add_textures();
    add_materials();
    for (const Model& model : blueprint_.models) add_model(model);
    add_nodes();
    while (bin_.size() % 4 != 0) bin_.push_back(0);
    root_["buffers"] = json::array({{{"byteLength", bin_.size()}}});
    return assemble();
  }

 private:
  int add_view(const void* data, std::size_t size, int target) {
    while (bin_.size() % 4 != 0) bin_.push_back(0);
    json view = {{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    bin_.insert(bin_.end(), bytes, bytes + size);
    root_["bufferViews"].push_back(std::move(view));
    return static_cast<int>(root_["bufferViews"].size()) - 1;
  }

  int add_accessor(const void* data, std::size_t count, std::size_t element_bytes, int component,
                   const char* type, int target) {
    const int view = add_view(data, count * element_bytes, target);
    root_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return static_cast<int>(root_["accessors"].size()) - 1;
  }

  template <class T>
  void add_attribute(json& attributes, const char* name, const std::vector<T>& values, const char* type) {
    if (!values.empty())
      attributes[name] = add_accessor(values.data(), values.size(), sizeof(T), kFloat, type, kVertexTarget);
  }

  void add_textures() {
    for (const auto& png : blueprint_.textures) {
      const int view = add_view(png.data(), png.size(), 0);
      const std::size_t image = root_["images"].size();
      root_["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
      root_["textures"].push_back({{"sampler", 0}, {"source", image}});
    }
    if (!blueprint_.textures.empty())
      root_["samplers"] =
          json::array({{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}});
  }

  void add_materials() {
    for (const Look& look : blueprint_.looks) {
      json pbr = {{"baseColorFactor", {look.color.x, look.color.y, look.color.z, 1.0}},
                  {"metallicFactor", look.metallic},
                  {"roughnessFactor", look.roughness}};
      if (look.texture >= 0) pbr["baseColorTexture"] = {{"index", look.texture}};
      json material = {{"name", look.name}, {"pbrMetallicRoughness", pbr}};
      if (look.double_sided) material["doubleSided"] = true;
      if (look.alpha_test) material["alphaMode"] = "MASK";
      if (look.unlit) material["extensions"] = {{"KHR_materials_unlit", json::object()}};
      root_["materials"].push_back(std::move(material));
    }
  }

  json primitive_of(const Piece& piece) {
    const MeshSurface& s = piece.surface;
    json attributes;
    add_attribute(attributes, "POSITION", s.positions, "VEC3");
    glm::vec3 low = s.positions.front(), high = low;
    for (const glm::vec3& p : s.positions) low = glm::min(low, p), high = glm::max(high, p);
    root_["accessors"].back()["min"] = {low.x, low.y, low.z};
    root_["accessors"].back()["max"] = {high.x, high.y, high.z};
    add_attribute(attributes, "NORMAL", s.normals, "VEC3");
    add_attribute(attributes, "TANGENT", s.tangents, "VEC4");
    if (blueprint_.looks[static_cast<std::size_t>(piece.look)].texture >= 0)
      add_attribute(attributes, "TEXCOORD_0", s.uvs, "VEC2");
    add_attribute(attributes, "_HWSIM_RADIUS", s.radius, "SCALAR");
    return {{"attributes", attributes}, {"indices", add_indices(s)}, {"material", piece.look}};
  }

  int add_indices(const MeshSurface& s) {
    if (s.positions.size() > 65535)  // 65535 itself would restart strips
      return add_accessor(s.indices.data(), s.indices.size(), 4, kUint32, "SCALAR", kIndexTarget);
    std::vector<std::uint16_t> narrow(s.indices.size());
    std::transform(s.indices.begin(), s.indices.end(), narrow.begin(),
                   [](std::uint32_t i) { return static_cast<std::uint16_t>(i); });
    return add_accessor(narrow.data(), narrow.size(), 2, kUint16, "SCALAR", kIndexTarget);
  }

  void add_model(const Model& model) {
    json primitives = json::array();
    for (const Piece& piece : model.pieces)
      if (!piece.surface.indices.empty()) primitives.push_back(primitive_of(piece));
    root_["meshes"].push_back({{"name", model.name}, {"primitives", primitives}});
  }

  void add_camera(json& nodes, const View& view) {
    nodes.push_back({{"name", view.name},
                     {"camera", root_["cameras"].size()},
                     {"translation", array_of(view.eye)},
                     {"rotation", look_rotation(view.target - view.eye)}});
    root_["cameras"].push_back(
        {{"type", "perspective"}, {"perspective", {{"yfov", view.fov_y_rad}, {"znear", blueprint_.near_m}}}});
  }

  void add_nodes() {
    json nodes = json::array();
    for (const Placement& p : blueprint_.placements) {
      json node = {{"mesh", p.model}, {"translation", array_of(p.position)}};
      if (p.turn_rad != 0.0)
        node["rotation"] = {0.0, exact_sin(p.turn_rad / 2), 0.0, exact_cos(p.turn_rad / 2)};
      if (p.scale != 1.0) node["scale"] = {p.scale, p.scale, p.scale};
      nodes.push_back(std::move(node));
    }
    add_camera(nodes, {"suggested", blueprint_.eye, blueprint_.target, blueprint_.fov_y_rad});
    for (const View& view : blueprint_.more_views) add_camera(nodes, view);
    nodes.push_back({{"name", "sun"},
                     {"rotation", look_rotation(blueprint_.sun_direction)},
                     {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    root_["extensions"]["KHR_lights_punctual"]["lights"] =
        json::array({{{"type", "directional"}, {"intensity", blueprint_.sun_lux}}});
    json list = json::array();
    for (std::size_t i = 0; i < nodes.size(); ++i) list.push_back(i);
    root_["nodes"] = std::move(nodes);
    root_["scenes"] = json::array({{{"nodes", list}}});
  }

  Bytes assemble() const {
    std::string text = root_.dump();
    while (text.size() % 4 != 0) text += ' ';
    Bytes out;
    const auto word = [&](std::size_t value) {
      for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
    };
    word(0x46546C67);  // "glTF"
    word(2);
    word(12 + 8 + text.size() + 8 + bin_.size());
    word(text.size());
    word(0x4E4F534A);  // "JSON"
    out.insert(out.end(), text.begin(), text.end());
    word(bin_.size());
    word(0x004E4942);  // "BIN"
    out.insert(out.end(), bin_.begin(), bin_.end());
    return out;
  }

  const Blueprint& blueprint_;
  json root_;
  Bytes bin_;
};

}  // namespace

Bytes encode_glb(const Blueprint& blueprint) { return GlbEncoder(blueprint).encode(); }

}  // namespace hwsim::pipeline::generate
