// Definition of the aggregates (the paper's Algorithm 1).
#include "algos/agaa/shaders/programs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/agaa/shaders/compute.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/agaa/shaders/pixel_groups-inl.h"
#include "algos/agaa/shaders/record-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

enum DefineBlock : int {
  kReadBlock = 1,       // a sample's depth and normal
  kFirstSeedBlock = 2,  // a sample against the mean
  kSumBlock = 3,        // a sample against a new seed
  kSeedBlock = 4,       // a further seed
  kFarthestBlock = 5,   // a sample's sum against the farthest
  kApartBlock = 6,      // a candidate against a seed
  kAssignBlock = 7,     // a sample
  kNearestBlock = 8,    // a sample against a seed
  kStoreBlock = 9,      // a word of codes
  kSamplesBlock = 10,   // a pixel whose samples are clustered one by one
  kTileBlock = 11,      // the planes of a layer's tile
  kPlaneBlock = 12,     // a pixel against one of them
  kOnPlaneBlock = 13,   // a sample against a plane
  kCodeBlock = 14       // the code of a sample on a plane
};

template <class F>
struct SurfaceSample {
  Vec3<F> position;  ///< view space: relative to the camera, so that large scenes keep their precision
  Vec3<F> normal;    ///< in the pixel's basis
};

template <class M, class F>
SurfaceSample<F> pick(M mask, const SurfaceSample<F>& a, const SurfaceSample<F>& b) {
  return {select(mask, a.position, b.position), select(mask, a.normal, b.normal)};
}

/// Clusters the samples of one pixel.
template <class S>
class Clusters {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;

  Clusters(S& s, const DefineUniforms& u) : s_(s), u_(u) {}

  void run() {
    // Not held as planes, or as more than aggregates (docs/techniques/agaa.md#depth-planes): by samples.
    bool by_planes = kCounting<S> || u_.reads_planes;
    s_.loop(kTileBlock, u_.reads_planes ? u_.layers : 0, s_.valid(),
            [&](int layer) HWY_ATTR { by_planes = by_planes && find_planes(layer); });
    if (by_planes) cluster_planes();
    s_.uniform_branch(kSamplesBlock, !by_planes, [&]() HWY_ATTR { cluster_samples(); });
    store_codes();
  }

 private:
  void cluster_samples() {
    read();
    find_first_seed();
    for (int j = 1; j < u_.aggregates; ++j) find_seed(j);
    assign();
    if constexpr (!kCounting<S>) count_plane_splits();
  }

  /// Adds the planes of a layer's tile that are no background; whether all so far are at most as many as
  /// aggregates. A triangle's plane is the same in all layers, but for the shifts of their viewports.
  bool find_planes(int layer) {
    int all = 0;
    if constexpr (kCounting<S>)
      all = s_.tile_plane_count();
    else
      all = s_.tile_plane_count(layer);
    const int first = layer * pipeline::kMaxDepthPlanes;
    for (int plane = first; plane < first + all; ++plane) {
      if (s_.tile_plane_is_far(plane)) continue;
      const int found = find_plane(plane, layer);
      if (found == u_.aggregates) return false;
      const auto index = static_cast<std::size_t>(found);
      if (found == planes_) {
        plane_[index] = plane;
        in_layer_[index].fill(-1);
        ++planes_;
      }
      in_layer_[index][static_cast<std::size_t>(layer)] = plane;
    }
    return all > 0;
  }

  /// Which of the planes so far it is, their number if none: a wave's work, not its lanes'.
  int find_plane(int plane, int layer) {
    if constexpr (!kCounting<S>)
      for (int a = 0; a < planes_ && layer > 0; ++a) {
        const int known = plane_[static_cast<std::size_t>(a)];
        if (s_.is_moved_tile_plane(known, plane, shift(layer) - shift(known / pipeline::kMaxDepthPlanes)))
          return a;
      }
    return planes_;
  }

  glm::vec2 shift(int layer) const { return u_.layer_shift_px[static_cast<std::size_t>(layer)]; }

  /// Pixels whose sample, of all layers' together, lies on the plane of an aggregate.
  M on_plane(std::size_t aggregate, int sample) {
    const int of_layer = u_.samples / u_.layers;
    const int plane = in_layer_[aggregate][static_cast<std::size_t>(sample / of_layer)];
    return plane < 0 ? F(1.0f) < F(0.0f) : s_.in_tile_plane(plane, sample % of_layer);
  }

  /// A plane where its samples lie in the pixel: their mean place, and the plane's normal in view space.
  SurfaceSample<F> place_on_plane(std::size_t aggregate, F& held) {
    F count(0.0f), dx(0.0f), dy(0.0f);
    s_.loop(kOnPlaneBlock, u_.samples, s_.valid(), [&](int i) HWY_ATTR {
      const pipeline::SamplePosition p = u_.positions[static_cast<std::size_t>(i)];
      const F one = select(on_plane(aggregate, i), F(1.0f), F(0.0f));
      count = count + one;
      dx = dx + one * F(static_cast<float>(p.x) * 0.0625f);
      dy = dy + one * F(static_cast<float>(p.y) * 0.0625f);
    });
    const F share = F(1.0f) / max(count, F(1.0f));
    const F x = to_float(s_.pixel_x()) + F(0.5f) + dx * share,
            y = to_float(s_.pixel_y()) + F(0.5f) + dy * share;
    const int plane = plane_[aggregate];
    const glm::vec2 moved = shift(plane / pipeline::kMaxDepthPlanes);
    const auto at = [&](F px, F py) HWY_ATTR {
      return unproject(px, py, s_.tile_plane_depth(plane, px + F(moved.x), py + F(moved.y)));
    };
    SurfaceSample<F> place;
    place.position = at(x, y);
    const Vec3<F> across = at(x + F(1.0f), y) - place.position, down = at(x, y + F(1.0f)) - place.position;
    const Vec3<F> normal = cross(down, across);  // toward the eye: y goes down on the screen
    place.normal = normal * rsqrt(max(dot(normal, normal), F(1e-30f)));
    held = count;
    return place;
  }

  // Aggregate i is plane i, unless it comes too near to another one: both paths then behave alike where
  // surfaces lie apart.
  void cluster_planes() {
    if (planes_ == 0) return;  // background alone
    M covered = F(1.0f) < F(0.0f);
    inv_k2_ = F(u_.inv_k2);
    std::array<I, 4> code{};
    const auto count = static_cast<std::size_t>(planes_);
    I made(0);
    s_.loop(kPlaneBlock, planes_, s_.valid(), [&](int index) HWY_ATTR {
      const auto a = static_cast<std::size_t>(index);
      F held;
      seed_[a] = place_on_plane(a, held);
      M own = held > F(0.5f);
      covered = covered | own;
      code[a] = made;
      if (u_.footprint_k > 0.0f) grow_k(seed_[a].position.z);
      for (std::size_t b = 0; b < a; ++b) {
        const M joins = own & exists_[b] & (distance(seed_[a], seed_[b]) < F(u_.separation));
        code[a] = select(joins, code[b], code[a]);
        own = own & !joins;
      }
      exists_[a] = own;
      made = made + select(own, I(1), I(0));
      s_.count(AgaaCounters::agaa_aggregates, own);
    });
    const int bits = u_.code_bits;
    s_.loop(kCodeBlock, u_.samples, s_.valid(), [&](int i) HWY_ATTR {
      I of(0);
      for (std::size_t a = 1; a < count; ++a) of = select(on_plane(a, i), code[a], of);
      const auto word = static_cast<std::size_t>(i / 8);
      words_[word] = words_[word] + of * I(1 << (i % 8 * bits));
    });
    s_.count(AgaaCounters::agaa_plane_path_pixels, s_.valid() & covered);
  }

  // Equation 1.
  F distance(const SurfaceSample<F>& a, const SurfaceSample<F>& b) const {
    const Vec3<F> d = a.position - b.position;
    return dot(d, d) * inv_k2_ + (F(1.0f) - dot(a.normal, b.normal)) * F(0.5f);
  }

  void read() {
    Vec3<F> position_sum = {F(0.0f), F(0.0f), F(0.0f)}, normal_sum = position_sum;
    F count(0.0f);
    const I x = s_.pixel_x(), y = s_.pixel_y();
    s_.loop(kReadBlock, u_.samples, s_.valid(), [&](int i) HWY_ATTR {
      const auto n = static_cast<std::size_t>(i);
      const F z = s_.load_image(0, x, y, I(i)).x;
      const auto code = s_.load_image(1, x, y, I(i));
      visible_[n] = z < F(1.0f);  // samples of the sky belong to no aggregate
      sample_[n].position = unproject(x, y, u_.positions[n], z);
      sample_[n].normal = decode_pixel_normal(code.x, code.y);
      const M first = visible_[n] & (count < F(0.5f));
      first_ = pick(first, sample_[n], first_);
      const F one = select(visible_[n], F(1.0f), F(0.0f));
      count = count + one;
      position_sum = position_sum + sample_[n].position * one;
      normal_sum = normal_sum + sample_[n].normal * one;
    });
    covered_ = s_.valid() & (count > F(0.5f));
    running_ = u_.empty_exit ? covered_ : s_.valid();
    const F share = F(1.0f) / max(count, F(1.0f));
    mean_.position = position_sum * share;
    mean_.normal = normal_sum * share;
    const F length2 = dot(mean_.normal, mean_.normal);
    if (u_.unit_mean_normal) mean_.normal = mean_.normal * rsqrt(max(length2, F(1e-12f)));
    mean_.normal = select(length2 < F(1e-12f), first_.normal, mean_.normal);
    inv_k2_ = F(u_.inv_k2);
    if (u_.footprint_k > 0.0f) grow_k(mean_.position.z);
  }

  // k grows with the pixel's footprint.
  void grow_k(F view_z) {
    const F distance = u_.perspective ? F(0.0f) - view_z : F(1.0f);
    const F k = F(u_.footprint_k) * distance;
    inv_k2_ = min(F(u_.inv_k2), F(1.0f) / max(k * k, F(1e-20f)));
  }

  Vec3<F> unproject(I x, I y, pipeline::SamplePosition p, F z) const {
    const F px = to_float(x) + F(0.5f + static_cast<float>(p.x) * 0.0625f);
    const F py = to_float(y) + F(0.5f + static_cast<float>(p.y) * 0.0625f);
    return unproject(px, py, z);
  }
  Vec3<F> unproject(F px, F py, F z) const {
    const F ndc_x = px * F(2.0f / static_cast<float>(u_.width)) - F(1.0f);
    const F ndc_y = F(1.0f) - py * F(2.0f / static_cast<float>(u_.height));
    const glm::mat4& m = u_.view_from_clip;  // a projection's inverse: x and y apart, z and w of z alone
    const F inv_w = F(1.0f) / (F(m[2][3]) * z + F(m[3][3]));
    return {(F(m[0][0]) * ndc_x + F(m[3][0])) * inv_w, (F(m[1][1]) * ndc_y + F(m[3][1])) * inv_w,
            (F(m[2][2]) * z + F(m[3][2])) * inv_w};
  }

  void find_first_seed() {
    F farthest(-1.0f);
    s_.loop(kFirstSeedBlock, u_.samples, running_, [&](int i) HWY_ATTR {
      const auto n = static_cast<std::size_t>(i);
      const F d = distance(sample_[n], mean_);
      const M better = visible_[n] & (d > farthest);
      farthest = select(better, d, farthest);
      seed_[0] = pick(better, sample_[n], seed_[0]);
    });
    exists_[0] = covered_;
    add_distances(0, running_);
    s_.count(AgaaCounters::agaa_aggregates, covered_);
  }

  // Over the seeds so far: the distance to the nearest one, or sums; for the first seed all are its distance.
  void add_distances(int seed, M mask) {
    s_.loop(kSumBlock, u_.samples, mask, [&](int i) HWY_ATTR {
      const auto n = static_cast<std::size_t>(i);
      F d = distance(sample_[n], seed_[static_cast<std::size_t>(seed)]);
      if (u_.seeds == SeedRule::square_sums) d = d * d;
      far_[n] = seed == 0 ? d : u_.seeds == SeedRule::farthest ? min(far_[n], d) : far_[n] + d;
    });
  }

  // The sample farthest from the seeds, unless it is too near to one of them. By sums that ends the search
  // early: the largest one lies at an extreme of the pixel, where a seed is already.
  void find_seed(int j) {
    const auto index = static_cast<std::size_t>(j);
    const M open = exists_[index - 1];
    exists_[index] = F(1.0f) < F(0.0f);
    // Where the search ended, nothing is tried; that a pixel is empty is not asked before the second seed.
    const M tried = j == 1 ? running_ : open;
    s_.branch(kSeedBlock, tried, [&]() HWY_ATTR {
      F farthest(-1.0f);
      SurfaceSample<F> candidate = first_;
      s_.loop(kFarthestBlock, u_.samples, tried, [&](int i) HWY_ATTR {
        const auto n = static_cast<std::size_t>(i);
        const M better = visible_[n] & (far_[n] > farthest);
        farthest = select(better, far_[n], farthest);
        candidate = pick(better, sample_[n], candidate);
      });
      M apart = open;
      s_.loop(kApartBlock, j, tried, [&](int i) HWY_ATTR {
        apart = apart & !(distance(candidate, seed_[static_cast<std::size_t>(i)]) < F(u_.separation));
      });
      seed_[index] = candidate;
      exists_[index] = apart;
      if (j + 1 < u_.aggregates) add_distances(j, apart);
      s_.count(AgaaCounters::agaa_aggregates, apart);
    });
  }

  void assign() {
    const int bits = u_.code_bits;
    if (bits == 0) return;
    s_.loop(kAssignBlock, u_.samples, running_, [&](int i) HWY_ATTR {
      const auto n = static_cast<std::size_t>(i);
      F nearest(1e30f);
      I code(0);
      s_.loop(kNearestBlock, u_.aggregates, running_, [&](int a) HWY_ATTR {
        const auto seed = static_cast<std::size_t>(a);
        const F d = distance(sample_[n], seed_[seed]);
        const M nearer = exists_[seed] & (d < nearest);
        nearest = select(nearer, d, nearest);
        code = select(nearer, I(a), code);
      });
      code = select(visible_[n] & covered_, code, I(0));
      words_[n / 8] = words_[n / 8] + code * I(1 << (i % 8 * bits));
    });
  }

  void store_codes() {
    if (u_.code_bits == 0) return;
    s_.loop(kStoreBlock, (u_.samples + 7) / 8, s_.valid(), [&](int i) HWY_ATTR {
      const F word = to_float(words_[static_cast<std::size_t>(i)]);
      s_.store_image(0, s_.pixel_x(), s_.pixel_y(), I(i), {word, F(0.0f), F(0.0f), F(0.0f)}, s_.valid());
    });
  }

  // Pixels in which one plane became several aggregates: same normal, and positions that lie in its plane.
  // What compressed depth planes would have told. For counters alone.
  void count_plane_splits() {
    if (u_.aggregates < 2) return;
    M plane = exists_[1];
    F out(0.0f), across(0.0f);
    for (int i = 0; i < u_.samples; ++i) {
      const auto n = static_cast<std::size_t>(i);
      plane = plane & ((!visible_[n]) | (dot(sample_[n].normal, first_.normal) > F(0.9999f)));
      const Vec3<F> d = (sample_[n].position - mean_.position) * select(visible_[n], F(1.0f), F(0.0f));
      across = max(across, dot(d, d));
    }
    // The normals' basis is the pixel's, positions are the camera's: the plane's own normal comes from three
    // samples.
    const Vec3<F> a = sample_[1].position - sample_[0].position,
                  b = sample_[2].position - sample_[0].position;
    const Vec3<F> normal = normalize(cross(a, b));
    for (int i = 0; i < u_.samples; ++i) {
      const auto n = static_cast<std::size_t>(i);
      plane = plane & visible_[n];
      out = max(out, abs(dot(sample_[n].position - sample_[0].position, normal)));
    }
    s_.count(AgaaCounters::agaa_plane_split_pixels, plane & (out * out < across * F(1e-4f)));
  }

  S& s_;
  const DefineUniforms& u_;
  std::array<SurfaceSample<F>, 32> sample_;
  std::array<M, 32> visible_;
  std::array<F, 32> far_;
  SurfaceSample<F> first_{}, mean_{};
  std::array<SurfaceSample<F>, 4> seed_{};
  std::array<M, 4> exists_;
  M covered_;
  M running_;  ///< pixels whose samples are clustered
  F inv_k2_;
  std::array<I, 4> words_ = {I(0), I(0), I(0), I(0)};  ///< the codes
  int planes_ = 0;
  std::array<int, 4> plane_{};                    ///< one of each aggregate, in the first layer that has it
  std::array<std::array<int, 4>, 4> in_layer_{};  ///< the same in each layer; -1: not there
};

struct DefineShader {
  using Uniforms = DefineUniforms;
  template <class S>
  static void run(S& s, const DefineUniforms& u) {
    Clusters<S>(s, u).run();
  }
};

void run_define(pipeline::GroupBatch& group, const void* u) { run_pixel_group<DefineShader>(group, u); }

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_define);

const pipeline::ComputeProgram& agaa_define_program() {
  static const pipeline::ComputeProgram program =
      HWY_NAMESPACE::describe_pixel_groups<HWY_NAMESPACE::DefineShader>(
          "agaa_define", [](pipeline::GroupBatch& g, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_define)
            (g, u);
          });
  return program;
}

}  // namespace hwsim::algos
#endif
