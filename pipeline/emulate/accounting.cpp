#include "pipeline/emulate/pass_context.h"

namespace hwsim::pipeline {
namespace {

/// Sums over the subgroups of each width: issued = lanes of the subgroup * the most trips of one of them.
struct BlockLanes {
  std::uint64_t active = 0;
  std::array<std::uint64_t, kSubgroupWidths.size()> issued{};
};

/// Lanes of a batch that run, in groups of the narrowest subgroup's width.
struct ValidGroups {
  static constexpr std::size_t kWidth = kSubgroupWidths[0], kCount = kBatchLanes / kWidth;
  std::array<std::uint64_t, kCount> lanes;  ///< that run, of each
  std::size_t used = 0;                     ///< groups up to the last that has one

  explicit ValidGroups(std::uint64_t valid_lanes) {
    for (std::size_t g = 0; g < kCount; ++g) {
      lanes[g] = static_cast<std::uint64_t>(__builtin_popcountll(valid_lanes >> (g * kWidth) & 0xff));
      if (lanes[g] != 0) used = g + 1;
    }
  }
};

BlockLanes sum_trips(const std::array<std::int32_t, kBatchLanes>& trips, const ValidGroups& valid) {
  constexpr std::size_t kWidth = ValidGroups::kWidth;
  BlockLanes sum;
  std::array<std::uint64_t, ValidGroups::kCount> most{}, lanes = valid.lanes;
  for (std::size_t g = 0; g < valid.used; ++g) {
    std::int32_t all = 0, highest = 0;
    for (std::size_t lane = g * kWidth; lane < (g + 1) * kWidth; ++lane) {
      all += trips[lane];
      highest = std::max(highest, trips[lane]);
    }
    sum.active += static_cast<std::uint64_t>(all);
    most[g] = static_cast<std::uint64_t>(highest);
  }
  // A subgroup that the batch does not fill is charged for its share: the hardware fills it with other quads.
  std::size_t groups = ValidGroups::kCount;
  for (std::uint64_t& issued : sum.issued) {
    for (std::size_t g = 0; g < groups; ++g) issued += most[g] * lanes[g];
    groups /= 2;
    for (std::size_t g = 0; g < groups; ++g) {
      most[g] = std::max(most[2 * g], most[2 * g + 1]);
      lanes[g] = lanes[2 * g] + lanes[2 * g + 1];
    }
  }
  return sum;
}

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
  c.tex.requests += ops.tex * n.active;
  c.tex.bilinear_probes += ops.tex * n.active;
}

}  // namespace

void charge_texels(const TexelCounts& n, PassCounters& c) {
  c.tex.texels += n.bits32 + n.bits64 + n.bits128;
  c.tex.fetched_32bit_texels += n.bits32;
  c.tex.fetched_64bit_texels += n.bits64;
  c.tex.fetched_128bit_texels += n.bits128;
}

bool tests_late(const PipelineState& state, const FragmentProgram* program) {
  if (program == nullptr || state.force_early_z || !(state.depth.test || state.stencil.test)) return false;
  const bool drops_samples = program->can_discard || program->writes_mask || state.coverage.alpha_to_coverage;
  return program->writes_storage || (drops_samples && (state.depth.write || state.stencil.test));
}

bool rejects_early(const PipelineState& state, const FragmentProgram* program) {
  if (!state.coverage.alpha_to_coverage || state.coverage.override_output) return false;
  return tests_late(state, program) && !program->writes_storage && state.depth.test && !state.stencil.test;
}

void account_blocks(const BlockTrips& blocks, const BlockOps& ops, int block_count, std::uint64_t valid_lanes,
                    PassCounters& counters) {
  BlockLanes all;
  all.active = static_cast<std::uint64_t>(__builtin_popcountll(valid_lanes));
  all.issued.fill(all.active);
  charge(ops[0], all, counters);
  if (blocks.used == 0) return;
  const ValidGroups valid(valid_lanes);
  for (int block = 1; block < block_count; ++block) {
    if ((blocks.used >> block & 1u) == 0) continue;
    charge(ops[static_cast<std::size_t>(block)],
           sum_trips(blocks.trips[static_cast<std::size_t>(block)], valid), counters);
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
  c.mem.texture_read_bytes += 16 * (probes - batch.image_probes);  // of textures: 32 bits a texel
  charge_texels(batch.image_texels, c);
  c.mem.texture_read_bytes += batch.image_read_bytes;
  c.mem.storage_read_bytes += batch.storage_read_bytes;
  c.mem.storage_write_bytes += batch.storage_write_bytes;
}

}  // namespace hwsim::pipeline
