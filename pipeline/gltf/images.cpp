#include "pipeline/gltf/images.h"

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "pipeline/gltf/uri.h"

namespace hwsim::pipeline::gltf {
namespace {
using nlohmann::json;

std::string text_at(const json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? std::string() : found->get<std::string>();
}

std::span<const std::uint8_t> view_bytes(const json& view,
                                         const std::vector<std::vector<std::uint8_t>>& buffers) {
  const std::vector<std::uint8_t>& buffer = buffers[view["buffer"].get<std::size_t>()];
  const std::size_t first = view.contains("byteOffset") ? view["byteOffset"].get<std::size_t>() : 0;
  if (buffer.empty()) return {};  // nothing draws with it
  return {buffer.data() + first, view["byteLength"].get<std::size_t>()};
}

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Files often hold one picture several times, under several names.
void find_equal(std::vector<EncodedImage>& images) {
  std::multimap<std::size_t, int> by_hash;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (images[i].bytes.empty()) continue;
    const std::string_view text = as_text(images[i].bytes);
    const std::size_t hash = std::hash<std::string_view>{}(text);
    const auto [first, last] = by_hash.equal_range(hash);
    const auto same = std::find_if(first, last, [&](const auto& entry) {
      return as_text(images[static_cast<std::size_t>(entry.second)].bytes) == text;
    });
    if (same != last)
      images[i].same_as = same->second;
    else
      by_hash.emplace(hash, static_cast<int>(i));
  }
}

}  // namespace

std::vector<EncodedImage> read_images(SceneFiles& files, const json& root,
                                      const std::vector<std::vector<std::uint8_t>>& buffers) {
  std::vector<EncodedImage> out;
  if (!root.contains("images")) return out;
  std::map<std::string, std::size_t> read_already;  // by URI
  out.resize(root["images"].size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const json& source = root["images"][i];
    EncodedImage& image = out[i];
    const std::string uri = text_at(source, "uri"), where = element("images", i);
    image.name = text_at(source, "name");
    image.label = where + (uri.empty() || is_data_uri(uri) ? "" : " (" + uri.substr(0, 200) + ")");
    if (source.contains("bufferView")) {
      image.bytes = view_bytes(root["bufferViews"][source["bufferView"].get<std::size_t>()], buffers);
      continue;
    }
    if (const auto known = read_already.find(uri); known != read_already.end()) {
      image.bytes = out[known->second].bytes;
      image.fault = out[known->second].fault;
      continue;
    }
    image.storage = files.read(uri, where, image.fault);
    image.bytes = image.storage;
    if (image.bytes.empty() && image.fault.empty()) image.fault = "is empty";
    read_already.emplace(uri, i);
  }
  find_equal(out);
  return out;
}

}  // namespace hwsim::pipeline::gltf
