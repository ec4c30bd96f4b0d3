#include "pipeline/shade/op_recorder.h"

#include <algorithm>
#include <utility>

namespace hwsim::pipeline {
namespace {

constexpr std::uint32_t kVliwSlots = 5;       // TeraScale: x, y, z, w and t
constexpr std::uint32_t kInputRegisters = 4;  // position or invocation id, and the barycentric coordinates

void charge(OpKind kind, ShaderOps& ops) {
  switch (kind) {
    case OpKind::alu:
      ops.alu += 1;
      return;
    case OpKind::sfu:
      ops.sfu += 1;
      return;
    case OpKind::interp:
      ops.interp += 1;
      return;
    case OpKind::texture:
      ops.tex += 1;
      return;
    case OpKind::gather:
      ops.gather += 1;
      return;
    case OpKind::comparison:
      ops.comparison += 1;
      return;
    case OpKind::fetch:  // charged by texels, where they are read
      return;
    case OpKind::load:
      ops.load += 1;
      return;
    case OpKind::store:
      ops.store += 1;
      return;
    case OpKind::atomic:
      ops.atomic += 1;
      return;
    case OpKind::group_memory:
      ops.group_memory += 1;
      return;
    case OpKind::value:
    case OpKind::fused:
    case OpKind::output:
      return;
  }
}

ShaderOps dearest(const ShaderOps& a, const ShaderOps& b) {
  ShaderOps ops;
  for (const auto count : {&ShaderOps::alu, &ShaderOps::sfu, &ShaderOps::interp, &ShaderOps::tex,
                           &ShaderOps::gather, &ShaderOps::comparison, &ShaderOps::load, &ShaderOps::store,
                           &ShaderOps::atomic, &ShaderOps::group_memory})
    ops.*count = std::max(a.*count, b.*count);
  return ops;
}

bool waits_for_memory(OpKind kind) {
  return kind == OpKind::texture || kind == OpKind::gather || kind == OpKind::comparison ||
         kind == OpKind::fetch || kind == OpKind::load || kind == OpKind::atomic;
}
bool runs_on_lanes(OpKind kind) {
  // Group memory answers within a few instructions.
  return kind == OpKind::alu || kind == OpKind::sfu || kind == OpKind::interp || kind == OpKind::group_memory;
}

}  // namespace

int OpRecorder::add(OpKind kind, const Operands& operands) {
  charge(kind, ops());
  Op op{operands, block_, site_, 0, 0};
  for (std::size_t i = 0; i < operands.size(); ++i) {
    if (operands[i] < 0) continue;
    const Op& from = record_[static_cast<std::size_t>(operands[i])];
    if (from.site != site_) continue;
    // The fused operation issues when the addend is there; its product (operand 0) issues with it.
    const std::uint32_t issue = kind == OpKind::fused && i > 0 ? 1 : 0;
    op.alu_chain = std::max(op.alu_chain, from.alu_chain + issue);
    op.memory_chain = std::max(op.memory_chain, from.memory_chain);
  }
  op.alu_chain += runs_on_lanes(kind) ? 1 : 0;
  op.memory_chain += waits_for_memory(kind) ? 1 : 0;
  record_.push_back(op);
  return static_cast<int>(record_.size()) - 1;
}

OpRecorder::Site OpRecorder::open(int block) {
  const auto b = static_cast<std::size_t>(block);
  Site outer{block_, site_, {}};
  if (open_.at(b)++ == 0) std::swap(outer.elsewhere, blocks_[b]);
  block_ = block;
  site_ = sites_++;
  block_count_ = std::max(block_count_, block + 1);
  return outer;
}

void OpRecorder::close(const Site& outer) {
  const auto b = static_cast<std::size_t>(block_);
  if (--open_[b] == 0) blocks_[b] = dearest(blocks_[b], outer.elsewhere);
  block_ = outer.block;
  site_ = outer.number;
}

// Every operation as late as its users allow; a register holds a result from there to its last use.
std::uint32_t OpRecorder::registers() const {
  const std::size_t count = record_.size();
  std::vector<std::uint32_t> height(count, 0);
  std::uint32_t top = 0;
  for (std::size_t i = count; i-- > 0;) {
    top = std::max(top, height[i]);
    for (const int operand : record_[i].operands)
      if (operand >= 0)
        height[static_cast<std::size_t>(operand)] =
            std::max(height[static_cast<std::size_t>(operand)], height[i] + 1);
  }
  std::vector<std::uint32_t> last_use(height);  // as heights: small is late
  for (std::size_t i = 0; i < count; ++i)
    for (const int operand : record_[i].operands)
      if (operand >= 0)
        last_use[static_cast<std::size_t>(operand)] =
            std::min(last_use[static_cast<std::size_t>(operand)], height[i]);
  std::vector<std::int32_t> change(top + 2, 0);
  for (std::size_t i = 0; i < count; ++i) {
    change[height[i]] += 1;  // walking from the end: alive below its own height, down to its last use
    change[last_use[i]] -= 1;
  }
  std::int32_t live = 0, most = 0;
  for (std::size_t h = change.size(); h-- > 0;) {
    live += change[h];
    most = std::max(most, live);
  }
  return static_cast<std::uint32_t>(most) + kInputRegisters;
}

BlockOps OpRecorder::finish() const {
  BlockOps blocks = blocks_;
  for (const Op& op : record_) {
    ShaderOps& of = blocks[static_cast<std::size_t>(op.block)];
    of.alu_chain = std::max(of.alu_chain, op.alu_chain);
    of.memory_chain = std::max(of.memory_chain, op.memory_chain);
  }
  for (ShaderOps& of : blocks) {
    const std::uint32_t slots = (of.alu + of.sfu + kVliwSlots - 1) / kVliwSlots;
    of.vliw5_words = std::max({of.sfu, slots, std::min(of.alu_chain, of.alu + of.sfu)});
  }
  blocks[0].registers = registers();
  return blocks;
}

}  // namespace hwsim::pipeline
