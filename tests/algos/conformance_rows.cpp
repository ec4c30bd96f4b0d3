#include "tests/algos/conformance_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "algos/base/reference_frame.h"
#include "algos/techniques.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/gltf/gltf_loader.h"

namespace hwsim::test {
namespace {
using nlohmann::json;

pipeline::Image emulated(const algos::FrameRequest& request, const std::string& technique) {
  const auto graph = algos::build_frame(algos::parse_technique(technique), request);
  return pipeline::emulate(graph, request.features, request.functional, {}).color;
}

constexpr int kSquarePx = 32;

/// A white square of 2 m at the origin, seen by the camera of `camera_node`, lit by one light at
/// `light_node`.
algos::FrameRequest white_square(const json& light, const json& light_node, const json& camera,
                                 const json& camera_node) {
  pipeline::test::GlbBuilder glb;
  glb.add_attribute("POSITION", {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0}, "VEC3", 3);
  glb.add_attribute("NORMAL", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  glb.primitive()["mode"] = 5;
  glb.primitive()["material"] = 0;
  glb.root["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}}};
  glb.root["cameras"] = json::array({camera});
  glb.root["nodes"].push_back(camera_node);
  glb.root["nodes"][1]["camera"] = 0;
  glb.root["nodes"].push_back(light_node);
  glb.root["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  glb.root["scenes"][0]["nodes"] = {0, 1, 2};
  glb.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({light});
  const pipeline::test::TemporaryFolder folder("white_square");
  algos::FrameRequest request;
  request.scene =
      std::make_shared<const pipeline::Scene>(pipeline::load_gltf(folder.write("square.glb", glb.bytes())));
  request.width_px = request.height_px = kSquarePx;
  return request;
}

json orthographic(double xmag, double ymag, double zfar = 20) {
  return {{"type", "orthographic"},
          {"orthographic", {{"xmag", xmag}, {"ymag", ymag}, {"znear", 0.1}, {"zfar", zfar}}}};
}

/// Sees `half_height` above and below the axis at a distance of 4 m.
json perspective(double half_height, double aspect_ratio, bool far_plane = true) {
  json camera = {{"type", "perspective"},
                 {"perspective", {{"yfov", 2 * std::atan(half_height / 4)}, {"znear", 0.1}}}};
  if (aspect_ratio > 0) camera["perspective"]["aspectRatio"] = aspect_ratio;
  if (far_plane) camera["perspective"]["zfar"] = 20;
  return camera;
}

json at_z(double z) { return {{"translation", {0, 0, z}}}; }

// Base color 1, roughness 1; see ConformanceScene::lit.
float white_lit_by(float light, float cosine) {
  return std::min(0.05f + light * (cosine + 0.04f / 3.14159265f), 1.0f);
}

const json kSun = {{"type", "directional"}, {"intensity", 0.5}};

}  // namespace

Codes codes_of(const glm::vec3& linear) {
  Codes out{};
  for (int i = 0; i < 3; ++i)
    out[static_cast<std::size_t>(i)] =
        static_cast<int>(std::lround(std::min(pipeline::srgb_from_linear(linear[i]), 1.0f) * 255.0f));
  return out;
}

int largest_difference(const Codes& a, const Codes& b) {
  int most = 0;
  for (std::size_t i = 0; i < 3; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

PatchPictures::PatchPictures() {
  const pipeline::test::TemporaryFolder folder("conformance");
  request_.scene = std::make_shared<const pipeline::Scene>(
      pipeline::load_gltf(folder.write("patches.glb", scene_.bytes())));
  request_.width_px = ConformanceScene::kColumns * kCellPx;
  request_.height_px = scene_.rows() * kCellPx;
}

pipeline::Image PatchPictures::drawn_by(const std::string& technique) const {
  return emulated(request_, technique);
}

pipeline::Image PatchPictures::traced() const {
  return algos::render_reference_frame(request_, {.samples = 4});
}

Codes PatchPictures::shown(const pipeline::Image& image, std::size_t patch) const {
  const int cell = static_cast<int>(patch), x = cell % ConformanceScene::kColumns,
            y = cell / ConformanceScene::kColumns;
  return codes_of(
      glm::vec3(image.at(x * kCellPx + kCellPx / 2, image.height - 1 - y * kCellPx - kCellPx / 2)));
}

std::vector<ConformanceRow> patch_rows(const PatchPictures& pictures) {
  const pipeline::Image drawn = pictures.drawn_by("none"), traced = pictures.traced();
  std::vector<ConformanceRow> rows;
  for (std::size_t i = 0; i < pictures.patches().size(); ++i) {
    const Patch& patch = pictures.patches()[i];
    rows.push_back(
        {patch.kind, patch.name, codes_of(patch.color), pictures.shown(drawn, i), pictures.shown(traced, i)});
  }
  return rows;
}

std::vector<ConformanceRow> light_rows() {
  struct Case {
    const char* name;
    json light, node;
    float middle;  ///< linear
  };
  const float window = std::pow(1.0f - std::pow(4.0f / 16.0f, 2.0f), 2.0f);
  const json cone = {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}};
  const std::vector<Case> cases = {
      {"directional", kSun, json::object(), white_lit_by(0.5f, 1)},
      {"directional, at 60 degrees",
       kSun,
       {{"rotation", {0, 0.5, 0, std::sqrt(0.75)}}},
       white_lit_by(0.5f, 0.5f)},
      {"directional, from behind", kSun, {{"rotation", {0, 1, 0, 0}}}, 0.05f},
      {"point, two meters away",
       {{"type", "point"}, {"intensity", 2}, {"range", 1e6}},
       at_z(2),
       white_lit_by(0.5f, 1)},
      {"point, windowed by its range",
       {{"type", "point"}, {"intensity", 2}, {"range", 4}},
       at_z(2),
       white_lit_by(0.5f * window, 1)},
      {"point, beyond its range", {{"type", "point"}, {"intensity", 2}, {"range", 1}}, at_z(2), 0.05f},
      {"spot, on its axis",
       {{"type", "spot"}, {"intensity", 2}, {"range", 1e6}, {"spot", cone}},
       at_z(2),
       white_lit_by(0.5f, 1)},
      {"spot, looking away",
       {{"type", "spot"}, {"intensity", 2}, {"spot", cone}},
       {{"translation", {0, 0, 2}}, {"rotation", {0, 1, 0, 0}}},
       0.05f}};
  std::vector<ConformanceRow> rows;
  for (const Case& c : cases) {
    const auto request = white_square(c.light, c.node, orthographic(0.25, 0.25), at_z(5));
    const auto middle = [](const pipeline::Image& image) {
      return codes_of(glm::vec3(image.at(kSquarePx / 2, kSquarePx / 2)));
    };
    rows.push_back({"lights", c.name, codes_of(glm::vec3(c.middle)), middle(emulated(request, "none")),
                    middle(algos::render_reference_frame(request, {.samples = 16}))});
  }
  return rows;
}

std::vector<ConformanceRow> camera_rows() {
  struct Case {
    const char* name;
    json camera, node;
    bool seen = true;
  };
  // Each that sees the square sees 2 m to each side: it fills the middle half of the picture.
  const std::vector<Case> cases = {
      {"orthographic", orthographic(2, 2), at_z(5)},
      {"orthographic, wider than the picture", orthographic(2, 1), at_z(5)},
      {"orthographic, behind its far plane", orthographic(2, 2, 4.5), at_z(5), false},
      {"perspective", perspective(2, 1), at_z(4)},
      {"perspective without aspectRatio", perspective(2, 0), at_z(4)},
      {"perspective without a far plane", perspective(2, 1, false), at_z(4)},
      {"perspective, wider than the picture", perspective(2.0 / 3.0, 3), at_z(4)},
      {"turned by a quarter around its axis",
       perspective(2, 1),
       {{"translation", {0, 0, 4}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}}},
      {"looking away", perspective(2, 1), {{"translation", {0, 0, 4}}, {"rotation", {0, 1, 0, 0}}}, false},
      {"from behind", orthographic(2, 2), {{"translation", {0, 0, -5}}, {"rotation", {0, 1, 0, 0}}}, false}};
  std::vector<ConformanceRow> rows;
  for (const Case& c : cases) {
    const auto request = white_square(kSun, json::object(), c.camera, c.node);
    const pipeline::Image drawn = emulated(request, "none"),
                          traced = algos::render_reference_frame(request, {.samples = 16});
    const auto probe = [&](const char* where, int x, int y, bool lit) {
      const auto shown = [&](const pipeline::Image& image) { return codes_of(glm::vec3(image.at(x, y))); };
      rows.push_back({"cameras", std::string(c.name) + where,
                      codes_of(lit ? glm::vec3(white_lit_by(0.5f, 1)) : ConformanceScene::kBackground),
                      shown(drawn), shown(traced)});
    };
    probe(", inside the left edge", kSquarePx / 4, kSquarePx / 2, c.seen);
    probe(", outside of it", kSquarePx / 4 - 1, kSquarePx / 2, false);
    probe(", inside the upper edge", kSquarePx / 2, kSquarePx / 4, c.seen);
    probe(", outside of it", kSquarePx / 2, kSquarePx / 4 - 1, false);
  }
  return rows;
}

namespace {

struct KindSummary {
  std::string kind;
  std::size_t rows = 0;
  int emulated = 0, traced = 0, apart = 0;  ///< largest differences in codes
};

std::vector<KindSummary> by_kind(const std::vector<ConformanceRow>& rows) {
  std::vector<KindSummary> kinds;
  for (const ConformanceRow& row : rows) {
    auto found = std::find_if(kinds.begin(), kinds.end(),
                              [&](const KindSummary& kind) { return kind.kind == row.kind; });
    if (found == kinds.end()) found = kinds.insert(kinds.end(), {row.kind});
    ++found->rows;
    found->emulated = std::max(found->emulated, largest_difference(row.emulated, row.want));
    found->traced = std::max(found->traced, largest_difference(row.traced, row.want));
    found->apart = std::max(found->apart, largest_difference(row.emulated, row.traced));
  }
  return kinds;
}

std::string text(const Codes& codes) {
  return std::to_string(codes[0]) + " " + std::to_string(codes[1]) + " " + std::to_string(codes[2]);
}

}  // namespace

std::string conformance_page(const std::vector<ConformanceRow>& rows) {
  std::string page =
      "# Conformance\n\n"
      "This page shows, for each way in which glTF says something, what color a closed form predicts and "
      "what "
      "the emulated\npipeline (`none`) and the ray-traced reference show.\n\n"
      "`tests/algos/conformance_scene.cpp` makes the scenes, `scripts/conformance.sh` writes this page, and "
      "`Conformance.*` of\n`algos_tests` fails where it is not what the program shows. Colors are sRGB "
      "codes, "
      "0 to 255.\n\n"
      "## By kind\n\n"
      "Largest differences in codes, over all patches of the kind.\n\n"
      "| kind | patches | emulation to closed form | reference to closed form | one to the other |\n"
      "|---|---|---|---|---|\n";
  for (const KindSummary& kind : by_kind(rows))
    page += "| " + kind.kind + " | " + std::to_string(kind.rows) + " | " + std::to_string(kind.emulated) +
            " | " + std::to_string(kind.traced) + " | " + std::to_string(kind.apart) + " |\n";
  page += "\n## By patch\n\n| kind | patch | closed form | emulation | reference |\n|---|---|---|---|---|\n";
  for (const ConformanceRow& row : rows)
    page += "| " + row.kind + " | " + row.name + " | " + text(row.want) + " | " + text(row.emulated) + " | " +
            text(row.traced) + " |\n";
  return page;
}

}  // namespace hwsim::test
