// The same scene elsewhere and in other units: moved to map coordinates, in millimeters, or ten thousand
// times as large. Every counter of the work trace and every code of the picture must be what they were.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "algos/frame_run.h"
#include "pipeline/gltf/gltf_loader.h"

namespace hwsim::test {
namespace {
using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

struct Move {
  double meters, scale;
};

constexpr Move kMoves[] = {{5e6, 1.0}, {0.0, 1e-3}, {0.0, 1e4}, {0.0, 0x1p13}};

Bytes read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

std::size_t word_at(const Bytes& glb, std::size_t at) {
  return glb.at(at) | std::size_t{glb.at(at + 1)} << 8 | std::size_t{glb.at(at + 2)} << 16 |
         std::size_t{glb.at(at + 3)} << 24;
}

void scale_lengths(json& root, double scale) {
  for (json& camera : root["cameras"])
    for (const char* key : {"znear", "zfar", "xmag", "ymag"})
      if (json& values = camera[camera["type"].get<std::string>()]; values.contains(key))
        values[key] = values[key].get<double>() * scale;
}

/// A GLB file with a new node above all of its scene's.
Bytes moved(const Bytes& glb, const Move& move) {
  const std::size_t length = word_at(glb, 12);
  json root = json::parse(glb.begin() + 20, glb.begin() + 20 + static_cast<std::ptrdiff_t>(length));
  json& nodes = root["scenes"][root.value("scene", 0)]["nodes"];
  root["nodes"].push_back({{"children", nodes},
                           {"translation", {move.meters, -0.5 * move.meters, move.meters}},
                           {"scale", {move.scale, move.scale, move.scale}}});
  nodes = json::array({root["nodes"].size() - 1});
  scale_lengths(root, move.scale);
  std::string text = root.dump();
  while (text.size() % 4 != 0) text += ' ';
  Bytes out(glb.size() - length + text.size());  // at once: g++ 12 takes an insertion for an overflow
  const auto header_end = std::copy_n(glb.begin(), 20, out.begin());
  const auto text_end = std::copy(text.begin(), text.end(), header_end);
  std::copy(glb.begin() + 20 + static_cast<std::ptrdiff_t>(length), glb.end(), text_end);
  for (std::size_t i = 0; i < 4; ++i) {
    out[8 + i] = static_cast<std::uint8_t>(out.size() >> (8 * i));
    out[12 + i] = static_cast<std::uint8_t>(text.size() >> (8 * i));
  }
  return out;
}

pipeline::Emulation draw(const Bytes& glb, const std::string& technique) {
  algos::FrameRequest request;
  request.scene = std::make_shared<const pipeline::Scene>(pipeline::load_glb(glb, "moved"));
  request.width_px = 240;
  request.height_px = 135;
  request.shadow_map_px = 512;
  request.point_lights = 4;
  request.features = test_features();
  return pipeline::emulate(algos::build_frame(algos::parse_technique(technique), request), test_features(),
                           FunctionalConfig{}, {});
}

std::size_t differing_counters(const WorkTrace& a, const WorkTrace& b) {
  if (a.passes.size() != b.passes.size()) return a.passes.size() + b.passes.size();
  std::size_t count = a.peak_memory_bytes == b.peak_memory_bytes ? 0 : 1;
  for (std::size_t i = 0; i < a.passes.size(); ++i) {
    const auto left_total = total(a.passes[i]), right_total = total(b.passes[i]);  // values() looks into them
    const auto left = values(left_total), right = values(right_total);
    for (std::size_t k = 0; k < left.size(); ++k) count += left[k] == right[k] ? 0 : 1;
    if (count == 0 && !difference(a.passes[i], b.passes[i]).empty()) ++count;
  }
  return count;
}

int largest_difference_in_codes(const pipeline::Image& a, const pipeline::Image& b) {
  const auto code = [](float linear) {
    return static_cast<int>(std::lround(255.0f * std::min(pipeline::srgb_from_linear(linear), 1.0f)));
  };
  int largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c)
      largest = std::max(largest, std::abs(code(a.pixels[i][c]) - code(b.pixels[i][c])));
  return largest;
}

void expect_the_same_everywhere(const std::string& glb_path, const std::vector<std::string>& techniques) {
  const Bytes glb = read_bytes(glb_path);
  for (const std::string& technique : techniques) {
    const pipeline::Emulation here = draw(glb, technique);
    for (const Move& move : kMoves) {
      const pipeline::Emulation there = draw(moved(glb, move), technique);
      const std::string what = std::filesystem::path(glb_path).filename().string() + ", " + technique +
                               ", by " + std::to_string(move.meters) + " m and " + std::to_string(move.scale);
      EXPECT_EQ(differing_counters(here.trace, there.trace), 0u) << what;
      EXPECT_EQ(largest_difference_in_codes(here.color, there.color), 0) << what;
    }
  }
}

std::string generated_file(const std::string& name, const std::map<std::string, double>& parameters) {
  const std::string path = binary_dir() + "/test_scenes/moved_" + name + ".glb";
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  pipeline::write_generated_scene(name, parameters, path);
  return path;
}

TEST(MovedScene, GeneratedScenesHaveTheSameCountsAndPictureAnywhere) {
  expect_the_same_everywhere(generated_file("sponza_hall", {{"bays", 4}, {"detail", 6}}),
                             {"none", "msaa4x", "deferred:samples=4", "sbaa_merge", "agaa", "sss_cs"});
  expect_the_same_everywhere(generated_file("wires", {{"poles", 3}}), {"wire_aa+none"});
}

TEST(MovedScene, RealScenesHaveTheSameCountsAndPictureAnywhere) {
  const std::string folder = shared_dir() + "/scenes/";
  if (!std::filesystem::exists(folder + "sponza.glb")) GTEST_SKIP() << "no shared scenes";
  for (const char* file : {"sponza.glb", "dragon_small.glb", "car_sedan.glb"})
    expect_the_same_everywhere(folder + file, {"msaa4x", "agaa"});
}

}  // namespace
}  // namespace hwsim::test
