#pragma once
// Errors of images against references, each computed once: a second GPU with the same frame has the same.
#include <memory>
#include <optional>
#include <vector>

#include "lab/store/reference_image.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/image/metrics.h"

namespace hwsim::lab {

struct ComparedImage {
  pipeline::ImageError error;
  std::shared_ptr<const pipeline::Image> flip_map;
};

class ImageErrors {
 public:
  /// `jobs`: threads that compare.
  explicit ImageErrors(int jobs) : jobs_(jobs) {}
  /// The reference must outlive this object.
  const ComparedImage& of(const std::shared_ptr<const pipeline::Emulation>& frame,
                          const ReferenceImage& reference);
  std::size_t computed() const { return computed_; }

 private:
  struct Kept {
    std::weak_ptr<const pipeline::Emulation> frame;
    const ReferenceImage* reference = nullptr;
    ComparedImage compared;
  };
  int jobs_;
  const ReferenceImage* side_of_ = nullptr;
  std::optional<pipeline::ComparedReference> side_;  ///< the last reference, prepared for comparisons
  std::vector<Kept> kept_;                           ///< the newest last
  std::size_t computed_ = 0;
};

}  // namespace hwsim::lab
