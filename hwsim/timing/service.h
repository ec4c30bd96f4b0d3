#pragma once
// What a chunk costs: how long each unit would need for it alone, the bytes that it moves, and what lets
// units run ahead of each other.
#include "hwsim/timing/traffic.h"
#include "hwsim/units/units.h"

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

/// Packets of a chunk: a subgroup's worth of what there is most of, so that every unit sees the same number.
double packets_of(const PassCounters& c, int subgroup_size);

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

template <class T>
ChunkCost<T> chunk_cost(const PassCounters& c, const PassWork& pass, const TrafficModel<T>& model,
                        const GpuRates<T>& r) {
  const ChunkTraffic<T> traffic = chunk_traffic(c, model, r);
  ChunkCost<T> cost;
  cost.dram = traffic.dram;
  cost.ns = service_times_ns(UnitWork<T>{c, pass, traffic}, r);
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
  const auto write = [&cost](Stream stream, const T& bytes) { cost.dram.write[index_of(stream)] += bytes; };
  for (const ColorTargetWork& target : pass.color_targets) {
    const auto k = static_cast<std::size_t>(info(target.format).rate_class);
    if (r.fast_clear_color) {
      write(Stream::other, tiles * r.clear_color_tile_bytes);
    } else if (k < static_cast<std::size_t>(RateClass::depth)) {
      write(Stream::color, T(px * target.samples * info(target.format).bytes));
      cost.ns[index_of(Unit::crop)] +=
          larger(T(px * r.color_px_ns[k]), T(px * target.samples * r.color_sample_ns[k]));
    }
  }
  if (pass.depth_format != Format::none && r.fast_clear_depth) {
    write(Stream::other, tiles * r.clear_depth_tile_bytes);
  } else if (pass.depth_format != Format::none) {
    write(Stream::depth, T(px * pass.depth_samples * info(pass.depth_format).bytes));
    cost.ns[index_of(Unit::zrop)] += px * pass.depth_samples * r.zrop_sample_ns;
  }
  cost.ns[index_of(Unit::dram)] = cost.dram.total() * r.dram_byte_ns;
  return cost;
}

}  // namespace hwsim
