#pragma once
// Gives a file's bytes back while its meshes are built, so that a large scene is not held twice.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/gltf/source.h"

namespace hwsim::pipeline::gltf {

/// Counts how often primitives refer to each buffer view, and gives the pages of a view back when each of
/// these uses has copied it. Views that images or skins need, or that share bytes with one that is still
/// needed, stay. The bytes of a view that was given back are zeros: nothing may read them any more.
class ViewRelease {
 public:
  static constexpr std::size_t kMinBytes = std::size_t{1} << 20;  ///< smaller views stay

  explicit ViewRelease(Source& source);

  /// One of the primitives' references to the accessor has copied it. At most once for each reference.
  void copied(int accessor);
  std::size_t released_bytes() const { return released_bytes_; }

 private:
  struct Range {
    int buffer = 0;
    std::size_t begin = 0, end = 0;

    bool overlaps(const Range& other) const {
      return buffer == other.buffer && begin < other.end && other.begin < end;
    }
  };
  Range range_of(int view) const;
  std::vector<int> views_of(int accessor) const;
  void keep(std::span<const std::uint8_t> bytes);
  bool is_needed(const Range& range) const;

  tinygltf::Model& model_;
  std::vector<std::uint64_t> uses_;  ///< by view: references that have not copied it
  std::vector<Range> kept_;          ///< the images' bytes
  std::size_t released_bytes_ = 0;
};

}  // namespace hwsim::pipeline::gltf
