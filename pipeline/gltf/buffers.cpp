#include "pipeline/gltf/buffers.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "pipeline/gltf/container.h"
#include "pipeline/gltf/skins.h"
#include "pipeline/gltf/uri.h"

namespace hwsim::pipeline::gltf {
namespace {
using nlohmann::json;

std::string shown_uri(std::string_view uri) {
  return is_data_uri(uri) ? "its data URI" : "`" + std::string(uri.substr(0, 200)) + "`";
}

// The buffers behind what is drawn: a file may leave out others, or hold their places only.
class NeededBuffers {
 public:
  explicit NeededBuffers(const json& root) : root_(root), needed_(array("buffers").size(), false) {
    for (const json& mesh : array("meshes"))
      for (const json& primitive : mesh["primitives"]) {
        for (const auto& [name, accessor] : primitive["attributes"].items()) mark_accessor(accessor);
        if (primitive.contains("indices")) mark_accessor(primitive["indices"]);
      }
    for (const SkinSpec& skin : read_skins(root))
      if (skin.inverse_bind_matrices >= 0) mark_accessor(skin.inverse_bind_matrices);
    for (const json& texture : array("textures"))
      if (texture.contains("source")) mark_view(array("images")[texture["source"].get<std::size_t>()]);
  }

  const std::vector<bool>& take() const { return needed_; }

 private:
  const json& array(const char* key) const {
    static const json kEmpty = json::array();
    const auto found = root_.find(key);
    return found == root_.end() ? kEmpty : *found;
  }
  void mark_view(const json& holder) {
    if (!holder.contains("bufferView")) return;
    const json& view = array("bufferViews")[holder["bufferView"].get<std::size_t>()];
    needed_[view["buffer"].get<std::size_t>()] = true;
  }
  void mark_accessor(const json& index) {
    const json& accessor = array("accessors")[index.get<std::size_t>()];
    mark_view(accessor);
    if (!accessor.contains("sparse")) return;
    mark_view(accessor["sparse"]["indices"]);
    mark_view(accessor["sparse"]["values"]);
  }

  const json& root_;
  std::vector<bool> needed_;
};

// The extension that holds the data in the buffer's stead; "": none.
std::string compression_of(const json& root, std::size_t buffer) {
  if (root["buffers"][buffer].contains("extensions"))
    for (const auto& [name, value] : root["buffers"][buffer]["extensions"].items()) return name;
  for (const json& view : root["bufferViews"])
    if (view["buffer"].get<std::size_t>() == buffer && view.contains("extensions"))
      for (const auto& [name, value] : view["extensions"].items()) return name;
  return "";
}

[[noreturn]] void fail_missing(const Report& report, const json& root, std::size_t buffer,
                               const std::string& fault) {
  if (const std::string name = compression_of(root, buffer); !name.empty())
    report.fail("S006",
                element("buffers", buffer) + " is a placeholder: its data is compressed by " + name +
                    ", which is not supported",
                "export without " + name);
  report.fail("S007", element("buffers", buffer) + " " + fault,
              "put the buffer's file beside the .gltf file under the name that its uri gives");
}

}  // namespace

SceneFiles::SceneFiles(const Report& report, Budget& budget, std::size_t max_file_bytes)
    : report_(report), budget_(budget), max_file_bytes_(max_file_bytes) {
  std::error_code error;
  const std::filesystem::path file = std::filesystem::absolute(report.file(), error);
  folder_ = file.parent_path().string();
  paths_.insert(file.string());
}

std::vector<std::uint8_t> SceneFiles::read(std::string_view uri, const std::string& where,
                                           std::string& fault) {
  std::vector<std::uint8_t> bytes;
  if (is_data_uri(uri)) {
    budget_.charge(uri.size() / 4 * 3, where);
    if (auto decoded = decode_data_uri(uri))
      bytes = std::move(*decoded);
    else
      fault = "has a damaged data URI";
    return bytes;
  }
  const FilePlace place = locate_file(folder_, uri);
  if (!place.refusal.empty())
    report_.fail("S015", where + ": the uri " + shown_uri(uri) + " " + place.refusal,
                 "put the file into the scene's folder and name it by a relative path");
  paths_.insert(place.path);
  std::error_code error;
  const auto size = std::filesystem::file_size(place.path, error);
  if (!error) budget_.charge(size, where);
  if (error || !read_bytes(place.path, max_file_bytes_, bytes)) {
    fault = "cannot be read: " + shown_uri(uri) +
            (error ? " (" + error.message() + ")"
                   : " is no file, or larger than " + std::to_string(max_file_bytes_) + " bytes");
    return {};
  }
  add_to_hash(bytes);
  return bytes;
}

std::vector<std::vector<std::uint8_t>> read_buffers(Report& report, SceneFiles& files, const json& root,
                                                    std::vector<std::uint8_t> bin) {
  std::vector<std::vector<std::uint8_t>> out;
  if (!root.contains("buffers")) return out;
  const std::vector<bool> needed = NeededBuffers(root).take();
  out.resize(needed.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const json& buffer = root["buffers"][i];
    const auto wanted = buffer["byteLength"].get<std::size_t>();
    if (!needed[i]) {
      report.note("S119", "buffers that nothing drawn refers to were not read", element("buffers", i));
      continue;
    }
    std::string fault;
    if (buffer.contains("uri")) {
      out[i] = files.read(buffer["uri"].get_ref<const std::string&>(), element("buffers", i), fault);
    } else if (i > 0 || bin.empty()) {
      fault = i > 0 ? "has no uri; only the first buffer of a GLB may omit it"
                    : "has no uri, and the file has no BIN chunk, or an empty one";
    } else {
      out[i] = std::move(bin);
    }
    if (fault.empty() && out[i].size() < wanted)
      fault = "holds " + std::to_string(out[i].size()) + " bytes, byteLength says " + std::to_string(wanted);
    if (!fault.empty()) fail_missing(report, root, i, fault);
    out[i].resize(wanted);  // glTF lets a file be longer
  }
  return out;
}

}  // namespace hwsim::pipeline::gltf
