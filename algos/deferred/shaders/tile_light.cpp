#include <algorithm>
#include <cmath>

#include "algos/deferred/shaders/programs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/deferred/shaders/tile_light.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/base/shaders/gbuffer-inl.h"
#include "algos/base/shaders/tile_waves-inl.h"
#include "pipeline/shade/compute_lanes-inl.h"
#include "pipeline/shade/count_fragment-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

enum TileBlock : int {
  kBoundsBlock = 1,  // depth of each sample, for the tile's bounds
  kCullBlock = 2,    // a light against the tile
  kFirstSampleBlock = 3,
  kTileClassifyBlock = 4,  // and the next one
  kOtherSampleBlock = 10,
  kReplicateBlock = 11,  // a simple pixel's color stored to a further sample
  kMeanBlock = 12        // the mean of a complex pixel's samples
};

template <GBufferEncoding kEncoding, class S, class Bounds>
void gather_bounds(S& s, const DeferredUniforms& u, Bounds& bounds) {
  using I = typename S::I;
  s.loop(kBoundsBlock, u.samples, s.valid(), [&](int i) HWY_ATTR {
    typename S::M covered;
    const auto z = view_z<kEncoding>(s, u, s.pixel_x(), s.pixel_y(), I(i), covered);
    bounds.add(z, s.valid() & covered);
  });
}

template <GBufferEncoding kEncoding, class S>
lanes::Vec4<typename S::F> light_at(S& s, const DeferredUniforms& u,
                                    std::span<const pipeline::PointLight> points, typename S::I sample,
                                    typename S::F ox, typename S::F oy) {
  s.count(BaseCounters::lit_samples, s.valid());
  const auto g = read_gbuffer<kEncoding>(s, u, s.pixel_x(), s.pixel_y(), sample, ox, oy);
  return light_sample(s, u, points, g, s.valid());
}

struct CountBounds {
  void add(pipeline::CountF z, pipeline::CountM) { max(min(z, z), z); }
};

/// The most registers that a phase needs: the group waits for itself between them, and nothing but a pixel's
/// place lives on.
template <GBufferEncoding kEncoding>
std::uint32_t registers_of_phases(const DeferredUniforms& u, std::span<const pipeline::PointLight> points) {
  using F = pipeline::CountF;
  using I = pipeline::CountI;
  lanes::CountFragment bounds_phase, light_phase, classify_phase;
  CountBounds bounds;
  gather_bounds<kEncoding>(bounds_phase, u, bounds);
  light_phase.branch(kFirstSampleBlock, light_phase.valid(), [&]() HWY_ATTR {
    (void)light_at<kEncoding>(light_phase, u, points, I(0), F(0.0f), F(0.0f));
  });
  (void)is_complex<kEncoding>(classify_phase, u, kTileClassifyBlock, classify_phase.pixel_x(),
                              classify_phase.pixel_y());
  std::uint32_t most = 0;
  for (const lanes::CountFragment* phase : {&bounds_phase, &light_phase, &classify_phase})
    most = std::max(most, phase->blocks()[0].registers);
  return most;
}

/// One pass through every block, for the operation counts.
template <GBufferEncoding kEncoding>
pipeline::ComputeProgram describe_tile_light(bool extended, bool means,
                                             void (*run)(pipeline::GroupBatch&, const void*)) {
  lanes::CountFragment s;
  DeferredUniforms u;
  u.lighting.extended = extended;
  const std::span points(u.lighting.points.data(), 1);
  CountBounds bounds;
  gather_bounds<kEncoding>(s, u, bounds);
  using F = pipeline::CountF;
  using I = pipeline::CountI;
  s.branch(kCullBlock, s.valid(),
           [&]() HWY_ATTR {  // the light's sphere against the tile's box, and a slot in the list
             const auto p = lanes::broadcast<F>(u.lighting.points[0].position);
             const auto v = s.load_image(0, s.pixel_x(), s.pixel_y(), I(0));
             const lanes::Vec3<F> d = {max(v.x - p.x, p.x - v.y), max(v.y - p.y, p.y - v.z),
                                       max(v.z - p.z, p.z - v.w)};
             (void)(dot(d, d) < v.x);
           });
  const auto lit_block = [&]() HWY_ATTR {
    const auto color = light_at<kEncoding>(s, u, points, I(0), F(0.0f), F(0.0f));
    if (!means) s.store_image(0, s.pixel_x(), s.pixel_y(), I(0), color, s.valid());
  };
  s.branch(kFirstSampleBlock, s.valid(), lit_block);
  (void)is_complex<kEncoding>(s, u, kTileClassifyBlock, s.pixel_x(), s.pixel_y());
  s.branch(kOtherSampleBlock, s.valid(), lit_block);
  s.branch(kReplicateBlock, s.valid(), [&]() HWY_ATTR { s.store_image(0, I(0), I(0), I(0), {}, s.valid()); });
  s.branch(kMeanBlock, s.valid(), [&]() HWY_ATTR {
    const lanes::Vec4<F> sum = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
    s.store_image(0, s.pixel_x(), s.pixel_y(), I(0), sum * F(1.0f), s.valid());
  });
  pipeline::ComputeProgram program;
  program.name = "tile_light";
  program.run = run;
  program.ops = s.blocks();
  // The lights' blocks stand at both places that light, and lanes are counted at each: they cost what they do
  // at one.
  lanes::CountFragment once;
  light_at<kEncoding>(once, u, points, I(0), F(0.0f), F(0.0f));
  for (const int block :
       {lanes::kShadowBlock, lanes::kDirectionalBlock, lanes::kPointBlock, lanes::kPointInRangeBlock})
    program.ops[static_cast<std::size_t>(block)] = once.blocks()[static_cast<std::size_t>(block)];
  program.ops[0].registers = registers_of_phases<kEncoding>(u, points);
  program.ops[kCullBlock].group_memory = 1;
  program.ops[kTileClassifyBlock].group_memory = 1;
  program.ops[kOtherSampleBlock].group_memory = means ? 4 : 1;
  program.ops[kMeanBlock].group_memory = 3;
  program.block_count = s.block_count();
  program.group_width = program.group_height = kWaveTilePx;
  // The tile's lights, and the pixels whose samples are lit apart: the number of a sample follows from that
  // of the invocation. Then sums of their colors, where they are averaged here.
  program.group_memory_bytes = 4 * (1024 + kWaveTilePx * kWaveTilePx * (means ? 4 : 1));
  return program;
}

using lanes::ComputeLanes;
using lanes::kVectorLanes;
using lanes::LaneF;
using lanes::LaneI;
using lanes::LaneM;

struct LaneBounds {
  LaneF nearest, farthest;  // view z is negative
  LaneBounds()
      : nearest(-1e30f), farthest(1e30f) {}  // an implicit constructor would not get the vector target
  void add(LaneF z, LaneM mask) {
    nearest = select(mask, max(nearest, z), nearest);
    farthest = select(mask, min(farthest, z), farthest);
  }
};

template <GBufferEncoding kEncoding>
class TileLighter {
 public:
  TileLighter(pipeline::GroupBatch& group, const DeferredUniforms& u)
      : g_(group), u_(u), x0_(group.group_x * kWaveTilePx), y0_(group.group_y * kWaveTilePx) {}

  void run() {
    find_bounds();
    cull_lights();
    light_first_samples();
    light_other_samples();
    if (means()) store_means();
  }

 private:
  template <class Body>
  HWY_INLINE void for_each_pixel(Body&& body) {
    for_each_tile_register(g_, u_.width, u_.height, body);
  }

  void find_bounds() {
    LaneBounds bounds;
    for_each_pixel([&](ComputeLanes& s) HWY_ATTR { gather_bounds<kEncoding>(s, u_, bounds); });
    HWY_ALIGN float nearest[kVectorLanes], farthest[kVectorLanes];
    lanes::store(bounds.nearest, nearest);
    lanes::store(bounds.farthest, farthest);
    near_ = *std::max_element(nearest, nearest + kVectorLanes);
    far_ = *std::min_element(farthest, farthest + kVectorLanes);
  }

  // The box around the tile's frustum between its depth bounds, in view space; a light whose sphere misses it
  // goes.
  void cull_lights() {
    const int count = u_.lighting.point_count;
    if (count == 0 || near_ < far_) return;
    glm::vec3 low(1e30f), high(-1e30f);
    for (int corner = 0; corner < 8; ++corner) {
      const float z = (corner & 4) != 0 ? near_ : far_;
      const glm::vec2 xy =
          view_corner(x0_ + (corner & 1) * kWaveTilePx, y0_ + (corner >> 1 & 1) * kWaveTilePx, z);
      const glm::vec3 p(xy.x, xy.y, z);
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    for (const pipeline::PointLight& light :
         std::span(u_.lighting.points.data(), static_cast<std::size_t>(count))) {
      const glm::vec3 p(u_.view_from_world * glm::vec4(light.position, 1.0f));
      const glm::vec3 d = glm::max(glm::max(low - p, p - high), glm::vec3(0.0f));
      if (glm::dot(d, d) * light.inv_range2 < 1.0f) points_.push_back(light);
    }
    charge_culling(count);
  }

  glm::vec2 view_corner(int x, int y, float z) const {
    const float ndc_x = 2.0f * static_cast<float>(x) / static_cast<float>(u_.width) - 1.0f;
    const float ndc_y = 1.0f - 2.0f * static_cast<float>(y) / static_cast<float>(u_.height);
    const glm::mat4& m = u_.view_from_clip;
    const bool perspective = m[2][3] != 0.0f;
    const float scale = perspective ? -z : 1.0f;
    return {m[0][0] * ndc_x * scale, m[1][1] * ndc_y * scale};
  }

  // Invocation i tests lights i, i + 256, ...
  void charge_culling(int count) {
    constexpr int kInvocations = kWaveTilePx * kWaveTilePx;
    for (int wave = 0; wave < kInvocations; wave += pipeline::kBatchLanes) {
      for (int first = 0; first < pipeline::kBatchLanes; first += kVectorLanes) {
        for (int begin = 0; begin < count; begin += kInvocations) {
          HWY_ALIGN std::int32_t index[kVectorLanes];
          for (int lane = 0; lane < kVectorLanes; ++lane) index[lane] = begin + wave + first + lane;
          const LaneM tests = lanes::load(index) < LaneI(count);
          if (any(tests)) lanes::count_trip(g_.blocks, kCullBlock, first, tests);
        }
      }
      lanes::end_wave(g_, pipeline::kBatchLanes);
    }
  }

  bool means() const { return u_.mean_in_tiles && u_.samples > 1; }

  static LaneF offset(int sixteenths) { return LaneF(static_cast<float>(sixteenths) * 0.0625f); }

  void light_first_samples() {
    for_each_pixel([&](ComputeLanes& s) HWY_ATTR {
      lanes::Vec4<LaneF> color = {LaneF(0.0f), LaneF(0.0f), LaneF(0.0f), LaneF(0.0f)};
      s.branch(kFirstSampleBlock, s.valid(), [&]() HWY_ATTR {
        color = light_at<kEncoding>(s, u_, points_, LaneI(0), offset(u_.positions[0].x),
                                    offset(u_.positions[0].y));
        if (!means()) s.store_image(0, s.pixel_x(), s.pixel_y(), LaneI(0), color, s.valid());
      });
      if (u_.samples == 1) return;
      const LaneM complex =
          is_complex<kEncoding>(s, u_, kTileClassifyBlock, s.pixel_x(), s.pixel_y()) & s.valid();
      if (means()) {
        const LaneM simple = !complex & s.valid();
        s.branch(kReplicateBlock, simple,
                 [&]() HWY_ATTR { s.store_image(0, s.pixel_x(), s.pixel_y(), LaneI(0), color, simple); });
        add_to_means(s.pixel_x(), s.pixel_y(), color, complex);
        remember(s, complex);
        return;
      }
      s.loop(kReplicateBlock, u_.samples - 1, !complex, [&](int i) HWY_ATTR {
        s.store_image(0, s.pixel_x(), s.pixel_y(), LaneI(i + 1), color, !complex);
      });
      remember(s, complex);
    });
  }

  void remember(const ComputeLanes& s, LaneM complex) {
    HWY_ALIGN std::int32_t x[kVectorLanes], y[kVectorLanes];
    lanes::store(s.pixel_x(), x);
    lanes::store(s.pixel_y(), y);
    for (std::uint32_t bits = lanes::mask_bits(complex); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      for (int i = 1; i < u_.samples; ++i) work_[work_count_++] = {x[lane], y[lane], i};
    }
  }

  int place(int x, int y) const { return (y - y0_) * kWaveTilePx + x - x0_; }

  void add_to_means(LaneI px, LaneI py, const lanes::Vec4<LaneF>& color, LaneM mask) {
    HWY_ALIGN std::int32_t x[kVectorLanes], y[kVectorLanes];
    HWY_ALIGN float rgb[3][kVectorLanes];
    lanes::store(px, x);
    lanes::store(py, y);
    lanes::store(color.x, rgb[0]);
    lanes::store(color.y, rgb[1]);
    lanes::store(color.z, rgb[2]);
    for (std::uint32_t bits = lanes::mask_bits(mask); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits), at = place(x[lane], y[lane]);
      for (int c = 0; c < 3; ++c) sums_[c][at] += rgb[c][lane];
    }
  }

  /// Complex pixels: those that remember() gave items.
  void store_means() {
    bool complex[kWaveTilePx * kWaveTilePx] = {};
    for (int i = 0; i < work_count_; ++i) complex[place(work_[i].x, work_[i].y)] = true;
    const LaneF share(1.0f / static_cast<float>(u_.samples));
    for_each_pixel([&](ComputeLanes& s) HWY_ATTR {
      HWY_ALIGN std::int32_t x[kVectorLanes], y[kVectorLanes], summed[kVectorLanes];
      HWY_ALIGN float rgb[3][kVectorLanes];
      lanes::store(s.pixel_x(), x);
      lanes::store(s.pixel_y(), y);
      for (int lane = 0; lane < kVectorLanes; ++lane) {
        const int at = place(x[lane], y[lane]);
        summed[lane] = complex[at] ? 1 : 0;
        for (int c = 0; c < 3; ++c) rgb[c][lane] = sums_[c][at];
      }
      const LaneM mask = (lanes::load(summed) == LaneI(1)) & s.valid();
      s.branch(kMeanBlock, mask, [&]() HWY_ATTR {
        const lanes::Vec4<LaneF> sum = {lanes::load(rgb[0]), lanes::load(rgb[1]), lanes::load(rgb[2]),
                                        LaneF(static_cast<float>(u_.samples))};
        s.store_image(0, s.pixel_x(), s.pixel_y(), LaneI(0), sum * share, mask);
      });
    });
  }

  // The remaining samples, spread over all invocations: no lane idles beside a complex neighbor.
  void light_other_samples() {
    for (int wave = 0; wave < work_count_; wave += pipeline::kBatchLanes) {
      const int lanes_of_wave = std::min(pipeline::kBatchLanes, work_count_ - wave);
      for (int first = 0; first < lanes_of_wave; first += kVectorLanes) light_work(wave + first, first);
      lanes::end_wave(g_, lanes_of_wave);
    }
  }

  void light_work(int begin, int first_lane) {
    HWY_ALIGN std::int32_t x[kVectorLanes], y[kVectorLanes], sample[kVectorLanes], valid[kVectorLanes];
    HWY_ALIGN float ox[kVectorLanes], oy[kVectorLanes];
    for (int lane = 0; lane < kVectorLanes; ++lane) {
      const Item item = work_[std::min(begin + lane, work_count_ - 1)];
      const pipeline::SamplePosition p = u_.positions[static_cast<std::size_t>(item.sample)];
      x[lane] = item.x;
      y[lane] = item.y;
      sample[lane] = item.sample;
      valid[lane] = begin + lane < work_count_ ? 1 : 0;
      ox[lane] = static_cast<float>(p.x) * 0.0625f;
      oy[lane] = static_cast<float>(p.y) * 0.0625f;
    }
    const LaneI samples = lanes::load(sample);
    ComputeLanes s(g_, first_lane, lanes::load(x), lanes::load(y), samples, lanes::load(valid) == LaneI(1));
    s.branch(kOtherSampleBlock, s.valid(), [&]() HWY_ATTR {
      const auto color = light_at<kEncoding>(s, u_, points_, samples, lanes::load(ox), lanes::load(oy));
      if (means())
        add_to_means(s.pixel_x(), s.pixel_y(), color, s.valid());
      else
        s.store_image(0, s.pixel_x(), s.pixel_y(), samples, color, s.valid());
    });
  }

  struct Item {
    std::int32_t x, y, sample;
  };
  pipeline::GroupBatch& g_;
  const DeferredUniforms& u_;
  int x0_, y0_;
  float near_ = 0.0f, far_ = 0.0f;  // view z of the tile's nearest and farthest sample
  std::vector<pipeline::PointLight> points_;
  int work_count_ = 0;
  Item work_[kWaveTilePx * kWaveTilePx * 31];
  float sums_[3][kWaveTilePx * kWaveTilePx] = {};  ///< colors of complex pixels
};

template <GBufferEncoding kEncoding>
void run_tile(pipeline::GroupBatch& group, const void* uniforms) {
  TileLighter<kEncoding>(group, *static_cast<const DeferredUniforms*>(uniforms)).run();
}

void run_tile_light(GBufferEncoding encoding, pipeline::GroupBatch& group, const void* uniforms) {
  switch (encoding) {
    case GBufferEncoding::gradients:
      return run_tile<GBufferEncoding::gradients>(group, uniforms);
    case GBufferEncoding::record:
      return run_tile<GBufferEncoding::record>(group, uniforms);
    case GBufferEncoding::compact:
      return run_tile<GBufferEncoding::compact>(group, uniforms);
    case GBufferEncoding::split:
      return run_tile<GBufferEncoding::split>(group, uniforms);
  }
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_tile_light);

template <GBufferEncoding kEncoding>
pipeline::ComputeProgram describe(bool extended, bool means) {
  return HWY_NAMESPACE::describe_tile_light<kEncoding>(extended, means,
                                                       [](pipeline::GroupBatch& g, const void* u) {
                                                         HWY_DYNAMIC_DISPATCH(run_tile_light)
                                                         (kEncoding, g, u);
                                                       });
}

template <GBufferEncoding kEncoding>
const pipeline::ComputeProgram& program_of(bool extended, bool means) {
  static const pipeline::ComputeProgram programs[] = {
      describe<kEncoding>(false, false), describe<kEncoding>(true, false), describe<kEncoding>(false, true),
      describe<kEncoding>(true, true)};
  return programs[(means ? 2 : 0) + (extended ? 1 : 0)];
}

const pipeline::ComputeProgram& tile_light_program(GBufferEncoding encoding, bool extended, bool means) {
  switch (encoding) {
    case GBufferEncoding::gradients:
      return program_of<GBufferEncoding::gradients>(extended, means);
    case GBufferEncoding::record:
      return program_of<GBufferEncoding::record>(extended, means);
    case GBufferEncoding::compact:
      return program_of<GBufferEncoding::compact>(extended, means);
    case GBufferEncoding::split:
      return program_of<GBufferEncoding::split>(extended, means);
  }
  return program_of<GBufferEncoding::gradients>(extended, means);
}

}  // namespace hwsim::algos
#endif
