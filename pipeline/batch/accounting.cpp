#include "pipeline/batch/accounting.h"

#include <algorithm>

namespace hwsim::pipeline {
namespace {

/// Sums over the subgroups of each width: issued = lanes of the subgroup * the most trips of one of them.
struct BlockLanes {
  std::uint64_t active = 0;
  std::array<std::uint64_t, kSubgroupWidths.size()> issued{};
};

/// Adds up a block's trips, from the narrowest subgroups to the widest.
class TripSum {
 public:
  TripSum(const std::array<std::int32_t, kBatchLanes>& trips, std::uint64_t valid_lanes)
      : trips_(trips), valid_lanes_(valid_lanes) {
    add<kSubgroupWidths.size() - 1>(0);
  }
  const BlockLanes& sum() const { return sum_; }

 private:
  /// Adds the subgroup from lane `first` on; returns the most trips of one lane. A subgroup that the batch
  /// does not fill is charged for its share: the hardware fills it with other quads.
  template <std::size_t kWidth>
  std::uint64_t add(std::size_t first) {
    constexpr auto kLanes = static_cast<std::size_t>(kSubgroupWidths[kWidth]);
    const std::uint64_t valid = valid_lanes_ >> first & (~std::uint64_t{0} >> (kBatchLanes - kLanes));
    if (valid == 0) return 0;
    std::uint64_t most = 0;
    if constexpr (kWidth == 0) {
      std::int32_t all = 0, highest = 0;
      for (std::size_t lane = first; lane < first + kLanes; ++lane) {
        all += trips_[lane];
        highest = std::max(highest, trips_[lane]);
      }
      sum_.active += static_cast<std::uint64_t>(all);
      most = static_cast<std::uint64_t>(highest);
    } else {
      static_assert(kSubgroupWidths[kWidth] == 2 * kSubgroupWidths[kWidth - 1]);
      const std::uint64_t low = add<kWidth - 1>(first);
      most = std::max(low, add<kWidth - 1>(first + kLanes / 2));
    }
    sum_.issued[kWidth] += most * static_cast<std::uint64_t>(__builtin_popcountll(valid));
    return most;
  }

  const std::array<std::int32_t, kBatchLanes>& trips_;
  const std::uint64_t valid_lanes_;
  BlockLanes sum_;
};

void charge(const ShaderOps& ops, const BlockLanes& n, PassCounters& c) {
  ShaderCounters& s = c.shader;
  s.alu_lane_ops += ops.alu * n.active;
  s.alu_issued_lane_ops_w8 += ops.alu * n.issued[0];
  s.alu_issued_lane_ops_w16 += ops.alu * n.issued[1];
  s.alu_issued_lane_ops_w32 += ops.alu * n.issued[2];
  s.alu_issued_lane_ops_w64 += ops.alu * n.issued[3];
  s.sfu_lane_ops += ops.sfu * n.active;
  s.sfu_issued_lane_ops_w8 += ops.sfu * n.issued[0];
  s.sfu_issued_lane_ops_w16 += ops.sfu * n.issued[1];
  s.sfu_issued_lane_ops_w32 += ops.sfu * n.issued[2];
  s.sfu_issued_lane_ops_w64 += ops.sfu * n.issued[3];
  s.vliw5_issued_words_w64 += ops.vliw5_words * n.issued[3];
  s.alu_chain_lane_ops += ops.alu_chain * n.active;
  s.memory_chain_lane_ops += ops.memory_chain * n.active;
  s.register_lanes += ops.registers * n.active;
  s.interp_lane_ops += ops.interp * n.active;
  s.load_lane_ops += ops.load * n.active;
  s.store_lane_ops += ops.store * n.active;
  s.atomic_lane_ops += ops.atomic * n.active;
  s.group_memory_lane_ops += ops.group_memory * n.active;
  c.tex.requests += (ops.tex + ops.gather + ops.comparison) * n.active;
  c.tex.bilinear_probes += ops.tex * n.active;
  c.tex.gathers += ops.gather * n.active;
  c.tex.comparisons += ops.comparison * n.active;
  c.tex.texels += 4 * (ops.gather + ops.comparison) * n.active;
}

}  // namespace

void charge_texels(const TexelCounts& n, PassCounters& c) {
  c.tex.texels += n.bits32 + n.bits64 + n.bits128;
  c.tex.fetched_32bit_texels += n.bits32;
  c.tex.fetched_64bit_texels += n.bits64;
  c.tex.fetched_128bit_texels += n.bits128;
}

void account_blocks(const BlockTrips& blocks, const BlockOps& ops, int block_count, std::uint64_t valid_lanes,
                    PassCounters& counters) {
  BlockLanes all;
  all.active = static_cast<std::uint64_t>(__builtin_popcountll(valid_lanes));
  all.issued.fill(all.active);
  charge(ops[0], all, counters);
  for (int block = 1; block < block_count; ++block) {
    if ((blocks.used >> block & 1u) == 0) continue;
    charge(ops[static_cast<std::size_t>(block)],
           TripSum(blocks.trips[static_cast<std::size_t>(block)], valid_lanes).sum(), counters);
  }
}

void account_shading(const FragmentBatch& batch, const FragmentProgram& program, bool sample_rate,
                     PassCounters& c) {
  const auto lanes = static_cast<std::uint64_t>(__builtin_popcountll(batch.valid_lanes));
  const auto active = static_cast<std::uint64_t>(__builtin_popcountll(batch.active_lanes));
  c.stats.fragment_shader_invocations += lanes;
  c.ps.invocations += active;
  c.ps.helper_invocations += lanes - active;
  if (sample_rate) c.ps.sample_rate_invocations += active;
  c.ps.discarded_invocations += static_cast<std::uint64_t>(__builtin_popcountll(batch.discarded_lanes));
  const std::uint64_t probes_before = c.tex.bilinear_probes;
  account_blocks(batch.blocks, program.ops, program.block_count, batch.valid_lanes, c);
  c.tex.bilinear_probes += batch.tex_bilinear_probes;
  const std::uint64_t probes = c.tex.bilinear_probes - probes_before;
  c.tex.texels += 4 * probes;
  c.mem.texture_read_bytes += 16 * (probes - batch.image_probes);  // textures have 32 bits a texel
  charge_texels(batch.image_texels, c);
  c.mem.texture_read_bytes += batch.image_read_bytes;
  c.mem.storage_read_bytes += batch.storage_read_bytes;
  c.mem.storage_write_bytes += batch.storage_write_bytes;
  c.shader.narrow_store_lane_ops += batch.narrow_stores;
}

}  // namespace hwsim::pipeline
