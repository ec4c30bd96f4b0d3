#pragma once
// The file as bytes: GLB chunks or JSON text, checked before any parser sees them.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/gltf/report.h"

namespace hwsim::pipeline::gltf {

struct Container {
  std::vector<std::uint8_t> bytes;
  bool binary = false;
  std::size_t json_begin = 0, json_bytes = 0;
  std::size_t bin_begin = 0, bin_bytes = 0;  ///< place and size of the BIN chunk; 0 bytes: none

  std::string_view json() const {
    return {reinterpret_cast<const char*>(bytes.data()) + json_begin, json_bytes};
  }
  /// The BIN chunk in the memory of the whole file, which is gone then.
  std::vector<std::uint8_t> take_bin() &&;
};

/// Reads and checks the container. Throws InputError (S001 unreadable, S002 damaged, S012 too large).
Container read_container(Report& report, std::size_t max_file_bytes);

/// The same of bytes that are in memory.
Container check_container(Report& report, std::vector<std::uint8_t> bytes, bool must_be_binary);

/// False if the file cannot be read or is larger than max_bytes.
bool read_bytes(const std::string& path, std::size_t max_bytes, std::vector<std::uint8_t>& out);

}  // namespace hwsim::pipeline::gltf
