// Per-pixel lists of what critical triangles contribute (techniques 5.4).
#include <array>

#include "algos/shaders/sss.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/shaders/sss_lists.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/shaders/sss_composite-inl.h"
#include "algos/shaders/sss_geometry-inl.h"
#include "algos/shaders/sss_pixel-inl.h"
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
  template <class F>
  static F fitting_grid(F highlight_px) {
    return select(highlight_px < F(0.25f), F(8.0f), select(highlight_px < F(1.0f), F(4.0f), F(2.0f)));
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
    const F step = F(256.0f) / grid, places = grid * grid;
    F covered(0.0f);
    s.loop_each(kSampleBlock, to_int(places), s.valid(), [&](int i, typename S::M left) HWY_ATTR {
      const Vec2<F> p = place(i, grid, step);
      covered = covered + select(left & t.covers(p.x, p.y), F(1.0f), F(0.0f));
    });
    const auto reached = s.active() & (covered > F(0.0f));
    s.discard(!reached);
    s.branch(kCriticalBlock, reached, [&]() HWY_ATTR {
      const I in_front = samples_behind(s, u, t, s.flat_attr(kTriangle + kBias));
      const SeenPart<F> part = light_seen(s, u, t, grid, step, in_front, reached);
      const auto seen = reached & (part.places > F(0.0f));
      const F share = F(1.0f) / max(part.places, F(1.0f));
      const F z = t.depth(part.sum_x * share, part.sum_y * share);
      store_node(s, u, pack_color<S>(u, part.sum * share, part.places * (F(64.0f) / places)), z, seen);
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

  /// Centers of a regular grid over the pixel.
  template <class F>
  static Vec2<F> place(int i, F grid, F step) {
    const F index(static_cast<float>(i));
    const F row = floor((index + F(0.5f)) / grid);
    return {(index - row * grid + F(0.5f)) * step, (row + F(0.5f)) * step};
  }

  /// A bit for each of the frame's samples that the triangle's plane is not behind of.
  template <class S, class F>
  static typename S::I samples_behind(S& s, const SssUniforms& u, const PixelTriangle<F>& t, F bias) {
    using I = typename S::I;
    I bits(0);
    for (int k = 0; k < kSssBaseSamples; ++k) {
      const auto at = [&](std::int32_t digits)
                          HWY_ATTR { return F(16.0f * static_cast<float>(digits >> (4 * k) & 15)); };
      const F z = t.depth(at(u.samples_x), at(u.samples_y)) - bias;
      const F scene = s.load_image(kSssDepthSlot, s.pixel_x(), s.pixel_y(), I(k)).x;
      bits = bits | select(z > scene, I(0), I(1 << k));
    }
    return bits;
  }

  /// The covered places that are seen: how many, the sums of where they are and of their light.
  template <class F>
  struct SeenPart {
    F places, sum_x, sum_y;
    Vec3<F> sum;
  };

  template <class S, class F, class I>
  static SeenPart<F> light_seen(S& s, const SssUniforms& u, const PixelTriangle<F>& t, F grid, F step,
                                I in_front, typename S::M reached) {
    std::array<F, static_cast<std::size_t>(3 * attribute_count(kVertex))> values;
    for (int v = 0; v < 3; ++v)
      for (int k = 0; k < attribute_count(kVertex); ++k)
        values[static_cast<std::size_t>(v * attribute_count(kVertex) + k)] =
            s.flat_attr(v * corner_scalars(kVertex) + 4 + k);
    const F zero(0.0f);
    SeenPart<F> part = {zero, zero, zero, {zero, zero, zero}};
    s.loop_each(kShadeBlock, to_int(grid * grid), reached, [&](int i, typename S::M left) HWY_ATTR {
      const Vec2<F> p = place(i, grid, step);
      const I near = near_sample<F, I>(u, p.x * F(1.0f / 256.0f), p.y * F(1.0f / 256.0f)).number;
      const auto open = I(0) < (lanes::shift_right_by(in_front, near) & I(1));
      const auto inside = left & open & t.covers(p.x, p.y);
      s.branch(kStoreBlock, inside, [&]() HWY_ATTR {
        SurfacePoint<S> point(s);
        set_point(t, values, p, point);
        const Vec3<F> c = light_point(s, u, point, kVertex, inside);
        part.sum = select(inside, part.sum + c, part.sum);
        const F one = select(inside, F(1.0f), F(0.0f));
        part.places = part.places + one;
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
  static void store_node(S& s, const SssUniforms& u, const NodeColor<S>& color, F z, typename S::M seen) {
    using I = typename S::I;
    using T = TechniqueCounters;
    const I number = s.atomic_add(kSssCounterBuffer, I(0), I(1), seen);
    const auto room = seen & (number < I(u.capacity_nodes));
    s.count(&T::sss_stored_fragments, room);
    s.count(&T::sss_dropped_fragments, seen & !room);
    const I pixel = s.pixel_y() * I(u.width_px) + s.pixel_x();
    const I next = s.atomic_exchange(kSssHeadBuffer, pixel, number, room);
    const I at = number * I(u.node_words);
    s.store_buffer(kSssNodeBuffer, at, float_to_bits(z), room);
    s.store_buffer(kSssNodeBuffer, at + I(1), next, room);
    s.store_buffer(kSssNodeBuffer, at + I(2), color.words[0], room);
    s.uniform_branch(kHighlightSunBlock, u.node_words == 4,
                     [&]() HWY_ATTR { s.store_buffer(kSssNodeBuffer, at + I(3), color.words[1], room); });
  }
};

/// Front to back: sorted by depth, ties by color, so that the order of insertion does not show.
struct ListResolveShader {
  using Uniforms = SssUniforms;
  static constexpr int kMost = 64;
  enum Block : int { kRead = 1, kSort = 2, kBlend = 3, kLong = 4 };

  template <class S>
  static void run(S& s, const SssUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    Nodes<S> nodes;
    const int read = read_list(s, u, nodes);
    const F zero(0.0f);
    F share = zero;
    Vec3<F> sum = {zero, zero, zero};
    for (int i = 0; i < static_cast<int>(s.loop_count(read)); ++i) {
      const auto open = s.active() & (I(i) < nodes.count) & (share < F(1.0f - 1e-4f));
      if (!any(open)) break;
      s.branch(kBlend, open, [&]() HWY_ATTR {
        const Vec4<F> c = unpack_color<S>(u, nodes.color[static_cast<std::size_t>(i)]);
        const F g = select(open, min(c.w, F(1.0f) - share), F(0.0f));
        sum = sum + Vec3<F>{c.x, c.y, c.z} * g;
        share = share + g;
      });
    }
    blend_over_frame(s, u, {sum.x, sum.y, sum.z, share});
  }

 private:
  template <class S>
  struct Nodes {
    std::array<typename S::F, kMost> z;
    std::array<NodeColor<S>, kMost> color;
    typename S::I count;
  };

  template <class S>
  static int read_list(S& s, const SssUniforms& u, Nodes<S>& nodes) {
    using I = typename S::I;
    const I pixel = s.pixel_y() * I(u.width_px) + s.pixel_x();
    I next = s.load_buffer(kSssHeadBuffer, pixel, s.active());
    nodes.count = I(0);
    const int most = static_cast<int>(s.loop_count(std::min(u.list_nodes_max, kMost)));
    int read = 0;
    while (read < most) {
      const auto more = s.active() & (I(-1) < next);
      if (!any(more)) break;
      s.branch(kRead, more, [&]() HWY_ATTR { read_node(s, u, more, read, next, nodes); });
      ++read;
    }
    count_lengths(s, nodes.count, s.active() & (I(-1) < next));
    return read;
  }

  template <class S>
  static void read_node(S& s, const SssUniforms& u, typename S::M more, int read, typename S::I& next,
                        Nodes<S>& nodes) {
    using F = typename S::F;
    using I = typename S::I;
    const I at = next * I(u.node_words);
    F z = bits_to_float(s.load_buffer(kSssNodeBuffer, at, more));
    const I after = s.load_buffer(kSssNodeBuffer, at + I(1), more);
    NodeColor<S> color{{s.load_buffer(kSssNodeBuffer, at + I(2), more), I(0)}};
    s.uniform_branch(kLong, u.node_words == 4,
                     [&]() HWY_ATTR { color.words[1] = s.load_buffer(kSssNodeBuffer, at + I(3), more); });
    // Each lane inserts its node among the `read` that it has: an exchange with every place in turn.
    for (int i = 0; i < static_cast<int>(s.loop_count(read)); ++i)
      s.branch(kSort, more, [&]() HWY_ATTR { exchange(nodes, static_cast<std::size_t>(i), more, z, color); });
    const auto place = static_cast<std::size_t>(read);
    nodes.z[place] = z;
    nodes.color[place] = color;
    nodes.count = nodes.count + select(more, I(1), I(0));
    next = select(more, after, next);
  }

  template <class S, class F>
  static void exchange(Nodes<S>& nodes, std::size_t i, typename S::M more, F& z, NodeColor<S>& color) {
    const NodeColor<S> there = nodes.color[i];
    const F there_z = nodes.z[i];
    const auto same_z = !((z < there_z) | (there_z < z));
    const auto first = (color.words[0] < there.words[0]) |
                       ((color.words[0] == there.words[0]) & (color.words[1] < there.words[1]));
    const auto swap = more & ((z < there_z) | (same_z & first));
    nodes.z[i] = select(swap, z, there_z);
    z = select(swap, there_z, z);
    for (int w = 0; w < 2; ++w) {
      nodes.color[i].words[w] = select(swap, color.words[w], there.words[w]);
      color.words[w] = select(swap, there.words[w], color.words[w]);
    }
  }

  template <class S, class M>
  static void count_lengths(S& s, typename S::I count, M longer) {
    using I = typename S::I;
    using T = TechniqueCounters;
    const auto between = [&](int low, int high)
                             HWY_ATTR { return s.active() & (I(low - 1) < count) & (count < I(high + 1)); };
    s.count(&T::sss_list_1_pixels, between(1, 1));
    s.count(&T::sss_list_2_to_3_pixels, between(2, 3));
    s.count(&T::sss_list_4_to_7_pixels, between(4, 7));
    s.count(&T::sss_list_8_to_15_pixels, between(8, 15));
    s.count(&T::sss_list_16_to_31_pixels, between(16, 31));
    s.count(&T::sss_list_from_32_pixels, between(32, kMost));
    s.count(&T::sss_truncated_pixels, longer);
  }
};

void run_boxes(SssVertex vertex, pipeline::GeometryBatch& b, const void* u) {
  with_vertex(vertex, [&](auto v) HWY_ATTR { lanes::run_geometry_shader<BoxShader<v()>>(b, u); });
}
void run_lists(SssVertex vertex, pipeline::FragmentBatch& b, const void* u) {
  with_vertex(vertex, [&](auto v) HWY_ATTR { lanes::run_fragment_shader<ListShader<v()>>(b, u); });
}
void run_list_resolve(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<ListResolveShader>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_boxes);
HWY_EXPORT(run_lists);
HWY_EXPORT(run_list_resolve);

namespace {
using pipeline::FragmentBatch;
using pipeline::FragmentProgram;
using pipeline::GeometryBatch;
using pipeline::GeometryProgram;
namespace shaders = HWY_NAMESPACE;

template <SssVertex kVertex>
void call_boxes(GeometryBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_boxes)(kVertex, b, u);
}
template <SssVertex kVertex>
void call_lists(FragmentBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_lists)(kVertex, b, u);
}

template <SssVertex kVertex>
FragmentProgram describe_list() {
  FragmentProgram program = pipeline::HWY_NAMESPACE::describe_fragment_shader<shaders::ListShader<kVertex>>(
      "sss_list", call_lists<kVertex>);
  program.varying_scalars = shaders::box_scalars(kVertex);
  return program;
}
}  // namespace

const GeometryProgram& sss_boxes_program(SssVertex vertex) {
  static const auto programs = for_each_vertex([](auto v) {
    return pipeline::HWY_NAMESPACE::describe_geometry_shader<shaders::BoxShader<v()>>("sss_boxes",
                                                                                      call_boxes<v()>);
  });
  return programs[static_cast<std::size_t>(vertex)];
}

const FragmentProgram& sss_list_program(SssVertex vertex) {
  static const auto programs = for_each_vertex([](auto v) { return describe_list<v()>(); });
  return programs[static_cast<std::size_t>(vertex)];
}

const FragmentProgram& sss_list_resolve_program() {
  static const FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<shaders::ListResolveShader>(
          "sss_list_resolve", [](FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_list_resolve)(b, u);
          });
  return program;
}

}  // namespace hwsim::algos
#endif
