#pragma once
// Errors of an image against a reference of the same size. Both linear; compared as a viewer sees them (sRGB,
// [0,1]).
#include <memory>

#include "pipeline/image/image.h"

namespace hwsim::pipeline {

struct ImageError {
  double psnr_db = 0.0;  ///< from sRGB-encoded values in [0,1]; +infinity is reported as 999
  double rmse = 0.0;     ///< likewise
  double ssim = 0.0;     ///< from luma, 11x11 Gaussian window, sigma 1.5 (Wang et al. 2004)
  double flip_mean = 0.0, flip_median = 0.0, flip_p99 = 0.0;  ///< LDR FLIP (Andersson et al. 2020), 0..1
};

/// A reference with all that comparisons ask of it, found once. 55 bytes a pixel.
class ComparedReference {
 public:
  explicit ComparedReference(const Image& reference, int jobs = 1);
  ~ComparedReference();
  ComparedReference(ComparedReference&&) noexcept;

  /// Throws std::invalid_argument when sizes differ. `flip_map` (optional) receives the per-pixel FLIP error
  /// in r.
  ImageError error_of(const Image& test, Image* flip_map = nullptr) const;

 private:
  struct Sides;
  std::unique_ptr<const Sides> sides_;
  int jobs_;
};

/// The same of a reference that is compared once.
ImageError compare(const Image& test, const Image& reference, Image* flip_map = nullptr);

/// The magma color map on values in [0,1], for error and heat maps. Linear, so that write_image shows the
/// map's colors.
glm::vec3 magma(float value);

}  // namespace hwsim::pipeline
