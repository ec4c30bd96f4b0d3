#include "pipeline/gltf/source.h"

#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "pipeline/gltf/rules.h"

namespace hwsim::pipeline::gltf {
namespace {
using nlohmann::json;

std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.size() > 200 ? line.substr(0, 197) + "..." : line;
}

bool is_unbacked(const json& accessor) { return !accessor.contains("bufferView"); }

// What the parser is given: no buffers, images, cameras and skins, which are read by this project's own code,
// and nothing that is ignored anyway, so that a mistake in an animation costs no scene. The parser wants a
// buffer view of accessors that are zeros or sparse alone: they get the first, and lose it again after
// parsing.
std::string text_for_parser(json&& root) {
  for (const char* key : {"buffers", "images", "cameras", "animations", "skins", "extras"}) root.erase(key);
  if (root.contains("extensions")) {
    json kept = json::object();
    if (root["extensions"].contains("KHR_lights_punctual")) {
      kept["KHR_lights_punctual"] = root["extensions"]["KHR_lights_punctual"];
      for (json& light : kept["KHR_lights_punctual"]["lights"])  // the parser refuses the file without it
        if (light["type"] == "spot" && !light.contains("spot")) light["spot"] = json::object();
    }
    root["extensions"] = std::move(kept);
  }
  if (root.contains("accessors")) {
    bool any = false;
    for (json& accessor : root["accessors"])
      if (is_unbacked(accessor)) {
        accessor["bufferView"] = 0;
        any = true;
      }
    if (any && (!root.contains("bufferViews") || root["bufferViews"].empty()))
      root["bufferViews"] = {{{"buffer", 0}, {"byteLength", 4}}};
  }
  return root.dump(-1, ' ', false, json::error_handler_t::replace);
}

tinygltf::Model parse(const Report& report, json&& root) {
  tinygltf::TinyGLTF parser;
  tinygltf::Model model;
  std::string error, warning;
  std::vector<bool> unbacked;
  if (root.contains("accessors"))
    for (const json& accessor : root["accessors"]) unbacked.push_back(is_unbacked(accessor));
  const std::string text = text_for_parser(std::move(root));
  bool parsed = false;
  try {
    parsed = parser.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                        static_cast<unsigned>(text.size()), "", tinygltf::REQUIRE_VERSION);
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (!parsed) report.fail("S004", "the glTF cannot be read: " + first_line(error));
  for (std::size_t i = 0; i < model.accessors.size(); ++i)
    if (unbacked[i]) model.accessors[i].bufferView = -1;
  return model;
}

}  // namespace

Source read_source(Report& report, Container container, const SceneLoadOptions& options, Budget& budget) {
  budget.charge(container.bytes.size(), "the file");
  json root = parse_json(report, container.json());
  check_rules(report, root);

  SceneFiles files(report, budget, options.max_file_bytes);
  files.add_to_hash(container.bytes);
  auto buffers = read_buffers(report, files, root, std::move(container).take_bin());
  Source source;
  source.images = read_images(files, root, buffers);
  source.cameras = read_cameras(root);
  source.skins = read_skins(root);
  source.has_animations = root.contains("animations") && !root["animations"].empty();
  source.model = parse(report, std::move(root));
  // Moved, not copied: what the images point at stays where it is.
  source.model.buffers.resize(buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i) source.model.buffers[i].data = std::move(buffers[i]);
  source.content_hash = files.content_hash();
  source.files = files.paths();
  return source;
}

}  // namespace hwsim::pipeline::gltf
