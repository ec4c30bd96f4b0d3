#pragma once
// What the conformance scenes must show and what they do show, a row for each patch, light and camera.
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "algos/base/technique.h"
#include "pipeline/image/image.h"
#include "tests/algos/conformance_scene.h"

namespace hwsim::test {

using Codes = std::array<int, 3>;  ///< sRGB, 0 to 255

Codes codes_of(const glm::vec3& linear);
int largest_difference(const Codes& a, const Codes& b);

struct ConformanceRow {
  std::string kind, name;
  Codes want{}, emulated{}, traced{};  ///< closed form, technique `none`, ray-traced reference
};

/// The scene of patches in cells of kCellPx pixels, and pictures of it.
class PatchPictures {
 public:
  static constexpr int kCellPx = 16;

  PatchPictures();
  const std::vector<Patch>& patches() const { return scene_.patches(); }
  pipeline::Image drawn_by(const std::string& technique) const;
  pipeline::Image traced() const;
  /// In the middle of a patch.
  Codes shown(const pipeline::Image& image, std::size_t patch) const;

 private:
  ConformanceScene scene_;
  algos::FrameRequest request_;
};

std::vector<ConformanceRow> patch_rows(const PatchPictures& pictures);
/// A white square under one light each.
std::vector<ConformanceRow> light_rows();
/// Just inside and just outside of where a camera sees the edge of a white square.
std::vector<ConformanceRow> camera_rows();

/// docs/conformance.md.
std::string conformance_page(const std::vector<ConformanceRow>& rows);

}  // namespace hwsim::test
