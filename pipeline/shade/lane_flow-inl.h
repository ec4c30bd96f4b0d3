// Branches and loops of shaders on the host's vector registers: which lanes go on, and how often each went
// through which block. Shared by fragment, geometry and compute contexts. Per-target include guard.
#include "pipeline/batch/fragment_batch.h"
#include "pipeline/simd/lanes-inl.h"

#if defined(HWSIM_SHADE_LANE_FLOW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_LANE_FLOW_INL_H_
#undef HWSIM_SHADE_LANE_FLOW_INL_H_
#else
#define HWSIM_SHADE_LANE_FLOW_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// Counts a pass of the lanes of `mask` through a block.
HWY_INLINE void count_trip(BlockTrips& blocks, int block, int first_lane, LaneM mask) {
  std::int32_t* trips = blocks.trips[static_cast<std::size_t>(block)].data();
  if ((blocks.used >> block & 1u) == 0) {
    blocks.used |= 1u << block;
    for (int i = 0; i < kBatchLanes; ++i) trips[i] = 0;
  }
  store(load(trips + first_lane) + select(mask, LaneI(1), LaneI(0)), trips + first_lane);
}

class LaneFlow {
 public:
  using F = LaneF;
  using I = LaneI;
  using M = LaneM;

  M valid() const { return valid_; }  ///< lanes that run

  /// Runs body() if a lane of `mask` is left, and charges those lanes with the block's operations. What the
  /// body does is charged to the same lanes: the others are there because registers are wide.
  template <class Body>
  HWY_INLINE void branch(int block, M mask, Body&& body) {
    const M outer = live_;
    const M live = mask & outer;
    if (!any(live)) return;
    live_ = live;
    count_trip(blocks_, block, first_, live);
    body();
    live_ = outer;
  }
  /// As branch, for a condition that is the same for all lanes.
  template <class Body>
  HWY_INLINE void uniform_branch(int block, bool condition, Body&& body) {
    if (!condition) return;
    count_trip(blocks_, block, first_, live_);
    body();
  }
  /// body(i) for i in [0, count), the lanes of `mask`; charged for each iteration.
  template <class Body>
  HWY_INLINE void loop(int block, int count, M mask, Body&& body) {
    const M outer = live_;
    const M live = mask & outer;
    if (!any(live)) return;
    live_ = live;
    for (int i = 0; i < count; ++i) {
      count_trip(blocks_, block, first_, live);
      body(i);
    }
    live_ = outer;
  }
  /// body(i, lanes) for i from 0 as long as a lane of `mask` has i < count; `lanes`: those that do.
  template <class Body>
  HWY_INLINE void loop_each(int block, I count, M mask, Body&& body) {
    const M outer = live_;
    for (int i = 0;; ++i) {
      const M live = mask & outer & (I(i) < count);
      if (!any(live)) break;
      live_ = live;
      count_trip(blocks_, block, first_, live);
      body(i, live);
    }
    live_ = outer;
  }

  /// The number of elements of a uniform array: at least one where a shader is only counted.
  std::size_t loop_count(int count) const { return static_cast<std::size_t>(count); }

 protected:
  LaneFlow(BlockTrips& blocks, int first_lane, M valid)
      : blocks_(blocks), first_(first_lane), valid_(valid), live_(valid) {}

  BlockTrips& blocks_;
  int first_;
  M valid_;
  M live_;  ///< valid lanes in the current branch
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
