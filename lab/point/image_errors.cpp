#include "lab/point/image_errors.h"

namespace hwsim::lab {
namespace {

constexpr std::size_t kKeptErrors = 4;  // as many as frames are kept, with a map of 15 MB each at 1280x720

}  // namespace

const ComparedImage& ImageErrors::of(const std::shared_ptr<const pipeline::Emulation>& frame,
                                     const ReferenceImage& reference) {
  for (const Kept& kept : kept_)
    if (kept.reference == &reference && kept.frame.lock() == frame) return kept.compared;
  if (side_of_ != &reference) {
    side_.emplace(reference.image, jobs_);
    side_of_ = &reference;
  }
  pipeline::Image map;
  Kept kept{frame, &reference, {side_->error_of(frame->color, &map), nullptr}};
  kept.compared.flip_map = std::make_shared<const pipeline::Image>(std::move(map));
  ++computed_;
  if (kept_.size() == kKeptErrors) kept_.erase(kept_.begin());
  return kept_.emplace_back(std::move(kept)).compared;
}

}  // namespace hwsim::lab
