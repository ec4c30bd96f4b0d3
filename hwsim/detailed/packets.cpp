#include "hwsim/detailed/packets.h"

#include <algorithm>
#include <cmath>

namespace hwsim {
namespace {

/// Queues that a packet waits in before it is dispatched.
constexpr auto kUnitsBeforeCores = static_cast<double>(count_units(UnitPlace::front));

SubgroupWork subgroup_work(const PassCounters& c, const ShaderPipes<double>& pipes, double tex_ns,
                           const TrafficModel<double>& model, const GpuRates<double>& r, double subgroups) {
  const double of_core = r.shader_cores / subgroups;
  SubgroupWork work;
  work.alu_ns = pipes.alu * of_core;
  work.sfu_ns = pipes.sfu * of_core;
  work.memory_pipe_ns = std::max(pipes.words, pipes.group) * of_core;
  work.atomic_ns = pipes.atomics / subgroups;  // one unit of the chip
  work.tex_ns = tex_ns * of_core;
  const double lanes = std::max(1.0, subgroups_of(c, r.subgroup_size) * r.subgroup_size);
  work.alu_chain_ns = static_cast<double>(c.shader.alu_chain_lane_ops) / lanes * r.alu_latency_ns;
  work.memory_phases = static_cast<double>(c.shader.memory_chain_lane_ops) / lanes;
  work.l1_lines =
      static_cast<double>(c.mem.texture_read_bytes) * model.l1_asked / kTextureLineBytes / subgroups;
  work.storage_lines = static_cast<double>(c.mem.storage_read_bytes) *
                       model.l2.read[index_of(Stream::storage)] / kTextureLineBytes / subgroups;
  return work;
}

bool passes_l2_by(std::size_t stream, const GpuRates<double>& r) {
  if (stream == index_of(Stream::color) || stream == index_of(Stream::depth))
    return !r.rop_through_l2 || r.tile_based;
  return false;
}

void share_bytes(const PassCounters& c, const TrafficModel<double>& model, const GpuRates<double>& r,
                 ChunkPackets& chunk) {
  const StreamBytes asked = requested_bytes(c);
  const auto n = static_cast<double>(chunk.count);
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    const bool by = passes_l2_by(i, r);
    StreamBytesOf<double>& to = by ? chunk.direct : chunk.l2;
    const StreamBytesOf<double>& ratio = by ? model.dram : model.l2;
    to.read[i] = asked.read[i] * ratio.read[i] / n;
    to.write[i] = asked.write[i] * ratio.write[i] / n;
  }
  if (r.tile_based) {
    for (std::size_t i = 0; i < kStreamCount; ++i) {
      chunk.direct.read[i] += model.tile_chunk.read[i] / n;
      chunk.direct.write[i] += model.tile_chunk.write[i] / n;
    }
    const double binned = binned_bytes(c, model.tile_px, r) / n;
    chunk.direct.read[index_of(Stream::other)] += binned;
    chunk.direct.write[index_of(Stream::other)] += binned;
  }
  chunk.l2.read[index_of(Stream::other)] += ring_bytes(c, r.gs_on_chip) / n;
  chunk.l2.write[index_of(Stream::other)] += ring_bytes(c, r.gs_on_chip) / n;
  chunk.l2.read[index_of(Stream::texture)] = 0.0;  // L1 decides which lines L2 is asked for
  chunk.l2.read[index_of(Stream::storage)] = 0.0;  // asked for by the subgroups
}

/// Tiles come into the ROPs' caches and leave them whole, or what was asked of them: one after the other, the
/// lines of a tile follow each other.
void set_runs(const PassWork& pass, const PassShape& shape, const TrafficModel<double>& model,
              const GpuRates<double>& r, PacketPlan& plan) {
  plan.run_lines.read.fill(1.0);
  plan.run_lines.write.fill(1.0);
  for (const bool color : {true, false}) {
    const std::size_t i = index_of(color ? Stream::color : Stream::depth);
    const MissCurve& curve = pass.reuse.apart[index_of(color ? ReuseStream::color : ReuseStream::depth)];
    const double cache = color ? r.crop_cache_bytes : r.zrop_cache_bytes,
                 tile = color ? shape.color_tile_bytes : shape.depth_tile_bytes;
    const auto lines = [&](const auto& bytes, const auto& stays, double reached, double reached_raw) {
      const double kept = reached_raw > 0.0 ? std::min(1.0, reached / reached_raw) : 1.0;
      return std::max(1.0, stay_bytes(bytes, stays, cache, tile) * kept / kTextureLineBytes);
    };
    plan.run_lines.read[i] =
        lines(curve.read_bytes, curve.read_stays, model.l2.read[i], model.reaches_l2.read[i]);
    plan.run_lines.write[i] =
        lines(curve.write_bytes, curve.write_stays, model.l2.write[i], model.reaches_l2.write[i]);
  }
}

/// What waits where units serve with a load (below 1) and a latency, at most `most`.
double waiting(double latency, double load, double most) {
  return latency < most * (1.0 - load) ? latency / (1.0 - load) : most;
}

/// Packets between the front's queues and the ROPs: as many as arrive while one is in the cores and its lines
/// are on their way, more where the units behind the front are nearly full; at most what the cores and the
/// units' lines hold.
double in_flight_packets(const ChunkPackets& chunk, const ChunkCost<double>& cost,
                         const GpuRates<double>& r) {
  double packets = static_cast<double>(r.queue_packets) * kUnitsBeforeCores;
  if (chunk.expected_ns <= 0.0) return packets;
  const double dram_load = chunk.service_ns[index_of(Unit::dram)] / chunk.expected_ns;
  packets += waiting(r.dram_latency_ns * dram_load / chunk.expected_ns, dram_load,
                     r.unit_lines * kTextureLineBytes / std::max(1.0, chunk.expected_bytes));
  if (chunk.subgroups <= 0.0) return packets;
  double behind_ns = 0.0;
  for (std::size_t u = 0; u < kUnitCount; ++u)
    if (!stands_in(u, UnitPlace::front)) behind_ns = std::max(behind_ns, chunk.service_ns[u]);
  return packets +
         waiting(cost.shader_latency_ns / chunk.expected_ns, behind_ns / chunk.expected_ns,
                 chunk.resident * r.shader_cores * static_cast<double>(chunk.count) / chunk.subgroups);
}

}  // namespace

const ChunkPackets& PacketPlan::chunk_of(std::uint64_t packet) const {
  const auto after = std::upper_bound(chunks.begin(), chunks.end(), packet,
                                      [](std::uint64_t p, const ChunkPackets& c) { return p < c.first; });
  return *(after - 1);
}

PacketPlan plan_packets(const PassWork& pass, const GpuRates<double>& rates) {
  const PassShape shape = shape_of(pass);
  const TrafficModel<double> model = model_traffic(shape, pass, rates);
  PacketPlan plan;
  plan.reaches_l2 = model.reaches_l2;
  plan.l1_asked = model.l1_asked;
  set_runs(pass, shape, model, rates, plan);
  for (const PassCounters& c : pass.chunks) {
    const ChunkCost<double> cost = chunk_cost(c, pass, model, rates);
    ChunkPackets chunk;
    chunk.subgroups = std::ceil(subgroups_of(c, rates.subgroup_size));
    chunk.first = plan.packets;
    chunk.count = static_cast<std::uint64_t>(cost.packets);
    plan.packets += chunk.count;
    for (std::size_t u = 0; u < kUnitCount; ++u)
      chunk.service_ns[u] = cost.ns[u] / static_cast<double>(chunk.count);
    if (chunk.subgroups > 0.0) chunk.leaving_packets = static_cast<double>(chunk.count) / chunk.subgroups;
    chunk.resident = std::floor(resident_subgroups(c, pass, rates));
    if (chunk.subgroups > 0.0)
      chunk.work =
          subgroup_work(c, shader_pipes(c, rates), tex_pipe_ns(c, rates), model, rates, chunk.subgroups);
    share_bytes(c, model, rates, chunk);
    chunk.expected_ns = *std::max_element(chunk.service_ns.begin(), chunk.service_ns.end());
    chunk.expected_bytes = cost.dram.total() / static_cast<double>(chunk.count);
    chunk.in_flight = in_flight_packets(chunk, cost, rates);
    plan.chunks.push_back(chunk);
  }
  return plan;
}

}  // namespace hwsim
