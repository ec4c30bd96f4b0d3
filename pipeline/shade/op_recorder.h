#pragma once
// The operations of a shader, recorded while it is counted, with what each waits for. From the record follow
// the counts of each block, the longest chains of operations that wait for each other, and the registers of
// an invocation. All of them depend on the graph of operations alone, not on the order in which a compiler of
// the host evaluated the arguments of a call.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/batch/program.h"

namespace hwsim::pipeline {

enum class OpKind : std::uint8_t {
  value,  ///< costs nothing: an index, a system value, one more component of a texel
  alu,
  fused,  ///< an addition that an earlier multiplication absorbs: costs nothing more
  sfu,
  interp,
  texture,
  gather,      ///< one channel of 2x2 texels
  comparison,  ///< 2x2 texels, compared with a depth and filtered
  fetch,       ///< a texel, unfiltered
  load,
  store,
  atomic,
  group_memory,
  output,  ///< uses values, costs nothing
};

class OpRecorder {
 public:
  using Operands = std::array<int, 3>;  ///< operations by number; -1: none

  /// Charges the current block and returns the operation's number.
  int add(OpKind kind, const Operands& operands);
  /// A place in the shader where a block stands.
  struct Site {
    int block = 0, number = 0;
    ShaderOps elsewhere;  ///< what the opened block costs at its other sites
  };
  /// From here on a block is recorded, until close(); returns where the shader was. A function that is called
  /// at several places brings its blocks along to each: lanes are counted at all of them, so such a block
  /// costs what it does at one, the dearest, not their sum.
  Site open(int block);
  void close(const Site& outer);
  /// Costs of the block that is being recorded, for what has no operands: branches and loop counters.
  ShaderOps& ops() { return blocks_[static_cast<std::size_t>(block_)]; }
  int block_count() const { return block_count_; }

  /// The blocks, with chains, words and (in block 0) registers filled in.
  BlockOps finish() const;

 private:
  struct Op {
    Operands operands;
    int block, site;
    std::uint32_t alu_chain, memory_chain;  ///< longest, of its own block, up to here
  };
  std::uint32_t registers() const;

  std::vector<Op> record_;
  BlockOps blocks_{};
  std::array<int, kMaxBlocks> open_{};  ///< how often a block is open now
  int block_ = 0, site_ = 0, sites_ = 1;
  int block_count_ = 1;
};

}  // namespace hwsim::pipeline
