#pragma once
// Small GLB files for the tests of the loader, built from JSON and bytes, so that any of it can be made
// wrong.
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/places.h"

namespace hwsim::pipeline::test {

using Bytes = std::vector<std::uint8_t>;

inline void append_u32(Bytes& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

inline Bytes assemble_glb(const std::string& json_text, const Bytes& bin) {
  std::string text = json_text;
  while (text.size() % 4 != 0) text += ' ';
  Bytes out;
  append_u32(out, 0x46546C67);
  append_u32(out, 2);
  append_u32(out, 20 + text.size() + (bin.empty() ? 0 : 8 + bin.size()));
  append_u32(out, text.size());
  append_u32(out, 0x4E4F534A);
  out.insert(out.end(), text.begin(), text.end());
  if (bin.empty()) return out;
  append_u32(out, bin.size());
  append_u32(out, 0x004E4942);
  out.insert(out.end(), bin.begin(), bin.end());
  return out;
}

/// One node that draws one mesh of one primitive; everything may be changed before writing.
class GlbBuilder {
 public:
  nlohmann::json root = {{"asset", {{"version", "2.0"}}},
                         {"scene", 0},
                         {"scenes", {{{"nodes", {0}}}}},
                         {"nodes", {{{"mesh", 0}}}},
                         {"meshes", {{{"primitives", {{{"attributes", nlohmann::json::object()}}}}}}}};
  Bytes bin;

  nlohmann::json& primitive() { return root["meshes"][0]["primitives"][0]; }

  template <class T>
  int add_accessor(const std::vector<T>& values, int component_type, const char* type, std::size_t components,
                   int stride = 0) {
    const int view = add_view(values, stride);
    root["accessors"].push_back({{"bufferView", view},
                                 {"componentType", component_type},
                                 {"count", values.size() / components},
                                 {"type", type}});
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  template <class T>
  int add_view(const std::vector<T>& values, int stride = 0) {
    while (bin.size() % 4 != 0) bin.push_back(0);
    const std::size_t offset = bin.size(), size = values.size() * sizeof(T);
    bin.resize(offset + size);
    std::memcpy(bin.data() + offset, values.data(), size);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    if (stride != 0) root["bufferViews"].back()["byteStride"] = stride;
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }

  void add_attribute(const char* name, const std::vector<float>& values, const char* type,
                     std::size_t components) {
    const int accessor = add_accessor(values, 5126, type, components);
    primitive()["attributes"][name] = accessor;
  }

  Bytes bytes() {
    while (bin.size() % 4 != 0) bin.push_back(0);
    if (!bin.empty() && !root.contains("buffers")) root["buffers"] = {{{"byteLength", bin.size()}}};
    return assemble_glb(root.dump(), bin);
  }
};

/// The unit square in the xy plane as four vertices: a strip in this order.
inline std::vector<float> square_positions() { return {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}; }

inline GlbBuilder square_glb() {
  GlbBuilder glb;
  glb.add_attribute("POSITION", square_positions(), "VEC3", 3);
  glb.add_attribute("NORMAL", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  glb.primitive()["indices"] = glb.add_accessor<std::uint16_t>({0, 1, 2, 2, 1, 3}, 5123, "SCALAR", 1);
  return glb;
}

/// A folder of its own below the test's temporary directory, removed at the end.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name)
      : path_(std::filesystem::path(hwsim::test::binary_dir()) / "test_files" / name) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path() const { return path_.string(); }
  std::string write(const std::string& name, const Bytes& bytes) const {
    const std::string path = (path_ / name).string();
    std::filesystem::remove(path);  // ext4 flushes a file that is truncated and written again: 7 ms each
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace hwsim::pipeline::test
