#pragma once
// The one decoder of glTF's URIs, for buffers and images: data URIs, and files below the scene's folder.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hwsim::pipeline::gltf {

/// "%20" becomes a space; "+" and a "%" without two hexadecimal digits stay as they are.
std::string percent_decoded(std::string_view uri);

bool is_data_uri(std::string_view uri);

/// The bytes of a data URI; none where its base64 is damaged.
std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri);

/// Where a URI's file lies. Only files below the scene's folder are read, wherever links lead.
struct FilePlace {
  std::string path;     ///< absolute; empty where the URI is refused
  std::string refusal;  ///< why: "lies outside of the scene's folder"
};
FilePlace locate_file(const std::string& folder, std::string_view uri);

}  // namespace hwsim::pipeline::gltf
