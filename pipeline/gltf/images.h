#pragma once
// The images of a file, still encoded.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "pipeline/gltf/buffers.h"

namespace hwsim::pipeline::gltf {

struct EncodedImage {
  std::string label;  ///< for messages: "images[3] (wood.png)"
  std::string name;
  std::string fault;                    ///< why there are no bytes
  std::span<const std::uint8_t> bytes;  ///< PNG or JPEG; empty: could not be read
  std::vector<std::uint8_t> storage;    ///< holds the bytes where no buffer does
  int same_as = -1;                     ///< an earlier image with equal bytes; -1: none
};

/// Reads the images. Those that cannot be read keep the reason: a texture that uses one is an error, another
/// one is not. `buffers` must live as long as the result.
std::vector<EncodedImage> read_images(SceneFiles& files, const nlohmann::json& root,
                                      const std::vector<std::vector<std::uint8_t>>& buffers);

}  // namespace hwsim::pipeline::gltf
