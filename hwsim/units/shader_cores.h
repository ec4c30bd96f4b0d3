#pragma once
// Shader cores: pipes side by side, and subgroups that wait for their latencies. The fullest pipe sets the
// pace, unless too few subgroups are there to hide their latency.
#include "hwsim/base/units_of_measure.h"
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/texture.h"
#include "hwsim/units/unit_work.h"

namespace hwsim {

struct IssuedOps {
  double alu = 0.0, sfu = 0.0;
};

/// Lane operations with idle lanes, for the GPU's subgroups.
IssuedOps issued_ops(const ShaderCounters& shader, int subgroup_size);

/// Subgroups that fragments, geometry-shader and compute invocations fill, in parts.
double subgroups_of(const PassCounters& c, int subgroup_size);

/// Subgroups that a core holds at once: its registers, shared by those of the chunk's invocations, and the
/// group memory that they reserve (docs/techniques/sbaa.md#group-memory: four of SBAA's analysis on a SIMD of
/// 32 KiB).
template <class R, class T = typename R::Scalar>
T resident_subgroups(const PassCounters& c, const PassWork& pass, const R& r) {
  T most = r.subgroups_max;
  if (pass.group_memory_lane_bytes > 0)
    most = smaller(most, T(r.group_memory_bytes /
                           (static_cast<double>(pass.group_memory_lane_bytes) * r.subgroup_size)));
  const auto lanes =
      static_cast<double>(c.stats.fragment_shader_invocations + c.stats.geometry_shader_invocations +
                          c.stats.compute_shader_invocations);
  const auto registers = static_cast<double>(c.shader.register_lanes);
  if (lanes > 0.0 && registers > 0.0)
    most = smaller(most,
                   T(r.registers / (smaller(T(registers / lanes), r.registers_lane_max) * r.subgroup_size)));
  return larger(T(1.0), most);
}

/// Values that an invocation has no register for: each is stored and loaded again, once at least. The chunk's
/// mean stands for its invocations.
template <class R, class T = typename R::Scalar>
T spilled_words(const PassCounters& c, const R& r) {
  const auto lanes =
      static_cast<double>(c.stats.fragment_shader_invocations + c.stats.geometry_shader_invocations +
                          c.stats.compute_shader_invocations);
  return 2.0 * larger(T(0.0), T(static_cast<double>(c.shader.register_lanes) - lanes * r.registers_lane_max));
}

/// Latency of a subgroup's memory request: it waits for the slowest of its lanes, so one line that misses is
/// enough.
template <class T, class R>
T memory_latency_ns(const PassCounters& c, const ChunkTraffic<T>& traffic, const R& r) {
  const std::uint64_t fetched =
      c.tex.fetched_32bit_texels + c.tex.fetched_64bit_texels + c.tex.fetched_128bit_texels;
  const double requests =
      static_cast<double>(c.tex.requests + fetched + c.shader.load_lane_ops + c.shader.atomic_lane_ops) /
      r.subgroup_size;
  if (requests <= 0.0) return r.tex_latency_ns;
  const T beyond_l1 = smaller(T(1.0), T(traffic.l1_missed_lines() / requests));
  const T beyond_l2 = smaller(beyond_l1, T(traffic.l2_missed_lines() / requests));
  return (1.0 - beyond_l1) * r.tex_latency_ns + (beyond_l1 - beyond_l2) * r.l2_latency_ns +
         beyond_l2 * r.dram_latency_ns;
}

/// How long a subgroup stays in a core that is otherwise empty: its chain of operations, or as long as the
/// pipes need for it alone, and its chain of memory requests.
template <class T, class R>
T subgroup_life_ns(const PassCounters& c, const ChunkTraffic<T>& traffic, const T& pipes_ns, double subgroups,
                   const R& r) {
  const double lanes = subgroups * r.subgroup_size;
  const T alu_chain = (static_cast<double>(c.shader.alu_chain_lane_ops) / lanes) * r.alu_latency_ns;
  const T memory =
      (static_cast<double>(c.shader.memory_chain_lane_ops) / lanes) * memory_latency_ns(c, traffic, r);
  return memory + larger(alu_chain, T(pipes_ns * r.shader_cores / subgroups)) +
         tex_pipe_ns(c, r) * r.shader_cores / subgroups;
}

/// The cores as a set of subgroups that wait most of the time (Little's law): a core holds so many at once.
template <class T, class R>
T latency_bound_ns(const PassCounters& c, const PassWork& pass, const ChunkTraffic<T>& traffic,
                   const T& pipes_ns, const R& r) {
  const double subgroups = subgroups_of(c, r.subgroup_size);
  if (subgroups <= 0.0) return T(0.0);
  return subgroups * subgroup_life_ns(c, traffic, pipes_ns, subgroups, r) /
         (r.shader_cores * resident_subgroups(c, pass, r));
}

/// Time of each pipe of the cores for all that they run in the chunk, vertex shading included.
template <class T>
struct ShaderPipes {
  T alu, sfu, words, group, atomics;
  T fullest() const { return larger(larger(larger(alu, sfu), larger(words, group)), atomics); }
};

template <class R, class T = typename R::Scalar>
ShaderPipes<T> shader_pipes(const PassCounters& c, const R& r) {
  const IssuedOps issued = issued_ops(c.shader, r.subgroup_size);
  T alu = (static_cast<double>(c.vs.alu_lane_ops) + issued.alu) * r.alu_lane_op_ns;
  if (r.vliw) {  // a special function takes slots; words cannot be fuller than chains and t slots allow
    alu += (static_cast<double>(c.vs.sfu_lane_ops) + issued.sfu) * r.vliw_sfu_slots * r.alu_lane_op_ns;
    alu = larger(alu, T(static_cast<double>(c.shader.vliw5_issued_words_w64) * r.vliw_word_ns));
  }
  T sfu = (static_cast<double>(c.vs.sfu_lane_ops) + issued.sfu) * r.sfu_lane_op_ns;
  const T interp = static_cast<double>(c.shader.interp_lane_ops) * r.interp_scalar_ns;
  (r.interp_on_alu ? alu : sfu) += interp;
  const T words =
      (static_cast<double>(c.shader.load_lane_ops + c.shader.store_lane_ops) + spilled_words(c, r)) *
      r.memory_word_ns;
  const T group = static_cast<double>(c.shader.group_memory_lane_ops) * r.group_memory_word_ns;
  const T atomics =
      larger(T(static_cast<double>(c.shader.atomic_lane_ops) * r.atomic_ns +
               static_cast<double>(c.shader.narrow_store_lane_ops) * r.narrow_store_ns),
             T(static_cast<double>(c.shader.same_address_atomic_lane_ops) * r.same_address_atomic_ns));
  return {alu, sfu, words, group, atomics};
}

}  // namespace hwsim

namespace hwsim::units {

/// The shader cores: what runs subgroups.
struct ShaderCores {
  static constexpr UnitInfo kInfo = {
      "shader", UnitPlace::cores, set_of(),
      "max over the pipes of the cores: arithmetic, special functions, loads and stores, group memory, "
      "atomics with narrow stores; at least the latency bound, see below"};

  template <class T>
  struct Values {
    T shader_cores{0.0};
    T fp32_lanes_per_core{0.0};
    T sfu_lanes_per_core{0.0};
    int subgroup_size = 32;
    T vliw_slots{1.0};
    T vliw_fill_slots{1.0};
    T vliw_sfu_slots{1.0};
    T alu_efficiency_ratio{1.0};
    T interp_scalars_per_core_clk{0.0};
    bool interp_on_alu = false;
    T registers_kib_per_core{256.0};
    T registers_per_invocation_max{255.0};
    T group_memory_kib_per_core{32.0};
    T subgroups_per_core_max{48.0};
    T alu_latency_cycles{8.0};
    T load_words_per_core_clk{16.0};
    T group_memory_words_per_core_clk{32.0};
    int core_lines_max = 256;
    T atomic_lane_ops_per_clk{64.0};
    T atomic_same_address_ops_per_clk{1.0};
    T narrow_stores_per_clk{kRateHigh};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"shader_cores", 1, 1e5, kRequired | kFaster | kWhole,
           "SM, SIMD engine, compute unit, EU: what runs a subgroup"},
          c.shader_cores);
    v.key({"fp32_lanes_per_core", kRateLow, 1e5, kRequired | kFaster,
           "32-bit multiply-adds a shader clock and core"},
          c.fp32_lanes_per_core);
    v.key({"sfu_lanes_per_core", kRateLow, 1e5, kRequired | kFaster,
           "special functions a shader clock and core"},
          c.sfu_lanes_per_core);
    v.key({"subgroup_size", 8, 64, kNeither, "lanes that run in lock step: 8, 16, 32 or 64"},
          c.subgroup_size);
    v.key({"vliw_slots", 1, 16, kSlower, "operations of an instruction word; 1 for scalar lanes"},
          c.vliw_slots);
    v.key({"vliw_fill_slots", 0.1, 16, kFit | kFaster, "of these, filled on average"}, c.vliw_fill_slots);
    v.key({"vliw_sfu_slots", 1, 16, kSlower, "of a word's slots, those that a special function takes"},
          c.vliw_sfu_slots);
    v.key({"alu_efficiency_ratio", kRatioLow, 1, kFit | kFaster, "issue slots that shaders can use"},
          c.alu_efficiency_ratio);
    v.key({"interp_scalars_per_core_clk", kRateLow, kRateHigh, kRequired | kFaster,
           "attribute scalars interpolated a shader clock and core"},
          c.interp_scalars_per_core_clk);
    v.key({"interp_on_alu", 0, 0, kNeither,
           "interpolation takes issue slots of the lanes, not of the special functions"},
          c.interp_on_alu);
    v.key({"registers_kib_per_core", 1, kKibHigh, kFaster,
           "register file: with the shader's registers it bounds the resident subgroups"},
          c.registers_kib_per_core);
    v.key({"registers_per_invocation_max", 8, 4096, kNeither,
           "32-bit registers that instructions can name: values beyond them are stored and loaded"},
          c.registers_per_invocation_max);
    v.key({"group_memory_kib_per_core", 1, kKibHigh, kFaster,
           "group memory: what compute groups reserve of it bounds the resident subgroups, too"},
          c.group_memory_kib_per_core);
    v.key({"subgroups_per_core_max", 1, 4096, kFaster, "resident subgroups whatever they need"},
          c.subgroups_per_core_max);
    v.key({"alu_latency_cycles", 1, 1e4, kSlower, "shader clocks from an operation to one that waits for it"},
          c.alu_latency_cycles);
    v.key({"load_words_per_core_clk", kRateLow, kRateHigh, kFaster,
           "32-bit loads and stores a core clock and core"},
          c.load_words_per_core_clk);
    v.key({"group_memory_words_per_core_clk", kRateLow, kRateHigh, kFaster,
           "32-bit group-memory accesses a core clock and core"},
          c.group_memory_words_per_core_clk);
    v.key({"core_lines_max", 16, 65536, kFaster, "engine detailed: lines on their way to a core"},
          c.core_lines_max);
    v.key({"atomic_lane_ops_per_clk", kRateLow, kRateHigh, kFit | kFaster,
           "atomics of the chip, mixed addresses"},
          c.atomic_lane_ops_per_clk);
    v.key({"atomic_same_address_ops_per_clk", kRateLow, kRateHigh, kFit | kFaster, "atomics on one address"},
          c.atomic_same_address_ops_per_clk);
    v.key({"narrow_stores_per_clk", kRateLow, kRateHigh, kFaster,
           "texels of fewer than 32 bits that the chip's shaders store; they take the path of atomics"},
          c.narrow_stores_per_clk);
  }

  template <class T>
  struct Rates {
    T shader_cores, subgroups_max, registers, group_memory_bytes, alu_latency_ns;
    T alu_lane_op_ns, sfu_lane_op_ns, interp_scalar_ns, memory_word_ns, group_memory_word_ns;
    T atomic_ns, same_address_atomic_ns, narrow_store_ns;
    T vliw_word_ns;  ///< zero where words have neither five slots nor four: then the average fill alone says
                     ///< it
    T vliw_sfu_slots, registers_lane_max;
    int subgroup_size;
    bool vliw;  ///< special functions take a slot of the words
    bool interp_on_alu;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    const T lanes = c.shader_cores * c.fp32_lanes_per_core * c.vliw_fill_slots / c.vliw_slots;
    // Words are counted with five slots; in as many with four no more fits.
    constexpr double kCountedVliwSlots = 5.0, kFewestCountedSlots = 4.0, kRegisterBytes = 4.0;
    r.vliw = c.vliw_slots > T(1.0);
    r.vliw_word_ns = T(0.0);
    if (!(c.vliw_slots < T(kFewestCountedSlots)) && !(T(kCountedVliwSlots) < c.vliw_slots))
      r.vliw_word_ns =
          r.shader_clk_ns * c.vliw_slots / (c.shader_cores * c.fp32_lanes_per_core * c.alu_efficiency_ratio);
    r.vliw_sfu_slots = c.vliw_sfu_slots;
    r.registers_lane_max = c.registers_per_invocation_max;
    r.shader_cores = c.shader_cores;
    r.subgroups_max = c.subgroups_per_core_max;
    r.group_memory_bytes = c.group_memory_kib_per_core * kBytesPerKib;
    r.registers = c.registers_kib_per_core * (kBytesPerKib / kRegisterBytes);
    r.alu_latency_ns = c.alu_latency_cycles * r.shader_clk_ns;
    r.alu_lane_op_ns = r.shader_clk_ns / (lanes * c.alu_efficiency_ratio);
    r.sfu_lane_op_ns = r.shader_clk_ns / (c.shader_cores * c.sfu_lanes_per_core);
    r.interp_scalar_ns = r.shader_clk_ns / (c.shader_cores * c.interp_scalars_per_core_clk);
    r.interp_on_alu = c.interp_on_alu;
    r.memory_word_ns = clk_ns / (c.shader_cores * c.load_words_per_core_clk);
    r.group_memory_word_ns = clk_ns / (c.shader_cores * c.group_memory_words_per_core_clk);
    r.atomic_ns = clk_ns / c.atomic_lane_ops_per_clk;
    r.same_address_atomic_ns = clk_ns / c.atomic_same_address_ops_per_clk;
    r.narrow_store_ns = clk_ns / c.narrow_stores_per_clk;
    r.subgroup_size = c.subgroup_size;
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    const T pipes = shader_pipes(w.counters, r).fullest();
    return larger(pipes, latency_bound_ns(w.counters, w.pass, w.traffic, pipes, r));
  }
};

}  // namespace hwsim::units
