// Per-pixel lists of what critical triangles contribute (docs/techniques/sss.md#lists): creation.
#include <array>

#include "algos/sss/shaders/programs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/sss/shaders/lists.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/sss/shaders/geometry-inl.h"
#include "algos/sss/shaders/pixel-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// A box's flat varyings: of each corner x and y in 1/256 px, z, 1/w and attributes; then of the triangle.
constexpr int corner_scalars(SssVertex vertex) { return 4 + attribute_count(vertex); }
enum BoxScalar : int { kArea2 = 0, kGrid = 1, kBias = 2, kSlopeX = 3, kSlopeY = 4, kBoxScalars = 5 };
constexpr int box_scalars(SssVertex vertex) { return 3 * corner_scalars(vertex) + kBoxScalars; }

/// The screen bounding box of a chosen triangle, half a pixel larger on each side; or, where the rasterizer
/// is conservative itself, the triangle.
template <SssVertex kVertex>
struct BoxShader : SssGeometryShader<kVertex, pipeline::GeometryOutput::triangle_strip, 4> {
  template <class S>
  static void run(S& s, const SssUniforms& u) {
    using F = typename S::F;
    BoxShader::for_chosen(
        s, u, [&](const SssCorner<F>(&c)[3], const SssTriangle<F>& t, typename S::M chosen) HWY_ATTR {
          std::array<F, static_cast<std::size_t>(box_scalars(kVertex))> out;
          for (int v = 0; v < 3; ++v) store_corner(s, t, c[v], v, out.data() + v * corner_scalars(kVertex));
          F* of_triangle = out.data() + 3 * corner_scalars(kVertex);
          of_triangle[kArea2] = t.area2;
          of_triangle[kGrid] = u.grid > 0 ? F(static_cast<float>(u.grid)) : fitting_grid(t.highlight_px);
          of_triangle[kBias] = t.depth_bias;
          of_triangle[kSlopeX] = t.depth_slope.x;
          of_triangle[kSlopeY] = t.depth_slope.y;
          emit_box(s, u, c, chosen, std::span<const F>(out));
        });
  }

 private:
  /// 4 or 8: the frame has eight samples a pixel, so fewer places would coarsen edges; and places lie no
  /// farther apart than a highlight is wide.
  template <class F>
  static F fitting_grid(F highlight_px) {
    return select(highlight_px < F(0.25f), F(8.0f), F(4.0f));
  }

  template <class S, class F>
  static void store_corner(S& s, const SssTriangle<F>& t, const SssCorner<F>& c, int v, F* out) {
    out[0] = floor(c.x * F(256.0f) + F(0.5f));
    out[1] = floor(c.y * F(256.0f) + F(0.5f));
    out[2] = c.z;
    out[3] = c.inv_w;
    for (int k = 0; k < attribute_count(kVertex); ++k) {
      const F value = s.attr(v, attribute_place(kVertex, k));
      out[4 + k] = k < 3 ? value * t.facing : value;
    }
  }

  template <class S, class F>
  static void emit_box(S& s, const SssUniforms& u, const SssCorner<F> (&c)[3], typename S::M chosen,
                       std::span<const F> out) {
    if (u.conservative_raster) {
      for (int v = 0; v < 3; ++v)
        s.emit(chosen, {c[v].clip.x * c[v].inv_w, c[v].clip.y * c[v].inv_w, F(0.5f), F(1.0f)}, out);
      return;
    }
    const F half(0.5f), wide(2.0f / static_cast<float>(u.width_px)),
        high(2.0f / static_cast<float>(u.height_px));
    const F left = min(min(c[0].x, c[1].x), c[2].x) - half, right = max(max(c[0].x, c[1].x), c[2].x) + half;
    const F top = min(min(c[0].y, c[1].y), c[2].y) - half, bottom = max(max(c[0].y, c[1].y), c[2].y) + half;
    for (int i = 0; i < 4; ++i)
      s.emit(chosen,
             {(i % 2 == 0 ? left : right) * wide - F(1.0f), F(1.0f) - (i < 2 ? top : bottom) * high, half,
              F(1.0f)},
             out);
  }
};

template <SssVertex kVertex>
struct ListShader {
  using Uniforms = SssUniforms;

  template <class S>
  static void run(S& s, const SssUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    constexpr int kTriangle = 3 * corner_scalars(kVertex);
    const PixelTriangle<F> t = read_triangle(s, kTriangle);
    const F grid = s.flat_attr(kTriangle + kGrid);
    const F places = grid * grid;
    const PixelEdges<F> edges(t);
    PixelPlaces<F> at(grid);
    // The depth goes first, for it spares hidden fragments the loops (docs/techniques/sss.md#lists).
    const OpenSamples<I> samples = open_samples(s, u, t, s.flat_attr(kTriangle + kBias));
    const auto open = I(0) < samples.open;
    auto covered = s.active() & (F(1.0f) < F(0.0f));
    s.loop_each(kSampleBlock, to_int(places), s.valid() & open, [&](int, typename S::M left) HWY_ATTR {
      covered = covered | (left & edges.cover(at.x(), at.y()));
      at.next();
    });
    const auto reached = s.active() & covered;
    s.discard(!reached);
    s.branch(kCriticalBlock, reached, [&]() HWY_ATTR {
      const SeenPart<S> part = light_seen(s, u, t, edges, grid, samples, reached);
      const auto seen = reached & (part.weight > F(0.0f));
      const F share = F(1.0f) / max(part.weight, F(1e-3f));
      F z = t.depth(part.sum_x * share, part.sum_y * share);
      NodeData<S> node = pack_color<S>(u, part.sum * share, part.weight * (F(64.0f) / places));
      if (u.by_place()) {
        z = t.depth(F(16.0f), F(16.0f));  // at the first place's center
        for (int w = 0; w < 2; ++w) node.words[NodeData<S>::kMask + w] = part.mask[w];
        node.words[NodeData<S>::kSlope] = float_to_bits(t.slope_x * F(32.0f));
        node.words[NodeData<S>::kSlope + 1] = float_to_bits(t.slope_y * F(32.0f));
      }
      store_node(s, u, node, z, seen);
    });
  }

 private:
  template <class S>
  static PixelTriangle<typename S::F> read_triangle(S& s, int triangle_at) {
    using F = typename S::F;
    PixelTriangle<F> t;
    const F left = to_float(s.pixel_x()) * F(256.0f), top = to_float(s.pixel_y()) * F(256.0f);
    for (int v = 0; v < 3; ++v) {
      const int at = v * corner_scalars(kVertex);
      t.x[v] = s.flat_attr(at) - left;
      t.y[v] = s.flat_attr(at + 1) - top;
      t.z[v] = s.flat_attr(at + 2);
      t.inv_w[v] = s.flat_attr(at + 3);
    }
    t.area2 = s.flat_attr(triangle_at + kArea2);
    t.slope_x = s.flat_attr(triangle_at + kSlopeX) * F(1.0f / 256.0f);
    t.slope_y = s.flat_attr(triangle_at + kSlopeY) * F(1.0f / 256.0f);
    return t;
  }

  /// A bit for each of the frame's samples.
  template <class I>
  struct OpenSamples {
    I in_front;  ///< the triangle's plane is not behind it
    I open;      ///< or, by place, it is on a sampled triangle itself: the resolve sees which is in front
  };

  template <class S, class F>
  static OpenSamples<typename S::I> open_samples(S& s, const SssUniforms& u, const PixelTriangle<F>& t,
                                                 F bias) {
    using I = typename S::I;
    OpenSamples<I> samples = {I(0), I(0)};
    for (int k = 0; k < kSssBaseSamples; ++k) {
      const auto at = [&](std::int32_t digits)
                          HWY_ATTR { return F(16.0f * static_cast<float>(digits >> (4 * k) & 15)); };
      const F z = t.depth(at(u.samples_x), at(u.samples_y)) - bias;
      const F scene = s.load_image(kSssDepthSlot, s.pixel_x(), s.pixel_y(), I(k)).x;
      samples.in_front = samples.in_front | select(z > scene, I(0), I(1 << k));
      if (!u.by_place()) continue;
      const F marked = s.load_image(u.mark_slot, s.pixel_x(), s.pixel_y(), I(k)).x;
      samples.open = samples.open | select(marked > F(0.5f), I(1 << k), I(0));
    }
    // What is behind all of them, and around them, is far behind (the paper's discard).
    if (u.by_place()) {
      const auto near = (I(0) < samples.in_front) | seen_beside(s, u, t, bias);
      samples.open = select(near, samples.open, I(0));
    }
    samples.open = samples.open | samples.in_front;
    return samples;
  }

  /// Whether the plane is not behind the nearest sample of any pixel around: then an edge between may show it
  /// here.
  template <class S, class F>
  static typename S::M seen_beside(S& s, const SssUniforms& u, const PixelTriangle<F>& t, F bias) {
    using I = typename S::I;
    auto seen = s.active() & (F(0.0f) > F(1.0f));
    for (int k = 0; k < 8; ++k) {
      const int i = k < 4 ? k : k + 1, x = i % 3 - 1, y = i / 3 - 1;
      const int sample = u.neighbor_samples[static_cast<std::size_t>(k)];
      const auto at = [&](std::int32_t digits, int pixel) HWY_ATTR {
        return F(16.0f * static_cast<float>((digits >> (4 * sample) & 15) + 16 * pixel));
      };
      const I px = s.pixel_x() + I(x), py = s.pixel_y() + I(y);
      const auto exists = (I(-1) < px) & (I(-1) < py) & (px < I(u.width_px)) & (py < I(u.height_px));
      const F scene = s.load_image(kSssDepthSlot, max(min(px, I(u.width_px - 1)), I(0)),
                                   max(min(py, I(u.height_px - 1)), I(0)), I(sample))
                          .x;
      seen = seen | (exists & !(t.depth(at(u.samples_x, x), at(u.samples_y, y)) - bias > scene));
    }
    return seen;
  }

  /// The covered places that may be seen, and the sums of where they are and of their light, by weight.
  template <class S>
  struct SeenPart {
    using F = typename S::F;
    F weight, sum_x, sum_y;
    Vec3<F> sum;
    typename S::I mask[2];
  };

  /// A place that only the resolve may show still has a color, but a seen one's counts for more.
  static constexpr float kUnsureWeight = 1.0f / 64.0f;

  template <class S, class F, class I>
  static SeenPart<S> light_seen(S& s, const SssUniforms& u, const PixelTriangle<F>& t,
                                const PixelEdges<F>& edges, F grid, const OpenSamples<I>& samples,
                                typename S::M reached) {
    std::array<F, static_cast<std::size_t>(3 * attribute_count(kVertex))> values;
    for (int v = 0; v < 3; ++v)
      for (int k = 0; k < attribute_count(kVertex); ++k)
        values[static_cast<std::size_t>(v * attribute_count(kVertex) + k)] =
            s.flat_attr(v * corner_scalars(kVertex) + 4 + k);
    const F zero(0.0f);
    SeenPart<S> part = {zero, zero, zero, {zero, zero, zero}, {I(0), I(0)}};
    PixelPlaces<F> at(grid);
    s.loop_each(kShadeBlock, to_int(grid * grid), reached, [&](int i, typename S::M left) HWY_ATTR {
      const Vec2<F> p = {at.x(), at.y()};
      at.next();
      const I near = near_sample<F, I>(u, p.x * F(1.0f / 256.0f), p.y * F(1.0f / 256.0f)).number;
      const auto open = I(0) < (lanes::shift_right_by(samples.open, near) & I(1));
      const auto inside = left & open & edges.cover(p.x, p.y);
      s.branch(kStoreBlock, inside, [&]() HWY_ATTR {
        SurfacePoint<S> point(s);
        set_point(t, values, p, point);
        Vec3<F> c = light_point(s, u, point, kVertex, inside);
        F weight(1.0f);
        if (u.by_place()) {
          const auto sure = I(0) < (lanes::shift_right_by(samples.in_front, near) & I(1));
          weight = select(sure, weight, F(kUnsureWeight));
          c = c * weight;
          add_place(i, grid, inside, part.mask);
        }
        part.sum = select(inside, part.sum + c, part.sum);
        const F one = select(inside, weight, F(0.0f));
        part.weight = part.weight + one;
        part.sum_x = part.sum_x + one * p.x;
        part.sum_y = part.sum_y + one * p.y;
      });
    });
    return part;
  }

  template <class S, class F, std::size_t kValues>
  static void set_point(const PixelTriangle<F>& t, const std::array<F, kValues>& values, const Vec2<F>& p,
                        SurfacePoint<S>& point) {
    using V = pipeline::SurfaceVaryings;
    constexpr int kCount = attribute_count(kVertex);
    const Vec3<F> b = t.barycentric(p.x, p.y);
    const Vec3<F> w = {b.x * t.inv_w[0], b.y * t.inv_w[1], b.z * t.inv_w[2]};
    const F scale = F(1.0f) / (w.x + w.y + w.z);
    point.values.fill(F(0.0f));
    for (int k = 0; k < kCount; ++k) {
      const auto at = [&](int v) HWY_ATTR { return values[static_cast<std::size_t>(v * kCount + k)]; };
      point.values[static_cast<std::size_t>(attribute_place(kVertex, k))] =
          (w.x * at(0) + w.y * at(1) + w.z * at(2)) * scale;
    }
    if constexpr (kVertex == SssVertex::plain) return;
    // A triangle's texture coordinates change for a pixel as on its plane on the screen.
    const auto per_px = [&](int k, F& dx, F& dy) HWY_ATTR {
      const F inv =
          F(256.0f) / ((t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - (t.x[2] - t.x[0]) * (t.y[1] - t.y[0]));
      const F v0 = values[static_cast<std::size_t>(k)];
      const F d1 = values[static_cast<std::size_t>(kCount + k)] - v0,
              d2 = values[static_cast<std::size_t>(2 * kCount + k)] - v0;
      dx = (d1 * (t.y[2] - t.y[0]) - d2 * (t.y[1] - t.y[0])) * inv;
      dy = (d2 * (t.x[1] - t.x[0]) - d1 * (t.x[2] - t.x[0])) * inv;
    };
    per_px(V::kUv0, point.site.du_dx, point.site.du_dy);
    per_px(V::kUv0 + 1, point.site.dv_dx, point.site.dv_dy);
  }

  template <class S, class F>
  static void store_node(S& s, const SssUniforms& u, const NodeData<S>& node, F z, typename S::M seen) {
    using I = typename S::I;
    using T = SssCounters;
    const I number = s.atomic_add(kSssCounterBuffer, I(0), I(1), seen);
    const auto room = seen & (number < I(u.capacity_nodes));
    s.count(T::sss_stored_fragments, room);
    s.count(T::sss_dropped_fragments, seen & !room);
    const I pixel = s.pixel_y() * I(u.width_px) + s.pixel_x();
    const I next = s.atomic_exchange(kSssHeadBuffer, pixel, number, room);
    const I at = number * I(u.node_words);
    s.store_buffer(kSssNodeBuffer, at, float_to_bits(z), room);
    s.store_buffer(kSssNodeBuffer, at + I(1), next, room);
    s.store_buffer(kSssNodeBuffer, at + I(2), node.words[0], room);
    s.uniform_branch(kHighlightSunBlock, u.node_words > 3,
                     [&]() HWY_ATTR { s.store_buffer(kSssNodeBuffer, at + I(3), node.words[1], room); });
    if (u.by_place())
      for (int w = 2; w < NodeData<S>::kWords; ++w)
        s.store_buffer(kSssNodeBuffer, at + I(w + 2), node.words[w], room);
  }
};

void run_boxes(SssVertex vertex, pipeline::GeometryBatch& b, const void* u) {
  with_vertex(vertex, [&](auto v) HWY_ATTR { lanes::run_geometry_shader<BoxShader<v()>>(b, u); });
}
void run_lists(SssVertex vertex, pipeline::FragmentBatch& b, const void* u) {
  with_vertex(vertex, [&](auto v) HWY_ATTR { lanes::run_fragment_shader<ListShader<v()>>(b, u); });
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_boxes);
HWY_EXPORT(run_lists);

namespace {

template <SssVertex kVertex>
pipeline::FragmentProgram describe_list(bool by_place, bool extended) {
  SssUniforms u;
  u.lighting.extended = extended;
  u.node_words = by_place ? kSssPlaceNodeWords : 4;
  pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::ListShader<kVertex>>(
          by_place ? "sss_place_list" : "sss_list",
          [](pipeline::FragmentBatch& b, const void* uniforms) {
            HWY_DYNAMIC_DISPATCH(run_lists)(kVertex, b, uniforms);
          },
          u);
  program.varying_scalars = HWY_NAMESPACE::box_scalars(kVertex);
  return program;
}
}  // namespace

const pipeline::GeometryProgram& sss_boxes_program(SssVertex vertex) {
  static const auto programs = for_each_vertex([](auto v) {
    return pipeline::HWY_NAMESPACE::describe_geometry_shader<HWY_NAMESPACE::BoxShader<v()>>(
        "sss_boxes", [](pipeline::GeometryBatch& b, const void* u) {
          HWY_DYNAMIC_DISPATCH(run_boxes)(decltype(v)::value, b, u);
        });
  });
  return programs[static_cast<std::size_t>(vertex)];
}

const pipeline::FragmentProgram& sss_list_program(SssVertex vertex, bool by_place, bool extended) {
  static const auto of = [](bool places, bool more) {
    return for_each_vertex([&](auto v) { return describe_list<v()>(places, more); });
  };
  static const std::array programs = {of(false, false), of(true, false), of(false, true), of(true, true)};
  return programs[(by_place ? 1u : 0u) + (extended ? 2u : 0u)][static_cast<std::size_t>(vertex)];
}

}  // namespace hwsim::algos
#endif
