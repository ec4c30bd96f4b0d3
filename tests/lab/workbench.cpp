#include "lab/workbench.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace hwsim::lab::test {
namespace {

constexpr const char* kTriangle = R"({
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                 "min": [-1, -1, 0], "max": [1, 1, 0]}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]
})";

}  // namespace

Workbench::Workbench() {
  std::string name = (std::filesystem::temp_directory_path() / "hwsim-lab-test-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  folder_ = name;
  std::ofstream(folder_ / "triangle.gltf") << kTriangle;
}

Workbench::~Workbench() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

Request Workbench::request(std::vector<std::string> techniques, std::vector<std::string> gpus) const {
  Request request;
  request.view.scene = path("triangle.gltf");
  request.view.resolution = {64, 48};
  request.settings.images = false;
  request.techniques = std::move(techniques);
  request.gpus = std::move(gpus);
  return request;
}

}  // namespace hwsim::lab::test
