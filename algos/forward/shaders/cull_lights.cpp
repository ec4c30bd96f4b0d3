#include <algorithm>

#include "algos/base/shaders/tile_box.h"
#include "algos/forward/shaders/light_lists.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/forward/shaders/cull_lights.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/base/shaders/tile_waves-inl.h"
#include "pipeline/shade/compute_lanes-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/lighting-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

static_assert(kListTilePx == kWaveTilePx);

enum CullBlock : int {
  kDepthBlock = 1,   // depth of each sample, for the tile's bounds
  kLightBlock = 2,   // a light against the tile
  kKeptBlock = 3,    // its place in the list
  kLengthBlock = 4,  // the list's length
  kReduceBlock = 5,  // a pixel's bounds into the tile's
};

/// Depths of a pixel's samples into `bounds`; background has none.
template <class S, class Bounds>
void gather_depths(S& s, const CullUniforms& u, Bounds& bounds) {
  using F = typename S::F;
  using I = typename S::I;
  s.loop(kDepthBlock, u.samples, s.valid(), [&](int i) HWY_ATTR {
    const F z = s.load_image(0, s.pixel_x(), s.pixel_y(), I(i)).x;
    bounds.add(z, s.valid() & (z < F(1.0f)));
  });
}

/// The lanes whose light reaches the box. A thousandth more than the range: rounding must not lose a light.
template <class S>
typename S::M reaching(S& s, const CullUniforms& u, const TileBox& box, typename S::I light,
                       typename S::M mask) {
  using F = typename S::F;
  const typename S::I at = light * typename S::I(kLightWords);
  lanes::Vec3<F> p;
  F* const coordinate[] = {&p.x, &p.y, &p.z};
  for (int i = 0; i < 3; ++i)
    *coordinate[i] = bits_to_float(s.load_buffer(kLightsBuffer, at + typename S::I(i), mask));
  const F inv_range2 = bits_to_float(s.load_buffer(kLightsBuffer, at + typename S::I(3), mask));
  const glm::mat4& m = u.view_from_world;
  const auto beyond = [&](int row) HWY_ATTR {
    const F v = F(m[0][row]) * p.x + F(m[1][row]) * p.y + F(m[2][row]) * p.z + F(m[3][row]);
    return max(max(F(box.low[row]) - v, v - F(box.high[row])), F(0.0f));
  };
  const F x = beyond(0), y = beyond(1), z = beyond(2);
  return (x * x + y * y + z * z) * inv_range2 < F(1.001f);
}

struct CountBounds {
  void add(pipeline::CountF z, pipeline::CountM covered) {
    select(covered, min(z, z), z);
    select(covered, max(z, z), z);
  }
};

/// One pass through every block, for the operation counts.
pipeline::ComputeProgram describe_cull(void (*run)(pipeline::GroupBatch&, const void*)) {
  lanes::CountFragment s;
  const CullUniforms u;
  CountBounds bounds;
  gather_depths(s, u, bounds);
  s.branch(kReduceBlock, s.valid(), []() HWY_ATTR {});
  s.branch(kLightBlock, s.valid(),
           [&]() HWY_ATTR { (void)reaching(s, u, TileBox{}, s.lane_index(), s.valid()); });
  s.branch(kKeptBlock, s.valid(), [&]() HWY_ATTR {
    s.store_buffer(kListsBuffer, s.lane_index() + pipeline::CountI(1), s.lane_index(), s.valid());
  });
  s.branch(kLengthBlock, s.valid(),
           [&]() HWY_ATTR { s.store_buffer(kListsBuffer, s.lane_index(), s.lane_index(), s.valid()); });
  pipeline::ComputeProgram program;
  program.name = "cull_lights";
  program.run = run;
  program.ops = s.blocks();
  program.ops[kReduceBlock].group_memory = 4;  // the tile's least and greatest depth: two atomics, two loads
  program.ops[kKeptBlock].group_memory = 1;    // the next place of the list: an atomic
  program.block_count = s.block_count();
  program.group_width = program.group_height = kListTilePx;
  program.group_memory_bytes = 3 * 4;  // both depths and the length
  return program;
}

using lanes::ComputeLanes;
using lanes::kVectorLanes;
using lanes::LaneF;
using lanes::LaneI;
using lanes::LaneM;

struct LaneBounds {
  LaneF nearest, farthest;
  LaneBounds() : nearest(1.0f), farthest(0.0f) {}  // an implicit constructor would not get the vector target
  /// Inlined: g++ 12 loses what a call with emulated vectors writes (hwy/detect_targets.h,
  /// HWY_BROKEN_EMU128).
  HWY_INLINE void add(LaneF z, LaneM mask) {
    nearest = select(mask, min(nearest, z), nearest);
    farthest = select(mask, max(farthest, z), farthest);
  }
};

class TileCuller {
 public:
  TileCuller(pipeline::GroupBatch& group, const CullUniforms& u)
      : g_(group), u_(u), list_((group.group_y * u.grid.columns() + group.group_x) * u.grid.list_words()) {}

  void run() {
    find_depths();
    if (nearest_ <= farthest_)
      box_ = tile_box({u_.grid.width, u_.grid.height, kListTilePx}, {g_.group_x, g_.group_y},
                      u_.view_from_clip, {nearest_, farthest_});
    // Invocation i tests lights i, i + 256, ...; the first then writes how many there are.
    constexpr int kInvocations = kListTilePx * kListTilePx;
    for (int begin = 0; begin < u_.grid.lights && nearest_ <= farthest_; begin += kInvocations)
      for (int wave = 0; wave < kInvocations; wave += pipeline::kBatchLanes) test_lights(begin + wave);
    write_length();
  }

 private:
  void find_depths() {
    LaneBounds bounds;
    for_each_tile_register(g_, u_.grid.width, u_.grid.height, [&](ComputeLanes& s) HWY_ATTR {
      gather_depths(s, u_, bounds);
      s.branch(kReduceBlock, s.valid(), []() HWY_ATTR {});
    });
    HWY_ALIGN float nearest[kVectorLanes], farthest[kVectorLanes];
    lanes::store(bounds.nearest, nearest);
    lanes::store(bounds.farthest, farthest);
    nearest_ = *std::min_element(nearest, nearest + kVectorLanes);
    farthest_ = *std::max_element(farthest, farthest + kVectorLanes);
  }

  void test_lights(int begin) {
    const int lights = std::min(pipeline::kBatchLanes, u_.grid.lights - begin);
    for (int first = 0; first < lights; first += kVectorLanes) {
      ComputeLanes s(g_, first, LaneI(0), LaneI(0), LaneI(0), up_to(first, lights));
      const LaneI number = s.lane_index() + LaneI(begin);
      s.branch(kLightBlock, s.valid(), [&]() HWY_ATTR {
        const LaneM kept = reaching(s, u_, box_, number, s.valid()) & s.valid();
        s.branch(kKeptBlock, kept, [&]() HWY_ATTR { append(s, number, kept); });
      });
    }
    if (lights > 0) lanes::end_wave(g_, lights);
  }

  /// The order of a GPU's atomics is open; ours keeps the lights' own, so that sums are those of plain loops.
  void append(ComputeLanes& s, LaneI number, LaneM kept) {
    HWY_ALIGN std::int32_t place[kVectorLanes] = {};
    for (std::uint32_t bits = lanes::mask_bits(kept); bits != 0; bits &= bits - 1)
      place[__builtin_ctz(bits)] = length_++;
    s.store_buffer(kListsBuffer, lanes::load(place) + LaneI(list_ + 1), number, kept);
  }

  void write_length() {
    ComputeLanes s(g_, 0, LaneI(0), LaneI(0), LaneI(0), up_to(0, 1));
    s.branch(kLengthBlock, s.valid(),
             [&]() HWY_ATTR { s.store_buffer(kListsBuffer, LaneI(list_), LaneI(length_), s.valid()); });
    lanes::end_wave(g_, 1);
  }

  static LaneM up_to(int first, int count) {
    HWY_ALIGN std::int32_t index[kVectorLanes];
    for (int lane = 0; lane < kVectorLanes; ++lane) index[lane] = first + lane;
    return lanes::load(index) < LaneI(count);
  }

  pipeline::GroupBatch& g_;
  const CullUniforms& u_;
  int list_, length_ = 0;
  float nearest_ = 1.0f, farthest_ = 0.0f;  // depths; empty: nearer than nothing
  TileBox box_;
};

void run_cull(pipeline::GroupBatch& group, const void* uniforms) {
  TileCuller(group, *static_cast<const CullUniforms*>(uniforms)).run();
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_cull);

const pipeline::ComputeProgram& cull_lights_program() {
  static const pipeline::ComputeProgram program =
      HWY_NAMESPACE::describe_cull([](pipeline::GroupBatch& g, const void* u) {
        HWY_DYNAMIC_DISPATCH(run_cull)
        (g, u);
      });
  return program;
}

}  // namespace hwsim::algos
#endif
