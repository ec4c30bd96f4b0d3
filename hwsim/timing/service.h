#pragma once
// How long each unit would need for a chunk alone (docs/hardware_model.md, "Service times").
#include "hwsim/timing/traffic.h"

namespace hwsim {

template <class T>
struct ChunkCost {
  std::array<T, kUnitCount> ns;
  StreamBytesOf<T> dram;
  double packets = 1.0;
  T shader_latency_ns{0.0};  ///< from a subgroup's dispatch to its end
  T core_fills{0.0};         ///< how often its subgroups fill the cores
  T line_fills{0.0};         ///< how often its lines fill what a fixed-function unit has on their way
  ChunkCost() { ns.fill(T(0.0)); }
};

struct IssuedOps {
  double alu = 0.0, sfu = 0.0;
};

/// Lane operations with idle lanes, for the GPU's subgroups.
IssuedOps issued_ops(const ShaderCounters& shader, int subgroup_size);

template <class T>
T fe_ns(const PassCounters& c, const GpuRates<T>& r) {
  return static_cast<double>(c.fe.draws) * r.draw_ns +
         static_cast<double>(c.fe.state_changes) * r.state_change_ns;
}

/// Culling and setup are stages of one pipe: the slower one sets the pace.
template <class T>
T setup_ns(const PassCounters& c, const GpuRates<T>& r) {
  return larger(T(static_cast<double>(c.setup.in_primitives) * r.culled_triangle_ns),
                T(static_cast<double>(c.setup.out_primitives) * r.drawn_triangle_ns));
}

/// Pixels are charged by whole quads (small triangles), and at least once where all samples failed the depth
/// test.
template <class T>
T raster_ns(const PassCounters& c, const PassWork& pass, const GpuRates<T>& r) {
  const auto samples = static_cast<double>(c.raster.covered_samples);
  const double px =
      std::max(4.0 * static_cast<double>(c.raster.quads), samples / std::max(1, pass.raster_samples));
  const T by_px = larger(T(px * r.raster_px_ns), T(samples * r.raster_sample_ns));
  return larger(by_px, T(static_cast<double>(c.raster.visited_tiles) * r.raster_tile_ns));
}

template <class T>
T zrop_ns(const PassCounters& c, const GpuRates<T>& r) {
  const std::uint64_t tested = c.zrop.early_z_tested_samples + c.zrop.late_z_tested_samples;
  return static_cast<double>(std::max(tested, c.zrop.written_samples)) * r.zrop_sample_ns;
}

/// Geometry shaders' output alone; what they compute is shader work as any other.
template <class T>
T gs_output_ns(const PassCounters& c, const GpuRates<T>& r) {
  return static_cast<double>(c.gs.output_bytes) / 4.0 * r.gs_output_word_ns;
}

/// Vertex shading alone.
template <class T>
T vs_ns(const PassCounters& c, const GpuRates<T>& r) {
  return larger(T(static_cast<double>(c.vs.alu_lane_ops) * r.alu_lane_op_ns),
                T(static_cast<double>(c.vs.sfu_lane_ops) * r.sfu_lane_op_ns));
}

/// Subgroups that a core holds at once: its registers, shared by those of the chunk's invocations, and the
/// group memory that they reserve (docs/techniques/sbaa.md#group-memory: four of SBAA's analysis on a SIMD of
/// 32 KiB).
template <class T>
T resident_subgroups(const PassCounters& c, const PassWork& pass, const GpuRates<T>& r) {
  T most = r.subgroups_max;
  if (pass.group_memory_lane_bytes > 0)
    most = smaller(most, T(r.group_memory_bytes /
                           (static_cast<double>(pass.group_memory_lane_bytes) * r.subgroup_size)));
  const auto lanes =
      static_cast<double>(c.stats.fragment_shader_invocations + c.stats.geometry_shader_invocations +
                          c.stats.compute_shader_invocations);
  const auto registers = static_cast<double>(c.shader.register_lanes);
  if (lanes > 0.0 && registers > 0.0)
    most = smaller(most, T(r.registers / (registers / lanes * r.subgroup_size)));
  return larger(T(1.0), most);
}

/// An unfiltered texel takes the place of a probe, a wide one of several. (Filtered textures are 32-bit.)
template <class T>
T fetch_ns(const PassCounters& c, const GpuRates<T>& r) {
  return (static_cast<double>(c.tex.fetched_32bit_texels) +
          static_cast<double>(c.tex.fetched_64bit_texels) * r.fetch_64bit_cost +
          static_cast<double>(c.tex.fetched_128bit_texels) * r.fetch_128bit_cost) *
         r.bilinear_probe_ns;
}

template <class T>
T tex_pipe_ns(const PassCounters& c, const GpuRates<T>& r) {
  return static_cast<double>(c.tex.bilinear_probes) * r.bilinear_probe_ns + fetch_ns(c, r);
}

/// Subgroups that fragments, geometry-shader and compute invocations fill, in parts.
double subgroups_of(const PassCounters& c, int subgroup_size);

/// Packets of a chunk: a subgroup's worth of what there is most of, so that every unit sees the same number.
double packets_of(const PassCounters& c, int subgroup_size);
/// Latency of a subgroup's memory request: it waits for the slowest of its lanes, so one line that misses is
/// enough.
template <class T>
T memory_latency_ns(const PassCounters& c, const ChunkTraffic<T>& traffic, const GpuRates<T>& r) {
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
template <class T>
T subgroup_life_ns(const PassCounters& c, const ChunkTraffic<T>& traffic, const T& pipes_ns, double subgroups,
                   const GpuRates<T>& r) {
  const double lanes = subgroups * r.subgroup_size;
  const T alu_chain = (static_cast<double>(c.shader.alu_chain_lane_ops) / lanes) * r.alu_latency_ns;
  const T memory =
      (static_cast<double>(c.shader.memory_chain_lane_ops) / lanes) * memory_latency_ns(c, traffic, r);
  return memory + larger(alu_chain, T(pipes_ns * r.shader_cores / subgroups)) +
         tex_pipe_ns(c, r) * r.shader_cores / subgroups;
}

/// The cores as a set of subgroups that wait most of the time (Little's law): a core holds so many at once.
template <class T>
T latency_bound_ns(const PassCounters& c, const PassWork& pass, const ChunkTraffic<T>& traffic,
                   const T& pipes_ns, const GpuRates<T>& r) {
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

template <class T>
ShaderPipes<T> shader_pipes(const PassCounters& c, const GpuRates<T>& r) {
  const IssuedOps issued = issued_ops(c.shader, r.subgroup_size);
  T alu = (static_cast<double>(c.vs.alu_lane_ops) + issued.alu) * r.alu_lane_op_ns;
  if (r.vliw) {  // a special function takes a slot; words cannot be fuller than chains and t slots allow
    alu += (static_cast<double>(c.vs.sfu_lane_ops) + issued.sfu) * r.alu_lane_op_ns;
    alu = larger(alu, T(static_cast<double>(c.shader.vliw5_issued_words_w64) * r.vliw_word_ns));
  }
  T sfu = (static_cast<double>(c.vs.sfu_lane_ops) + issued.sfu) * r.sfu_lane_op_ns;
  const T interp = static_cast<double>(c.shader.interp_lane_ops) * r.interp_scalar_ns;
  (r.interp_on_alu ? alu : sfu) += interp;
  const T words = static_cast<double>(c.shader.load_lane_ops + c.shader.store_lane_ops) * r.memory_word_ns;
  const T group = static_cast<double>(c.shader.group_memory_lane_ops) * r.group_memory_word_ns;
  const T atomics =
      larger(T(static_cast<double>(c.shader.atomic_lane_ops) * r.atomic_ns),
             T(static_cast<double>(c.shader.same_address_atomic_lane_ops) * r.same_address_atomic_ns));
  return {alu, sfu, words, group, atomics};
}

/// Pipes run side by side, the fullest sets the pace, unless too few subgroups are there to hide their
/// latency.
template <class T>
T shader_ns(const PassCounters& c, const PassWork& pass, const ChunkTraffic<T>& traffic,
            const GpuRates<T>& r) {
  const T pipes = shader_pipes(c, r).fullest();
  return larger(pipes, latency_bound_ns(c, pass, traffic, pipes, r));
}

template <class T>
T tex_ns(const PassCounters& c, const T& l1_fill_bytes, const GpuRates<T>& r) {
  return larger(tex_pipe_ns(c, r), T(l1_fill_bytes * r.l1_fill_byte_ns));
}

/// docs/hardware_sources.md#rops: rop time = max(pixels / pixel rate, uncompressed samples / sample rate),
/// summed over the targets.
template <class T>
T crop_ns(const PassCounters& c, const PassWork& pass, const GpuRates<T>& r) {
  double all_samples = 0.0;
  for (const ColorTargetWork& target : pass.color_targets) all_samples += target.samples;
  const auto targets = static_cast<double>(pass.color_targets.size());
  T sum(0.0);
  for (const ColorTargetWork& target : pass.color_targets) {
    const auto k = static_cast<std::size_t>(info(target.format).rate_class);
    if (k >= static_cast<std::size_t>(RateClass::depth)) continue;
    const double px = static_cast<double>(c.crop.exported_fragments) / targets;
    const bool blended = target.blended && c.crop.blended_samples > 0;
    const T& px_ns = blended ? r.blended_px_ns[k] : r.color_px_ns[k];
    T cost = px * px_ns;
    if (target.samples > 1) {
      const double written = static_cast<double>(c.crop.written_samples) * target.samples / all_samples;
      const double single = static_cast<double>(c.crop.single_color_fragments) / targets * target.samples;
      const double samples = r.crop_compressible_at_pixel_rate ? std::max(0.0, written - single) : written;
      cost = larger(cost, T(samples * r.color_sample_ns[k] * (px_ns / r.color_px_ns[k])));
    }
    sum += cost;
  }
  return sum;
}

template <class T>
T resolve_ns(const PassCounters& c, const PassWork& pass, const GpuRates<T>& r) {
  const T read = static_cast<double>(c.resolve.read_samples) * r.resolve_sample_ns;
  if (pass.color_targets.empty()) return read;
  const auto k = static_cast<std::size_t>(info(pass.color_targets.front().format).rate_class);
  if (k >= static_cast<std::size_t>(RateClass::depth)) return read;
  return larger(read, T(static_cast<double>(c.resolve.written_pixels) * r.color_px_ns[k]));
}

/// What lets units run ahead of each other.
template <class T>
void set_waiting(const PassCounters& c, const PassWork& pass, const ChunkTraffic<T>& traffic,
                 const GpuRates<T>& r, ChunkCost<T>& cost) {
  const double subgroups = subgroups_of(c, r.subgroup_size);
  if (subgroups > 0.0) {
    cost.shader_latency_ns = subgroup_life_ns(c, traffic, shader_pipes(c, r).fullest(), subgroups, r);
    cost.core_fills = subgroups / (resident_subgroups(c, pass, r) * r.shader_cores);
  }
  cost.line_fills = larger(traffic.l2_bytes, traffic.dram.total()) / (r.unit_lines * kTextureLineBytes);
}

/// Bytes, and two turns of the bus for each group of writes that has reads around it.
template <class T>
T dram_ns(const StreamBytesOf<T>& bytes, const GpuRates<T>& r) {
  T read(0.0), write(0.0);
  for (const T& b : bytes.read) read += b;
  for (const T& b : bytes.write) write += b;
  const T groups = smaller(T(write / static_cast<double>(r.dram_write_lines)), read) / kTextureLineBytes;
  return (read + write) * r.dram_byte_ns + 2.0 * groups * r.dram_turn_ns;
}

template <class T>
ChunkCost<T> chunk_cost(const PassCounters& c, const PassWork& pass, const TrafficModel<T>& model,
                        const GpuRates<T>& r) {
  const ChunkTraffic<T> traffic = chunk_traffic(c, model, r);
  ChunkCost<T> cost;
  cost.dram = traffic.dram;
  const auto set = [&cost](Unit unit, const T& ns) { cost.ns[at(unit)] = ns; };
  set(Unit::fe, fe_ns(c, r));
  set(Unit::ia, static_cast<double>(c.stats.input_assembly_vertices) * r.index_ns);
  set(Unit::vs, larger(vs_ns(c, r), gs_output_ns(c, r)));
  set(Unit::setup, setup_ns(c, r));
  set(Unit::raster, raster_ns(c, pass, r));
  set(Unit::hiz, static_cast<double>(c.hiz.tested_tiles) * kTilePixels * r.hiz_px_ns);
  set(Unit::zrop, zrop_ns(c, r));
  set(Unit::shader, shader_ns(c, pass, traffic, r));
  set(Unit::tex, tex_ns(c, traffic.l1_fill_bytes, r));
  set(Unit::crop, crop_ns(c, pass, r));
  set(Unit::resolve, resolve_ns(c, pass, r));
  set(Unit::l2, traffic.l2_bytes * r.l2_byte_ns);
  set(Unit::dram, dram_ns(traffic.dram, r));
  cost.packets = packets_of(c, r.subgroup_size);
  set_waiting(c, pass, traffic, r, cost);
  return cost;
}

/// A clear, whole: table bytes where the GPU has fast clear, every sample otherwise.
template <class T>
ChunkCost<T> clear_cost(const PassWork& pass, const GpuRates<T>& r) {
  if (r.tile_based) return {};  // the pass that draws finds its tile memory cleared, and stores it
  const double tiles =
      static_cast<double>((pass.width_px + 7) / 8) * static_cast<double>((pass.height_px + 7) / 8);
  const double px = static_cast<double>(pass.width_px) * static_cast<double>(pass.height_px);
  ChunkCost<T> cost;
  const auto write = [&cost](Stream stream, const T& bytes) { cost.dram.write[at(stream)] += bytes; };
  for (const ColorTargetWork& target : pass.color_targets) {
    const auto k = static_cast<std::size_t>(info(target.format).rate_class);
    if (r.fast_clear_color) {
      write(Stream::other, tiles * r.clear_color_tile_bytes);
    } else if (k < static_cast<std::size_t>(RateClass::depth)) {
      write(Stream::color, T(px * target.samples * info(target.format).bytes));
      cost.ns[at(Unit::crop)] +=
          larger(T(px * r.color_px_ns[k]), T(px * target.samples * r.color_sample_ns[k]));
    }
  }
  if (pass.depth_format != Format::none && r.fast_clear_depth) {
    write(Stream::other, tiles * r.clear_depth_tile_bytes);
  } else if (pass.depth_format != Format::none) {
    write(Stream::depth, T(px * pass.depth_samples * info(pass.depth_format).bytes));
    cost.ns[at(Unit::zrop)] += px * pass.depth_samples * r.zrop_sample_ns;
  }
  cost.ns[at(Unit::dram)] = cost.dram.total() * r.dram_byte_ns;
  return cost;
}

}  // namespace hwsim
