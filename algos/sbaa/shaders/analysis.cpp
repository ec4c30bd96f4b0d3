#include <vector>

#include "algos/sbaa/shaders/programs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/sbaa/shaders/analysis.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/sbaa/shaders/record-inl.h"
#include "pipeline/shade/compute_lanes-inl.h"
#include "pipeline/shade/count_fragment-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

inline constexpr int kGroupPx = 8;  // 64 invocations, each with its own counters in group memory

enum AnalysisBlock : int {
  kLoadBlock = 1,
  kPickBlock = 2,     // a slot of a pixel that has samples left
  kScanBlock = 3,     // a sample's counter against the best one
  kAlignBlock = 4,    // MERGE: a normal against the reference
  kModeBlock = 5,     // MERGE: a depth against the middle region
  kRemoveBlock = 6,   // a sample that belongs to a surface now
  kUncountBlock = 7,  // MERGE: its counter
  kLinearDepthBlock = 8,
  kClearBlock = 9,  // the counters of a pixel's samples
  kEmitBlock = 10,  // a slot is stored, empty or not
};

/// One pixel's samples in registers.
template <class S>
struct PixelSamples {
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;
  I id[pipeline::kMaxSamples];
  lanes::Vec3<F> normal[pipeline::kMaxSamples];
  F z[pipeline::kMaxSamples];
  M in[pipeline::kMaxSamples];  ///< not yet part of a surface (U of docs/techniques/sbaa.md#analysis)
  M remaining;                  ///< any is
  I background;                 ///< samples that nothing was drawn to
};

template <class S, class I>
I counter_address(S& s, const SbaaAnalysisUniforms& u, I id) {
  return s.lane_index() * I(u.id_mask + 1) + (id & I(u.id_mask));
}

template <SbaaSample kSample, class S>
void load_samples(S& s, const SbaaAnalysisUniforms& u, PixelSamples<S>& p) {
  using F = typename S::F;
  using I = typename S::I;
  p.remaining = F(1.0f) < F(0.0f);
  p.background = I(0);
  s.loop(kLoadBlock, u.samples, s.valid(), [&](int i) HWY_ATTR {
    const I x = s.pixel_x(), y = s.pixel_y(), sample(i);
    if constexpr (kSample == SbaaSample::packed) {
      I texel[4];
      s.load_image_int(0, x, y, sample, texel);
      p.id[i] = texel[0];
      const auto component = [](I code) HWY_ATTR {
        return max(to_float(code - I(128)) * F(1.0f / 127.0f), F(-1.0f));
      };
      p.normal[i] = {component(texel[1]), component(texel[2]), component(texel[3])};
    } else {
      I texel[1];
      s.load_image_int(0, x, y, sample, texel);
      p.id[i] = texel[0];
    }
    if constexpr (kSample == SbaaSample::id_and_normal) {
      const auto n = s.load_image(1, x, y, sample);
      p.normal[i] = {n.x, n.y, n.z};
    }
    if constexpr (kSample != SbaaSample::id) {
      F z = s.load_image(kSample == SbaaSample::packed ? 1 : 2, x, y, sample).x;
      s.uniform_branch(kLinearDepthBlock, u.linear_depth, [&]() HWY_ATTR {
        const glm::mat4& m = u.view_from_clip;
        z = F(0.0f) - (F(m[2][2]) * z + F(m[3][2])) / (F(m[2][3]) * z + F(m[3][3]));
      });
      p.z[i] = z;
    }
    p.in[i] = s.valid() & (p.id[i] > I(u.id_mask));
    p.remaining = p.remaining | p.in[i];
    p.background = p.background + select(p.in[i], I(0), I(1));
    s.add_group_byte(counter_address(s, u, p.id[i]), I(1), p.in[i]);
  });
}

/// What one iteration finds.
template <class S>
struct Choice {
  typename S::I id, count;
  lanes::Vec3<typename S::F> normal;  ///< normal of the lowest sample of the primitive
  Choice() : id(0), count(0) {}
};

/// The primitive with the most samples left; the lowest sample breaks ties. Here and below, `running` are the
/// pixels that look for a surface.
template <bool kMerge, class S>
void pick_top(S& s, const SbaaAnalysisUniforms& u, const PixelSamples<S>& p, typename S::M running,
              Choice<S>& best) {
  s.loop(kScanBlock, u.samples, running, [&](int i) HWY_ATTR {
    const auto n = s.load_group_byte(counter_address(s, u, p.id[i]), p.in[i]);
    const auto better = p.in[i] & (n > best.count);
    best.count = select(better, n, best.count);
    best.id = select(better, p.id[i], best.id);
    if constexpr (kMerge) best.normal = select(better, p.normal[i], best.normal);
  });
}

template <class S>
void remove_primitive(S& s, const SbaaAnalysisUniforms& u, const Choice<S>& best, typename S::M running,
                      PixelSamples<S>& p) {
  using F = typename S::F;
  auto left = F(1.0f) < F(0.0f);
  s.loop(kRemoveBlock, u.samples, running, [&](int i) HWY_ATTR {
    p.in[i] = p.in[i] & (p.id[i] != best.id);
    left = left | p.in[i];
  });
  p.remaining = left;
}

/// Aligned samples whose depths have one mode join the primitive (docs/techniques/sbaa.md#analysis).
template <class S>
void remove_surface(S& s, const SbaaAnalysisUniforms& u, Choice<S>& best, typename S::M running,
                    PixelSamples<S>& p) {
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;
  M aligned[pipeline::kMaxSamples];
  F nearest(1e30f), farthest(-1e30f);
  I total(0);
  s.loop(kAlignBlock, u.samples, running, [&](int i) HWY_ATTR {
    aligned[i] = p.in[i] & ((p.id[i] == best.id) | (dot(best.normal, p.normal[i]) > F(u.cos_alpha)));
    nearest = select(aligned[i], min(nearest, p.z[i]), nearest);
    farthest = select(aligned[i], max(farthest, p.z[i]), farthest);
    total = total + select(aligned[i], I(1), I(0));
  });
  const F end = (farthest - nearest) * F(u.end_region);
  M one_mode = nearest >= farthest;
  s.loop(kModeBlock, u.samples, running, [&](int i) HWY_ATTR {
    one_mode = one_mode | (aligned[i] & (p.z[i] >= nearest + end) & (p.z[i] <= farthest - end));
  });
  s.count(SbaaCounters::merge_fallbacks_surfaces, p.remaining & !one_mode);
  auto left = F(1.0f) < F(0.0f);
  s.loop(kRemoveBlock, u.samples, running, [&](int i) HWY_ATTR {
    const M taken = aligned[i] & (one_mode | (p.id[i] == best.id));
    p.in[i] = p.in[i] & !taken;
    left = left | p.in[i];
    s.branch(kUncountBlock, taken,
             [&]() HWY_ATTR { s.add_group_byte(counter_address(s, u, p.id[i]), I(-1), taken); });
  });
  best.count = select(one_mode, total, best.count);
  p.remaining = left;
}

template <class S>
void emit_surface(S& s, const SbaaAnalysisUniforms& u, std::size_t slot, const Choice<S>& best,
                  typename S::I background) {
  using F = typename S::F;
  using I = typename S::I;
  const SbaaSurfaces& to = u.surfaces;
  const I count = slot == 0 ? best.count + background * I(to.background_unit) : best.count;
  const auto k = static_cast<int>(slot);
  s.store_image(0, s.pixel_x(), s.pixel_y() + I(k * to.height), I(0),
                {to_float(best.id & I(u.id_mask)), to_float(count), F(0.0f), F(0.0f)}, s.valid());
  const auto emitted = s.valid() & (best.count > I(0));
  using T = SbaaCounters;
  constexpr TechniqueCounter kOfSlot[] = {T::slots_emitted_first_surfaces, T::slots_emitted_second_surfaces,
                                          T::slots_emitted_third_surfaces, T::slots_emitted_further_surfaces};
  s.count(T::slots_emitted_surfaces, emitted);
  s.count(kOfSlot[slot < 3 ? slot : 3], emitted);
}

template <SbaaSample kSample, class S>
void analyze(S& s, const SbaaAnalysisUniforms& u) {
  using I = typename S::I;
  constexpr bool kMerge = kSample != SbaaSample::id;
  PixelSamples<S> p;
  load_samples<kSample>(s, u, p);
  const I background = p.background;
  const std::size_t slots = s.loop_count(u.surfaces.slots);
  for (std::size_t slot = 0; slot < slots; ++slot) {
    Choice<S> best;
    // An iteration runs until samples run out (section 3.3); the first one asks nothing (Table 1: times
    // hardly depend on what the scene covers).
    const auto running = slot == 0 && !u.empty_exit ? s.valid() : p.remaining;
    s.branch(kPickBlock, running, [&]() HWY_ATTR {
      pick_top<kMerge>(s, u, p, running, best);
      if constexpr (kMerge)
        remove_surface(s, u, best, running, p);
      else
        remove_primitive(s, u, best, running, p);
    });
    s.branch(kEmitBlock, s.valid(), [&]() HWY_ATTR { emit_surface(s, u, slot, best, background); });
  }
  s.loop(kClearBlock, u.samples, s.valid(),
         [&](int i) HWY_ATTR { s.store_group_byte(counter_address(s, u, p.id[i]), I(0), s.valid()); });
}

template <SbaaSample kSample>
pipeline::ComputeProgram describe_analysis(int id_bits, void (*run)(pipeline::GroupBatch&, const void*)) {
  lanes::CountFragment s;
  analyze<kSample>(s, SbaaAnalysisUniforms{});
  pipeline::ComputeProgram program;
  program.name = kSample == SbaaSample::id ? "sbaa_top" : "sbaa_merge";
  program.run = run;
  program.ops = s.blocks();
  program.block_count = s.block_count();
  program.group_width = program.group_height = kGroupPx;
  program.group_memory_bytes = (kGroupPx * kGroupPx) << id_bits;  // a byte a counter: 8 KiB with 7 bits
  program.leaves_group_memory_zero = true;
  return program;
}

template <SbaaSample kSample>
void run_group(pipeline::GroupBatch& group, const SbaaAnalysisUniforms& u) {
  static_assert(kGroupPx * kGroupPx == pipeline::kBatchLanes);
  for (int first = 0; first < pipeline::kBatchLanes; first += lanes::kVectorLanes) {
    HWY_ALIGN std::int32_t x[lanes::kVectorLanes], y[lanes::kVectorLanes];
    for (int lane = 0; lane < lanes::kVectorLanes; ++lane) {
      x[lane] = group.group_x * kGroupPx + pipeline::lane_x(first + lane);
      y[lane] = group.group_y * kGroupPx + pipeline::lane_y(first + lane);
    }
    const lanes::LaneI px = lanes::load(x), py = lanes::load(y);
    const lanes::LaneM valid = (px < lanes::LaneI(u.surfaces.width)) & (py < lanes::LaneI(u.surfaces.height));
    if (!any(valid)) continue;
    lanes::ComputeLanes s(group, first, px, py, lanes::LaneI(0), valid);
    analyze<kSample>(s, u);
  }
  lanes::end_wave(group, pipeline::kBatchLanes);
}

void run_analysis(SbaaSample sample, pipeline::GroupBatch& group, const void* uniforms) {
  const auto& u = *static_cast<const SbaaAnalysisUniforms*>(uniforms);
  switch (sample) {
    case SbaaSample::id:
      return run_group<SbaaSample::id>(group, u);
    case SbaaSample::id_and_normal:
      return run_group<SbaaSample::id_and_normal>(group, u);
    case SbaaSample::packed:
      return run_group<SbaaSample::packed>(group, u);
  }
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_analysis);

namespace {
constexpr int kLargestIdBits = 16;

template <SbaaSample kSample>
const pipeline::ComputeProgram& program_of(int id_bits) {
  static const std::vector<pipeline::ComputeProgram> programs = [] {
    std::vector<pipeline::ComputeProgram> all;
    for (int bits = 0; bits <= kLargestIdBits; ++bits)
      all.push_back(
          HWY_NAMESPACE::describe_analysis<kSample>(bits, [](pipeline::GroupBatch& g, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_analysis)
            (kSample, g, u);
          }));
    return all;
  }();
  return programs.at(static_cast<std::size_t>(id_bits));
}
}  // namespace

const pipeline::ComputeProgram& sbaa_analysis_program(SbaaSample sample, int id_bits) {
  switch (sample) {
    case SbaaSample::id:
      return program_of<SbaaSample::id>(id_bits);
    case SbaaSample::id_and_normal:
      return program_of<SbaaSample::id_and_normal>(id_bits);
    case SbaaSample::packed:
      return program_of<SbaaSample::packed>(id_bits);
  }
  return program_of<SbaaSample::id>(id_bits);
}

}  // namespace hwsim::algos
#endif
