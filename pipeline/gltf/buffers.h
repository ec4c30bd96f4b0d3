#pragma once
// The bytes that a file refers to: its BIN chunk, data URIs and files beside it.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/base/content_hash.h"
#include "pipeline/gltf/budget.h"
#include "pipeline/gltf/report.h"

namespace hwsim::pipeline::gltf {

/// Reads what lies beside one scene, and remembers what it read.
class SceneFiles {
 public:
  SceneFiles(const Report& report, Budget& budget, std::size_t max_file_bytes);

  /// The bytes of a URI, or an empty vector and the reason. `where`: "buffers[0]". Throws InputError where a
  /// URI leads out of the scene's folder (S015), and where the budget ends (S012).
  std::vector<std::uint8_t> read(std::string_view uri, const std::string& where, std::string& fault);

  void add_to_hash(std::span<const std::uint8_t> bytes) { hash_.add(bytes); }
  std::string content_hash() const { return hash_.hex(); }
  /// Absolute paths of what was read, or looked for and missing.
  std::vector<std::string> paths() const { return {paths_.begin(), paths_.end()}; }

 private:
  const Report& report_;
  Budget& budget_;
  std::size_t max_file_bytes_;
  std::string folder_;
  ContentHash hash_;
  std::set<std::string> paths_;
};

/// All buffers, byteLength bytes each; those that neither a primitive nor an image needs stay empty. `bin`:
/// the GLB's BIN chunk, whose memory the first of them takes over. Throws InputError (S006, S007, S012,
/// S015).
std::vector<std::vector<std::uint8_t>> read_buffers(Report& report, SceneFiles& files,
                                                    const nlohmann::json& root,
                                                    std::vector<std::uint8_t> bin);

}  // namespace hwsim::pipeline::gltf
