// Per-pixel lists of what critical triangles contribute (docs/techniques/sss.md#lists): their resolve.
#include <array>

#include "algos/sss/shaders/programs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/sss/shaders/list_resolve.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/sss/shaders/composite-inl.h"
#include "algos/sss/shaders/pixel-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// What is in front. Ties go by color, so that the order of insertion does not show.
struct ListResolveShader {
  using Uniforms = SssUniforms;
  static constexpr int kMost = 64;
  enum Block : int { kRead = 1, kSort = 2, kBlend = 3, kLong = 4 };

  template <class S>
  static void run(S& s, const SssUniforms& u) {
    Nodes<S> nodes;
    const int read = read_list(s, u, nodes);
    blend_over_frame(s, u, u.by_place() ? front_places(s, u, nodes, read) : front_to_back(s, u, nodes, read));
  }

 private:
  template <class S>
  struct Nodes {
    std::array<typename S::F, kMost> z;
    std::array<NodeData<S>, kMost> data;
    typename S::I count;
  };

  /// By the depths of whole nodes (the paper's 4.3.2).
  template <class S>
  static Vec4<typename S::F> front_to_back(S& s, const SssUniforms& u, const Nodes<S>& nodes, int read) {
    using F = typename S::F;
    using I = typename S::I;
    const F zero(0.0f);
    Vec4<F> sum = {zero, zero, zero, zero};
    for (int i = 0; i < static_cast<int>(s.loop_count(read)); ++i) {
      const auto open = s.active() & (I(i) < nodes.count) & (sum.w < F(1.0f - 1e-4f));
      if (!any(open)) break;
      s.branch(kBlend, open, [&]() HWY_ATTR {
        const Vec4<F> c = unpack_color<S>(u, nodes.data[static_cast<std::size_t>(i)]);
        const F g = select(open, min(c.w, F(1.0f) - sum.w), zero);
        sum = sum + Vec4<F>{c.x * g, c.y * g, c.z * g, g};
      });
    }
    return sum;
  }

  /// At each place the nearest of the nodes that have it, ties by color.
  template <class S>
  static Vec4<typename S::F> front_places(S& s, const SssUniforms& u, const Nodes<S>& nodes, int read) {
    using F = typename S::F;
    using I = typename S::I;
    const F zero(0.0f), part(1.0f / 64.0f);
    Vec4<F> sum = {zero, zero, zero, zero};
    s.loop(kBlend, 64, s.active() & (I(0) < nodes.count), [&](int place) HWY_ATTR {
      const F x(static_cast<float>(place % 8)), y(static_cast<float>(place / 8));
      F nearest(1e30f), covered = zero;
      NodeData<S> best = {{I(0), I(0), I(0), I(0), I(0), I(0)}};
      for (int i = 0; i < static_cast<int>(s.loop_count(read)); ++i) {
        const auto exists = s.active() & (I(i) < nodes.count);
        if (!any(exists)) break;
        s.branch(kSort, exists, [&]() HWY_ATTR {
          const NodeData<S>& node = nodes.data[static_cast<std::size_t>(i)];
          const F z = nodes.z[static_cast<std::size_t>(i)] +
                      bits_to_float(node.words[NodeData<S>::kSlope]) * x +
                      bits_to_float(node.words[NodeData<S>::kSlope + 1]) * y;
          const I word = node.words[NodeData<S>::kMask + place / 32];
          const auto has = exists & ((word & I(static_cast<std::int32_t>(1u << (place % 32)))) != I(0));
          const auto nearer = has & ((z < nearest) | ((!(nearest < z)) & color_before(node, best)));
          nearest = select(nearer, z, nearest);
          covered = select(nearer, part, covered);
          for (int w = 0; w < 2; ++w) best.words[w] = select(nearer, node.words[w], best.words[w]);
        });
      }
      const Vec4<F> c = unpack_color<S>(u, best);
      sum = sum + Vec4<F>{c.x * covered, c.y * covered, c.z * covered, covered};
    });
    return sum;
  }

  template <class S>
  static auto color_before(const NodeData<S>& a, const NodeData<S>& b) {
    return (a.words[0] < b.words[0]) | ((a.words[0] == b.words[0]) & (a.words[1] < b.words[1]));
  }

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
    NodeData<S> data{{s.load_buffer(kSssNodeBuffer, at + I(2), more), I(0), I(0), I(0), I(0), I(0)}};
    s.uniform_branch(kLong, u.node_words > 3,
                     [&]() HWY_ATTR { data.words[1] = s.load_buffer(kSssNodeBuffer, at + I(3), more); });
    if (u.by_place())
      for (int w = 2; w < NodeData<S>::kWords; ++w)
        data.words[w] = s.load_buffer(kSssNodeBuffer, at + I(w + 2), more);
    // Each lane inserts its node among the `read` that it has: an exchange with every place in turn.
    for (int i = 0; i < (u.by_place() ? 0 : static_cast<int>(s.loop_count(read))); ++i)
      s.branch(kSort, more, [&]() HWY_ATTR { exchange(nodes, static_cast<std::size_t>(i), more, z, data); });
    const auto place = static_cast<std::size_t>(read);
    nodes.z[place] = z;
    nodes.data[place] = data;
    nodes.count = nodes.count + select(more, I(1), I(0));
    next = select(more, after, next);
  }

  template <class S, class F>
  static void exchange(Nodes<S>& nodes, std::size_t i, typename S::M more, F& z, NodeData<S>& data) {
    NodeData<S>& there = nodes.data[i];
    const F there_z = nodes.z[i];
    const auto same_z = !((z < there_z) | (there_z < z));
    const auto swap = more & ((z < there_z) | (same_z & color_before(data, there)));
    nodes.z[i] = select(swap, z, there_z);
    z = select(swap, there_z, z);
    for (int w = 0; w < 2; ++w) {
      const auto word = there.words[w];
      there.words[w] = select(swap, data.words[w], word);
      data.words[w] = select(swap, word, data.words[w]);
    }
  }

  template <class S, class M>
  static void count_lengths(S& s, typename S::I count, M longer) {
    using I = typename S::I;
    using T = SssCounters;
    const auto between = [&](int low, int high)
                             HWY_ATTR { return s.active() & (I(low - 1) < count) & (count < I(high + 1)); };
    s.count(T::sss_list_1_pixels, between(1, 1));
    s.count(T::sss_list_2_to_3_pixels, between(2, 3));
    s.count(T::sss_list_4_to_7_pixels, between(4, 7));
    s.count(T::sss_list_8_to_15_pixels, between(8, 15));
    s.count(T::sss_list_16_to_31_pixels, between(16, 31));
    s.count(T::sss_list_from_32_pixels, between(32, kMost));
    s.count(T::sss_truncated_pixels, longer);
  }
};

void run_list_resolve(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<ListResolveShader>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_list_resolve);

namespace {
pipeline::FragmentProgram describe_list_resolve(bool by_place) {
  SssUniforms u;
  u.node_words = by_place ? kSssPlaceNodeWords : 4;
  return pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::ListResolveShader>(
      by_place ? "sss_place_resolve" : "sss_list_resolve",
      [](pipeline::FragmentBatch& b, const void* uniforms) {
        HWY_DYNAMIC_DISPATCH(run_list_resolve)(b, uniforms);
      },
      u);
}
}  // namespace

const pipeline::FragmentProgram& sss_list_resolve_program(bool by_place) {
  static const pipeline::FragmentProgram programs[] = {describe_list_resolve(false),
                                                       describe_list_resolve(true)};
  return programs[by_place ? 1 : 0];
}

}  // namespace hwsim::algos
#endif
